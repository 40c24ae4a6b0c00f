// SPDX-License-Identifier: Apache-2.0
// One sky drawn in every projection: at a common direction it has one luminance. The directions of pixels are
// tested by themselves in projection_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/core/units.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using weather::Genus;

constexpr double kHeadingDeg = 40.0;
constexpr double kPitchDeg = 35.0;
constexpr int kSide = 64;  // of a cube's face; the others have pixels of about the same angle

// Where a direction falls in each picture, in pixels.
glm::dvec2 inPerspective(glm::dvec3 d, double width, double height, double fovDeg) {
  const double h = radians(kHeadingDeg), p = radians(kPitchDeg);
  const glm::dvec3 right(std::cos(h), -std::sin(h), 0);
  const glm::dvec3 forward(std::sin(h) * std::cos(p), std::cos(h) * std::cos(p), std::sin(p));
  const glm::dvec3 up = glm::cross(right, forward);
  const double scale = 0.5 * width / std::tan(0.5 * radians(fovDeg)) / glm::dot(d, forward);
  return {0.5 * width + glm::dot(d, right) * scale, 0.5 * height - glm::dot(d, up) * scale};
}
glm::dvec2 inFisheye(glm::dvec3 d, double side) {
  // Heading at the bottom, and what lies right of it on the right.
  const double fromHeading = std::atan2(d.x, d.y) - radians(kHeadingDeg);
  const double r = std::acos(d.z) / (0.5 * kPi) * 0.5 * side;
  return {0.5 * side + r * std::sin(fromHeading), 0.5 * side + r * std::cos(fromHeading)};
}
glm::dvec2 inEquirect(glm::dvec3 d, double width, double height) {
  const double fromHeading = std::remainder(std::atan2(d.x, d.y) - radians(kHeadingDeg), 2.0 * kPi);
  return {(0.5 + fromHeading / (2.0 * kPi)) * width, (0.5 - std::asin(d.z) / kPi) * height};
}
glm::dvec2 inCubemap(glm::dvec3 d, double side) {
  const glm::dvec3 a(std::abs(d.x), std::abs(d.y), std::abs(d.z));
  int face;
  double s, t, m;
  if (a.x >= a.y && a.x >= a.z) {
    face = d.x > 0 ? 0 : 1, m = a.x, s = d.x > 0 ? -d.z : d.z, t = -d.y;
  } else if (a.y >= a.z) {
    face = d.y > 0 ? 2 : 3, m = a.y, s = d.x, t = d.y > 0 ? d.z : -d.z;
  } else {
    face = d.z > 0 ? 4 : 5, m = a.z, s = d.z > 0 ? d.x : -d.x, t = -d.y;
  }
  return {(face + 0.5 * (s / m + 1.0)) * side, 0.5 * (t / m + 1.0) * side};
}

// Mean over a disc of about three pixels: what a slight blur leaves.
glm::dvec3 blurred(const Image<float>& picture, glm::dvec2 at) {
  glm::dvec3 sum(0.0);
  int n = 0;
  for (int j = -2; j <= 2; ++j)
    for (int i = -2; i <= 2; ++i, ++n) sum += glm::dvec3(sample(picture, at.x + 0.75 * i, at.y + 0.75 * j));
  return sum / static_cast<double>(n);
}

struct Disagreement {
  double mean = 0.0, worst = 0.0;  // relative to the mean of the four
};

Disagreement compare(const scene::Scene& scene) {
  SkyRenderer renderer;
  const scene::SkyState state = scene::buildSky(looking(scene, kHeadingDeg, kPitchDeg), 0.0);
  const auto draw = [&](scene::Projection projection, int width, int height, double fovDeg = 70.0) {
    scene::SkyState s = state;
    s.scene = projected(looking(state.scene, kHeadingDeg, kPitchDeg, fovDeg), projection, width, height);
    return renderer.draw(s).luminance;
  };
  // Pixels of about 1.5 degrees at the middle in each.
  const double fovDeg = 60.0;
  const int wide = static_cast<int>(std::lround(2.0 * std::tan(radians(0.5 * fovDeg)) * kSide / 2.0));
  const Image<float> perspective = draw(scene::Projection::kPerspective, wide, wide, fovDeg);
  const Image<float> fisheye = draw(scene::Projection::kFisheye, 2 * kSide * 3 / 4, 2 * kSide * 3 / 4);
  const Image<float> equirect = draw(scene::Projection::kEquirect, 3 * kSide, 3 * kSide / 2);
  const Image<float> cubemap = draw(scene::Projection::kCubemap, 6 * kSide, kSide);

  Disagreement result;
  int n = 0;
  for (int y = 6; y < wide - 6; y += 2)
    for (int x = 6; x < wide - 6; x += 2) {
      // Through the middle of the perspective picture; far enough from faces' edges, where a blur would cross
      // them.
      const double h = radians(kHeadingDeg), p = radians(kPitchDeg),
                   scale = 2.0 * std::tan(0.5 * radians(fovDeg)) / wide;
      const glm::dvec3 right(std::cos(h), -std::sin(h), 0);
      const glm::dvec3 forward(std::sin(h) * std::cos(p), std::cos(h) * std::cos(p), std::sin(p));
      const glm::dvec3 up = glm::cross(right, forward);
      const glm::dvec3 d =
          glm::normalize(forward + right * ((x - 0.5 * wide) * scale) + up * ((0.5 * wide - y) * scale));
      const glm::dvec2 onCube = inCubemap(d, kSide);
      const double s = std::fmod(onCube.x, kSide), margin = 2.5;
      if (s < margin || s > kSide - margin || onCube.y < margin || onCube.y > kSide - margin) continue;
      const glm::dvec3 seen[] = {blurred(perspective, inPerspective(d, wide, wide, fovDeg)),
                                 blurred(fisheye, inFisheye(d, fisheye.width)),
                                 blurred(equirect, inEquirect(d, equirect.width, equirect.height)),
                                 blurred(cubemap, onCube)};
      const glm::dvec3 mean = 0.25 * (seen[0] + seen[1] + seen[2] + seen[3]);
      for (const glm::dvec3& v : seen) {
        const double error = glm::length(v - mean) / glm::length(mean);
        result.mean += error;
        result.worst = std::max(result.worst, error);
        ++n;
      }
    }
  EXPECT_GT(n, 500);
  result.mean /= n;
  return result;
}

TEST(Projections, ShowTheSameClearSky) {
  // The sun stands elsewhere, in the west.
  const Disagreement d = compare(clearScene(40.0));
  // At worst in the glare about the sun, where the resolve's five pixels span more of the gradient in the
  // coarser pictures.
  EXPECT_LT(d.mean, 0.003);
  EXPECT_LT(d.worst, 0.04);
  RecordProperty("mean", std::to_string(d.mean));
}

// Faces beside each other in the strip are not neighbours in the sky: their pixels at the border are as good
// as others. Each is compared with the one in its middle of a picture five times as fine.
TEST(Projections, FacesOfACubeDoNotBleed) {
  scene::Scene s = clearScene(3.0);
  s.output.sunDisc = false;
  SkyRenderer renderer;
  const auto drawn = [&](int side) {
    return renderer.draw(scene::buildSky(projected(s, scene::Projection::kCubemap, 6 * side, side), 0.0))
        .luminance;
  };
  constexpr int kFace = 32, kFiner = 5;
  const Image<float> coarse = drawn(kFace), fine = drawn(kFiner * kFace);
  double border = 0.0, inside = 0.0;
  for (int face = 1; face < 6; ++face)
    for (int y = 0; y < kFace; ++y) {
      const auto error = [&](int x) {
        const glm::vec3 want = pixel(fine, kFiner * x + kFiner / 2, kFiner * y + kFiner / 2);
        return static_cast<double>(glm::length(pixel(coarse, x, y) - want) / glm::length(want));
      };
      border = std::max({border, error(face * kFace - 1), error(face * kFace)});
      inside = std::max({inside, error(face * kFace - 6), error(face * kFace + 5)});
    }
  EXPECT_LT(border, 1.5 * inside + 0.01);
}

TEST(Projections, ShowTheSameClouds) {
  scene::Scene s = cloudyScene(40.0, {Genus::kStratocumulus, Genus::kCirrus});
  s.output.quality = scene::Quality::kMedium;
  const Disagreement d = compare(s);
  EXPECT_LT(d.mean, 0.03);
  RecordProperty("mean", std::to_string(d.mean));
}

TEST(Projections, ShowTheSameSheetsAmongVolumes) {
  scene::Scene s = cloudyScene(40.0, {Genus::kStratocumulus, Genus::kCirrus});
  s.layers[1].technique = scene::Technique::kSkyPlane;
  s.output.quality = scene::Quality::kMedium;
  scene::Sheet dome = scene::sheetOf(field::ThesisTexture::kDome);
  dome.texels = 32;
  dome.heightM = 3000.0;
  dome.tileM = 12000.0;
  s.sheets = {dome};
  const Disagreement d = compare(s);
  EXPECT_LT(d.mean, 0.03);
  RecordProperty("mean", std::to_string(d.mean));
}

}  // namespace
}  // namespace welkin::render
