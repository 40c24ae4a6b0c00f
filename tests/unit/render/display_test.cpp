// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/display.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec3.hpp>
#include <limits>

namespace welkin::render {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Image<float> filled(float r, float g, float b) {
  Image<float> picture(16, 9, 3);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 16; ++x) picture.at(x, y, 0) = r, picture.at(x, y, 1) = g, picture.at(x, y, 2) = b;
  return picture;
}

TEST(Display, ExposureFollowsLuminance) {
  double last = -100.0;
  for (double luminance = 1e-6; luminance < 1e6; luminance *= 2.0) {
    const float l = static_cast<float>(luminance);
    const double ev = automaticExposureEv(filled(l, l, l));
    EXPECT_TRUE(std::isfinite(ev)) << luminance;
    EXPECT_GT(ev, last) << luminance;
    last = ev;
  }
}

// ISO 2720 with K = 12.5: a meter reads EV 15 off 4000 cd/m2, which it renders as middle grey. Skies are
// lighter than that, so they are exposed a stop or two more, never less.
TEST(Display, DaylightIsExposedAsPhotographersDo) {
  EXPECT_NEAR(automaticExposureEv(filled(4000, 4000, 4000)), 13.5, 1.5);
}

TEST(Display, ExposureOfNothingIsFinite) {
  EXPECT_TRUE(std::isfinite(automaticExposureEv(filled(0, 0, 0))));
  EXPECT_TRUE(std::isfinite(automaticExposureEv(Image<float>(0, 0, 3))));
  Image<float> one(1, 1, 3);
  one.data = {100, 100, 100};
  EXPECT_TRUE(std::isfinite(automaticExposureEv(one)));
}

TEST(Display, BadPixelsDoNotSpoilTheExposure) {
  Image<float> picture = filled(1000, 1000, 1000);
  const double ev = automaticExposureEv(picture);
  for (int c = 0; c < 3; ++c) {
    picture.at(3, 3, c) = kNan;
    picture.at(5, 5, c) = kInfinity;
    picture.at(7, 7, c) = -5.0f;
  }
  EXPECT_NEAR(automaticExposureEv(picture), ev, 0.05);
}

TEST(Display, ValuesLieBetweenBlackAndWhite) {
  for (const float v : {0.0f, -1.0f, 1e-30f, 1.0f, 1e4f, 1e9f, 3e38f, kInfinity, -kInfinity, kNan}) {
    for (const double ev : {-12.0, 0.0, 15.0, 30.0}) {
      const Image<float> grey = toDisplay(filled(v, v, v), ev);
      for (const float x : grey.data) ASSERT_TRUE(x >= 0.0f && x <= 1.0f) << v << " " << ev << " gave " << x;
      const Image<float> red = toDisplay(filled(v, 0.0f, 0.0f), ev);
      for (const float x : red.data) ASSERT_TRUE(x >= 0.0f && x <= 1.0f) << v << " " << ev << " gave " << x;
    }
  }
}

TEST(Display, BrighterStaysBrighter) {
  float last[3] = {-1, -1, -1};
  for (float l = 1.0f; l < 1e5f; l *= 1.3f) {
    const Image<float> out = toDisplay(filled(0.9f * l, l, 1.1f * l), 14.0);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(out.data[c], last[c]) << l;
      last[c] = out.data[c];
    }
  }
  EXPECT_GT(last[1], 0.93f);
}

// A sunlit cloud of 25,000 cd/m2 against a sky of 5,000 is white, not grey and not yellow, and has room above
// for its brightest parts.
TEST(Display, SunlitCloudsAreWhite) {
  const glm::vec3 sunlight(1.12f, 1.0f, 0.90f);  // direct light and that of the sky at noon
  const float cloud = 25000.0f;
  const double ev = 14.7;
  const Image<float> out = toDisplay(filled(cloud * sunlight.x, cloud * sunlight.y, cloud * sunlight.z), ev);
  for (int c = 0; c < 3; ++c) {
    EXPECT_GT(out.data[c], 0.80f);
    EXPECT_LT(out.data[c], 1.0f);
  }
  EXPECT_NEAR(out.data[0], out.data[1], 0.02f);
  EXPECT_NEAR(out.data[2], out.data[1], 0.02f);
}

// A cloud's shaded side has about half the light of its sunlit one: a fifth of the screen's range apart, as
// in photographs.
TEST(Display, CloudsHaveASunlitAndAShadedSide) {
  const double ev = 14.7;
  const float sunlit = toDisplay(filled(25000, 25000, 25000), ev).data[1];
  const float shaded = toDisplay(filled(12500, 12500, 12500), ev).data[1];
  EXPECT_GT(sunlit, 0.9f);
  EXPECT_LT(sunlit, 0.96f);
  EXPECT_GT(sunlit - shaded, 0.21f);
}

TEST(Display, ClearSkiesAreBlue) {
  const Image<float> out = toDisplay(filled(2200, 3300, 5600), 14.7);
  EXPECT_GT(out.data[2], out.data[1] + 0.08f);
  EXPECT_GT(out.data[1], out.data[0] + 0.08f);
}

}  // namespace
}  // namespace welkin::render
