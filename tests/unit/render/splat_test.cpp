// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs drawn in two passes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/testing/engine_depth.h"
#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/core/colour.h"
#include "welkin/core/glsl.h"
#include "welkin/core/random.h"
#include "welkin/gpu/context.h"
#include "welkin/render/splat_pass.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using namespace welkin::glsl;
#include "shaders/lib/splat.glsl"

constexpr int kSide = 64;
constexpr double kDistanceM = 1000.0;

std::vector<field::Metaball> someBalls(int count) {
  std::vector<field::Metaball> balls;
  Random random(7);
  const auto within = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  for (int i = 0; i < count; ++i) {
    const double x = within(-200.0, 200.0), y = kDistanceM + within(-200.0, 200.0), z = within(-150.0, 150.0);
    balls.push_back({{x, y, z}, within(20.0, 90.0), within(0.005, 0.03)});
  }
  return balls;
}

TEST(SplatColumn, IsTheIntegralOfTheKernel) {
  for (const double b : {0.0, 0.3, 0.7, 0.95})
    for (const double to : {-0.5, 0.1, 2.0}) {
      double sum = 0.0;
      constexpr int kSteps = 20000;
      for (int i = 0; i < kSteps; ++i) {
        const double t = -1.0 + (std::min(to, 1.0) + 1.0) * (i + 0.5) / kSteps;
        sum += field::wyvillOfSquare(b * b + t * t) * (std::min(to, 1.0) + 1.0) / kSteps;
      }
      EXPECT_NEAR(splatColumn(static_cast<float>(b * b), -1.0f, static_cast<float>(to)), sum, 1e-5)
          << b << " " << to;
    }
}

class SplatTest : public ::testing::Test {
 protected:
  // North, the balls at eye level in the middle of the picture.
  SplatTest() { sunAt(40.0); }
  void sunAt(double elevationDeg) {
    scene::Scene s = looking(sized(clearScene(elevationDeg), kSide, kSide), 0.0, 0.0, 40.0);
    s.camera.eyeM = 1500.0;
    state = scene::buildSky(s, 0.0);
    tables.update(state);
    pass.setSky(shading::skyUniforms(state), shading::splatLights(state));
  }
  void TearDown() override {
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }

  // At heights from the eye's.
  Image<float> drawn(std::vector<field::Metaball> balls, SplatPhase phase = SplatPhase::kDroplets) {
    return drawnTogether({std::move(balls)}, phase);
  }
  Image<float> drawnTogether(std::vector<std::vector<field::Metaball>> clouds,
                             SplatPhase phase = SplatPhase::kDroplets) {
    std::vector<SplatCloud> all;
    for (std::vector<field::Metaball>& balls : clouds) {
      for (field::Metaball& b : balls) b.centreM.z += state.scene.camera.eyeM;
      all.push_back({balls, phase});
    }
    target.clear();
    pass.draw(all, view, tables, {target});
    return target.readPicture();
  }

  gpu::Context context{{.debug = true}};
  gpu::Texture2D texture{kSide, kSide, {.format = gpu::Format::kRgba32F}};
  gpu::Framebuffer target{texture};
  SkyTextures tables;
  SplatPass pass;
  scene::SkyState state;
  shading::ViewParts view = [] {
    scene::SkyState at;
    at.scene = looking(sized(clearScene(40.0), kSide, kSide), 0.0, 0.0, 40.0);
    at.scene.camera.eyeM = 1500.0;
    return shading::partsOf(shading::viewOf(at), kSide);
  }();

  // The ray of a pixel.
  glm::dvec3 rayOf(int x, int y) const {
    const glm::vec2 clip((x + 0.5f) / kSide * 2.0f - 1.0f, 1.0f - (y + 0.5f) / kSide * 2.0f);
    return glm::normalize(
        glm::dvec3(view.enuFromCamera * glm::vec3(view.rayScale.x * clip.x + view.rayScale.z,
                                                  view.rayScale.y * clip.y + view.rayScale.w, -1.0f)));
  }
  // Optical depth along it from the eye on, by quadrature.
  static double depthAlong(const field::MetaballField& field, const glm::dvec3& ray, double endM) {
    constexpr int kSteps = 4000;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) sum += std::max(field(ray * ((i + 0.5) / kSteps * endM)), -1.0);
    return sum * endM / kSteps;
  }
};

void expectSameBytes(const Image<float>& a, const Image<float>& b) {
  EXPECT_EQ(a.data, b.data);
}

// What is hidden is what the field hides, pixel by pixel: of one ball, of many, of one that the eye is in.
TEST_F(SplatTest, HidesWhatTheFieldHides) {
  const std::vector<std::vector<field::Metaball>> clouds = {
      {{{30.0, kDistanceM, -20.0}, 200.0, 0.008}},
      someBalls(60),
      {{{10.0, 30.0, 5.0}, 100.0, 0.012}},
      {{{0.0, -30.0, 10.0}, 100.0, 0.03}, {{0.0, 1500.0, 0.0}, 300.0, 0.002}}};
  for (std::size_t c = 0; c < clouds.size(); ++c) {
    const Image<float> picture = drawn(clouds[c]);
    const field::MetaballField field(clouds[c]);
    double most = 0.0;
    for (int y = 0; y < kSide; y += 3)
      for (int x = 0; x < kSide; x += 3) {
        const double hidden = 1.0 - std::exp(-depthAlong(field, rayOf(x, y), 2000.0));
        most = std::max(most, hidden);
        EXPECT_NEAR(picture.at(x, y, 3), hidden, 2e-3) << "cloud " << c << " at " << x << ", " << y;
      }
    EXPECT_GT(most, 0.3) << "cloud " << c;
  }
}

// Softly: what an engine has drawn in a ball hides what is behind it of the ball, along each ray, and no
// more.
TEST_F(SplatTest, WhatAnEngineHasDrawnCutsBalls) {
  constexpr double kNearM = 10.0, kFarM = 1e4;
  const std::vector<field::Metaball> balls{{{30.0, kDistanceM, -20.0}, 250.0, 0.006}};
  const field::MetaballField field(balls);
  std::vector<field::Metaball> inPlace = balls;
  inPlace[0].centreM.z += state.scene.camera.eyeM;
  const SplatCloud cloud{.balls = inPlace};
  for (const bool reversed : {false, true}) {
    glm::dmat4 m(0.0);
    m[2][2] = reversed ? kNearM / (kFarM - kNearM) : -(kFarM + kNearM) / (kFarM - kNearM);
    m[3][2] = (reversed ? 1.0 : -2.0) * kFarM * kNearM / (kFarM - kNearM);
    for (const double wallM : {500.0, 850.0, 1000.0, 1150.0, 3000.0}) {
      const double ndc = -m[2][2] + m[3][2] / wallM;
      Image<float> depth(kSide, kSide, 1);
      std::ranges::fill(depth.data, static_cast<float>(reversed ? ndc : 0.5 + 0.5 * ndc));
      const EngineDepthTexture engine(depth);
      target.clear();
      pass.draw({&cloud, 1}, view, tables,
                {.target = target, .depth = {engine.id(), reversed}, .projection = m});
      const Image<float> picture = target.readPicture();
      for (int y = 1; y < kSide; y += 4)
        for (int x = 1; x < kSide; x += 4) {
          const glm::dvec3 ray = rayOf(x, y);
          ASSERT_NEAR(picture.at(x, y, 3), 1.0 - std::exp(-depthAlong(field, ray, wallM / ray.y)), 3e-3)
              << wallM << (reversed ? " reversed at " : " at ") << x << ", " << y;
        }
    }
  }
}

TEST_F(SplatTest, TheOrderOfTheBallsDoesNotMatter) {
  const std::vector<field::Metaball> balls = someBalls(200);
  std::vector<field::Metaball> turned(balls.rbegin(), balls.rend());
  const Image<float> a = drawn(balls), b = drawn(turned);
  for (std::size_t i = 0; i < a.data.size(); ++i)
    ASSERT_NEAR(a.data[i], b.data[i], 2e-4 * std::abs(a.data[i]) + 1e-6);  // sums of the light pass
}

TEST_F(SplatTest, AFrameIsTheSameAfterADetour) {
  const std::vector<field::Metaball> balls = someBalls(300);
  const Image<float> first = drawn(balls);
  drawn(someBalls(20));
  std::vector<field::Metaball> moved = balls;
  for (field::Metaball& b : moved) b.centreM.y = 2.0 * kDistanceM - b.centreM.y;
  drawn(moved);
  expectSameBytes(first, drawn(balls));
}

// In light of the same strength from everywhere a ball that scatters all of it would vanish; it can never be
// brighter than the brightest light on it is in every direction.
TEST_F(SplatTest, NoBallIsBrighterThanTheLightOnIt) {
  const double lux = luminanceOf(state.lights[0].illuminance);
  for (const double density : {0.001, 0.01, 0.1}) {
    const Image<float> picture = drawn({{{0.0, kDistanceM, 0.0}, 150.0, density}}, SplatPhase::kIsotropic);
    double brightest = 0.0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const float* p = &picture.data[picture.index(x, y)];
        brightest = std::max(brightest, static_cast<double>(luminanceOf(p)));
      }
    EXPECT_GT(brightest, 0.0);
    EXPECT_LT(brightest, lux / 3.14159);
  }
}

// Thick clouds are bright where the sun shines on them and dark on the other side; of thin ones the rim
// against the sun is brighter than all else: the silver lining.
TEST_F(SplatTest, ACloudHasALitSideAndADarkOneAndASilverLining) {
  sunAt(8.0);
  const glm::dvec3 toSun = glm::normalize(glm::dvec3(state.lights[0].direction) * glm::dvec3(1.0, 1.0, 0.0));
  // Mean luminance of a cloud's middle seen towards the sun or away from it, for each unit of what it hides.
  const auto seen = [&](double side, double density, SplatPhase phase) {
    scene::SkyState at = state;
    const glm::dvec3 ahead = side * toSun;
    at.headingDeg = std::atan2(ahead.x, ahead.y) * 180.0 / 3.14159265358979;
    view = shading::partsOf(shading::viewOf(at), kSide);
    std::vector<field::Metaball> balls = someBalls(300);
    for (field::Metaball& b : balls) {
      b.density = density;
      b.centreM = {b.centreM.y * ahead.x - b.centreM.x * ahead.y,
                   b.centreM.y * ahead.y + b.centreM.x * ahead.x, b.centreM.z};
    }
    const Image<float> picture = drawn(balls, phase);
    double light = 0.0, hidden = 0.0;
    for (int y = kSide * 3 / 8; y < kSide * 5 / 8; ++y)
      for (int x = kSide * 3 / 8; x < kSide * 5 / 8; ++x) {
        light += luminanceOf(&picture.data[picture.index(x, y)]);
        hidden += picture.at(x, y, 3);
      }
    return light / hidden;
  };
  EXPECT_GT(seen(-1.0, 0.2, SplatPhase::kDroplets), 1.3 * seen(1.0, 0.2, SplatPhase::kDroplets));
  EXPECT_GT(seen(1.0, 1e-4, SplatPhase::kDroplets), 1.5 * seen(-1.0, 1e-4, SplatPhase::kDroplets));
  EXPECT_GT(seen(1.0, 1e-4, SplatPhase::kDroplets), 1.5 * seen(1.0, 1e-4, SplatPhase::kIsotropic));
}

// A thick cloud in the sun's light of another makes it darker, in view or not; one behind or beside it does
// not.
TEST_F(SplatTest, ACloudShadesAnother) {
  const field::Metaball lit{{0.0, kDistanceM, 0.0}, 150.0, 0.03};
  const glm::dvec3 toSun(state.lights[0].direction);
  const auto middle = [&](const std::vector<std::vector<field::Metaball>>& clouds) {
    const Image<float> picture = drawnTogether(clouds);
    return luminanceOf(pixel(picture, kSide / 2, kSide / 2)) / picture.at(kSide / 2, kSide / 2, 3);
  };
  const double alone = middle({{lit}});
  field::Metaball other{lit.centreM + 1500.0 * toSun, 300.0, 0.3};
  EXPECT_LT(middle({{lit}, {other}}), 0.85 * alone);
  other.centreM = lit.centreM + 12500.0 * toSun;  // shadows end
  EXPECT_NEAR(middle({{lit}, {other}}) / alone, 1.0, 0.02);
  other.centreM = lit.centreM - 1500.0 * toSun;
  EXPECT_NEAR(middle({{lit}, {other}}) / alone, 1.0, 0.02);
  other.centreM = lit.centreM + 1500.0 * toSun + 600.0 * glm::normalize(glm::cross(toSun, {0.0, 0.0, 1.0}));
  EXPECT_NEAR(middle({{lit}, {other}}) / alone, 1.0, 0.02);
}

// Two clouds that stand in one another are lit as one of all their balls.
TEST_F(SplatTest, AParcelOfCloudsIsLitAsOne) {
  const std::vector<field::Metaball> all = someBalls(120);
  std::vector<std::vector<field::Metaball>> parts(2);
  for (std::size_t i = 0; i < all.size(); ++i) parts[i % 2].push_back(all[i]);
  const Image<float> whole = drawn(all), inParts = drawnTogether(parts);
  double difference = 0.0, light = 0.0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double a = luminanceOf(pixel(whole, x, y)), b = luminanceOf(pixel(inParts, x, y));
      light += a;
      difference += std::abs(a - b);
    }
  EXPECT_LT(difference, 0.15 * light);
}

}  // namespace
}  // namespace welkin::render
