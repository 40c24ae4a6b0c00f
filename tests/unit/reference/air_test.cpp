// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/air.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <vector>

#include "tests/testing/skies.h"
#include "welkin/core/random.h"
#include "welkin/reference/directions.h"
#include "welkin/scene/sky_state.h"

namespace welkin::reference {
namespace {

class AirTest : public ::testing::Test {
 protected:
  scene::SkyState state = scene::buildSky(testing::clearScene(30.0), 0.0);
  Air air{state.atmosphere->uniforms()};
  Sphere earth{state.clouds->earthRadiusM()};

  // Rays within the air, low ones among them, that end in it and above the ground.
  struct Stretch {
    Ray ray;
    double t;
  };
  std::vector<Stretch> someStretches(int count, double longestM) const {
    Random random(3);
    std::vector<Stretch> stretches;
    while (static_cast<int>(stretches.size()) < count) {
      const double height = 30e3 * unit(random) * unit(random), up = 2.0 * unit(random) - 1.0,
                   z = std::copysign(up * up, up), phi = 2.0 * kPi * unit(random);
      const Ray ray{{0.0, 0.0, height}, turned({0.0, 0.0, 1.0}, z, phi)};
      double near = 0.0, far = 0.0;
      if (!earth.crossings(ray, air.topM(), near, far)) continue;
      const double t = std::min(far, longestM * unit(random));
      stretches.push_back({ray, earth.toGround(ray, t) < t ? earth.toGround(ray, t) : t});
    }
    return stretches;
  }
  // By many short steps.
  glm::dvec3 summed(const Stretch& s) const {
    const int n = std::max(200, static_cast<int>(s.t / 100.0));
    glm::dvec3 depth(0.0);
    for (int i = 0; i < n; ++i)
      depth += air.at(std::max(earth.height(s.ray.at(s.t * (i + 0.5) / n)), 0.0)).extinction * (s.t / n);
    return depth;
  }
};

double largestOf(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

TEST_F(AirTest, OpticalDepthIsTheIntegral) {
  for (const Stretch& s : someStretches(300, 900e3)) {
    const glm::dvec3 expected = summed(s);
    EXPECT_LT(largestOf(glm::abs(air.opticalDepth(earth, s.ray, s.t) - expected) / (expected + 1e-4)), 4e-4)
        << s.ray.from.z << " m up, " << s.ray.way.z << ", " << s.t << " m";
  }
}

TEST_F(AirTest, ShortStretchesAreAsLongOnes) {
  for (const Stretch& s : someStretches(2000, 700.0))
    EXPECT_LT(largestOf(glm::abs(air.transmittance(earth, s.ray, s.t) - glm::exp(-summed(s)))), 1e-5)
        << s.ray.from.z << " m up, " << s.ray.way.z << ", " << s.t << " m";
}

// Places drawn stand for the integral: of scattering times transmittance, and of all else.
TEST_F(AirTest, PlacesAreDrawnWithTheirDensity) {
  for (const double longest : {1e3, 20e3, 900e3})
    for (const Stretch& s : someStretches(4, longest)) {
      if (s.t < 10.0) continue;
      constexpr int kDraws = 40000;
      Random random(11);
      double light = 0.0, all = 0.0, mass = 0.0;
      for (int i = 0; i < kDraws; ++i) {
        const Air::Place p = air.samplePlace(earth, s.ray, s.t, {0.2, 0.5, 0.3}, random);
        ASSERT_GE(p.t, 0.0);
        ASSERT_LE(p.t, s.t);
        const double scattering = air.at(std::max(earth.height(s.ray.at(p.t)), 0.0)).rayleigh.y;
        light += scattering / p.density / kDraws;
        all += p.t * scattering / p.density / kDraws;
      }
      constexpr int kSteps = 20000;
      double place = 0.0;
      for (int i = 0; i < kSteps; ++i) {
        const double t = s.t * (i + 0.5) / kSteps,
                     scattering = air.at(std::max(earth.height(s.ray.at(t)), 0.0)).rayleigh.y;
        mass += scattering * s.t / kSteps;
        place += t * scattering * s.t / kSteps;
      }
      EXPECT_NEAR(light, mass, 0.03 * mass) << s.t << " m";
      EXPECT_NEAR(all, place, 0.03 * place) << s.t << " m";
    }
}

}  // namespace
}  // namespace welkin::reference
