// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/rain_shafts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "welkin/field/cloud_field.h"
#include "welkin/scene/cloud_cover.h"
#include "welkin/scene/sky_state.h"

namespace welkin::scene {
namespace {

using weather::Genus;

std::shared_ptr<const field::CloudNoise> noise() {
  static const auto made = field::makeCloudNoise(1);
  return made;
}

weather::Weather storm(double rainMmPerH, double baseM = 1200.0) {
  weather::Weather weather;
  weather::Layer layer = weather::typicalLayer(Genus::kCumulonimbus, 45.0);
  layer.baseM = baseM;
  layer.topM = baseM + 9000.0;
  layer.oktas = 4.0;
  layer.rainMmPerH = rainMmPerH;
  weather.layers = {layer};
  weather.requestedOktas = 4.0;
  return weather;
}

field::CloudField cloudsOf(const weather::Weather& weather, double seconds = 0.0, const Scene& scene = {}) {
  return cloudsAt(scene, weather, calibrateClouds(scene, weather, noise()), noise(), seconds);
}

constexpr int kPlaces = 120;

// Extinction of all layers above a place.
float extinctionAt(const field::CloudField& clouds, glm::vec2 p, float heightM) {
  const float drop = glm::dot(p, p) / static_cast<float>(2.0 * clouds.earthRadiusM());
  return clouds.extinction({p.x, p.y, heightM - drop});
}

// The same at places of a grid about the eye.
template <class F>
void eachPlace(const field::CloudField& clouds, float heightM, F&& f) {
  for (int y = 0; y < kPlaces; ++y)
    for (int x = 0; x < kPlaces; ++x) {
      const glm::vec2 p = 600.0f * (glm::vec2(x, y) - 0.5f * kPlaces);
      f(extinctionAt(clouds, p, heightM), p);
    }
}

double shareAt(const field::CloudField& clouds, float heightM) {
  int n = 0;
  eachPlace(clouds, heightM, [&](float extinction, glm::vec2) { n += extinction > 0.0f; });
  return n / static_cast<double>(kPlaces * kPlaces);
}

TEST(RainShafts, HangFromTheCoresOfAStorm) {
  const field::CloudField clouds = cloudsOf(storm(25.0));
  ASSERT_EQ(clouds.layers().size(), 2u);
  const double base = shareAt(clouds, 1200.0f + 900.0f), rain = shareAt(clouds, 1150.0f);
  EXPECT_GT(rain, 0.15 * base);
  EXPECT_LT(rain, 0.5 * base);
  // Above every place with rain there is cloud.
  int wet = 0, beneath = 0;
  eachPlace(clouds, 1190.0f, [&](float extinction, glm::vec2 p) {
    if (extinction <= 0.0f) return;
    ++wet;
    beneath += extinctionAt(clouds, p, 2100.0f) > 0.0f;
  });
  ASSERT_GT(wet, 100);
  EXPECT_GT(beneath, 0.97 * wet);
}

TEST(RainShafts, AreAsDenseAsTheRainThatFalls) {
  for (const double rate : {2.0, 25.0}) {
    SCOPED_TRACE(rate);
    float most = 0.0f;
    eachPlace(cloudsOf(storm(rate)), 900.0f,
              [&](float extinction, glm::vec2) { most = std::max(most, extinction); });
    // The cross-section of Marshall and Palmer's drops: 1.825e-4 /m at 1 mm/h.
    const double wanted = 1.825e-4 * std::pow(rate, 0.63);
    EXPECT_LE(most, 1.0001 * wanted);
    EXPECT_GT(most, 0.6 * wanted);
  }
}

TEST(RainShafts, EndAboveTheGroundWhereLittleFallsFar) {
  const field::CloudField light = cloudsOf(storm(0.5, 2500.0)), heavy = cloudsOf(storm(25.0, 2500.0));
  EXPECT_GT(shareAt(light, 2300.0f), 0.01);
  EXPECT_EQ(shareAt(light, 1000.0f), 0.0);
  EXPECT_GT(shareAt(heavy, 20.0f), 0.5 * shareAt(heavy, 2300.0f));
}

// Where the cloud's wind is stronger than that below, rain comes down behind it.
TEST(RainShafts, StayBehind) {
  weather::Weather weather = storm(25.0);
  weather.layers[0].windFromDeg = weather.surfaceWindFromDeg = 270.0;
  weather.layers[0].windSpeedMps = 15.0;
  weather.surfaceWindSpeedMps = 5.0;
  const field::CloudField clouds = cloudsOf(weather);
  const field::CloudLayer& cloud = clouds.layers()[0];
  const field::CloudLayer& shaft = clouds.layers()[1];
  EXPECT_EQ(shaft.topM, cloud.baseM);
  EXPECT_EQ(shaft.driftM + shaft.shearM, cloud.driftM);
  // Half of 10 m/s for 1200 m at 6 m/s, to the east.
  EXPECT_NEAR(shaft.shearM.x, 1000.0f, 1.0f);
  EXPECT_NEAR(shaft.shearM.y, 0.0f, 0.1f);
}

TEST(RainShafts, AreNoCover) {
  const Scene scene;
  const weather::Weather dry = storm(0.0), wet = storm(25.0);
  EXPECT_EQ(calibrateClouds(scene, dry, noise()), calibrateClouds(scene, wet, noise()));
  const DeliveredCover without = measureCover(scene, dry, cloudsOf(dry), 0.0);
  const DeliveredCover with = measureCover(scene, wet, cloudsOf(wet), 0.0);
  ASSERT_EQ(with.layers.size(), 1u);
  EXPECT_EQ(with.layers[0].deliveredOktas, without.layers[0].deliveredOktas);
  EXPECT_EQ(with.sky.deliveredOktas, without.sky.deliveredOktas);
}

TEST(RainShafts, AreThoseOfAnyInstantAtOnce) {
  const Scene scene;
  const weather::Weather weather = storm(25.0);
  const auto calibration = calibrateClouds(scene, weather, noise());
  field::CloudField moved = cloudsAt(scene, weather, calibration, noise(), 0.0);
  moveClouds(scene, weather, calibration, 700.0, moved);
  const field::CloudField there = cloudsAt(scene, weather, calibration, noise(), 700.0);
  const field::CloudLayer &a = moved.layers()[1], &b = there.layers()[1];
  EXPECT_EQ(a.driftM, b.driftM);
  EXPECT_EQ(a.shapeShiftM, b.shapeShiftM);
  // Streaks fall at 6 m/s.
  const float fallen = (cloudsOf(weather).layers()[1].shapeShiftM.z - a.shapeShiftM.z) * a.shapeTall;
  EXPECT_NEAR(fallen, 6.0f * 700.0f, 1.0f);
}

TEST(RainShafts, AreOfVolumesAndOfTwoAtMost) {
  weather::Weather weather = storm(25.0);
  weather.layers.resize(4, weather.layers[0]);
  Scene scene;
  EXPECT_EQ(rainingLayers(scene, weather).count, 2u);
  weather.layers[0].technique = Technique::kPlane;
  weather.layers[1].technique = Technique::kMetaballs;
  weather.layers[2].rainMmPerH = 0.0;
  ASSERT_EQ(rainingLayers(scene, weather).count, 1u);
  EXPECT_EQ(layerOfField(scene, weather, 4).of, 3u);
  EXPECT_TRUE(layerOfField(scene, weather, 4).isShaft);
  EXPECT_TRUE(isVolumeInField(scene, weather, 4));
  EXPECT_FALSE(isVolumeInField(scene, weather, 0));
  EXPECT_EQ(matterInField(scene, weather, 4), CloudMatter::kRain);
  EXPECT_EQ(matterInField(scene, weather, 3), CloudMatter::kDroplets);
  EXPECT_TRUE(hasRain(scene, weather));
  weather.precipitation = weather::PrecipitationKind::kSnow;
  EXPECT_EQ(matterInField(scene, weather, 4), CloudMatter::kSnow);
  EXPECT_FALSE(hasRain(scene, weather));
  weather.precipitation = weather::PrecipitationKind::kNone;
  weather.temperatureC = -11.0;
  EXPECT_EQ(matterInField(scene, weather, 4), CloudMatter::kSnow);
  EXPECT_FALSE(hasRain(scene, weather));
  weather.layers[3].baseM = 0.0;  // nothing falls out of fog
  EXPECT_EQ(rainingLayers(scene, weather).count, 0u);
}

}  // namespace
}  // namespace welkin::scene
