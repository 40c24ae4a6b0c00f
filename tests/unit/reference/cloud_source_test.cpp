// SPDX-License-Identifier: Apache-2.0
// Light scattered at points of clouds against the sky tracer's pictures of them.
#include "welkin/reference/cloud_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/testing/skies.h"
#include "tests/testing/traced.h"
#include "welkin/core/units.h"
#include "welkin/reference/directions.h"
#include "welkin/reference/sky_tracer.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/rain_shafts.h"

namespace welkin::reference {
namespace {

using weather::Genus;

constexpr double kLux = 1000.0;

// What eyes see of clouds without air is what is scattered where their looks end.
TEST(CloudSource, IsWhatTheTracerSees) {
  for (const Genus genus : {Genus::kCumulus, Genus::kCirrus}) {
    const scene::SkyState state = testing::airlessSky(testing::cloudyScene(35.0, {genus}, 5.0), kLux);
    const SkyTracer tracer(state, {});
    const CloudMedium medium(*state.clouds, {0}, {scene::matterInField(state.scene, state.weather, 0)});
    const auto droplets = dropletPhase(scene::dropletDiameterUm(state.weather), DropletModel::kFit);
    const auto ice = snowPhase();
    const glm::dvec3 sun(state.lights[0].direction);
    const CloudSource source(medium, sun, droplets, ice);
    constexpr int kPaths = 40000;
    double a = 0.0, a2 = 0.0, b = 0.0, b2 = 0.0, single = 0.0;
    Random random(5);
    std::vector<glm::dvec3> ways;
    for (int i = 0; i < kPaths; ++i)
      ways.push_back(glm::normalize(glm::dvec3(unit(random) - 0.5, unit(random) - 0.5, 0.2 + unit(random))));
    const std::vector<SkySample> samples = testing::traced(tracer, ways);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const glm::dvec3& way = ways[i];
      const double seen = samples[i].luminance.x / kLux;
      a += seen, a2 += seen * seen;
      const Ray ray{{0.0, 0.0, state.scene.camera.eyeM}, way};
      const auto hit = medium.collide(ray, 400e3, random);
      if (!hit) continue;
      const glm::dvec3 p = ray.at(hit->t);
      const bool inIce = hit->matter == scene::CloudMatter::kIce;
      const double first = (inIce ? ice : droplets).density(glm::dot(way, sun)) *
                           medium.transmittance({p, sun}, 400e3, random);
      const double there = first + source.trace(p, way, inIce, random).sun;
      single += first;
      b += there, b2 += there * there;
    }
    const double error = std::sqrt((a2 + b2 - (a * a + b * b) / kPaths)) / kPaths;
    EXPECT_NEAR(a / kPaths, b / kPaths, 4.0 * error);
    EXPECT_LT(error, 0.08 * a / kPaths);
    EXPECT_LT(single, 0.9 * b);
  }
}

}  // namespace
}  // namespace welkin::reference
