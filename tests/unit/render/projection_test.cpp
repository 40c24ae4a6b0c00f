// SPDX-License-Identifier: Apache-2.0
// shaders/lib/projection.glsl: where the pixels of a picture look. Pictures from it are compared in
// projections_agree_test.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>

#include "tests/testing/skies.h"
#include "welkin/core/glsl.h"
#include "welkin/core/units.h"
#include "welkin/scene/sky_state.h"
#include "welkin/shading/uniforms.h"

namespace welkin::render {
namespace {

using namespace welkin::glsl;
#include "shaders/lib/projection.glsl"

// The projector as the renderer packs it: that packing is part of what is tested.
Projector projectorOf(scene::Camera camera, int width, int height) {
  scene::SkyState state;
  state.scene.camera = camera;
  state.scene.output.width = width;
  state.scene.output.height = height;
  state.headingDeg = camera.headingDeg.value_or(0.0);
  Projector p{};
  for (const auto& [name, value] : shading::projectorUniforms(state)) {
    if (name == "uProjector.kind") p.kind = std::get<int>(value);
    if (name == "uProjector.sizePx") p.sizePx = std::get<glm::vec2>(value);
    if (name == "uProjector.halfWidthTan") p.halfWidthTan = std::get<float>(value);
    if (name == "uProjector.enuFromCamera") p.enuFromCamera = std::get<glm::mat3>(value);
  }
  return p;
}

scene::Camera cameraOf(scene::Projection projection, double headingDeg, double pitchDeg = 0.0,
                       double fovDeg = 70.0) {
  scene::Camera c;
  c.projection = projection;
  c.headingDeg = headingDeg;
  c.pitchDeg = pitchDeg;
  c.fovDeg = fovDeg;
  return c;
}

struct Sight {
  vec3 dir{0};
  float pixelRad = 0.0f;
  bool inside = false;
};
Sight sightAt(const Projector& p, float x, float y) {
  Sight s;
  s.inside = projectorDirection(p, vec2(x, y), s.dir, s.pixelRad);
  return s;
}

vec3 towards(double headingDeg, double elevationDeg) {
  const double a = radians(headingDeg), e = radians(elevationDeg);
  return {static_cast<float>(std::sin(a) * std::cos(e)), static_cast<float>(std::cos(a) * std::cos(e)),
          static_cast<float>(std::sin(e))};
}

double angleBetween(vec3 a, vec3 b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

void expectLooks(const Projector& p, float x, float y, vec3 dir) {
  const Sight s = sightAt(p, x, y);
  EXPECT_LT(angleBetween(s.dir, dir), 2e-6)
      << "at " << x << ", " << y << ": " << s.dir.x << " " << s.dir.y << " " << s.dir.z;
}

struct Case {
  const char* name;
  scene::Projection projection;
  int width, height;
};
const Case kCases[] = {{"perspective", scene::Projection::kPerspective, 320, 180},
                       {"fisheye", scene::Projection::kFisheye, 200, 200},
                       {"equirect", scene::Projection::kEquirect, 400, 200},
                       {"cubemap", scene::Projection::kCubemap, 600, 100}};

TEST(Projection, DirectionsAreUnitVectors) {
  for (const Case& c : kCases) {
    const Projector p = projectorOf(cameraOf(c.projection, 217.0, 33.0), c.width, c.height);
    for (int y = 0; y < c.height; y += 3)
      for (int x = 0; x < c.width; x += 3)
        ASSERT_NEAR(glm::length(sightAt(p, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f).dir),
                    1.0f, 1e-6f)
            << c.name;
  }
}

// The directions of neighbouring pixels in the middle of the picture (of a face, of the horizon) are as far
// apart as stated.
TEST(Projection, PixelsSpanTheAngleThatTheySay) {
  for (const Case& c : kCases) {
    const Projector p = projectorOf(cameraOf(c.projection, 217.0, 33.0), c.width, c.height);
    const bool strip = c.projection == scene::Projection::kCubemap;
    const float x = strip ? 2.5f * static_cast<float>(c.height) : 0.5f * static_cast<float>(c.width);
    const float y = 0.5f * static_cast<float>(c.height);
    const double across = angleBetween(sightAt(p, x - 0.5f, y).dir, sightAt(p, x + 0.5f, y).dir);
    const double down = angleBetween(sightAt(p, x, y - 0.5f).dir, sightAt(p, x, y + 0.5f).dir);
    const double said = sightAt(p, x, y).pixelRad;
    EXPECT_NEAR(across / said, 1.0, 0.01) << c.name;
    EXPECT_NEAR(down / said, 1.0, 0.01) << c.name;
  }
}

TEST(Projection, PerspectiveLooksWhereItIsPointed) {
  for (const double pitch : {-40.0, 0.0, 12.0, 90.0}) {
    const Projector p = projectorOf(cameraOf(scene::Projection::kPerspective, 120.0, pitch, 60.0), 320, 180);
    expectLooks(p, 160, 90, towards(120, pitch));
  }
  // The field of view lies across the width: 30 degrees to the edge on each side, to the right the azimuth
  // grows.
  const Projector level = projectorOf(cameraOf(scene::Projection::kPerspective, 120.0, 0.0, 60.0), 320, 180);
  expectLooks(level, 0, 90, towards(90, 0));
  expectLooks(level, 320, 90, towards(150, 0));
  const double upHalf = degrees(std::atan(std::tan(radians(30.0)) * 180 / 320));
  expectLooks(level, 160, 0, towards(120, upHalf));
  expectLooks(level, 160, 180, towards(120, -upHalf));
}

TEST(Projection, FisheyeIsADomeMaster) {
  const Projector p =
      projectorOf(cameraOf(scene::Projection::kFisheye, 120.0, 45.0), 200, 200);  // no pitch in a whole sky
  expectLooks(p, 100, 100, {0, 0, 1});
  expectLooks(p, 100, 200, towards(120, 0));  // the heading at the bottom
  expectLooks(p, 100, 0, towards(300, 0));
  expectLooks(p, 100, 150, towards(120, 45));  // equidistant
  // Seen from below: what is right of the heading is on the right.
  expectLooks(p, 200, 100, towards(210, 0));
  EXPECT_TRUE(sightAt(p, 100, 199.5f).inside);
  EXPECT_FALSE(sightAt(p, 5, 5).inside);
}

TEST(Projection, EquirectHasTheHeadingInTheMiddle) {
  const Projector p = projectorOf(cameraOf(scene::Projection::kEquirect, 120.0, 45.0), 400, 200);
  expectLooks(p, 200, 100, towards(120, 0));
  expectLooks(p, 300, 100, towards(210, 0));  // azimuth grows to the right
  expectLooks(p, 100, 100, towards(30, 0));
  expectLooks(p, 0, 100, towards(300, 0));
  expectLooks(p, 200, 50, towards(120, 45));
  expectLooks(p, 123, 0, {0, 0, 1});
  expectLooks(p, 123, 200, {0, 0, -1});
}

// OpenGL 4.6, table 8.19: the face's major axis, and the axes along which sc and tc grow; rows go down with
// t.
TEST(Projection, CubeFacesAreOrientedAsOpenGlHasThem) {
  const struct {
    vec3 major, sc, tc;
  } kFaces[] = {{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},   {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}};
  const Projector p = projectorOf(cameraOf(scene::Projection::kCubemap, 0.0), 600, 100);
  for (int face = 0; face < 6; ++face) {
    const float x0 = 100.0f * static_cast<float>(face);
    const auto& f = kFaces[face];
    expectLooks(p, x0 + 50, 50, f.major);
    expectLooks(p, x0 + 75, 50, normalize(f.major + 0.5f * f.sc));
    expectLooks(p, x0 + 50, 75, normalize(f.major + 0.5f * f.tc));
    expectLooks(p, x0 + 0.5f, 99.5f, normalize(f.major - 0.99f * f.sc + 0.99f * f.tc));
  }
}

// A cube and a sphere have 4 pi of sky: the pixels' solid angles add up to it.
TEST(Projection, WholeSkiesAreWhole) {
  for (const Case& c : {kCases[2], kCases[3]}) {
    const Projector p = projectorOf(cameraOf(c.projection, 40.0), c.width, c.height);
    double sum = 0.0;
    for (int y = 0; y < c.height; ++y)
      for (int x = 0; x < c.width; ++x) {
        const float fx = static_cast<float>(x) + 0.5f, fy = static_cast<float>(y) + 0.5f;
        const vec3 dx = sightAt(p, fx + 0.2f, fy).dir - sightAt(p, fx - 0.2f, fy).dir;
        const vec3 dy = sightAt(p, fx, fy + 0.2f).dir - sightAt(p, fx, fy - 0.2f).dir;
        sum += glm::length(glm::cross(dx, dy)) / (0.4 * 0.4);
      }
    EXPECT_NEAR(sum / (4.0 * kPi), 1.0, 0.002) << c.name;
  }
}

}  // namespace
}  // namespace welkin::render
