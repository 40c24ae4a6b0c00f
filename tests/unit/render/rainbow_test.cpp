// SPDX-License-Identifier: Apache-2.0
// Rain that is marched: its bows, and their light against paths through the same rain.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "tests/testing/live_frames.h"
#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "tests/testing/traced.h"
#include "welkin/core/units.h"
#include "welkin/optics/rain_phase.h"
#include "welkin/reference/cloud_phases.h"
#include "welkin/reference/sky_tracer.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using weather::Genus;

constexpr double kSunDeg = 20.0, kBaseM = 1200.0, kFovDeg = 0.4, kSunLux = 60000.0;
constexpr int kSide = 12;

// Rain everywhere, from 1200 m down to the ground, in the sun alone: without air, and without the cloud that
// it falls from.
scene::SkyState rainAlone(weather::PrecipitationKind kind, double mmPerH = 10.0) {
  scene::Scene s = testing::sized(testing::cloudyScene(kSunDeg, {Genus::kCumulonimbus}, 4.0), kSide, kSide);
  s.layers[0].baseM = kBaseM;
  s.layers[0].topM = kBaseM + 8000.0;
  s.layers[0].rainMmPerH = mmPerH;
  scene::SkyState state = testing::airlessSky(s, kSunLux);
  state.ambient = {};
  state.weather.precipitation = kind;
  testing::changeLayers(state, [](auto& layers) {
    layers.at(0).threshold = 50.0f;
    layers.at(1).threshold = -50.0f;
  });
  return state;
}

// Looks up from the point opposite to the sun: so many degrees from it.
scene::SkyState lookingOut(scene::SkyState state, double outDeg) {
  state.headingDeg = state.ephemeris.sun.azimuthDeg + 180.0;
  state.scene.camera.pitchDeg = outDeg - state.ephemeris.sun.elevationDeg;
  state.scene.camera.fovDeg = kFovDeg;
  return state;
}

glm::dvec3 drawn(SkyRenderer& renderer, const scene::SkyState& state) {
  return testing::meanOf(renderer.draw(state).luminance);
}

double phaseAt(const Image<float>& table, double outDeg, int colour) {
  const double at = (180.0 - outDeg) / 180.0 * (optics::kRainAngles - 1), i = std::floor(at);
  const auto a = static_cast<double>(table.at(static_cast<int>(i), 0, colour)),
             b = static_cast<double>(table.at(static_cast<int>(i) + 1, 0, colour));
  return a + (at - i) * (b - a);
}

struct Traced {
  glm::dvec3 mean{0.0}, error{0.0};
};
Traced traced(const scene::SkyState& state, int paths) {
  const reference::SkyTracer tracer(state, {});
  Traced t;
  glm::dvec3 squares(0.0);
  for (const reference::SkySample& sample : testing::tracedInTurn(tracer, kSide, kSide, paths)) {
    const glm::dvec3& l = sample.luminance;
    t.mean += l / static_cast<double>(paths);
    squares += l * l / static_cast<double>(paths);
  }
  t.error = glm::sqrt(glm::max(squares - t.mean * t.mean, 0.0) / static_cast<double>(paths));
  return t;
}

// Inside the bow, on it, and outside. Light scattered often is the closed forms', which such a slab is made
// for; in heavier rain they have up to three tenths too much of it.
TEST(Rainbow, IsAsBrightAsTraced) {
  SkyRenderer renderer({.debug = true});
  for (const double mmPerH : {3.0, 10.0}) {
    const scene::SkyState rain = rainAlone(weather::PrecipitationKind::kRain, mmPerH);
    for (const double outDeg : {30.0, 41.8, 47.0, 60.0}) {
      const scene::SkyState state = lookingOut(rain, outDeg);
      const glm::dvec3 l = drawn(renderer, state);
      const Traced truth = traced(state, 6000);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(l[c], truth.mean[c], 0.1 * truth.mean[c] + 3.0 * truth.error[c])
            << mmPerH << " mm/h, " << outDeg << " degrees, colour " << c;
        EXPECT_LT(truth.error[c], 0.15 * truth.mean[c]);
      }
    }
  }
}

// What a bow has more than the band beside it is single scattering in even rain: the difference of the phase
// function, of the very table that paths have, times the light that comes to drops and from them to the eye.
TEST(Rainbow, HasTheTablesPhaseFunction) {
  const Image<float> table = optics::rainPhase();
  const reference::ColourPhase ofTracer(table);
  for (int i = 0; i < optics::kRainAngles; i += 7) {
    const glm::dvec3 p = ofTracer.density(std::cos(kPi * i / (optics::kRainAngles - 1)));
    for (int c = 0; c < 3; ++c) {
      const auto there = static_cast<double>(table.at(i, 0, c));
      EXPECT_NEAR(p[c], there, 1e-4 * there + 1e-7);
    }
  }
  SkyRenderer renderer({.debug = true});
  const scene::SkyState rain = rainAlone(weather::PrecipitationKind::kRain);
  const glm::dvec3 band = drawn(renderer, lookingOut(rain, 43.2));
  for (const double outDeg : {41.8, 40.8}) {
    const scene::SkyState state = lookingOut(rain, outDeg);
    const glm::dvec3 more = drawn(renderer, state) - band;
    const double sineView = std::sin(radians(state.scene.camera.pitchDeg)),
                 sineSun = rain.lights[0].direction.z;
    const double depth = static_cast<double>(rain.clouds->layers()[1].extinction) * kBaseM;
    // Light enters from above and leaves below: integral of exp(-t / mu0) exp(-(T - t) / mu) dt / mu.
    const double seen =
        (std::exp(-depth / sineSun) - std::exp(-depth / sineView)) / (1.0 - sineView / sineSun);
    for (int c = 0; c < 3; ++c) {
      // Over the picture's height.
      double expected = 0.0;
      for (int k = 0; k < kSide; ++k)
        expected +=
            (phaseAt(table, outDeg + kFovDeg * ((k + 0.5) / kSide - 0.5), c) - phaseAt(table, 43.2, c)) *
            kSunLux * seen / kSide;
      EXPECT_NEAR(more[c], expected, 0.15 * expected + 0.05 * band[c]) << outDeg << " degrees, colour " << c;
    }
  }
}

// In somebody's frame loop as in the still: a storm's rain, where red is most of the light 42 degrees from
// the point opposite to the sun.
TEST(Rainbow, IsInLiveFramesAsInStills) {
  constexpr int kWidth = 96, kHeight = 54;
  constexpr double kFov = 24.0;
  scene::Scene s;
  s.time = parseUtcTime("2026-07-21T17:15:00Z");
  s.seed = 30;
  s.place = {45.0, 8.0, 0.0};
  weather::Layer storm = weather::typicalLayer(Genus::kCumulonimbus, 45.0);
  storm.baseM = 2500.0;
  storm.topM = 10500.0;
  storm.oktas = 4.0;
  storm.rainMmPerH = 20.0;
  s.layers = {storm};
  s.output.quality = scene::Quality::kMedium;
  const sky::Body sun = scene::lightsAt(s, 0.0).ephemeris.sun;
  s = testing::looking(testing::sized(s, kWidth, kHeight), sun.azimuthDeg - 180.0, 42.0 - sun.elevationDeg,
                       kFov);
  const auto [live, still] = testing::liveAndStill(s);
  for (const Image<float>& picture : {live, still}) {
    double most = 0.0, at = 0.0;
    for (int y = 0; y < kHeight; ++y) {
      double red = 0.0, blue = 0.0;
      for (int x = kWidth / 2 - 4; x < kWidth / 2 + 4; ++x) {
        red += static_cast<double>(picture.at(x, y, 0));
        blue += static_cast<double>(picture.at(x, y, 2));
      }
      if (red / blue <= most) continue;
      most = red / blue;
      at = 42.0 - degrees(std::atan(std::tan(radians(0.5 * kFov)) * (2.0 * (y + 0.5) - kHeight) / kWidth));
    }
    EXPECT_NEAR(at, 42.0, 0.4);
    EXPECT_GT(most, 1.2);
  }
}

TEST(Rainbow, IsNotInSnow) {
  SkyRenderer renderer({.debug = true});
  const scene::SkyState snow = rainAlone(weather::PrecipitationKind::kSnow);
  const glm::dvec3 bow = drawn(renderer, lookingOut(snow, 41.8)),
                   beside = drawn(renderer, lookingOut(snow, 44.0));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(bow[c], beside[c], 0.04 * beside[c]);
}

}  // namespace
}  // namespace welkin::render
