// SPDX-License-Identifier: Apache-2.0
// Far clouds of metaballs as pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/gpu/context.h"
#include "welkin/io/texel_file.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/render/splat_pass.h"
#include "welkin/scene/cumulus_library.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using weather::Genus;

constexpr int kSide = 64;
constexpr double kEyeM = 1500.0, kWidthM = 1200.0;

class SplatPicturesTest : public ::testing::Test {
 protected:
  // North, a cloud some two thirds of the picture's width, its middle at the height of the eye.
  SplatPicturesTest() { lookAt(6.0); }
  void lookAt(double widths, double sunElevationDeg = 40.0) {
    scene::Scene s = looking(sized(clearScene(sunElevationDeg), kSide, kSide), 0.0, 0.0,
                             2.0 * std::atan(0.75 / widths) * 180.0 / 3.14159265358979);
    s.camera.eyeM = kEyeM;
    state = scene::buildSky(s, 0.0);
    tables.update(state);
    pass.setSky(shading::skyUniforms(state), shading::splatLights(state));
    view = shading::partsOf(shading::viewOf(state), kSide);
  }
  void TearDown() override {
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }

  static scene::MetaballLayer::Cloud placedAt(double widths, double turnRad = 0.7) {
    return {{0.0, widths * kWidthM, kEyeM - 0.35 * kWidthM}, kWidthM, turnRad, 0.04, 0};
  }
  // So much of a cloud as a picture, the rest in its finest balls; and what else there is.
  struct Drawn {
    std::vector<field::Metaball> balls;
    scene::CloudBalls::Far far;
  };
  static Drawn cloud(const scene::MetaballLayer::Cloud& placed, float share, std::size_t shape = 1) {
    Drawn one;
    one.far = {&scene::cumulusTowers()[shape], placed, share};
    for (const field::Metaball& b : one.far.shape->levels.back())
      one.balls.push_back(scene::placed(b, placed));
    return one;
  }
  Image<float> drawn(const std::vector<Drawn>& all, int attachment = 0) {
    std::vector<SplatCloud> clouds;
    for (const Drawn& one : all) {
      SplatCloud& cloud = clouds.emplace_back();
      cloud.balls = cloud.shade = one.balls;
      cloud.far = one.far;
      if (one.far.share >= 1.0f) cloud.balls = {};
    }
    target.clear(0);
    target.clear(1);
    pass.draw(clouds, view, tables, {target, 1.0f, true, {}, {}});
    return target.readPicture(attachment);
  }
  static double sumOf(const Image<float>& picture, int channel) {
    double sum = 0.0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) sum += static_cast<double>(picture.at(x, y, channel));
    return sum;
  }
  static double differenceOf(const Image<float>& a, const Image<float>& b, int channel) {
    double sum = 0.0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        sum += std::abs(static_cast<double>(a.at(x, y, channel) - b.at(x, y, channel)));
    return sum / sumOf(b, channel);
  }

  gpu::Context context{{.debug = true}};
  gpu::Texture2D light{kSide, kSide, {.format = gpu::Format::kRgba32F}},
      distance{kSide, kSide, {.format = gpu::Format::kRgba32F}};
  gpu::Framebuffer target = [this] {
    gpu::Framebuffer both(light);
    both.attach(1, distance);
    return both;
  }();
  SkyTextures tables;
  SplatPass pass{SplatDetail::kStill};
  scene::SkyState state;
  shading::ViewParts view;
};

// Of every shape, turned any way, near and far, under a high sun and a low one: as opaque, as bright and
// where it is.
TEST_F(SplatPicturesTest, APictureIsAsItsBalls) {
  double turnRad = 0.3;
  for (const double elevationDeg : {40.0, 5.0})
    for (const double widths : {5.0, 20.0})
      for (std::size_t shape = 0; shape < scene::cumulusTowers().size(); ++shape, turnRad += 1.1) {
        lookAt(widths, elevationDeg);
        const scene::MetaballLayer::Cloud placed = placedAt(widths, turnRad);
        const Image<float> balls = drawn({cloud(placed, 0.0f, shape)}),
                           picture = drawn({cloud(placed, 1.0f, shape)});
        EXPECT_GT(sumOf(balls, 3), 0.1 * kSide * kSide);
        EXPECT_LT(differenceOf(picture, balls, 3), 0.03) << widths << " widths, shape " << shape;
        EXPECT_NEAR(sumOf(picture, 1) / sumOf(balls, 1), 1.0, 0.1)
            << widths << " widths, shape " << shape << ", sun at " << elevationDeg;
        EXPECT_LT(differenceOf(picture, balls, 1), 0.15)
            << widths << " widths, shape " << shape << ", sun at " << elevationDeg;
      }
}

// While the one fades into the other there is as much of the cloud.
TEST_F(SplatPicturesTest, TheFadeIsAsOpaqueAsEither) {
  const Image<float> balls = drawn({cloud(placedAt(6.0), 0.0f)});
  for (const float share : {0.2f, 0.5f, 0.8f}) {
    const Image<float> both = drawn({cloud(placedAt(6.0), share)});
    EXPECT_LT(differenceOf(both, balls, 3), 0.03) << share;
  }
}

// Coming nearer, through the fade, the picture changes by no more in a step than the fade has to and nearness
// does.
TEST_F(SplatPicturesTest, NothingJumpsAsItComesNearer) {
  std::vector<double> outside, within;
  Image<float> before;
  for (double widths = 9.0; widths > 3.1; widths *= 0.96) {
    lookAt(widths);
    const scene::MetaballLayer::Cloud placed = placedAt(widths);
    const float share = scene::pictureShare(widths, placed.extinctionPerM * placed.widthM);
    const Image<float> picture = drawn({cloud(placed, share)});
    if (!before.data.empty())
      (widths > 3.3 && widths < 5.3 ? within : outside).push_back(differenceOf(picture, before, 1));
    before = picture;
  }
  lookAt(4.3);
  const double all =
      differenceOf(drawn({cloud(placedAt(4.3), 1.0f)}), drawn({cloud(placedAt(4.3), 0.0f)}), 1);
  const double most = *std::ranges::max_element(outside);
  std::ranges::sort(outside);
  EXPECT_GT(outside.front(), 0.0);
  EXPECT_LT(most, 3.0 * outside[outside.size() / 2]);
  // The fade takes nine steps, the thick of a cloud six of them.
  EXPECT_LT(*std::ranges::max_element(within), most + 0.35 * all);
}

TEST_F(SplatPicturesTest, AFrameIsTheSameAfterADetour) {
  const std::vector<Drawn> clouds = {cloud(placedAt(6.0), 1.0f), cloud(placedAt(9.0, 2.0), 0.5f, 2)};
  const Image<float> first = drawn(clouds);
  lookAt(9.0, 8.0);
  drawn({cloud(placedAt(7.0, 3.0), 1.0f, 3)});
  lookAt(6.0);
  EXPECT_EQ(first.data, drawn(clouds).data);
}

// From frame to frame the order is mended, not found anew.
TEST_F(SplatPicturesTest, ASmallStepSortsLittle) {
  const std::vector<Drawn> clouds = {cloud(placedAt(6.0), 0.5f), cloud(placedAt(9.0, 2.0), 0.5f, 2)};
  drawn(clouds);
  const std::size_t fresh = pass.order().comparisons();
  EXPECT_TRUE(pass.order().isFresh());
  EXPECT_GT(pass.order().order().size(), 400u);
  view.eyeM += glm::dvec3(1.0, 2.0, 0.0);
  drawn(clouds);
  EXPECT_FALSE(pass.order().isFresh());
  EXPECT_LT(pass.order().comparisons(), fresh / 4);
}

// A ball before a picture hides it, and one behind is hidden; a picture says how far away it is.
TEST_F(SplatPicturesTest, HasItsPlaceInTheOrder) {
  const scene::MetaballLayer::Cloud placed = placedAt(6.0);
  Drawn black;
  black.balls = {{{0.0, 0.0, kEyeM}, 200.0, 0.2}};
  const auto lightWith = [&](double awayM) {
    black.balls[0].centreM.y = awayM;
    std::vector<Drawn> both = {cloud(placed, 1.0f)};
    const double alone = sumOf(drawn(both), 0);
    both.push_back(black);
    // No light of its own.
    std::vector<SplatCloud> clouds(2);
    clouds[0].far = both[0].far;
    clouds[1].balls = black.balls;
    clouds[1].albedo = 0.0f;
    target.clear(0);
    target.clear(1);
    pass.draw(clouds, view, tables, {target, 1.0f, true, {}, {}});
    return sumOf(target.readPicture(), 0) / alone;
  };
  EXPECT_LT(lightWith(3.0 * kWidthM), 0.9);
  EXPECT_GT(lightWith(9.0 * kWidthM), 0.99);
  const Image<float> far = drawn({cloud(placed, 1.0f)}, 1);
  const double km = static_cast<double>(far.at(kSide / 2, kSide / 2, 0) / far.at(kSide / 2, kSide / 2, 3));
  EXPECT_NEAR(km, 6.0e-3 * kWidthM, 0.6e-3 * kWidthM);
}

// A cloud in the sun's light of a picture makes it darker; one beside that does not.
TEST_F(SplatPicturesTest, OthersShadeIt) {
  const scene::MetaballLayer::Cloud placed = placedAt(6.0);
  const glm::dvec3 toSun(state.lights[0].direction),
      middle = placed.baseM + glm::dvec3(0.0, 0.0, 0.35 * kWidthM);
  const auto lightUnder = [&](const glm::dvec3& awayM) {
    Drawn other;
    other.balls = {{middle + awayM, 700.0, 0.05}};
    return sumOf(drawn({cloud(placed, 1.0f), other}), 1);
  };
  const double alone = sumOf(drawn({cloud(placed, 1.0f)}), 1);
  EXPECT_LT(lightUnder(4000.0 * toSun), 0.8 * alone);
  const glm::dvec3 beside = glm::normalize(glm::cross(toSun, glm::dvec3(0.0, 0.0, 1.0)));
  EXPECT_NEAR(lightUnder(4000.0 * toSun + 3000.0 * beside) / alone, 1.0, 0.01);
}

// A sheet hides the pictures above it and none under it: with other clouds of the same kind there it is the
// same picture, or another. Its pattern is from a file, since one that is generated is another for another
// seed, as the clouds are.
TEST_F(SplatPicturesTest, HaveTheirPlaceAmongSheets) {
  scene::Scene s = looking(cloudyScene(50.0, {Genus::kCumulus}, 2.0), 0.0, 9.0, 20.0);
  s.technique = scene::Technique::kMetaballs;
  const std::string file = ::testing::TempDir() + "welkin_even_sheet.dds";
  Image<std::uint8_t> even(8, 8, 1);
  std::ranges::fill(even.data, std::uint8_t{150});
  io::writeTexels(file, io::toTexels(even, {io::Channels::kL, io::ValueType::kUnorm8}));
  scene::Sheet sheet;
  sheet.texture = file;
  sheet.cutoff = 0.0;
  sheet.density = 0.01;
  SkyRenderer renderer;
  const auto differences = [&](double sheetM) {
    sheet.heightM = sheetM;
    s.sheets = {sheet};
    std::array<Image<float>, 2> pictures;
    for (int i = 0; i < 2; ++i) {
      s.seed = 5 + i;
      const scene::SkyState at = scene::buildSky(s, 0.0);
      scene::CloudBalls balls;
      at.metaballs->at(0.0, {0.0, 0.0, s.camera.eyeM}, at.clouds->earthRadiusM(), balls);
      // What is so low in view is farther away than any balls.
      for (const field::Metaball& b : balls.balls) EXPECT_LT(glm::length(glm::dvec2(b.centreM)), 8000.0);
      EXPECT_TRUE(at.warnings.empty());
      pictures[static_cast<std::size_t>(i)] = renderer.draw(at).luminance;
    }
    return relativeDifference(pictures[0], pictures[1]);
  };
  const double behind = differences(300.0), before = differences(9000.0);
  std::filesystem::remove(file);
  EXPECT_GT(before, 0.1);
  EXPECT_LT(behind, 0.001 * before);
  context.makeCurrent();
}

}  // namespace
}  // namespace welkin::render
