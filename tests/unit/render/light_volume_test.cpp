// SPDX-License-Identifier: Apache-2.0
// The light volume on the GPU against rays through the field on the CPU.
#include "welkin/render/light_volume_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/testing/skies.h"
#include "welkin/field/cloud_field.h"
#include "welkin/gpu/context.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using weather::Genus;

// The volume of a sky, read back. Channels: up the line, straight up, down the line, straight down.
struct Swept {
  explicit Swept(const scene::Scene& scene, const scene::SkyState* previous = nullptr)
      : state(scene::buildSky(scene, 0.0, previous)), layout(shading::lightVolumeLayout(state)) {
    static gpu::Context context({.debug = true});
    static LightVolumePass pass;
    pass.draw(state, layout, CloudTextures(state.clouds->sharedNoise()));
    texels = pass.volume().read();
    fluence = pass.fluence().read();
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }

  // Centre of a column of the nearest cascade, m.
  float coordinate(int i) const {
    return (2.0f * (static_cast<float>(i) + 0.5f) / side() - 1.0f) * shading::LightVolumeLayout::kHalfM[0];
  }
  float side() const { return static_cast<float>(layout.columns); }

  // Of the nearest cascade, bilinear in a slice.
  float depth(float x, float y, int slice, int channel) const {
    const auto place = [&](float q) {
      return (q / shading::LightVolumeLayout::kHalfM[0] * 0.5f + 0.5f) * side() - 0.5f;
    };
    const float u = place(x), v = place(y);
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const float a = u - static_cast<float>(i), b = v - static_cast<float>(j);
    const auto at = [&](int di, int dj) { return texels.at(i + di, j + dj, slice, channel); };
    return (at(0, 0) * (1 - a) + at(1, 0) * a) * (1 - b) + (at(0, 1) * (1 - a) + at(1, 1) * a) * b;
  }

  // The point at height h over (x, y) along the curved ground, in the frame of the field.
  glm::vec3 point(float x, float y, float h) const {
    return {x, y, h - static_cast<float>((x * x + y * y) / (2.0 * state.clouds->earthRadiusM()))};
  }

  scene::SkyState state;
  shading::LightVolumeLayout layout;
  Volume<float> texels, fluence;
};

// Pairs of (volume, ray) at columns spread over the inner half of the nearest cascade.
std::vector<std::pair<double, double>> pairs(const Swept& s, int slice, int channel, glm::vec3 direction) {
  std::vector<std::pair<double, double>> result;
  const float h = s.layout.heightsM[static_cast<std::size_t>(slice)];
  const int side = s.layout.columns;
  for (int j = side / 4; j < 3 * side / 4; j += side / 32)
    for (int i = side / 4; i < 3 * side / 4; i += side / 32) {
      const float x = s.coordinate(i), y = s.coordinate(j);
      result.emplace_back(s.texels.at(i, j, slice, channel),
                          s.state.clouds->opticalDepth(s.point(x, y, h), direction, 1e9f));
    }
  return result;
}

// Over the rays that meet cloud.
double medianRelativeError(const std::vector<std::pair<double, double>>& values) {
  std::vector<double> errors;
  for (const auto& [volume, ray] : values)
    if (ray > 0.5) errors.push_back(std::abs(volume / ray - 1.0));
  EXPECT_GT(errors.size(), 20u);
  if (errors.empty()) return 1e9;
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  return errors[errors.size() / 2];
}

// Of transmittances, which is what is seen: depths of hundreds would outweigh everything else.
double correlation(const std::vector<std::pair<double, double>>& values, double scale) {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (const auto& [volume, ray] : values) {
    const double x = std::exp(-volume * scale), y = std::exp(-ray * scale);
    n += 1, a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
  }
  return (ab / n - a * b / n / n) / std::sqrt((aa / n - a * a / n / n) * (bb / n - b * b / n / n));
}

TEST(LightVolume, HoldsTheDepthsOfAStratus) {
  const Swept s(cloudyScene(40.0, {Genus::kStratus}, 8.0));
  const glm::vec3 sun = s.state.lights[0].direction;
  const int last = s.layout.bands[0].lastSlice;
  for (const int slice : {0, last / 2}) {
    EXPECT_LT(medianRelativeError(pairs(s, slice, 0, sun)), 0.20) << slice;
    EXPECT_LT(medianRelativeError(pairs(s, slice, 1, {0, 0, 1})), 0.20) << slice;
  }
  for (const int slice : {last / 2, last}) {
    EXPECT_LT(medianRelativeError(pairs(s, slice, 2, -sun)), 0.20) << slice;
    EXPECT_LT(medianRelativeError(pairs(s, slice, 3, {0, 0, -1})), 0.20) << slice;
  }
}

TEST(LightVolume, FollowsCumulus) {
  const Swept s(cloudyScene(40.0, {Genus::kCumulus}, 4.0));
  const glm::vec3 sun = s.state.lights[0].direction;
  const int middle = s.layout.bands[0].lastSlice / 2;
  EXPECT_GT(correlation(pairs(s, 0, 0, sun), 0.05), 0.9);
  EXPECT_GT(correlation(pairs(s, middle, 0, sun), 0.05), 0.9);
  EXPECT_GT(correlation(pairs(s, middle, 3, {0, 0, -1}), 0.05), 0.9);
}

// Of a tower the shadow is longer than the nearest cascade is wide: the line goes on in the next one.
TEST(LightVolume, FollowsLinesOutOfTheNearestCascade) {
  const Swept s(cloudyScene(25.0, {Genus::kCumulonimbus}, 4.0));
  const glm::vec3 sun = s.state.lights[0].direction;
  const float h = s.layout.heightsM[0];
  std::vector<std::pair<double, double>> values;
  int outside = 0;
  for (int j = 2; j < s.layout.columns; j += 6)
    for (int i = 2; i < s.layout.columns; i += 6) {
      const float x = s.coordinate(i), y = s.coordinate(j);
      const glm::vec2 top = glm::vec2(x, y) + glm::vec2(sun) * (s.layout.bands.back().topM - h) / sun.z;
      outside += std::max(std::abs(top.x), std::abs(top.y)) > shading::LightVolumeLayout::kHalfM[0];
      values.emplace_back(s.texels.at(i, j, 0, 0), s.state.clouds->opticalDepth(s.point(x, y, h), sun, 1e9f));
    }
  EXPECT_GT(outside, static_cast<int>(values.size()) / 2);
  EXPECT_GT(correlation(values, 0.05), 0.8);
}

// Shadows of cumulus on the ground, as the volume has them and along rays. They are looked up where the ray
// to the sun meets the lowest base (cloudDepthToSun in lib/light_volume.glsl).
std::vector<std::pair<double, double>> shadowsOfCumulus(scene::Quality quality) {
  scene::Scene scene = cloudyScene(50.0, {Genus::kCumulus}, 4.0);
  scene.output.quality = quality;
  const Swept s(scene);
  const glm::vec3 sun = s.state.lights[0].direction;
  const float base = s.layout.heightsM[0];
  std::vector<std::pair<double, double>> values;
  for (float y = -4000; y <= 4000; y += 400)
    for (float x = -4000; x <= 4000; x += 400) {
      const glm::vec3 onBase = glm::vec3(x, y, 0) + s.layout.line * (base / s.layout.line.z);
      values.emplace_back(s.depth(onBase.x, onBase.y, 0, 0),
                          s.state.clouds->opticalDepth(s.point(x, y, 0.5f), sun, 1e9f));
    }
  return values;
}

TEST(LightVolume, CastsShadowsOnTheGround) {
  const auto values = shadowsOfCumulus(scene::Quality::kMedium);
  EXPECT_GT(correlation(values, 1.0), 0.8);
  double inShadow = 0, drawn = 0;
  for (const auto& [volume, ray] : values) inShadow += std::exp(-ray), drawn += std::exp(-volume);
  // A little darker than along rays: the volume has no small noise, and columns of 100 m.
  EXPECT_NEAR(drawn / inShadow, 1.0, 0.2);
}

TEST(LightVolume, IsTwiceAsFineInHighQuality) {
  const double medium = correlation(shadowsOfCumulus(scene::Quality::kMedium), 1.0),
               high = correlation(shadowsOfCumulus(scene::Quality::kHigh), 1.0);
  EXPECT_LT(1.0 - high, 0.7 * (1.0 - medium)) << medium << ", " << high;
}

TEST(LightVolume, IsFiniteForEverySun) {
  scene::Scene scene = cloudyScene(50.0, {Genus::kStratus}, 6.0);
  const scene::SkyState day = scene::buildSky(scene, 0.0);
  for (const double sun : {83.0, 1.0, 0.0, -1.0, -5.0, -30.0}) {
    scene.time = clearScene(sun).time;
    const Swept s(scene, &day);  // of the sky by day only noise and cover are taken
    EXPECT_NEAR(glm::length(s.layout.line), 1.0f, 1e-5f);
    EXPECT_GT(s.layout.line.z, 0.0f);
    const auto bad = std::find_if_not(s.texels.data.begin(), s.texels.data.end(),
                                      [](float v) { return std::isfinite(v) && v >= 0.0f; });
    EXPECT_TRUE(bad == s.texels.data.end()) << sun << ": " << *bad;
    EXPECT_GT(*std::max_element(s.texels.data.begin(), s.texels.data.end()), 0.5f) << sun;
    for (const float f : s.fluence.data) ASSERT_TRUE(f >= 0.0f && f < 8.0f) << sun << ": " << f;
  }
}

// What lies above a slice and what lies below it are together all there is, at each slice.
TEST(LightVolume, DepthsUpAndDownAddUp) {
  const Swept s(cloudyScene(90.0, {Genus::kStratocumulus}, 6.0));
  const int last = s.layout.bands[0].lastSlice;
  for (int j = 20; j < 140; j += 30)
    for (int i = 20; i < 140; i += 30) {
      const float total = s.texels.at(i, j, 0, 1);
      for (int k = 0; k <= last; ++k)
        EXPECT_NEAR(s.texels.at(i, j, k, 1) + s.texels.at(i, j, k, 3), total, 0.01f + 0.005f * total) << k;
    }
}

// A few slices at a time, and in the middle of it another instant's: the same volumes.
TEST(LightVolume, InPartsItIsTheSame) {
  const scene::Scene scene = cloudyScene(30.0, {Genus::kCumulus, Genus::kAltocumulus});
  const Swept whole(scene);
  gpu::Context context({.debug = true});
  const CloudTextures clouds(whole.state.clouds->sharedNoise());
  LightVolumePass pass;
  pass.draw(scene::buildSky(scene, 500.0, &whole.state), whole.layout, clouds);
  const auto before = pass.volume().read().data, fluenceBefore = pass.fluence().read().data;
  pass.begin(shading::cloudUniforms(whole.state), whole.layout);
  int frames = 1;
  for (; !pass.advance(LightVolumePass::kParts / 16, clouds); ++frames) {
    ASSERT_TRUE(pass.inProgress());
    EXPECT_EQ(pass.volume().read().data, before);
    EXPECT_EQ(pass.fluence().read().data, fluenceBefore);
  }
  EXPECT_NEAR(frames, 16, 1);
  EXPECT_EQ(pass.volume().read().data, whole.texels.data);
  EXPECT_EQ(pass.fluence().read().data, whole.fluence.data);
  EXPECT_FALSE(pass.inProgress());
  for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
}

// However few steps are taken at a time: fluence and light on the ground lie where the volume does.
TEST(LightVolume, AllOfItIsExchangedAtOnce) {
  const scene::SkyState state = scene::buildSky(cloudyScene(30.0, {Genus::kCumulus}), 0.0);
  const shading::LightVolumeLayout layout = shading::lightVolumeLayout(state);
  gpu::Context context({.debug = true});
  const CloudTextures clouds(state.clouds->sharedNoise());
  LightVolumePass pass;
  pass.draw(state, layout, clouds);
  const auto shown = [&] {
    return std::array{pass.volume().id(), pass.fluence().id(), pass.groundShares().id()};
  };
  for (int sweep = 0; sweep < 2; ++sweep) {
    pass.begin(shading::cloudUniforms(state), layout);
    const auto before = shown();
    int parts = 1;
    for (; !pass.advance(1, clouds); ++parts) ASSERT_EQ(shown(), before);
    EXPECT_GT(parts, LightVolumePass::kParts / 2);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NE(shown()[i], before[i]) << i;
  }
  for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
}

}  // namespace
}  // namespace welkin::render
