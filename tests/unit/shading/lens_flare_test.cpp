// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/lens_flare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/testing/pictures.h"
#include "welkin/core/glsl.h"
#include "welkin/core/units.h"

namespace welkin::shading {
namespace {

namespace lib {
using namespace welkin::glsl;
#include "shaders/lib/lens_flare.glsl"
}  // namespace lib

constexpr float kSunRadius = 0.00465f;
const glm::vec3 kIlluminance(90000.0f, 85000.0f, 70000.0f);

// Looks north and a little up.
View looking(const glm::dmat4& projection) {
  View v;
  v.view = glm::lookAt(glm::dvec3(0, 0, 2), glm::dvec3(0, 100, 22), glm::dvec3(0, 0, 1));
  v.projection = projection;
  return v;
}
const glm::dmat4 kSymmetric = glm::perspective(1.0, 1.6, 1.0, 1e4);
const glm::dmat4 kOffAxis = glm::frustum(-0.2, 0.9, -0.5, 0.3, 1.0, 1e4);

// Where a direction is in the picture, by the matrices themselves.
glm::dvec2 projected(const View& view, const glm::dvec3& direction) {
  const glm::dvec4 clip = view.projection * view.view * glm::dvec4(direction, 0.0);
  return glm::dvec2(clip) / clip.w;
}
// That of the optical axis.
glm::dvec2 axisOf(const View& view) {
  return projected(view, glm::transpose(glm::dmat3(view.view)) * glm::dvec3(0, 0, -1));
}

LensFlare flareOf(const View& view, const glm::dvec3& toSun) {
  return lensFlareOf(partsOf(view, 720), glm::vec3(toSun), kSunRadius, kIlluminance);
}

TEST(LensFlare, GhostsStandOnTheLineFromTheSunThroughTheOpticalAxis) {
  constexpr double kShares[] = {0.5, 0.333, -0.05, -0.25, -0.75};
  for (const View& view : {looking(kSymmetric), looking(kOffAxis)})
    for (const glm::dvec3 at :
         {glm::dvec3(0.1, 1, 0.3), glm::dvec3(0.15, 1, 0.05), glm::dvec3(0.4, 1, 0.2)}) {
      const glm::dvec3 toSun = glm::normalize(at);
      const LensFlare flare = flareOf(view, toSun);
      ASSERT_EQ(flare.shown, 1.0f);
      const glm::dvec2 sun = projected(view, toSun), axis = axisOf(view);
      EXPECT_NEAR(glm::distance(glm::dvec2(flare.sunAt), sun), 0.0, 1e-6);
      EXPECT_NEAR(glm::distance(glm::dvec2(flare.sprites[0].centre), sun), 0.0, 1e-6);
      for (std::size_t i = 0; i < std::size(kShares); ++i)
        EXPECT_NEAR(glm::distance(glm::dvec2(flare.sprites[i + 1].centre), axis + kShares[i] * (sun - axis)),
                    0.0, 1e-6);
    }
  EXPECT_NEAR(glm::length(axisOf(looking(kSymmetric))), 0.0, 1e-12);
}

TEST(LensFlare, SpritesAreRoundWhateverThePicturesShape) {
  const View view = looking(glm::perspective(1.0, 3.0, 1.0, 1e4));
  for (const FlareSprite& s : flareOf(view, glm::normalize(glm::dvec3(0.1, 1, 0.3))).sprites)
    EXPECT_NEAR(s.halfSize.x * 3.0f, s.halfSize.y, 1e-5f);
}

TEST(LensFlare, IsGoneBehindAndBesideThePicture) {
  const View view = looking(kSymmetric);
  EXPECT_EQ(flareOf(view, {0, -1, 0}).shown, 0.0f);
  EXPECT_EQ(flareOf(view, glm::normalize(glm::dvec3(0, -1, -0.3))).shown, 0.0f);
  EXPECT_EQ(flareOf(view, {0, 0, 1}).shown, 0.0f);
  EXPECT_EQ(flareOf(view, {1, 0, 0}).shown, 0.0f);
  EXPECT_EQ(lensFlareOf(partsOf(view, 720), {0, 1, 0}, kSunRadius, glm::vec3(0.0f)).shown, 0.0f);
}

// The right rim of the picture; half of the disc is within when its centre is on it.
TEST(LensFlare, FadesOverTheDiscsWidth) {
  View view;
  view.projection = glm::perspective(1.0, 1.6, 1.0, 1e4);
  const double rim = std::atan(1.6 * std::tan(0.5));
  const auto shown = [&](double angle) {
    return flareOf(view, {std::sin(angle), 0, -std::cos(angle)}).shown;
  };
  EXPECT_NEAR(shown(rim), 0.5f, 0.01f);
  EXPECT_NEAR(shown(rim - 0.5 * kSunRadius), 0.75f, 0.02f);
  EXPECT_EQ(shown(rim - 1.1 * kSunRadius), 1.0f);
  EXPECT_EQ(shown(rim + 1.1 * kSunRadius), 0.0f);
  const float full = flareOf(view, {0, 0, -1}).sprites[0].light.y;
  EXPECT_NEAR(flareOf(view, {std::sin(rim), 0, -std::cos(rim)}).sprites[0].light.y, 0.5f * full,
              0.01f * full);
}

// All sprites together scatter what the strength says, 1 here.
TEST(LensFlare, LightIsTheSunsSpreadOverTheSprites) {
  const View view = looking(kSymmetric);
  const LensFlare flare = flareOf(view, glm::normalize(glm::dvec3(0.1, 1, 0.3)));
  const ViewParts parts = partsOf(view, 720);
  double lux = 0.0;
  for (const FlareSprite& s : flare.sprites)
    lux += testing::luminanceOf(s.light) * kPi * s.halfSize.x * parts.rayScale.x * s.halfSize.y *
           parts.rayScale.y;
  EXPECT_NEAR(lux / testing::luminanceOf(kIlluminance), 1.0, 0.02);
}

TEST(LensFlare, ProfilesHaveTheMeanOne) {
  constexpr int kSteps = 200000;
  for (const float hollow : {-1.0f, 0.0f, 0.4f, 1.0f}) {
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const auto r = static_cast<float>((i + 0.5) / kSteps);
      sum += 2.0 * r * (hollow < 0.0f ? lib::flareGlow(r) : lib::flareGhost(r, hollow)) / kSteps;
    }
    EXPECT_NEAR(sum, 1.0, 1e-4) << hollow;
  }
  EXPECT_EQ(lib::flareGlow(1.0f), 0.0f);
  EXPECT_EQ(lib::flareGhost(1.0f, 0.5f), 0.0f);
}

}  // namespace
}  // namespace welkin::shading
