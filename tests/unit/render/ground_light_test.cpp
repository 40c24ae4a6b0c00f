// SPDX-License-Identifier: Apache-2.0
// Where the ground has more or less light than on average (shaders/lib/ground_light.glsl).
#include "welkin/render/ground_light_pass.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/testing/skies.h"
#include "welkin/gpu/context.h"
#include "welkin/render/light_volume_pass.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using weather::Genus;

// Channels: of the light of sky and clouds, and of all.
Image<float> sharesOf(const scene::Scene& scene) {
  static gpu::Context context({.debug = true});
  static LightVolumePass pass;
  const scene::SkyState state = scene::buildSky(scene, 0.0);
  pass.draw(state, shading::lightVolumeLayout(state), CloudTextures(state.clouds->sharedNoise()));
  Image<float> shares = pass.groundShares().read();
  for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  return shares;
}

struct Range {
  double least = 1e9, most = 0.0, mean = 0.0;
};
Range rangeOf(const Image<float>& image, int channel) {
  Range r;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double v = image.at(x, y, channel);
      r.least = std::min(r.least, v);
      r.most = std::max(r.most, v);
      r.mean += v / image.width / image.height;
    }
  return r;
}

TEST(GroundLight, IsTheSameEverywhereUnderAClearAndUnderAClosedSky) {
  scene::Scene clear = cloudyScene(40.0, {});
  for (const scene::Scene& scene : {clear, cloudyScene(40.0, {Genus::kStratus}, 8.0), clear}) {
    const Image<float> shares = sharesOf(scene);
    for (const int c : {0, 1}) {
      const Range r = rangeOf(shares, c);
      EXPECT_NEAR(r.least, 1.0, 2e-3);
      EXPECT_NEAR(r.most, 1.0, 2e-3);
    }
  }
}

// Contrast lifts the mean of the shares a little, as that which they are shares of is taken before all of it
// is smoothed.
TEST(GroundLight, IsDarkUnderTowersAndBrightBetweenThem) {
  const Image<float> shares = sharesOf(cloudyScene(40.0, {Genus::kCumulonimbus}, 3.0));
  const Range sky = rangeOf(shares, 0), all = rangeOf(shares, 1);
  EXPECT_NEAR(sky.mean, 1.0, 0.15);
  EXPECT_NEAR(all.mean, 1.0, 0.1);
  EXPECT_LT(sky.least, 0.6);
  EXPECT_LT(all.least, 0.3);
  EXPECT_GT(sky.most, 1.2);
  EXPECT_GT(all.most, 1.2);
}

// Small clouds are nearer to each other than their light spreads.
TEST(GroundLight, VariesLittleUnderSmallCumulus) {
  const Range small = rangeOf(sharesOf(cloudyScene(40.0, {Genus::kCumulus}, 4.0)), 1),
              tall = rangeOf(sharesOf(cloudyScene(40.0, {Genus::kCumulonimbus}, 4.0)), 1);
  EXPECT_LT(small.most - small.least, 0.8 * (tall.most - tall.least));
}

}  // namespace
}  // namespace welkin::render
