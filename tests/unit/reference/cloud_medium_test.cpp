// SPDX-License-Identifier: Apache-2.0
// The clouds as a medium: bounds that hold, and null collisions that follow Beer's law along them.
#include "welkin/reference/cloud_medium.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/testing/skies.h"
#include "welkin/reference/directions.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/sky_state.h"

namespace welkin::reference {
namespace {

using weather::Genus;

scene::SkyState skyOf(std::initializer_list<Genus> genera, double oktas = 4.0) {
  return scene::buildSky(testing::cloudyScene(40.0, genera, oktas), 600.0);
}

std::vector<int> allLayers(const field::CloudField& field) {
  std::vector<int> layers;
  for (std::size_t i = 0; i < field.layers().size(); ++i) layers.push_back(static_cast<int>(i));
  return layers;
}

CloudMedium mediumOf(const scene::SkyState& state) {
  std::vector<bool> ice;
  for (const weather::Layer& layer : state.weather.layers) ice.push_back(scene::isIce(layer.genus));
  return CloudMedium(*state.clouds, allLayers(*state.clouds), ice);
}

// What bounds are compared with: the field itself, layer by layer, at a cloud position.
float fieldAt(const scene::SkyState& state, const glm::dvec3& q) {
  // Back from metres along the ground and above it.
  const double r = state.clouds->earthRadiusM(), along = std::hypot(q.x, q.y), angle = along / r;
  const double k = along > 0.0 ? (r + q.z) * std::sin(angle) / along : 1.0, sine = std::sin(0.5 * angle);
  return state.clouds->extinction(glm::vec3(k * q.x, k * q.y, q.z - 2.0 * (r + q.z) * sine * sine));
}

struct Bricks {
  int looked = 0, cloudy = 0, full = 0;
  double used =
      0.0;  // of the bounds of bricks with cloud: the largest extinction found in them over the bound
};

// Looks at random places, and around them in the brick that holds them.
void look(const scene::SkyState& state, Bricks& bricks, std::uint64_t seed) {
  const MajorantGrid grid(*state.clouds, allLayers(*state.clouds));
  Random random(seed);
  auto within = [&](double a, double b) { return a + (b - a) * unit(random); };
  for (int i = 0; i < 600; ++i) {
    const double reach = i % 3 == 0 ? 60e3 : 6e3;
    const glm::vec3 q(within(-reach, reach), within(-reach, reach), within(grid.lowM(), grid.highM()));
    const MajorantGrid::Brick brick = grid.at(q);
    for (int k = 0; k < 3; ++k) {
      ASSERT_GE(q[k], brick.box.low[k]);
      ASSERT_LE(q[k], brick.box.high[k]);
    }
    ++bricks.looked;
    float most = 0.0f;
    const glm::dvec3 low(glm::max(brick.box.low, q - 400.0f)), high(glm::min(brick.box.high, q + 400.0f));
    for (int k = 0; k < 60; ++k) {
      const glm::dvec3 p(within(low.x, high.x), within(low.y, high.y), within(low.z, high.z));
      const float sigma = fieldAt(state, p);
      most = std::max(most, sigma);
      ASSERT_LE(sigma, brick.majorant) << p.x << ' ' << p.y << ' ' << p.z;
      if (brick.layers == 0) {
        ASSERT_EQ(sigma, 0.0f);
      }
    }
    if (brick.layers != 0) ++bricks.cloudy;
    if (brick.full != 0) ++bricks.full;
    if (most > 0.0f) bricks.used += static_cast<double>(most / brick.majorant);
  }
}

TEST(MajorantGrid, BoundsTheFieldOfEveryGenus) {
  for (const Genus genus : {Genus::kCumulus, Genus::kStratocumulus, Genus::kStratus, Genus::kNimbostratus,
                            Genus::kCumulonimbus, Genus::kAltocumulus, Genus::kAltostratus, Genus::kCirrus,
                            Genus::kCirrocumulus, Genus::kCirrostratus, Genus::kFog}) {
    const int number = static_cast<int>(genus);
    SCOPED_TRACE("genus " + std::to_string(number));
    Bricks bricks;
    look(skyOf({genus}), bricks, 7 + static_cast<std::uint64_t>(number));
    EXPECT_GT(bricks.cloudy, 20);
    EXPECT_GT(bricks.used, 0.05 * bricks.cloudy);  // the bounds are not idle
  }
}

TEST(MajorantGrid, BoundsSeveralLayersAtOnce) {
  Bricks bricks;
  look(skyOf({Genus::kCumulus, Genus::kStratocumulus, Genus::kCirrus}, 5.0), bricks, 3);
  EXPECT_GT(bricks.cloudy, 100);
  Bricks overcast;
  look(skyOf({Genus::kStratus}, 8.0), overcast, 4);
  EXPECT_GT(overcast.full, 100);  // bricks where only height counts
}

TEST(CloudMedium, HasTheDensityOfTheField) {
  const scene::SkyState state = skyOf({Genus::kCumulus, Genus::kStratocumulus}, 5.0);
  const CloudMedium medium = mediumOf(state);
  Random random(11);
  int cloudy = 0;
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec3 p(20e3 * (unit(random) - 0.5), 20e3 * (unit(random) - 0.5),
                       900.0 + 1200.0 * unit(random));
    const float sigma = state.clouds->extinction(glm::vec3(p));
    EXPECT_NEAR(medium.extinction(p), sigma, 2e-4 * state.clouds->layers()[0].extinction);
    if (sigma > 0.0f) ++cloudy;
  }
  EXPECT_GT(cloudy, 300);
}

// Beer's law along rays of all kinds: by quadrature, by ratio tracking, and as the chance to get through.
TEST(CloudMedium, FollowsBeersLaw) {
  const scene::SkyState state = skyOf({Genus::kCumulus}, 5.0);
  const CloudMedium medium = mediumOf(state);
  Random random(5);
  int partial = 0;
  for (int i = 0; i < 250; ++i) {
    const double azimuth = 2.0 * kPi * unit(random), up = -0.3 + 0.8 * unit(random),
                 flat = std::sqrt(1.0 - up * up);
    const glm::dvec3 from(6e3 * (unit(random) - 0.5), 6e3 * (unit(random) - 0.5),
                          300.0 + 1800.0 * unit(random));
    const Ray ray{from, {flat * std::cos(azimuth), flat * std::sin(azimuth), up}};
    const double end =
        medium.earth().toGround(ray, 2500.0) < 2500.0 ? medium.earth().toGround(ray, 0.0) : 2500.0;
    double depth = 0.0;
    constexpr int kSteps = 2500;
    for (int k = 0; k < kSteps; ++k)
      depth += medium.extinction(ray.at(end * (k + 0.5) / kSteps)) * end / kSteps;
    const double truth = std::exp(-depth);
    if (truth < 0.02 || truth > 0.98) continue;
    ++partial;
    constexpr int kPaths = 2000;
    double ratio = 0.0, squares = 0.0, passed = 0.0;
    for (int k = 0; k < kPaths; ++k) {
      const double t = medium.transmittance(ray, end, random);
      ratio += t / kPaths;
      squares += t * t / kPaths;
      if (const auto collision = medium.collide(ray, end, random)) {
        EXPECT_GT(medium.extinction(ray.at(collision->t)), 0.0);
      } else {
        passed += 1.0 / kPaths;
      }
    }
    EXPECT_NEAR(ratio, truth, 4.5 * std::sqrt(std::max(squares - ratio * ratio, 0.0) / kPaths) + 1e-3);
    EXPECT_NEAR(passed, truth, 4.5 * std::sqrt(truth * (1.0 - truth) / kPaths) + 1e-3);
  }
  EXPECT_GE(partial, 8);
}

}  // namespace
}  // namespace welkin::reference
