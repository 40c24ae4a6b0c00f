// SPDX-License-Identifier: Apache-2.0
// Halos in marched ice clouds, against paths through the same ice.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec3.hpp>
#include <vector>

#include "tests/testing/live_frames.h"
#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "tests/testing/traced.h"
#include "welkin/core/units.h"
#include "welkin/reference/sky_tracer.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using weather::Genus;

constexpr double kSunDeg = 40.0, kFovDeg = 0.4, kSunLux = 60000.0;
constexpr float kExtinction = 1e-4f;
constexpr int kSide = 8;

// A thin veil all over, in the sun alone: without air.
scene::SkyState veil(Genus genus) {
  scene::Scene s = testing::sized(testing::cloudyScene(kSunDeg, {genus}, 8.0), kSide, kSide);
  s.layers[0].baseM = 8000.0;
  s.layers[0].topM = 9000.0;
  scene::SkyState state = testing::airlessSky(s, kSunLux);
  state.ambient = {};
  testing::changeLayers(state, [](auto& layers) {
    layers.at(0).threshold = -50.0f;
    layers.at(0).extinction = kExtinction;
  });
  return state;
}

// Looks so many degrees past the sun, as high as it stands.
scene::SkyState lookingAside(scene::SkyState state, double asideDeg) {
  const double sunDeg = state.ephemeris.sun.elevationDeg;
  state.headingDeg = state.ephemeris.sun.azimuthDeg +
                     2.0 * degrees(std::asin(std::sin(radians(0.5 * asideDeg)) / std::cos(radians(sunDeg))));
  state.scene.camera.pitchDeg = sunDeg;
  state.scene.camera.fovDeg = kFovDeg;
  return state;
}

glm::dvec3 drawn(SkyRenderer& renderer, const scene::SkyState& state) {
  return testing::meanOf(renderer.draw(state).luminance);
}

glm::dvec3 traced(const scene::SkyState& state, int paths) {
  const reference::SkyTracer tracer(state, {});
  glm::dvec3 sum(0.0);
  for (const reference::SkySample& sample : testing::tracedInTurn(tracer, kSide, kSide, paths))
    sum += sample.luminance / static_cast<double>(paths);
  return sum;
}

// Light scattered more than once is the network's, which has some too much of it in a veil without air: of
// the faint light far out a quarter. What the halo has more than the sky inside it is exact, but for the
// network's light, which differs from 20 to 46 degrees.
TEST(Halo, IsAsBrightAsTraced) {
  constexpr int kPaths = 6000;
  SkyRenderer renderer({.debug = true});
  const scene::SkyState ice = veil(Genus::kCirrostratus);
  const scene::SkyState dark = lookingAside(ice, 20.5);
  const glm::dvec3 inside = drawn(renderer, dark), insideTraced = traced(dark, kPaths);
  for (const double asideDeg : {22.1, 24.0, 46.5}) {
    const scene::SkyState state = lookingAside(ice, asideDeg);
    const glm::dvec3 l = drawn(renderer, state), truth = traced(state, kPaths);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(l[c], truth[c], (asideDeg < 30.0 ? 0.12 : 0.35) * truth[c])
          << asideDeg << " degrees, colour " << c;
      EXPECT_NEAR(l[c] - inside[c], truth[c] - insideTraced[c],
                  (asideDeg < 30.0 ? 0.05 : 0.08) * insideTraced[c])
          << asideDeg << " degrees, colour " << c;
    }
  }
}

// Red inside, blue outside, and not in what is of droplets.
TEST(Halo, IsInIceAlone) {
  SkyRenderer renderer({.debug = true});
  const scene::SkyState ice = veil(Genus::kCirrostratus);
  const glm::dvec3 inside = drawn(renderer, lookingAside(ice, 20.8)),
                   red = drawn(renderer, lookingAside(ice, 21.9)),
                   blue = drawn(renderer, lookingAside(ice, 22.6));
  EXPECT_GT(red.x, 1.25 * inside.x);
  EXPECT_GT(blue.z, 1.2 * inside.z);
  EXPECT_GT(red.x / red.z, 1.15 * inside.x / inside.z);
  EXPECT_LT(blue.x / blue.z, inside.x / inside.z);
  const scene::SkyState droplets = veil(Genus::kAltostratus);
  const glm::dvec3 near = drawn(renderer, lookingAside(droplets, 20.8)),
                   far = drawn(renderer, lookingAside(droplets, 22.1));
  for (int c = 0; c < 3; ++c) EXPECT_LT(far[c], near[c]);
}

// In somebody's frame loop as in the still: straight above the sun, red begins 22 degrees from it.
TEST(Halo, IsInLiveFramesAsInStills) {
  constexpr int kWidth = 48, kHeight = 32;
  constexpr double kFov = 12.0, kMiddleDeg = 22.0;
  scene::Scene s =
      testing::sized(testing::cloudyScene(kSunDeg, {Genus::kCirrostratus}, 8.0), kWidth, kHeight);
  s.output.quality = scene::Quality::kMedium;
  const sky::Body sun = scene::lightsAt(s, 0.0).ephemeris.sun;
  s = testing::looking(s, sun.azimuthDeg, sun.elevationDeg + kMiddleDeg, kFov);
  const auto [live, still] = testing::liveAndStill(s);
  for (const Image<float>& picture : {live, still}) {
    const auto redOverBlue = [&](int y) {
      const glm::vec3 row = testing::meanOf(picture, y, y + 1);
      return static_cast<double>(row.x / row.z);
    };
    double most = 0.0, at = 0.0;
    for (int y = 0; y < kHeight; ++y)
      if (redOverBlue(y) > most) {
        most = redOverBlue(y);
        at = kMiddleDeg -
             degrees(std::atan(std::tan(radians(0.5 * kFov)) * (2.0 * (y + 0.5) - kHeight) / kWidth));
      }
    EXPECT_NEAR(at, 21.8, 0.4);
    EXPECT_GT(most, 1.03 * redOverBlue(kHeight - 1));
  }
}

}  // namespace
}  // namespace welkin::render
