// SPDX-License-Identifier: Apache-2.0
// Each source's parameters against that source's own formula, on every 8-bit value.
#include "welkin/field/condensation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "welkin/core/error.h"

namespace welkin::field {
namespace {

template <class Formula>
void expectOnEveryLevel(const Condensation& law, const Formula& formula) {
  std::vector<float> row;
  for (int level = 0; level < 256; ++level) {
    const double noise = level / 255.0;
    ASSERT_NEAR(law.opacity(noise), formula(level), 1e-6) << "level " << level;
    row.push_back(static_cast<float>(noise));
  }
  const std::vector<float> noise = row;
  law.apply(row);
  for (int level = 0; level < 256; ++level)
    ASSERT_NEAR(row[level], law.opacity(noise[level]), 1e-6) << "level " << level;
}

TEST(Condensation, IsTheThesissTexture) {
  for (const double cutoff : {0.0, 0.3, 0.6, 0.7, 0.8, 1.0})
    for (const double density : {0.5, 0.95, 0.96, 0.99, 1.0})
      expectOnEveryLevel(thesisTexture(cutoff, density), [&](int alpha) {
        const double above = alpha - cutoff * 255.0;
        return above > 0 ? 1.0 - std::pow(density, above) : 0.0;
      });
}

TEST(Condensation, IsTheThesissShader) {
  for (const double cutoff : {0.0, 0.61, 0.85})
    for (const double exponent : {1e-6, 0.01, 0.5, 1.0})
      for (const double bias : {0.0, 0.8, 1.0, 1.7})
        expectOnEveryLevel(thesisShader(cutoff, exponent, bias), [&](int level) {
          double noise = level / 255.0;
          noise = noise < cutoff ? 0.0 : noise - cutoff;
          return std::clamp(bias * (1.0 - std::pow(exponent, noise)), 0.0, 1.0);
        });
}

TEST(Condensation, IsRealisticSkies) {
  for (const double cover : {0.0, 0.25, 0.5, 1.0})
    for (const double sharpness : {0.0, 0.01, 0.1, 0.9, 1.0})
      expectOnEveryLevel(realisticSkies(cover, sharpness), [&](int level) {
        const double colour = std::max(level / 255.0 - (1.0 - cover), 0.0);
        return 1.0 - std::pow(1.0 - sharpness, colour * 255.0);
      });
}

TEST(Condensation, IsPallistersScaledSubtraction) {
  for (const double subtract : {0.0, 0.4, 0.9})
    for (const double scale : {0.0, 1.0, 2.5, 10.0})
      expectOnEveryLevel(pallister(subtract, scale), [&](int level) {
        return std::min(scale * std::max(level / 255.0 - subtract, 0.0), 1.0);
      });
}

TEST(Condensation, ConversionsAgreeWhereTheyMeanTheSame) {
  EXPECT_NEAR(thesisTexture(0.6, 0.95).k, realisticSkies(0.4, 0.05).k, 1e-12);
  EXPECT_NEAR(thesisTexture(0.6, 0.95).k, thesisShader(0.6, std::pow(0.95, 255), 1).k, 1e-12);
}

TEST(Condensation, ExcessIsTheInverse) {
  const Condensation law = thesisShader(0.3, 0.02, 0.9);
  for (const double opacity : {0.001, 0.3, 0.8999})
    EXPECT_NEAR(law.opacity(law.threshold + law.excessOf(opacity)), opacity, 1e-12);
  EXPECT_EQ(law.excessOf(0.0), 0.0);
  EXPECT_TRUE(std::isinf(law.excessOf(0.91)));
  EXPECT_TRUE(std::isinf(thesisTexture(0.5, 1.0).excessOf(0.1)));
  EXPECT_EQ(thesisTexture(0.5, 0.0).excessOf(0.5), 0.0);
}

TEST(CondensationParams, OneOfEach) {
  EXPECT_NO_THROW(validate(CondensationParams{}));
  EXPECT_NO_THROW(validate(CondensationParams{.cover = 0.5, .scale = 2.0, .bias = 0.5}));
  EXPECT_THROW(validate(CondensationParams{.cutoff = 0.5, .cover = 0.5}), ParameterError);
  EXPECT_THROW(validate(CondensationParams{.cutoff = 0.5, .density = 0.9, .exponent = 0.1}), ParameterError);
  EXPECT_THROW(validate(CondensationParams{.density = 0.9}), ParameterError);
  EXPECT_THROW(validate(CondensationParams{.bias = 0.9}), ParameterError);
  EXPECT_EQ(lawOf({.cutoff = 0.7}).threshold, 0.7);
  EXPECT_EQ(lawOf({.cutoff = 0.7, .sharpness = 0.1}).threshold, 0.7);
  EXPECT_THROW(withCover(thesisTexture(0, 1.0), 0.5, 0.5 / 255), ParameterError);
}

TEST(ToneCurve, StretchesClampsAndBends) {
  const ToneCurve curve{0.2, 0.6, 2.0, 1.0, 0.5};
  EXPECT_DOUBLE_EQ(curve(0.1), 1.0);
  EXPECT_DOUBLE_EQ(curve(0.4), 1.0 - 0.5 * 0.25);
  EXPECT_DOUBLE_EQ(curve(0.9), 0.5);
  std::vector<float> row{0.1f, 0.4f, 0.9f}, plain{-0.5f, 0.25f, 1.5f};
  curve.apply(row);
  EXPECT_NEAR(row[1], 0.875f, 1e-6);
  ToneCurve{}.apply(plain);
  EXPECT_EQ(plain, (std::vector<float>{0.0f, 0.25f, 1.0f}));
  EXPECT_THROW(validate(ToneCurve{.inLow = 1, .inHigh = 1}), ParameterError);
}

}  // namespace
}  // namespace welkin::field
