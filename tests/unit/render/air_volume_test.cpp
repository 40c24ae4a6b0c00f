// SPDX-License-Identifier: Apache-2.0
// Air and clouds by distance, against LiveSky's own pictures and against sums along rays.
#include "welkin/render/air_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <vector>

#include "tests/testing/engine_volume.h"
#include "tests/testing/foreign_engine.h"
#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/core/error.h"
#include "welkin/gpu/context.h"
#include "welkin/reference/air.h"
#include "welkin/render/live_sky.h"
#include "welkin/render/live_volumes.h"
#include "welkin/shading/shader_library.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using weather::Genus;

constexpr int kWidth = 64, kHeight = 36, kSlices = 24;
constexpr float kScale = 1e-3f;

// What the textures hold, rows from the bottom up as in OpenGL.
struct Air {
  AirVolume shown;
  Volume<float> colour, transmittance;

  glm::vec3 at(const Volume<float>& v, int x, int y, int z) const {
    return {v.at(x, y, z, 0), v.at(x, y, z, 1), v.at(x, y, z, 2)};
  }
  // A slice as a picture, top row first, per cd/m2.
  Image<float> picture(int slice, const Image<float>& behind = {}) const {
    Image<float> p(shown.width, shown.height, 3);
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x)
        for (int c = 0; c < 3; ++c) {
          const int row = p.height - 1 - y;
          p.at(x, y, c) = colour.at(x, row, slice, c) / kScale;
          if (!behind.data.empty()) p.at(x, y, c) += transmittance.at(x, row, slice, c) * behind.at(x, y, c);
        }
    return p;
  }
};

class AirVolumeTest : public ::testing::Test {
 protected:
  void TearDown() override {
    context.makeCurrent();
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }
  static AirVolumeOptions options(float farM = 60000.0f) {
    return {.width = kWidth, .height = kHeight, .slices = kSlices, .farM = farM, .scale = kScale};
  }
  static scene::Scene cumulus() {
    return looking(sized(cloudyScene(40.0, {Genus::kCumulus}), kWidth, kHeight), 200.0, 14.0);
  }
  // Through a sheet between two layers of volumes.
  static scene::Scene mixed() {
    scene::Scene s = looking(
        sized(cloudyScene(40.0, {Genus::kCumulus, Genus::kAltocumulus, Genus::kCirrus}), kWidth, kHeight),
        200.0, 20.0);
    s.layers[1].technique = scene::Technique::kSkyPlane;
    return s;
  }
  // Over and among clouds, the ground being black.
  static scene::Scene overBlackGround(double eyeM) {
    scene::Scene s = looking(sized(fromHeight(cloudyScene(40.0, {Genus::kCumulus}), eyeM), kWidth, kHeight),
                             200.0, -50.0, 40.0);
    s.ground.albedo = glm::dvec3(0.0);
    s.seed = 8;  // one with clouds there
    return s;
  }
  static Air airOf(LiveSky& sky, const AirVolumeOptions& o) {
    const AirVolume& shown = sky.airVolume(shading::viewOf(sky.state()), o);
    return {shown, readVolume(shown.colour), readVolume(shown.transmittance)};
  }
  Image<float> drawn(LiveSky& sky, int frames = 8 * LiveVolumes::kFramesInRound) {
    const shading::View view = shading::viewOf(sky.state());
    for (int i = 0; i < frames; ++i) sky.draw(view, target);
    return target.readPicture(0, 3);
  }
  Image<float> drawn(const scene::Scene& s, int frames = 8 * LiveVolumes::kFramesInRound) {
    LiveSky sky;
    sky.update(s, 0.0);
    return drawn(sky, frames);
  }

  gpu::Context context{{.debug = true}};
  gpu::Texture2D texture{kWidth, kHeight, {.format = gpu::Format::kRgba32F}};
  gpu::Framebuffer target{texture};
};

TEST_F(AirVolumeTest, ComputeAndFragmentsAgree) {
  if (!context.hasCompute()) GTEST_SKIP() << "OpenGL 4.3 is needed";
  for (const scene::Scene& s : {clearScene(40.0), cumulus(), mixed(), overBlackGround(1200.0)}) {
    LiveSky sky;
    sky.update(s, 0.0);
    AirVolumeOptions o = options();
    const Air a = airOf(sky, o);
    o.compute = false;
    o.view = 1;
    const Air b = airOf(sky, o);
    ASSERT_NE(a.shown.colour, b.shown.colour);
    ASSERT_EQ(a.colour.data.size(), static_cast<std::size_t>(4 * kWidth * kHeight * kSlices));
    double most = 0.0, mean = 0.0;
    for (std::size_t i = 0; i < a.colour.data.size(); ++i) {
      const auto apart = [&](const Volume<float>& u, const Volume<float>& v) {
        return static_cast<double>(std::abs(u.data[i] - v.data[i])) / (0.01 + std::abs(u.data[i]));
      };
      const double d = std::max(apart(a.colour, b.colour), apart(a.transmittance, b.transmittance));
      most = std::max(most, d);
      mean += d / static_cast<double>(a.colour.data.size());
    }
    EXPECT_LT(mean, 0.0005);
    EXPECT_LT(most, 0.03);
  }
}

// No light is lost on the way, and none comes from nowhere.
TEST_F(AirVolumeTest, TransmittanceNeverRisesAndLightNeverFalls) {
  for (const scene::Scene& s : {clearScene(40.0), cumulus(), mixed(), overBlackGround(1200.0)}) {
    LiveSky sky;
    sky.update(s, 0.0);
    const Air a = airOf(sky, options());
    int bad = 0, opaque = 0;
    for (int z = 0; z < kSlices; ++z)
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
          for (int c = 0; c < 3; ++c) {
            const float t = a.transmittance.at(x, y, z, c), l = a.colour.at(x, y, z, c);
            bad += !(t >= 0.0f && t <= 1.0f) || !(l >= 0.0f && l < 65504.0f);
            if (z > 0) bad += t > a.transmittance.at(x, y, z - 1, c) || l < a.colour.at(x, y, z - 1, c);
            opaque += z == kSlices - 1 && t < 0.02f;
          }
    EXPECT_EQ(bad, 0);
    EXPECT_TRUE(s.layers.empty() || opaque > 50);  // there are clouds in it
  }
}

// Clear air at all distances, against quadrature of the same air without tables.
TEST_F(AirVolumeTest, ClearAirIsThatOfTheReference) {
  const scene::Scene s = looking(sized(clearScene(40.0), kWidth, kHeight), 200.0, 4.0, 30.0);
  LiveSky sky;
  sky.update(s, 0.0);
  const Air a = airOf(sky, options(100000.0f));
  const reference::Sphere earth(sky.state().clouds->earthRadiusM());
  const reference::Air truth(sky.state().atmosphere->uniforms());
  const shading::ViewParts parts = shading::partsOf(shading::viewOf(sky.state()), kHeight);
  int compared = 0;
  for (const int z : {0, 8, 14, 18, kSlices - 1})
    for (const int y : {kHeight / 2, kHeight - 1})
      for (const int x : {0, kWidth / 2}) {
        const glm::vec2 clip = (glm::vec2(x, y) + 0.5f) / glm::vec2(kWidth, kHeight) * 2.0f - 1.0f;
        const glm::vec2 ray =
            glm::vec2(parts.rayScale) * clip + glm::vec2(parts.rayScale.z, parts.rayScale.w);
        const glm::dvec3 way(glm::normalize(parts.enuFromCamera * glm::vec3(ray, -1.0f)));
        const glm::dvec3 through =
            truth.transmittance(earth, {{0.0, 0.0, parts.eyeM.z}, way}, a.shown.distanceM(z));
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(a.transmittance.at(x, y, z, c), through[c], 0.015) << z << ' ' << y << ' ' << x;
          ++compared;
        }
      }
  EXPECT_EQ(compared, 60);
}

// Behind everything it is LiveSky's picture of the same view. What the clear sky sends from beyond the last
// slice comes from a clear sky's picture and air.
TEST_F(AirVolumeTest, BehindEverythingItIsThePicture) {
  const scene::Scene cloudy = looking(cumulus(), 200.0, 27.0);  // no ground, which clouds shade
  scene::Scene clear = cloudy;
  clear.layers.clear();
  LiveSky clearSky;
  clearSky.update(clear, 0.0);
  const Air clearAir = airOf(clearSky, options());
  Image<float> beyond = drawn(clearSky, 1);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) {
        const int row = kHeight - 1 - y;
        beyond.at(x, y, c) = (beyond.at(x, y, c) - clearAir.colour.at(x, row, kSlices - 1, c) / kScale) /
                             clearAir.transmittance.at(x, row, kSlices - 1, c);
      }
  LiveSky sky;
  sky.update(cloudy, 0.0);
  const Image<float> picture = drawn(sky);
  const Air a = airOf(sky, options());
  const double apart = relativeDifference(a.picture(kSlices - 1, beyond), picture);
  RecordProperty("apart", std::to_string(apart));
  EXPECT_LT(apart, 0.065);
  const glm::vec3 mean = meanOf(a.picture(kSlices - 1, beyond)), expected = meanOf(picture);
  EXPECT_NEAR(luminanceOf(mean) / luminanceOf(expected), 1.0, 0.03);
  // The first slice is not.
  EXPECT_GT(relativeDifference(a.picture(0, beyond), picture), 3.0 * apart);
}

// Black ground is something opaque at a distance, in front of which there is what the volume says: in clear
// air, from above the clouds and from among them.
TEST_F(AirVolumeTest, InFrontOfSomethingOpaqueItIsThePicture) {
  for (const bool cloudy : {false, true})
    for (const double eyeM : {600.0, 1300.0, 4000.0}) {
      SCOPED_TRACE(std::to_string(eyeM) + (cloudy ? " cloudy" : " clear"));
      scene::Scene s = overBlackGround(eyeM);
      if (!cloudy) s.layers.clear();
      LiveSky sky;
      sky.update(s, 0.0);
      const Image<float> picture = drawn(sky);
      const Air a = airOf(sky, options());
      const Image<float> air = a.picture(kSlices - 1);
      const double apart = relativeDifference(air, picture);
      RecordProperty("apart", std::to_string(apart));
      EXPECT_LT(apart, cloudy ? 0.08 : 0.01);
      EXPECT_NEAR(luminanceOf(meanOf(air)) / luminanceOf(meanOf(picture)), 1.0, cloudy ? 0.03 : 0.01);
    }
}

// Within clouds: extinction summed along the rays, up to each slice.
TEST_F(AirVolumeTest, WithinCloudsItIsTheFieldsTransmittance) {
  LiveSky sky;
  scene::Scene s =
      looking(sized(fromHeight(cloudyScene(40.0, {Genus::kStratocumulus}, 7.0), 1100.0), kWidth, kHeight),
              200.0, 10.0, 8.0);
  s.output.quality = scene::Quality::kHigh;
  sky.update(s, 0.0);
  const Air a = airOf(sky, options());
  const reference::Sphere earth(sky.state().clouds->earthRadiusM());
  const shading::ViewParts parts = shading::partsOf(shading::viewOf(sky.state()), kHeight);
  std::vector<double> got(kSlices, 0.0), expected(kSlices, 0.0);
  int rays = 0;
  for (int y = 2; y < kHeight; y += 4)
    for (int x = 2; x < kWidth; x += 4, ++rays) {
      const glm::vec2 clip = (glm::vec2(x, y) + 0.5f) / glm::vec2(kWidth, kHeight) * 2.0f - 1.0f;
      const glm::vec2 ray = glm::vec2(parts.rayScale) * clip + glm::vec2(parts.rayScale.z, parts.rayScale.w);
      const glm::vec3 way = glm::normalize(parts.enuFromCamera * glm::vec3(ray, -1.0f));
      double depth = 0.0, t = 0.0;
      for (int z = 0; z < kSlices && a.shown.distanceM(z) < 8000.0; ++z) {
        constexpr double kStepM = 5.0;
        for (; t < a.shown.distanceM(z); t += kStepM)
          depth += kStepM * sky.state().clouds->extinction(glm::vec3(parts.eyeM) +
                                                           way * static_cast<float>(t + 0.5 * kStepM));
        expected[static_cast<std::size_t>(z)] += std::exp(-depth);
        got[static_cast<std::size_t>(z)] += a.transmittance.at(x, y, z, 1);
      }
    }
  double least = 1.0;
  for (int z = 0; z < kSlices && a.shown.distanceM(z) < 8000.0; ++z) {
    const auto i = static_cast<std::size_t>(z);
    least = std::min(least, expected[i] / rays);
    // A bit less for the air.
    EXPECT_NEAR(got[i] / rays, expected[i] / rays, 0.04) << a.shown.distanceM(z);
  }
  EXPECT_LT(least, 0.5);
}

// The function for engines: slices are where it says, and between them it does not leave what is around.
TEST_F(AirVolumeTest, TheFunctionForEnginesFindsTheSlices) {
  LiveSky sky;
  sky.update(cumulus(), 0.0);
  const Air a = airOf(sky, options());
  const gpu::TextureOptions kind{.format = gpu::Format::kRgba32F};
  const gpu::Texture3D colour(a.colour, kind), transmittance(a.transmittance, kind);
  ShaderSource source = shading::assembleShader("lib/air_volume.glsl", shading::ShaderDialect::kGl330);
  source.text += R"(
uniform sampler3D uColour, uTransmittance;
uniform vec2 uNearFar, uSize;
uniform float uDistance;
layout(location = 0) out vec4 outColour;
layout(location = 1) out vec4 outTransmittance;
void main() {
  AirBefore air = airBefore(uColour, uTransmittance, uNearFar, gl_FragCoord.xy / uSize, uDistance);
  outColour = vec4(air.colour, 1.0);
  outTransmittance = vec4(air.transmittance, 1.0);
}
)";
  const gpu::FullscreenTriangle triangle;
  gpu::Program p = gpu::Program::graphics(
      shading::assembleShader("pass/fullscreen.vert", shading::ShaderDialect::kGl330), source);
  const gpu::Texture2D second(kWidth, kHeight, {.format = gpu::Format::kRgba32F});
  gpu::Framebuffer both(texture);
  both.attach(1, second);
  const auto lookedUp = [&](double distanceM, int index) {
    p.set("uNearFar", glm::vec2(a.shown.nearM, a.shown.farM));
    p.set("uSize", glm::vec2(kWidth, kHeight));
    p.set("uDistance", static_cast<float>(distanceM));
    p.bind("uColour", colour);
    p.bind("uTransmittance", transmittance);
    triangle.draw(p, both);
    return both.readPicture(index, 3);
  };
  EXPECT_FLOAT_EQ(static_cast<float>(a.shown.distanceM(0)), a.shown.nearM);
  EXPECT_FLOAT_EQ(static_cast<float>(a.shown.distanceM(kSlices - 1)), a.shown.farM);
  const auto compare = [&](double distanceM, int slice, float share) {
    const Image<float> c = lookedUp(distanceM, 0), t = lookedUp(distanceM, 1);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const float wantedC = share * a.colour.at(x, kHeight - 1 - y, slice, 1);
        const float wantedT = 1.0f - share * (1.0f - a.transmittance.at(x, kHeight - 1 - y, slice, 1));
        ASSERT_NEAR(c.at(x, y, 1), wantedC, 0.002f * wantedC + 1e-4f) << distanceM;
        ASSERT_NEAR(t.at(x, y, 1), wantedT, 0.003f) << distanceM;
      }
  };
  for (const int z : {0, 7, 16, kSlices - 1}) compare(a.shown.distanceM(z), z, 1.0f);
  compare(0.5 * a.shown.nearM, 0, 0.5f);
  compare(0.0, 0, 0.0f);
  compare(10.0 * a.shown.farM, kSlices - 1, 1.0f);
}

TEST_F(AirVolumeTest, AnEngineFindsItsStateAgain) {
  for (const bool compute : {true, false}) {
    LiveSky sky;
    const ForeignEngine engine;
    const auto before = engine.state();
    AirVolumeOptions o = options();
    o.compute = compute;
    unsigned first = 0;
    for (int i = 0; i < 2; ++i) {
      sky.update(mixed(), i);
      const AirVolume& shown = sky.airVolume(shading::viewOf(sky.state()), o);
      EXPECT_EQ(engine.state(), before);
      if (i == 0) first = shown.colour;
      EXPECT_EQ(shown.colour, first);  // the same texture, filled anew
    }
  }
}

// One LiveSky through several scenes gives for each what a new one gives; and pictures do not change by it.
TEST_F(AirVolumeTest, NothingStaysFromOtherScenes) {
  LiveSky one;
  for (const scene::Scene& s : {cumulus(), looking(clearScene(10.0), 200.0, 14.0), mixed(), cumulus()}) {
    const scene::Scene here = sized(s, kWidth, kHeight);
    one.update(here, 0.0);
    const Air a = airOf(one, options());
    LiveSky fresh;
    fresh.update(here, 0.0);
    const Image<float> before = drawn(fresh, 1);
    const Air b = airOf(fresh, options());
    EXPECT_EQ(a.colour.data, b.colour.data);
    EXPECT_EQ(a.transmittance.data, b.transmittance.data);
    EXPECT_EQ(drawn(one, 1).data, before.data);
  }
}

// Not a test: milliseconds of a volume of the usual size (docs/performance.md).
TEST_F(AirVolumeTest, DISABLED_Cost) {
  LiveSky sky;
  sky.update(cumulus(), 0.0);
  for (const bool compute : {true, false}) {
    const AirVolumeOptions o{.compute = compute};
    std::vector<double> ms;
    for (int i = 0; i < 10; ++i) {
      gpu::Stopwatch watch;
      sky.airVolume(shading::viewOf(sky.state()), o);
      ms.push_back(watch.finishedMs());
    }
    std::ranges::sort(ms);
    std::cout << (compute ? "compute " : "fragments ") << ms.front() << " to " << ms.back() << " ms, median "
              << 0.5 * (ms[4] + ms[5]) << " ms\n";
  }
}

TEST_F(AirVolumeTest, SizesOutOfRangeAreErrors) {
  LiveSky sky;
  sky.update(cumulus(), 0.0);
  const shading::View view = shading::viewOf(sky.state());
  const auto with = [](auto change) {
    AirVolumeOptions o = options();
    change(o);
    return o;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const AirVolumeOptions& o :
       {with([](auto& v) { v.width = 0; }), with([](auto& v) { v.height = -3; }),
        with([](auto& v) { v.slices = 1; }), with([](auto& v) { v.width = 100000; }),
        with([](auto& v) { v.nearM = 0.0f; }), with([](auto& v) { v.farM = v.nearM; }),
        with([&](auto& v) { v.farM = nan; }), with([&](auto& v) { v.scale = nan; }),
        with([](auto& v) { v.scale = 0.0f; })})
    EXPECT_THROW(sky.airVolume(view, o), ParameterError);
  EXPECT_NO_THROW(sky.airVolume(view, options()));
}

}  // namespace
}  // namespace welkin::render
