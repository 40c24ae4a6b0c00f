// SPDX-License-Identifier: Apache-2.0
// Metaballs as a medium: bounds that hold, transmittances in closed form, light that is scattered once.
#include "welkin/reference/metaball_medium.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/testing/metaball_scene.h"
#include "tests/testing/skies.h"
#include "tests/testing/traced.h"
#include "welkin/core/glsl.h"
#include "welkin/optics/phase.h"
#include "welkin/reference/directions.h"
#include "welkin/reference/sky_film.h"
#include "welkin/reference/sky_tracer.h"

namespace welkin::reference {
namespace {

using namespace welkin::glsl;
#include "shaders/lib/splat.glsl"

scene::CloudBalls cloudsOf(std::initializer_list<std::vector<field::Metaball>> clouds) {
  scene::CloudBalls all;
  for (const std::vector<field::Metaball>& balls : clouds) {
    all.balls.insert(all.balls.end(), balls.begin(), balls.end());
    all.clouds.push_back({all.balls.size(), scene::MetaballPhase::kDroplets, 1.0f});
  }
  return all;
}

std::vector<field::Metaball> moved(std::vector<field::Metaball> balls, const glm::dvec3& by) {
  for (field::Metaball& b : balls) b.centreM += by;
  return balls;
}

// Every third takes away.
std::vector<field::Metaball> signedBalls() {
  std::vector<field::Metaball> balls = testing::lumpOfBalls(90, 0.004);
  for (std::size_t i = 0; i < balls.size(); i += 3) balls[i].density *= -1.0;
  return balls;
}

TEST(MetaballMedium, HasTheDensityOfTheFieldAndBoundsIt) {
  const std::vector<field::Metaball> a = signedBalls(), b = moved(signedBalls(), {600.0, 100.0, 50.0});
  const field::MetaballField fieldA(a), fieldB(b);
  const MetaballMedium medium(cloudsOf({a, b}));
  Random random(3);
  double most = 0.0, bounds = 0.0, mean = 0.0;
  int cloudy = 0, negative = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 p(2000.0 * unit(random) - 700.0, 1400.0 * unit(random) - 700.0,
                       1400.0 * unit(random) - 700.0);
    const double wanted = std::max(fieldA(p), 0.0) + std::max(fieldB(p), 0.0);
    const double found = medium.extinction(p);
    ASSERT_NEAR(found, wanted, 1e-12);
    ASSERT_LE(found, medium.majorant(p) * (1.0 + 1e-12));
    if (std::min(fieldA(p), fieldB(p)) < 0.0) ++negative;
    if (found <= 0.0) continue;
    ++cloudy;
    mean += found;
    bounds += medium.majorant(p);
    most = std::max(most, found);
  }
  EXPECT_GT(cloudy, 2000);
  EXPECT_GT(negative, 200);
  EXPECT_GT(mean, 0.3 * bounds);  // the bounds are not idle
}

// One ball has its transmittance in closed form.
TEST(MetaballMedium, TheTransmittanceOfABallIsItsIntegral) {
  const field::Metaball ball{{100.0, 2000.0, 300.0}, 250.0, 0.012};
  const MetaballMedium medium(cloudsOf({{ball}}));
  Random random(9);
  for (const double off : {0.0, 0.3, 0.7, 0.95}) {
    const Ray ray{{100.0 + off * ball.radiusM, 0.0, 300.0}, {0.0, 1.0, 0.0}};
    for (const double to : {-0.2, 0.5, 2.0}) {  // ends in the ball, and behind it
      const double end = ball.centreM.y + to * ball.radiusM;
      const double truth = std::exp(-ball.density * ball.radiusM *
                                    static_cast<double>(splatColumn(static_cast<float>(off * off), -1.0f,
                                                                    static_cast<float>(std::min(to, 1.0)))));
      constexpr int kPaths = 40000;
      double ratio = 0.0, squares = 0.0, passed = 0.0;
      for (int k = 0; k < kPaths; ++k) {
        const double t = medium.transmittance(ray, end, random);
        ratio += t / kPaths;
        squares += t * t / kPaths;
        if (!medium.collide(ray, end, random)) passed += 1.0 / kPaths;
      }
      const double error = std::sqrt(std::max(squares - ratio * ratio, 0.0) / kPaths);
      EXPECT_NEAR(ratio, truth, 4.0 * error + 1e-9) << off << " " << to;
      EXPECT_LT(error, 0.004);
      EXPECT_NEAR(passed, truth, 4.0 * std::sqrt(truth * (1.0 - truth) / kPaths) + 1e-9) << off << " " << to;
    }
  }
}

// Beer's law through many balls, of which some take away, in two clouds that overlap.
TEST(MetaballMedium, FollowsBeersLaw) {
  const MetaballMedium medium(cloudsOf({signedBalls(), moved(signedBalls(), {300.0, 100.0, 50.0})}));
  Random random(5);
  int partial = 0;
  for (int i = 0; i < 40; ++i) {
    const glm::dvec3 from(1200.0 * (unit(random) - 0.5), -1500.0, 1200.0 * (unit(random) - 0.5));
    const glm::dvec3 to(1200.0 * (unit(random) - 0.5), 1500.0, 1200.0 * (unit(random) - 0.5));
    const Ray ray{from, glm::normalize(to - from)};
    const double end = i % 4 == 0 ? 1500.0 : 4000.0;
    constexpr int kSteps = 4000;
    double depth = 0.0;
    for (int k = 0; k < kSteps; ++k)
      depth += medium.extinction(ray.at(end * (k + 0.5) / kSteps)) * end / kSteps;
    const double truth = std::exp(-depth);
    if (truth < 0.02 || truth > 0.98) continue;
    ++partial;
    constexpr int kPaths = 3000;
    double ratio = 0.0, squares = 0.0, passed = 0.0;
    for (int k = 0; k < kPaths; ++k) {
      const double t = medium.transmittance(ray, end, random);
      ratio += t / kPaths;
      squares += t * t / kPaths;
      if (const auto collision = medium.collide(ray, end, random)) {
        EXPECT_GT(medium.extinction(ray.at(collision->t)), 0.0);
        EXPECT_LT(collision->t, end);
      } else {
        passed += 1.0 / kPaths;
      }
    }
    EXPECT_NEAR(ratio, truth, 4.5 * std::sqrt(std::max(squares - ratio * ratio, 0.0) / kPaths) + 1e-4);
    EXPECT_NEAR(passed, truth, 4.5 * std::sqrt(truth * (1.0 - truth) / kPaths) + 1e-4);
  }
  EXPECT_GE(partial, 8);
}

double luminanceOf(const glm::dvec3& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

constexpr double kSunLux = 1000.0;

// A ball so thin that once is all that light is scattered, by each phase function.
TEST(SkyTracer, AThinBallScattersOnce) {
  const testing::MetaballFolder folder;
  const double radiusM = 300.0, depth = 0.02;
  constexpr double kAlbedo = 0.8;
  for (const auto phase : {scene::MetaballPhase::kRayleigh, scene::MetaballPhase::kIsotropic}) {
    scene::Scene s = testing::clearScene(30.0);
    const double column = static_cast<double>(splatColumn(0.0f, -1.0f, 1.0f));
    scene::MetaballCloud cloud =
        folder.cloud({{{0.0, 0.0, 0.0}, radiusM, depth / (column * radiusM)}}, {0.0, 3000.0, 2000.0});
    cloud.phase = phase;
    cloud.albedo = kAlbedo;
    s.metaballs = {cloud};
    const scene::SkyState state = testing::airlessSky(s, kSunLux);
    const SkyTracer tracer(state, {});
    const glm::dvec3 way = glm::normalize(glm::dvec3(0.0, 3000.0, 2000.0 - s.camera.eyeM));
    const auto cosine = static_cast<float>(glm::dot(way, glm::dvec3(state.lights[0].direction)));
    const double p = phase == scene::MetaballPhase::kRayleigh
                         ? static_cast<double>(optics::phaseRayleigh(cosine))
                         : 1.0 / (4.0 * kPi);
    double sum = 0.0, squares = 0.0;
    constexpr int kPaths = 60000;
    for (const SkySample& sample : testing::traced(tracer, way, kPaths)) {
      const double l = luminanceOf(sample.luminance);
      sum += l / kPaths;
      squares += l * l / kPaths;
    }
    const double error = std::sqrt((squares - sum * sum) / kPaths);
    const double once = kAlbedo * kSunLux * p * depth * std::exp(-depth);
    EXPECT_NEAR(sum, once, 3.0 * error + 0.02 * once);
    EXPECT_LT(error, 0.05 * once);
  }
}

// In uniform light what only scatters cannot be seen.
TEST(SkyTracer, ABallVanishesInUniformLight) {
  const testing::MetaballFolder folder;
  scene::Scene s = testing::clearScene(-30.0);
  s.metaballs = {folder.cloud(testing::lumpOfBalls(60, 0.01), {0.0, 3000.0, 2000.0}),
                 folder.cloud({{{0.0, 0.0, 0.0}, 400.0, 0.02}}, {500.0, 3500.0, 2400.0})};
  s.metaballs[1].phase = scene::MetaballPhase::kRayleigh;
  s.ground.albedo = {1.0, 1.0, 1.0};
  scene::SkyState state = testing::airlessSky(s, kSunLux);
  state.scene.ground.albedo = {1.0, 1.0, 1.0};
  for (sky::Light& light : state.lights) light.illuminance = glm::vec3(0.0f);
  sky::AtmosphereUniforms u = state.atmosphere->uniforms();
  u.airglow = glm::vec3(1.0f);
  u.airglowAltitudeM = 1e13f;
  state.atmosphere = std::make_shared<sky::Atmosphere>(u);
  auto noise = std::make_shared<field::CloudNoise>(state.clouds->noise());
  for (float& v : noise->placement.data) v = 0.0f;  // over a ground that is the same everywhere
  state.clouds.emplace(noise, std::vector<field::CloudLayer>{}, 0.0);
  const SkyTracer tracer(state, {});
  const glm::dvec3 way = glm::normalize(glm::dvec3(100.0, 3100.0, 2100.0));
  double sum = 0.0, squares = 0.0;
  int cloudy = 0;
  constexpr int kPaths = 2000;
  for (const SkySample& sample : testing::traced(tracer, way, kPaths)) {
    const double l = luminanceOf(sample.luminance);
    sum += l / kPaths;
    squares += l * l / kPaths;
    cloudy += sample.cloud ? 1 : 0;
  }
  EXPECT_NEAR(sum, 1.0, 4.0 * std::sqrt(std::max(squares - sum * sum, 0.0) / kPaths) + 1e-6);
  EXPECT_GT(cloudy, kPaths / 2);
}

// A layer of the weather, too, covering as much of the sky as was asked for.
TEST(SkyTracer, TracesLayersOfMetaballs) {
  scene::Scene s = testing::cloudyScene(50.0, {weather::Genus::kCumulus}, 4.0);
  s.layers[0].technique = scene::Technique::kMetaballs;
  const SkyTracer tracer(scene::buildSky(s, 0.0), {});
  Random random(1);
  constexpr int kRays = 2000;
  std::vector<glm::dvec3> ways;
  for (int i = 0; i < kRays; ++i) {
    const double z = unit(random), a = 2.0 * kPi * unit(random), flat = std::sqrt(1.0 - z * z);
    ways.emplace_back(flat * std::cos(a), flat * std::sin(a), z);
  }
  double cloudy = 0.0;
  for (const SkySample& sample : testing::traced(tracer, ways)) cloudy += sample.cloud ? 1.0 / kRays : 0.0;
  EXPECT_NEAR(cloudy, 0.5, 0.12);
}

}  // namespace
}  // namespace welkin::reference
