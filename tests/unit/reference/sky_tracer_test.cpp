// SPDX-License-Identifier: Apache-2.0
// Against closed forms, the slab tracer and the atmosphere's tables; and what must hold whatever the sky.
#include "welkin/reference/sky_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <span>
#include <string>
#include <vector>

#include "tests/testing/skies.h"
#include "tests/testing/traced.h"
#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/core/units.h"
#include "welkin/optics/phase.h"
#include "welkin/reference/directions.h"
#include "welkin/reference/sky_film.h"
#include "welkin/reference/slab_tracer.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/rain_shafts.h"

namespace welkin::reference {
namespace {

using weather::Genus;

double luminanceOf(const glm::dvec3& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

// The mean of paths in a direction.
Estimate meanTowards(const SkyTracer& tracer, const glm::dvec3& direction, int paths) {
  double s = 0.0, s2 = 0.0;
  for (const SkySample& sample : testing::traced(tracer, direction, paths)) {
    const double l = luminanceOf(sample.luminance);
    s += l;
    s2 += l * l;
  }
  const double mean = s / paths;
  return {mean, std::sqrt(std::max(s2 / paths - mean * mean, 0.0) / (paths - 1))};
}

glm::dvec3 directionAt(double elevationDeg, double azimuthDeg) {
  const double e = radians(elevationDeg), a = radians(azimuthDeg);
  return {std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
}

// A sky with other air.
scene::SkyState withAir(scene::SkyState state, const std::function<void(sky::AtmosphereUniforms&)>& change) {
  sky::AtmosphereUniforms u = state.atmosphere->uniforms();
  change(u);
  state.atmosphere = std::make_shared<sky::Atmosphere>(u);
  return state;
}

void noAir(sky::AtmosphereUniforms& u) {
  u.rayleighScattering = u.aerosolExtinction = u.aerosolScattering = u.ozoneAbsorption = glm::vec3(0.0f);
  u.airglow = glm::vec3(0.0f);
}

// Clouds of 3D noise alone, over a ground whose albedo is the same everywhere.
void withEvenPlacement(scene::SkyState& state) {
  auto noise = std::make_shared<field::CloudNoise>(state.clouds->noise());
  for (float& v : noise->placement.data) v = 0.0f;
  std::vector<field::CloudLayer> layers(state.clouds->layers().begin(), state.clouds->layers().end());
  for (field::CloudLayer& l : layers) l.threshold = -0.5f * l.dome;
  state.clouds.emplace(noise, layers, 0.0);
}

constexpr double kSunLux = 1000.0, kSlabDepth = 5.0;

// A scene's one layer made level and endless, of a vertical optical depth, in the sun without air.
scene::SkyState levelSky(const scene::Scene& scene, double depth) {
  scene::SkyState state = withAir(scene::buildSky(scene, 0.0), noAir);
  std::vector<field::CloudLayer> layers(state.clouds->layers().begin(), state.clouds->layers().end());
  layers.at(0).threshold = -50.0f;
  const field::CloudField dense(state.clouds->sharedNoise(), layers, 0.0);
  layers[0].extinction *=
      static_cast<float>(depth / static_cast<double>(dense.opticalDepth({0, 0, 0}, {0, 0, 1}, 1e9f)));
  state.clouds.emplace(state.clouds->sharedNoise(), layers, 0.0);
  state.lights[0].illuminance = glm::vec3(static_cast<float>(kSunLux));
  state.lights[1].illuminance = glm::vec3(0.0f);
  return state;
}

// In uniform light from everywhere what only scatters cannot be seen: neither droplets, ice, rain, clear air
// nor a white ground.
TEST(SkyTracer, WhiteFurnace) {
  scene::Scene s = testing::cloudyScene(-30.0, {Genus::kCumulus, Genus::kCirrus}, 6.0);
  s.ground.albedo = {1.0, 1.0, 1.0};
  s.layers[0].rainMmPerH = 20.0;
  scene::SkyState state = scene::buildSky(s, 0.0);
  ASSERT_EQ(scene::matterInField(state.scene, state.weather, 2), scene::CloudMatter::kRain);
  withEvenPlacement(state);
  for (sky::Light& light : state.lights) light.illuminance = glm::vec3(0.0f);
  for (const bool air : {false, true}) {
    const scene::SkyState uniform = withAir(state, [&](sky::AtmosphereUniforms& u) {
      u.aerosolScattering = u.aerosolExtinction;
      u.ozoneAbsorption = glm::vec3(0.0f);
      if (!air) noAir(u);
      u.airglow = glm::vec3(1.0f);
      u.airglowAltitudeM = 1e13f;  // even over the whole sky
    });
    const SkyTracer tracer(uniform, {});
    int scattered = 0, cloudy = 0;
    for (const double elevation : {80.0, 20.0, 3.0, -8.0, -70.0}) {
      const glm::dvec3 way = directionAt(elevation, 40.0);
      const Estimate e = meanTowards(tracer, way, 350);
      EXPECT_NEAR(e.value, 1.0, 4.0 * e.error + 1e-6) << elevation << " degrees, air " << air;
      EXPECT_LT(e.error, 0.06);
      for (const SkySample& sample : testing::traced(tracer, way, 50)) {
        scattered += static_cast<int>(sample.events);
        cloudy += sample.cloud ? 1 : 0;
      }
    }
    EXPECT_GT(scattered, 500);
    EXPECT_GT(cloudy, 20);
  }
}

// Paths and light that are worth little go on with a chance: over a dark ground both do, and the mean stays.
TEST(SkyTracer, ChancesLoseNoLight) {
  constexpr double kAlbedo = 0.05;
  scene::Scene s = testing::cloudyScene(50.0, {Genus::kCirrus}, 4.0);
  s.ground.albedo = {kAlbedo, kAlbedo, kAlbedo};
  scene::SkyState state = levelSky(s, 1e-9);
  withEvenPlacement(state);
  const glm::dvec3 down = directionAt(-60.0, 40.0);
  const double lit = kAlbedo / kPi * kSunLux * static_cast<double>(state.lights[0].direction.z);
  const Estimate bySun = meanTowards(SkyTracer(state, {}), down, 200000);
  EXPECT_NEAR(bySun.value, lit, 4.0 * bySun.error);
  EXPECT_LT(bySun.error, 0.005 * lit);
  state.lights[0].illuminance = glm::vec3(0.0f);
  const scene::SkyState uniform = withAir(state, [](sky::AtmosphereUniforms& u) {
    u.airglow = glm::vec3(1.0f);
    u.airglowAltitudeM = 1e13f;
  });
  const Estimate bySky = meanTowards(SkyTracer(uniform, {}), down, 400000);
  EXPECT_NEAR(bySky.value, kAlbedo, 4.0 * bySky.error);
  EXPECT_LT(bySky.error, 0.005 * kAlbedo);
}

// The illuminance of a plane that faces `up` by all that is seen from it, paths cosine-distributed.
Estimate illuminanceFrom(const SkyTracer& tracer, double up, int paths) {
  Random random(17);
  std::vector<glm::dvec3> ways;
  for (int i = 0; i < paths; ++i) ways.push_back(lambertDirection({0.0, 0.0, up}, random));
  double s = 0.0, s2 = 0.0;
  for (const SkySample& sample : testing::traced(tracer, ways)) {
    const double l = kPi * luminanceOf(sample.luminance);
    s += l / paths;
    s2 += l * l / paths;
  }
  return {s, std::sqrt((s2 - s * s) / (paths - 1))};
}

// A level layer without air over a black ground is a slab.
TEST(SkyTracer, ALevelLayerIsASlab) {
  scene::Scene s = testing::cloudyScene(30.0, {Genus::kStratus}, 8.0);
  s.ground.albedo = {0.0, 0.0, 0.0};
  s.output.sunDisc = false;
  const scene::SkyState above = levelSky(testing::fromHeight(s, 1500.0), kSlabDepth);
  const scene::SkyState below = levelSky(s, kSlabDepth);
  const double mu0 = static_cast<double>(above.lights[0].direction.z);
  scene::Slab slab;
  slab.opticalDepth = kSlabDepth;
  slab.phase = scene::SlabPhase::kDroplets;
  slab.dropletDiameterUm = scene::dropletDiameterUm(above.weather);
  slab.sunZenithDeg = std::acos(mu0) * 180.0 / kPi;
  const SlabLightFlow truth = traceSlab(slab, {.seed = 1, .maxPaths = 100000, .noise = 0.0}).total;
  for (const bool up : {true, false}) {
    const Estimate wanted = up ? truth.reflectance : truth.diffuseTransmittance;
    const Estimate e = illuminanceFrom(SkyTracer(up ? above : below, {}), up ? -1.0 : 1.0, 16000);
    const double scale = 1.0 / (kSunLux * mu0), error = std::hypot(wanted.error, scale * e.error);
    EXPECT_NEAR(scale * e.value, wanted.value, 3.0 * error) << "up " << up;
    EXPECT_LT(error, 0.025 * wanted.value) << "up " << up;
  }
}

// Molecules alone: the tables take light of the second and later scatterings for isotropic.
// What the tables have of the mean luminance along some ways, in what the tracer has.
double tablesOverTraced(const scene::SkyState& state, const SkyTracer& tracer,
                        std::span<const glm::dvec3> ways) {
  double traced = 0.0, tables = 0.0, squares = 0.0;
  for (const glm::dvec3& way : ways) {
    const Estimate e = meanTowards(tracer, way, 5000);
    traced += e.value;
    squares += e.error * e.error;
    tables += luminanceOf(
        glm::dvec3(state.atmosphere->skyLuminance(state.scene.camera.eyeM, glm::vec3(way), state.lights)));
  }
  EXPECT_LT(std::sqrt(squares), 0.015 * traced);
  return tables / traced;
}

TEST(SkyTracer, AClearRayleighSkyIsThatOfTheTables) {
  scene::Scene s = testing::clearScene(35.0);
  s.ground.albedo = {0.0, 0.0, 0.0};
  s.output.sunDisc = false;
  const scene::SkyState state = withAir(scene::buildSky(s, 0.0), [](sky::AtmosphereUniforms& u) {
    u.aerosolExtinction = u.aerosolScattering = u.ozoneAbsorption = u.groundAlbedo = u.airglow =
        glm::vec3(0.0f);
  });
  const SkyTracer tracer(state, {});
  double all = 0.0;
  constexpr double kElevations[] = {4.0, 12.0, 25.0, 50.0, 80.0};
  for (const double elevation : kElevations) {
    std::vector<glm::dvec3> ways;
    for (const double azimuth : {10.0, 100.0, 190.0, 280.0}) ways.push_back(directionAt(elevation, azimuth));
    const double share = tablesOverTraced(state, tracer, ways);
    EXPECT_NEAR(share, 1.0, 0.05) << elevation << " degrees";
    all += std::abs(share - 1.0) / std::size(kElevations);
  }
  EXPECT_LT(all, 0.03);
}

// Haze of 40 km of visibility, whose coarse particles scatter forward time and again: from near the sun to
// opposite it.
TEST(SkyTracer, AHazySkyIsThatOfTheTables) {
  scene::Scene s = testing::clearScene(25.0);
  s.output.sunDisc = false;
  const scene::SkyState state = scene::buildSky(s, 0.0);
  const SkyTracer tracer(state, {});
  const glm::dvec3 sun(state.lights[0].direction);
  double all = 0.0;
  constexpr double kAzimuths[] = {15.0, 50.0, 110.0, 180.0};
  for (const double azimuth : kAzimuths) {
    std::vector<glm::dvec3> ways;
    for (const double elevation : {6.0, 16.0, 45.0}) {
      const double a = std::atan2(sun.y, sun.x) + radians(azimuth), c = std::cos(radians(elevation));
      ways.emplace_back(c * std::cos(a), c * std::sin(a), std::sin(radians(elevation)));
    }
    const double share = tablesOverTraced(state, tracer, ways);
    EXPECT_NEAR(share, 1.0, 0.05) << azimuth << " degrees from the sun";
    all += std::abs(share - 1.0) / std::size(kAzimuths);
  }
  EXPECT_LT(all, 0.03);
}

// Through cloud so thin that once is all that light is scattered, from next to the sun to far from it.
TEST(SkyTracer, ThinCloudScattersOnce) {
  scene::Scene s = testing::cloudyScene(60.0, {Genus::kStratus}, 8.0);
  s.ground.albedo = {0.0, 0.0, 0.0};
  s.output.sunDisc = false;
  constexpr double kDepth = 0.02;
  const scene::SkyState state = levelSky(s, kDepth);
  const optics::DropletPhase droplets =
      optics::dropletPhase(static_cast<float>(scene::dropletDiameterUm(state.weather)));
  const glm::dvec3 sun = glm::normalize(glm::dvec3(state.lights[0].direction));
  const glm::dvec3 across = glm::normalize(glm::cross(sun, glm::dvec3(0.0, 0.0, 1.0)));
  const SkyTracer tracer(state, {});
  for (const double away : {5.0, 30.0, 75.0}) {
    const double a = radians(away);
    const glm::dvec3 way = std::cos(a) * sun + std::sin(a) * across;
    const Estimate e = meanTowards(tracer, way, 40000);
    // F p m exp(-(m0 + m) / 2) with m0, m the depths along the ways in and out, which are near each other.
    const double m0 = kDepth / sun.z, m = kDepth / way.z;
    const double once = kSunLux *
                        static_cast<double>(optics::phaseDroplet(static_cast<float>(std::cos(a)), droplets)) *
                        m * std::exp(-0.5 * (m0 + m));
    EXPECT_GT(e.value + 3.0 * e.error, once) << away;  // twice adds a few hundredths of it
    EXPECT_LT(e.value - 3.0 * e.error, 1.12 * once) << away;
    EXPECT_LT(e.error, 0.06 * once) << away;
  }
}

TEST(SkyTracer, RefusesWhatItDoesNotTrace) {
  scene::Scene s = testing::cloudyScene(40.0, {Genus::kCirrus});
  s.layers[0].technique = scene::Technique::kPlane;
  EXPECT_THROW(SkyTracer(scene::buildSky(s, 0.0), {}), ParameterError);
}

scene::SkyState smallSky() {
  return scene::buildSky(testing::sized(testing::cloudyScene(25.0, {Genus::kCumulus}, 5.0), 12, 7), 0.0);
}

SkyFilm filmOf(const SkyTracer& tracer, int passes) {
  SkyFilm film(tracer.width(), tracer.height());
  film.addPaths(tracer, passes);
  return film;
}

void expectSame(const SkyFilm& a, const SkyFilm& b) {
  const SkyFilm::State x = a.state(), y = b.state();
  EXPECT_EQ(x.planes, y.planes);
  EXPECT_EQ(x.texts, y.texts);
  EXPECT_EQ(a.luminance().data, b.luminance().data);
}

TEST(SkyFilm, ThreadsChangeNothingAndSeedsDo) {
  const scene::SkyState state = smallSky();
  const int before = threadCount();
  setThreadCount(1);
  const SkyFilm one = filmOf(SkyTracer(state, {}), 3);
  setThreadCount(3);
  const SkyFilm three = filmOf(SkyTracer(state, {}), 3);
  setThreadCount(before);
  expectSame(one, three);
  EXPECT_NE(one.luminance().data, filmOf(SkyTracer(state, {.seed = 2}), 3).luminance().data);
}

TEST(SkyFilm, GoesOnAsIfNothingHadHappened) {
  const scene::SkyState state = smallSky();
  const SkyTracer tracer(state, {});
  const SkyFilm whole = filmOf(tracer, 5);
  SkyFilm part = SkyFilm::fromState(filmOf(tracer, 2).state());
  EXPECT_EQ(part.samples(), 2);
  for (int i = 0; i < 3; ++i) part.addPaths(tracer, 1);
  expectSame(whole, part);
  EXPECT_THROW(part.addPaths(tracer, -1), ParameterError);
  EXPECT_THROW(SkyFilm(3, 2).addPaths(tracer, 1), ParameterError);
  SkyFilm::State damaged = whole.state();
  damaged.planes.erase("sum.red");
  EXPECT_THROW(SkyFilm::fromState(damaged), ParameterError);
  damaged = whole.state();
  damaged.texts["welkin_samples"] = "many";
  EXPECT_THROW(SkyFilm::fromState(damaged), ParameterError);
}

// Errors are true: among many seeds the means scatter as much as they say.
TEST(SkyFilm, ErrorsAreThoseAmongSeeds) {
  const scene::SkyState state = smallSky();
  constexpr int kSeeds = 6;
  std::vector<double> sum(12 * 7, 0.0), squares(12 * 7, 0.0);
  double expected = 0.0, relative = 0.0;
  for (int k = 0; k < kSeeds; ++k) {
    const SkyFilm film = filmOf(SkyTracer(state, {.seed = 50 + static_cast<std::uint64_t>(k)}), 6);
    const Image<float> picture = film.luminance(), error = film.error();
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const double l = luminanceOf({picture.data[3 * i], picture.data[3 * i + 1], picture.data[3 * i + 2]});
      sum[i] += l;
      squares[i] += l * l;
      expected += static_cast<double>(error.data[i]) * static_cast<double>(error.data[i]) / kSeeds;
    }
    relative += film.meanRelativeError() / kSeeds;
  }
  double found = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i)
    found += (squares[i] - sum[i] * sum[i] / kSeeds) / (kSeeds - 1);
  EXPECT_NEAR(found / expected, 1.0, 0.4);
  EXPECT_GT(relative, 0.02);
  EXPECT_LT(relative, 1.0);
}

TEST(SkyTracer, EveryProjectionHasItsPicture) {
  for (const scene::Projection projection : {scene::Projection::kPerspective, scene::Projection::kFisheye,
                                             scene::Projection::kEquirect, scene::Projection::kCubemap}) {
    const bool cube = projection == scene::Projection::kCubemap;
    const scene::SkyState state =
        scene::buildSky(testing::projected(testing::cloudyScene(40.0, {Genus::kStratocumulus}), projection,
                                           24, cube ? 4 : 12),
                        0.0);
    const SkyTracer tracer(state, {});
    double all = 0.0;
    for (const SkySample& sample :
         testing::tracedInTurn(tracer, tracer.width(), tracer.height(), tracer.width() * tracer.height()))
      all += luminanceOf(sample.luminance);
    EXPECT_GT(all / (tracer.width() * tracer.height()), 300.0);
    // Outside the circle of a fisheye there is nothing.
    if (projection == scene::Projection::kFisheye) {
      EXPECT_EQ(testing::traced(tracer, 0, 0, 1)[0].luminance, glm::dvec3(0.0));
    }
  }
}

}  // namespace
}  // namespace welkin::reference
