// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/hazy_deck.h"

#include <gtest/gtest.h>

namespace welkin::scene {
namespace {

sky::AtmosphereUniforms haze(float extinctionPerM, float albedo, float ground = 0.0f) {
  sky::AtmosphereUniforms air;
  air.aerosolExtinction = glm::vec3(extinctionPerM);
  air.aerosolScattering = glm::vec3(extinctionPerM * albedo);
  air.aerosolScaleHeightM = 1e7f;  // as dense everywhere
  air.aerosolG = 0.6f;
  air.groundAlbedo = glm::vec3(ground);
  return air;
}

TEST(HazyDeck, NoHazeTakesNothing) {
  const HazyLight light = lightThroughHaze({500.0, 2000.0, 5.0}, haze(0.0f, 0.9f, 0.2f));
  EXPECT_NEAR(light.onGround.x, 1.0f, 1e-6f);
  EXPECT_NEAR(light.underDeck.x, 1.0f, 1e-6f);
}

// Two slabs that absorb nothing are one: 1 / (1 + 3/4 depth) goes through (Eddington).
TEST(HazyDeck, WithoutAbsorptionDepthsAdd) {
  const double deck = 4.0, beneath = 0.4 * 0.001 * 1000.0;  // scaled
  const HazyLight light = lightThroughHaze({1000.0, 1001.0, deck}, haze(0.001f, 1.0f));
  EXPECT_NEAR(light.onGround.y, (1.0 + 0.75 * deck) / (1.0 + 0.75 * (deck + beneath)), 1e-3);
  // What the haze sends back comes down again, all the more under a deck that lets little out.
  const double sentBack = 0.75 * beneath / (1.0 + 0.75 * beneath), base = 0.75 * deck / (1.0 + 0.75 * deck);
  EXPECT_NEAR(light.underDeck.y, 1.0 / (1.0 - sentBack * base), 1e-3);
}

// Deep in a cloud light goes far: haze in it takes several times what it takes by itself.
TEST(HazyDeck, HazeInADeckTakesMore) {
  const sky::AtmosphereUniforms air = haze(1e-4f, 0.5f);
  const double thin = 1.0 - lightThroughHaze({0.0, 1000.0, 0.01}, air).onGround.x,
               deep = 1.0 - lightThroughHaze({0.0, 1000.0, 30.0}, air).onGround.x;
  EXPECT_GT(thin, 0.03);
  EXPECT_GT(deep, 3.0 * thin);
  EXPECT_LT(deep, 1.0);
}

}  // namespace
}  // namespace welkin::scene
