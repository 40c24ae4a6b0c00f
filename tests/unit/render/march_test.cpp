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

// The largest jump of rows' mean luminance against the trends above and beneath it, relative.
double largestLine(const Image<float>& picture, int firstRow, int lastRow) {
  std::vector<double> rows;
  for (int y = firstRow; y < lastRow; ++y) {
    double sum = 0.0;
    const int middle = picture.width / 2, half = picture.width / 16;
    for (int x = middle - half; x < middle + half; ++x) sum += std::log(luminanceOf(pixel(picture, x, y)));
    rows.push_back(sum / (2.0 * half));
  }
  double most = 0.0;
  for (std::size_t i = 8; i + 10 < rows.size(); ++i) {
    const double before = rows[i] - rows[i - 8], after = rows[i + 10] - rows[i + 2];
    most = std::max(most, std::abs(rows[i + 2] - rows[i] - (before + after) / 8.0));
  }
  return most;
}

TEST_F(March, NoLineWhereSurfacesAreSought) {
  const double line = largestLine(drawn(veil(Genus::kCirrocumulus, 14.0, 480, 270)), 60, 150);
  RecordProperty("jump", std::to_string(line));
  EXPECT_LT(line, 0.0045);
}

TEST_F(March, NoLineWhereCloudsBecomeOpaque) {
  const double line = largestLine(drawn(veil(Genus::kCirrostratus, 14.0, 480, 270)), 80, 180);
  RecordProperty("jump", std::to_string(line));
  EXPECT_LT(line, 0.003);
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
