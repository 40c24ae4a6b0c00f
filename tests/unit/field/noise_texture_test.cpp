// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/noise_texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"

namespace welkin::field {
namespace {

std::vector<float> all(const NoiseTexture& texture) {
  std::vector<float> out(texture.layerValues() * static_cast<std::size_t>(texture.layers()));
  texture.fill(0, texture.layers(), out);
  return out;
}

double coverOf(const std::vector<float>& opacity) {
  const auto covered =
      std::count_if(opacity.begin(), opacity.end(), [](float v) { return std::lround(v * 255.0f) > 0; });
  return static_cast<double>(covered) / static_cast<double>(opacity.size());
}

// Texel by texel, from the noise's point function and the thesis's own formula.
TEST(NoiseTexture, IsTheThesissTexture) {
  for (const ThesisTexture which : {ThesisTexture::kOvercast, ThesisTexture::kBroken, ThesisTexture::kFew}) {
    const TextureParams params = thesisParams(which);
    const int n = 64;
    const std::vector<float> texels = all(NoiseTexture(params, {n, n, 1}));
    const noise::Noise noise(params.noise);
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const double level = 255.0 * noise.sample({(x + 0.5) / n, (y + 0.5) / n, 0.0});
        const double above = level - 255.0 * *params.cloud.cutoff;
        const double expected = above > 0 ? 1.0 - std::pow(*params.cloud.density, above) : 0.0;
        ASSERT_NEAR(texels[y * n + x], expected, 1e-4);
      }
  }
}

// The thesis's figures: clouds everywhere with thin places, broken clouds, and few.
TEST(NoiseTexture, TheThesissLayersCoverLessAndLess) {
  double before = 1.0;
  for (const ThesisTexture which : {ThesisTexture::kOvercast, ThesisTexture::kBroken, ThesisTexture::kFew}) {
    const double cover = coverOf(all(NoiseTexture(thesisParams(which), {256, 256, 1})));
    EXPECT_LT(cover, before);
    EXPECT_GT(cover, 0.005);
    before = cover;
  }
}

TEST(NoiseTexture, CoverAskedForIsCoverDelivered) {
  for (const double cover : {0.125, 0.5, 0.875}) {
    TextureParams params = thesisParams(ThesisTexture::kBroken);
    params.noise.normalisation = noise::Normalisation::kUnitRange;
    params.cloud = {.cover = cover, .density = 0.96};
    NoiseTexture texture(params, {200, 150, 1});
    texture.meetCover(0.5 / 255);
    EXPECT_NEAR(coverOf(all(texture)), cover, 1.5 / (200 * 150));
  }
}

// Distances in cellular noise go beyond 1, where raw values are cut off.
TEST(NoiseTexture, CoverIsMetBeyondOne) {
  TextureParams params;
  params.noise.kind = noise::Kind::kCellular;
  params.noise.dimensions = 2;
  params.noise.frequency = glm::dvec3(8.0);
  params.cloud.cover = 0.05;
  NoiseTexture texture(params, {200, 150, 1});
  texture.meetCover(0.5 / 255);
  EXPECT_NEAR(coverOf(all(texture)), 0.05, 1.5 / (200 * 150));
}

TEST(NoiseTexture, IsTheSameHoweverItIsCutAndInAnyNumberOfThreads) {
  TextureParams params = thesisParams(ThesisTexture::kDome);
  params.cloud.cover = 0.4;
  setThreadCount(1);
  NoiseTexture texture(params, {24, 20, 18});
  texture.meetCover(0.0);
  const std::vector<float> one = all(texture);
  setThreadCount(3);
  NoiseTexture again(params, {24, 20, 18});
  again.meetCover(0.0);
  std::vector<float> pieces(one.size());
  for (int z = 0; z < 18; z += 5) {
    const int count = std::min(5, 18 - z);
    again.fill(z, count, std::span(pieces).subspan(z * texture.layerValues(), count * texture.layerValues()));
  }
  setThreadCount(0);
  EXPECT_EQ(one, pieces);
}

TEST(NoiseTexture, PlainNoiseIsTheNoiseItself) {
  TextureParams params;
  params.noise.dimensions = 2;
  const std::vector<float> texels = all(NoiseTexture(params, {32, 32, 1}));
  const noise::Noise noise(params.noise);
  EXPECT_NEAR(texels[5 * 32 + 7], noise.sample({7.5 / 32, 5.5 / 32, 0}), 2e-6);
  EXPECT_LT(*std::min_element(texels.begin(), texels.end()), -0.1f);
}

TEST(NoiseTexture, RefusesWhatDoesNotFit) {
  TextureParams params;
  params.noise.kind = noise::Kind::kPerlinWorley;
  EXPECT_EQ(NoiseTexture(params, {8, 8, 8}).channels(), 4);
  params.cloud.cutoff = 0.5;
  EXPECT_THROW(NoiseTexture(params, {8, 8, 8}), ParameterError);
  EXPECT_THROW(NoiseTexture(thesisParams(ThesisTexture::kFew), {8, 8, 8}), ParameterError);
}

}  // namespace
}  // namespace welkin::field
