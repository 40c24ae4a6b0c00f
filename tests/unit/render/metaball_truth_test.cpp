// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs as splats and as marched volumes, against light traced path by path through the same
// field.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/testing/metaball_scene.h"
#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "tests/testing/traced.h"
#include "welkin/core/units.h"
#include "welkin/reference/sky_film.h"
#include "welkin/reference/sky_tracer.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;

constexpr int kSide = 12;
constexpr double kDistanceM = 4000.0, kRadiusM = 500.0;

// A ball seen level from its own height, so many degrees to the right of the sun.
scene::Scene ballScene(const MetaballFolder& folder, double fromSunDeg, double density,
                       double sunElevationDeg = 30.0) {
  scene::Scene s = fromHeight(clearScene(sunElevationDeg), 1800.0);
  const sky::Body sun = scene::lightsAt(s, 0.0).ephemeris.sun;
  const double heading = sun.azimuthDeg + fromSunDeg, a = radians(heading);
  s.metaballs = {folder.cloud({{{0.0, 0.0, 0.0}, kRadiusM, density}},
                              {kDistanceM * std::sin(a), kDistanceM * std::cos(a), 1800.0})};
  return looking(sized(s, kSide, kSide), heading, 0.0, 16.0);
}

struct Seen {
  double luminance = 0.0, error = 0.0;
  double opacity = 0.0;  // traced alone
};

// Pixels whose centres lie within a share of the ball's radius.
template <class F>
double meanWithin(double share, F&& f) {
  double sum = 0.0;
  int count = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double tan = std::tan(radians(8.0)) * 2.0 / kSide;
      const double off = std::hypot(x + 0.5 - kSide / 2.0, y + 0.5 - kSide / 2.0) * tan * kDistanceM;
      if (off > share * kRadiusM) continue;
      sum += f(x, y);
      ++count;
    }
  return sum / count;
}

Seen traced(const scene::SkyState& state, int passes) {
  const reference::SkyTracer tracer(state, {});
  Seen seen;
  std::vector<reference::PixelPath> paths;
  for (int i = 0; i < passes; ++i)
    meanWithin(0.6, [&](int x, int y) {
      paths.push_back({x, y, static_cast<std::uint64_t>(i)});
      return 0.0;
    });
  const std::vector<reference::SkySample> samples = testing::traced(tracer, paths);
  double squares = 0.0;
  std::size_t next = 0;
  for (int i = 0; i < passes; ++i) {
    double cloudy = 0.0;
    const double l = meanWithin(0.6, [&](int, int) {
      const reference::SkySample& sample = samples[next++];
      cloudy += sample.cloud ? 1.0 : 0.0;
      return 0.2126 * sample.luminance.x + 0.7152 * sample.luminance.y + 0.0722 * sample.luminance.z;
    });
    seen.luminance += l / passes;
    squares += l * l / passes;
    seen.opacity += cloudy / passes;
  }
  seen.error = std::sqrt(std::max(squares - seen.luminance * seen.luminance, 0.0) / passes);
  return seen;
}

double drawn(SkyRenderer& renderer, scene::SkyState state, scene::MetaballRender as) {
  state.scene.metaballsAs = as;
  const Image<float> picture = renderer.draw(state).luminance;
  return meanWithin(0.6, [&](int x, int y) { return luminanceOf(pixel(picture, x, y)); });
}

// Thin and thick, with the sun behind it, beside it and on it. Both renderers have the light of
// lib/cloud_light.glsl, which knows optical depths along lines alone.
TEST(MetaballTruth, ABallIsAsBrightAsItsPathsAre) {
  const MetaballFolder folder;
  SkyRenderer renderer({.debug = true});
  double splats = 0.0, marched = 0.0;
  int views = 0;
  for (const double density : {0.002, 0.02})
    for (const double fromSunDeg : {20.0, 90.0, 170.0}) {
      const scene::SkyState state = scene::buildSky(ballScene(folder, fromSunDeg, density), 0.0);
      const Seen truth = traced(state, 400);
      const double bySplats = drawn(renderer, state, scene::MetaballRender::kSplats) / truth.luminance,
                   byMarch = drawn(renderer, state, scene::MetaballRender::kVolume) / truth.luminance;
      const std::string what = std::to_string(density) + "/m, " + std::to_string(fromSunDeg) + " degrees";
      EXPECT_LT(truth.error, 0.02 * truth.luminance) << what;
      EXPECT_NEAR(bySplats, 1.0, 0.5) << what;
      EXPECT_NEAR(byMarch, 1.0, 0.3) << what;
      splats += std::abs(bySplats - 1.0);
      marched += std::abs(byMarch - 1.0);
      ++views;
    }
  EXPECT_LT(splats / views, 0.25);
  EXPECT_LT(marched / views, 0.2);
  EXPECT_TRUE(renderer.takeErrors().empty());
}

// In the light of the sky alone, the sun under the horizon: towards its glow and away from it, where next to
// nothing is scattered twice and where nearly all is.
TEST(MetaballTruth, InTwilightABallIsAsBrightAsItsPathsAre) {
  const MetaballFolder folder;
  SkyRenderer renderer({.debug = true});
  double ratios = 0.0;
  int views = 0;
  for (const double density : {0.002, 0.1})
    for (const double fromSunDeg : {20.0, 90.0, 180.0}) {
      const scene::SkyState state = scene::buildSky(ballScene(folder, fromSunDeg, density, -4.0), 0.0);
      const Seen truth = traced(state, 800);
      const double ratio = drawn(renderer, state, scene::MetaballRender::kSplats) / truth.luminance;
      EXPECT_LT(truth.error, 0.15 * truth.luminance) << density << "/m, " << fromSunDeg << " degrees";
      EXPECT_NEAR(ratio, 1.0, 0.25) << density << "/m, " << fromSunDeg << " degrees";
      ratios += ratio;
      ++views;
    }
  EXPECT_NEAR(ratios / views, 1.0, 0.1);
  EXPECT_TRUE(renderer.takeErrors().empty());
}

// What a lump hides, marched and traced: the field that the texture holds is the field.
TEST(MetaballTruth, AMarchHidesWhatTheFieldHides) {
  const MetaballFolder folder;
  scene::Scene s = ballScene(folder, 90.0, 1.0);
  const glm::dvec3 at = s.metaballs[0].positionM;
  s.metaballs = {folder.cloud(lumpOfBalls(80, 0.0015), at)};
  s.metaballs[0].turnDeg = 30.0;
  s.output.quality = scene::Quality::kUltra;
  s.metaballsAs = scene::MetaballRender::kVolume;
  // Before a night sky by nothing but airglow, what arrives of it is what is not hidden.
  scene::SkyState state = scene::buildSky(s, 0.0);
  for (sky::Light& light : state.lights) light.illuminance = glm::vec3(0.0f);
  state.ambient = {};
  sky::AtmosphereUniforms u = state.atmosphere->uniforms();
  u.rayleighScattering = u.aerosolExtinction = u.aerosolScattering = u.ozoneAbsorption = glm::vec3(0.0f);
  u.airglow = glm::vec3(1.0f);
  u.airglowAltitudeM = 1e13f;
  state.atmosphere = std::make_shared<sky::Atmosphere>(u);
  SkyRenderer renderer({.debug = true});
  const Image<float> marched = renderer.draw(state).luminance;
  const reference::SkyTracer tracer(state, {});
  double most = 0.0, difference = 0.0;
  int count = 0;
  for (int y = 0; y < kSide / 2; ++y)  // above the horizon
    for (int x = 0; x < kSide; ++x) {
      double cloudy = 0.0;
      constexpr int kPaths = 1500;
      for (const reference::SkySample& sample : testing::traced(tracer, x, y, kPaths))
        cloudy += sample.cloud ? 1.0 / kPaths : 0.0;
      const double seen = 1.0 - luminanceOf(pixel(marched, x, y));
      EXPECT_NEAR(seen, cloudy, 0.08) << x << ", " << y;
      difference += std::abs(seen - cloudy);
      most = std::max(most, cloudy);
      ++count;
    }
  EXPECT_GT(most, 0.4);
  EXPECT_LT(difference / count, 0.02);
  EXPECT_TRUE(renderer.takeErrors().empty());
}

}  // namespace
}  // namespace welkin::render
