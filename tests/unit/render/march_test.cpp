// SPDX-License-Identifier: Apache-2.0
// The march of volumes: that its steps draw no patterns and its limits no lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using weather::Genus;

class March : public ::testing::Test {
 protected:
  static Image<float> drawn(const scene::Scene& s) {
    static SkyRenderer renderer({.debug = true});
    return renderer.draw(scene::buildSky(s, 0.0)).luminance;
  }
};

// An even veil of one genus over the whole sky.
scene::Scene veil(Genus genus, double pitchDeg, int width, int height) {
  scene::Scene s;
  s.layers = cloudyScene(45.0, {genus}, 8.0).layers;
  return sized(looking(s, 258.0, pitchDeg), width, height);
}

// The steps' noise met the phases of steps that were counted from the eye, in four places around the zenith.
TEST_F(March, StepsDrawNoRings) {
  constexpr int kSide = 320, kApart = 3;
  const Image<float> p = drawn(
      projected(veil(Genus::kCirrocumulus, 0.0, kSide, kSide), scene::Projection::kFisheye, kSide, kSide));
  std::vector<double> bends;
  for (int y = kSide / 5; y < kSide * 4 / 5; ++y)
    for (int x = kSide / 5; x < kSide * 4 / 5; ++x) {
      const auto at = [&](int dx, int dy) { return luminanceOf(pixel(p, x + dx, y + dy)); };
      bends.push_back(std::abs(1.0 - (at(kApart, 0) + at(-kApart, 0) + at(0, kApart) + at(0, -kApart)) /
                                         (4.0 * at(0, 0))));
    }
  const auto most = bends.begin() + static_cast<std::ptrdiff_t>(bends.size() * 3 / 4);
  std::nth_element(bends.begin(), most, bends.end());
  RecordProperty("bend", std::to_string(*most));
  EXPECT_LT(*most, 0.014);
}

}  // namespace
}  // namespace welkin::render
