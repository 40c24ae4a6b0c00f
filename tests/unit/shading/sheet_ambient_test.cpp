// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/sheet_ambient.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"

namespace welkin::shading {
namespace {

using testing::luminanceOf;

// A pattern in which values from 0 to 1 are equally frequent.
std::vector<float> evenPattern() {
  std::vector<float> pattern(4096);
  for (std::size_t i = 0; i < pattern.size(); ++i) pattern[i] = static_cast<float>(i) / 4096.0f;
  return pattern;
}

// Covers so many oktas, in them `depth` deep on average.
SheetMatter layerOf(double oktas, double depth) {
  SheetMatter matter;
  matter.quantiles = field::PatternQuantiles(evenPattern());
  matter.law.threshold = 1.0 - oktas / 8.0;
  matter.law.k = oktas > 0.0 ? 2.0 * depth / (oktas / 8.0) : 0.0;
  return matter;
}

struct Ground {
  double sky, direct;  // lux
  double all() const { return sky + direct; }
};
// Under layers of cover and depth, from the ground up.
Ground groundUnder(const scene::SkyState& state, const std::vector<SheetMatter>& layers) {
  std::vector<SheetInSky> sheets;
  for (std::size_t i = 0; i < layers.size(); ++i)
    sheets.push_back({1000.0 + 2000.0 * static_cast<double>(i), &layers[i]});
  const LightUnderSheets light = lightUnder(state, sheets);
  double through = 1.0;
  for (const float t : light.sunThrough) through *= t;
  const double sine = state.lights[0].direction.z;
  return {luminanceOf(light.ambient.skyOnGround),
          luminanceOf(state.lights[0].illuminance * state.atmosphere->transmittanceToSpace(0.0, sine)) *
              sine * through};
}

class SheetAmbientTest : public ::testing::Test {
 protected:
  const scene::SkyState state = scene::buildSky(testing::clearScene(40.0), 0.0);
  const Ground clear = groundUnder(state, {});
};

TEST(SheetTransmittance, LosesNothingWhereThereIsNoCloud) {
  const SheetTransmittance none = transmittanceOf(0.0, 0.5, 1.0);
  EXPECT_DOUBLE_EQ(none.direct, 1.0);
  EXPECT_NEAR(none.diffused, 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(none.sky, 1.0);
  EXPECT_NEAR(transmittanceOf(layerOf(0.0, 5.0), 0.5).direct, 1.0, 1e-12);
}

TEST(SheetTransmittance, NeverMakesLight) {
  for (const double mu : {0.02, 0.1, 0.5, 1.0})
    for (double depth = 0.01, last = 1.0; depth < 500.0; depth *= 1.5) {
      const SheetTransmittance t = transmittanceOf(depth, mu, 1.0);
      EXPECT_LE(t.direct + t.diffused, last + 1e-9) << depth;  // the thicker the darker
      EXPECT_GE(t.diffused, 0.0);
      EXPECT_GE(t.sky, 0.0);
      last = t.direct + t.diffused;
    }
  // A deep cloud lets (2/3 + mu) / (3/4 (1 - g) depth) ... through: a tenth of it at ten times the depth.
  EXPECT_NEAR(transmittanceOf(10000.0, 0.7, 1.0).diffused / transmittanceOf(1000.0, 0.7, 1.0).diffused, 0.1,
              0.002);
}

TEST(SheetTransmittance, HidesAtMostItsBias) {
  const SheetTransmittance t = transmittanceOf(1000.0, 0.7, 0.25);
  EXPECT_NEAR(t.direct, 0.75, 1e-9);
  EXPECT_GT(t.sky, 0.75);
}

TEST_F(SheetAmbientTest, WithoutSheetsItIsTheClearSkys) {
  EXPECT_NEAR(clear.sky / luminanceOf(state.ambient.skyOnGround), 1.0, 1e-4);
  EXPECT_EQ(lightUnder(state, {}).ambient.air.clearAir, 1.0f);
}

// Broken cloud scatters sunlight down: the sky gives more than a clear one, though the sun gives less.
TEST_F(SheetAmbientTest, RisesWithPartialCover) {
  double last = clear.sky;
  for (const double oktas : {1.0, 2.0, 3.0, 4.0}) {
    const Ground g = groundUnder(state, {layerOf(oktas, 8.0)});
    EXPECT_GT(g.sky, last * 1.1) << oktas;
    EXPECT_LT(g.direct, clear.direct);
    last = g.sky;
  }
}

// The gem: the light all around rises as clouds spread and falls again when they close. High sun, where
// broken cloud has most to scatter.
TEST(SheetAmbient, RisesToHalfCoverAndFallsToOvercast) {
  const scene::SkyState noon = scene::buildSky(testing::clearScene(75.0), 0.0);
  std::vector<double> sky, direct;
  for (int oktas = 0; oktas <= 8; ++oktas) {
    // Clouds that close get deeper as well: fair-weather cumulus at 4 oktas, a rainy deck at 8.
    const SheetMatter layer = layerOf(oktas, 8.0 * std::pow(7.5, (oktas - 4) / 4.0));
    const Ground g = groundUnder(noon, {layer});
    sky.push_back(g.sky);
    direct.push_back(g.direct);
  }
  for (std::size_t i = 1; i <= 4; ++i) EXPECT_GT(sky[i], sky[i - 1]) << i;
  EXPECT_GT(sky[4], 1.5 * sky[0]);
  EXPECT_LT(sky[8], 0.9 * sky[4]);
  for (std::size_t i = 1; i <= 8; ++i) EXPECT_LT(direct[i], direct[i - 1]) << i;
}

// Measured by day under overcast: a tenth to a third of the clear sky's light, all of it diffuse.
TEST_F(SheetAmbientTest, ThickOvercastIsDarkAndGrey) {
  const Ground g = groundUnder(state, {layerOf(8.0, 60.0)});
  EXPECT_LT(g.direct, 0.02 * clear.direct);
  EXPECT_LT(g.all(), 0.33 * clear.all());
  EXPECT_GT(g.all(), 0.08 * clear.all());
  EXPECT_LT(groundUnder(state, {layerOf(8.0, 200.0)}).sky, clear.sky);
  // Sunlight makes up most of it: far from the blue of the clear sky.
  const SheetMatter layer = layerOf(8.0, 60.0);
  const SheetInSky sheet{1000.0, &layer};
  const glm::vec3 grey = lightUnder(state, std::span(&sheet, 1)).ambient.skyOnGround,
                  blue = state.ambient.skyOnGround;
  EXPECT_LT(grey.z / grey.x, 0.75f * blue.z / blue.x);
}

TEST_F(SheetAmbientTest, SheetsAboveDimTheSunForThoseBeneath) {
  const SheetMatter low = layerOf(4.0, 5.0), high = layerOf(6.0, 2.0);
  const SheetInSky sheets[] = {{1000.0, &low}, {6000.0, &high}};
  const LightUnderSheets light = lightUnder(state, sheets);
  EXPECT_EQ(light.sheets[1].sun, 1.0f);
  EXPECT_FLOAT_EQ(light.sheets[0].sun, light.sunThrough[1]);
  EXPECT_LT(light.sheets[0].sun, 0.6f);
  EXPECT_GT(luminanceOf(light.sheets[0].sky), luminanceOf(light.sheets[1].sky));
  EXPECT_FLOAT_EQ(light.ambient.air.clearAir, light.sunThrough[0] * light.sunThrough[1]);
  EXPECT_EQ(light.ambient.air.airUnderSheets, light.ambient.air.clearAir);
}

// Snow sends light back to the clouds, which send it down again.
TEST_F(SheetAmbientTest, OvercastIsBrighterOverSnow) {
  scene::SkyState snow = state;
  snow.scene.ground.albedo = glm::dvec3(0.8);
  EXPECT_GT(groundUnder(snow, {layerOf(8.0, 30.0)}).sky, 1.5 * groundUnder(state, {layerOf(8.0, 30.0)}).sky);
}

// Beside volumes: a sheet that hides nothing changes nothing, and a thick one dims what they had left.
TEST(SheetAmbient, TakesTheVolumesLightAndDimsIt) {
  const scene::SkyState state =
      scene::buildSky(testing::cloudyScene(40.0, {weather::Genus::kCumulus}, 4.0), 0.0);
  const auto volumes = volumesIn(state);
  ASSERT_EQ(volumes.size(), 1u);
  const SheetMatter none = layerOf(0.0, 1.0), thick = layerOf(8.0, 20.0);
  const auto under = [&](double heightM, const SheetMatter& matter) {
    const SheetInSky sheet{heightM, &matter};
    return lightUnder(state, std::span(&sheet, 1), volumes);
  };
  const LightUnderSheets same = under(8000.0, none);
  EXPECT_NEAR(luminanceOf(same.ambient.skyOnGround) / luminanceOf(state.ambient.skyOnGround), 1.0, 1e-5);
  EXPECT_NEAR(luminanceOf(same.ambient.ground) / luminanceOf(state.ambient.ground), 1.0, 1e-5);
  EXPECT_NEAR(luminanceOf(same.ambient.air.haze.mean) / luminanceOf(state.ambient.air.haze.mean), 1.0, 1e-5);
  EXPECT_EQ(same.ambient.air.clearAir, state.ambient.air.clearAir);

  const LightUnderSheets over = under(8000.0, thick), beneath = under(300.0, thick);
  for (const LightUnderSheets* light : {&over, &beneath})
    EXPECT_LT(luminanceOf(light->ambient.ground), 0.6 * luminanceOf(state.ambient.ground));
  // Over a sheet beneath volumes the sky is brighter by what they diffuse; their shadow from the sun is
  // drawn, not averaged.
  EXPECT_GT(luminanceOf(beneath.sheets[0].sky), 1.2 * luminanceOf(over.sheets[0].sky));
  EXPECT_EQ(beneath.sheets[0].sun, 1.0f);
}

TEST_F(SheetAmbientTest, SharesOfLightAreThoseOfTheSheetsOverAPlace) {
  const SheetMatter low = layerOf(4.0, 5.0), high = layerOf(6.0, 2.0);
  const SheetInSky sheets[] = {{1000.0, &low}, {6000.0, &high}};
  const LightUnderSheets light = lightUnder(state, sheets);
  EXPECT_EQ(lightShareUnder(state, sheets, 7000.0), glm::vec4(1.0f));
  EXPECT_FLOAT_EQ(lightShareUnder(state, sheets, 3000.0).w, light.sunThrough[1]);
  EXPECT_FLOAT_EQ(lightShareUnder(state, sheets, 0.0).w, light.sunThrough[0] * light.sunThrough[1]);
}

TEST(SheetAmbient, NightStaysDark) {
  const scene::SkyState night = scene::buildSky(testing::moonlessScene(), 0.0);
  EXPECT_LT(groundUnder(night, {layerOf(8.0, 10.0)}).sky, 0.01);
}

}  // namespace
}  // namespace welkin::shading
