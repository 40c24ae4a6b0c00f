// SPDX-License-Identifier: Apache-2.0
// Living octaves on the device: against plain evaluations of their formulas, and as skies over time.
#include "welkin/render/octaves_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/gpu/context.h"
#include "welkin/render/live_sky.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using scene::OctaveBlend, scene::OctaveKernel;

constexpr OctaveKernel kKernels[] = {OctaveKernel::kGradient, OctaveKernel::kPallister,
                                     OctaveKernel::kCourse};
constexpr std::uint64_t kSeed = 4711;

scene::Sheet living(OctaveKernel kernel, int texels = 256) {
  scene::Sheet s;
  s.pattern = scene::SheetPattern::kOctaves;
  s.living.kernel = kernel;
  s.texels = texels;
  s.frequency = 8;
  s.octaves = 4;
  s.amplitude = 0.5;
  return s;
}

int wrapped(int i, int n) {
  return ((i % n) + n) % n;
}

// An octave at a place in [0, 1), without a device, in double: written from the sources' words, and slow.
double plainOctave(const scene::Sheet& sheet, const std::vector<glm::dvec2>& lattice, int side, int cells,
                   double u, double v) {
  const auto at = [&](int i, int j) {
    return lattice[static_cast<std::size_t>(wrapped(j, side) * side + wrapped(i, side))];
  };
  if (sheet.living.kernel == OctaveKernel::kGradient) {
    const double x = u * cells, y = v * cells;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const auto fade = [](double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); };
    double sum = 0.0;
    for (int dj = 0; dj < 2; ++dj)
      for (int di = 0; di < 2; ++di) {
        const double fx = x - (i + di), fy = y - (j + dj);
        const glm::dvec2 g = at(i + di, j + dj);
        sum += (1.0 - fade(std::abs(fx))) * (1.0 - fade(std::abs(fy))) * (g.x * fx + g.y * fy);
      }
    return sum;
  }
  // Texel centres, as a graphics card filters.
  const double x = u * cells - 0.5, y = v * cells - 0.5;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  double sum = 0.0, weights = 0.0;
  for (int dj = -1; dj <= 2; ++dj)
    for (int di = -1; di <= 2; ++di) {
      const double fx = std::abs(x - (i + di)), fy = std::abs(y - (j + dj));
      const double w = sheet.living.kernel == OctaveKernel::kPallister
                           ? std::max(1.0 - fx, 0.0) * std::max(1.0 - fy, 0.0)
                           : std::exp(-(fx * fx + fy * fy) / (2.0 * 0.5 * 0.5));
      sum += w * at(i + di, j + dj).x;
      weights += w;
    }
  return sum / weights;
}

// Pallister's listing with a linear blend: FractalSum = FractalSum * 0.5 + 0.5 * octave, from the finest to
// the first, of octaves in [0, 1].
class PlainPattern {
 public:
  PlainPattern(const scene::Sheet& sheet, double t) : sheet_(sheet), t_(t), pattern_(sheet, kSeed) {
    for (int k = 0; k < pattern_.count(); ++k) {
      const double interval = sheet.living.intervalS * std::pow(sheet.living.intervalRatio, k);
      const double j = std::floor(t / interval), w = t / interval - j;
      const std::vector<glm::vec2> a = pattern_.keyframe(k, j), b = pattern_.keyframe(k, j + 1.0);
      std::vector<glm::dvec2>& lattice = lattices_.emplace_back(a.size());
      for (std::size_t i = 0; i < a.size(); ++i)
        lattice[i] = (1.0 - w) * glm::dvec2(a[i]) + w * glm::dvec2(b[i]);
    }
  }
  double at(double u, double v) const {
    double fractalSum = 0.0;
    for (int k = pattern_.count() - 1; k >= 0; --k) {
      const int cells = (sheet_.living.kernel == OctaveKernel::kGradient ? 8 : 32) << k;
      const double east = k * sheet_.living.scrollMps * t_ / sheet_.tileM;  // the wind is from the west
      const double n =
          plainOctave(sheet_, lattices_[static_cast<std::size_t>(k)], pattern_.side(k), cells, u - east, v);
      fractalSum = 0.5 * fractalSum + 0.5 * (n + 1.0) / 2.0;
    }
    return fractalSum;
  }

 private:
  scene::Sheet sheet_;
  double t_;
  scene::LivingPattern pattern_;
  std::vector<std::vector<glm::dvec2>> lattices_;
};

class OctavesTest : public ::testing::Test {
 protected:
  void TearDown() override {
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }
  static gpu::Texture2D textureFor(const scene::Sheet& s) {
    const bool slopes = s.tier == scene::SheetTier::kEmbossed;
    const int n = static_cast<int>(s.texels);
    return {n,
            n,
            {.format = slopes ? gpu::Format::kRgba16F : gpu::Format::kR16F,
             .filter = gpu::Filter::kMipmap,
             .wrapX = gpu::Wrap::kRepeat,
             .wrapY = gpu::Wrap::kRepeat}};
  }
  Image<float> composed(const scene::Sheet& s, double t) {
    LivingTexture texture(s, kSeed);
    gpu::Texture2D target = textureFor(s);
    pass.compose(texture, t, target);
    return target.read();
  }
  static double meanDifference(const Image<float>& a, const Image<float>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.data.size(); ++i) sum += std::abs(a.data[i] - b.data[i]);
    return sum / static_cast<double>(a.data.size());
  }

  gpu::Context context{{.debug = true}};
  OctavesPass pass;
};

TEST_F(OctavesTest, EachKernelIsItsFormula) {
  for (const OctaveKernel kernel : kKernels)
    for (const double t : {0.0, 777.7}) {
      scene::Sheet s = living(kernel, 64);
      s.living.blend = OctaveBlend::kLinear;
      const Image<float> got = composed(s, t);
      const Image<float> onProcessor = scene::LivingPattern(s, kSeed).image(t, 64);
      const PlainPattern formula(s, t);
      double worst = 0.0, apart = 0.0;
      for (int y = 0; y < 64; y += 3)
        for (int x = 0; x < 64; x += 3) {
          const double plain = formula.at((x + 0.5) / 64.0, (y + 0.5) / 64.0);
          worst = std::max(worst, std::abs(got.at(x, y) - plain));
          apart = std::max(apart, std::abs(onProcessor.at(x, y) - plain));
        }
      EXPECT_LT(worst, 1e-3) << static_cast<int>(kernel) << " at " << t;
      EXPECT_LT(apart, 1e-4) << static_cast<int>(kernel) << " at " << t;
    }
}

TEST_F(OctavesTest, TheVariancePreservingBlendIsThatOfTheProcessor) {
  for (const OctaveKernel kernel : kKernels) {
    const scene::Sheet s = living(kernel);
    const Image<float> got = composed(s, 100.0), expected = scene::LivingPattern(s, kSeed).image(100.0, 256);
    for (std::size_t i = 0; i < got.data.size(); ++i) ASSERT_NEAR(got.data[i], expected.data[i], 1e-3);
  }
}

TEST_F(OctavesTest, APatternIsTheSameFirstOrAfterOthers) {
  for (const OctaveKernel kernel : kKernels) {
    const scene::Sheet s = living(kernel, 128);
    const Image<float> first = composed(s, 5000.0);
    LivingTexture texture(s, kSeed);
    gpu::Texture2D target = textureFor(s);
    for (int i = 0; i < 200; ++i) pass.compose(texture, 1.7 * i, target);
    pass.compose(texture, 5000.0, target);
    EXPECT_EQ(target.read().data, first.data);
  }
}

TEST_F(OctavesTest, SlopesAreDifferencesOfNeighbours) {
  scene::Sheet s = living(OctaveKernel::kGradient, 128);
  s.tier = scene::SheetTier::kEmbossed;
  const Image<float> got = composed(s, 50.0), pattern = scene::LivingPattern(s, kSeed).image(50.0, 128);
  double steepest = 0.0;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      const float dx = pattern.at((x + 1) % 128, y) - pattern.at((x + 127) % 128, y);
      const float dy = pattern.at(x, (y + 1) % 128) - pattern.at(x, (y + 127) % 128);
      EXPECT_NEAR(got.at(x, y, 0), pattern.at(x, y), 1e-3);
      ASSERT_NEAR(got.at(x, y, 1), dx, 1.5e-4);
      ASSERT_NEAR(got.at(x, y, 2), dy, 1.5e-4);
      steepest = std::max<double>(steepest, std::abs(dx));
    }
  EXPECT_GT(steepest, 0.01);
}

// The gem's 8-bit textures had 256 levels, its fine octaves a few of them.
TEST_F(OctavesTest, LevelsAreFinerThanBytes) {
  for (const OctaveKernel kernel : kKernels) {
    const Image<float> got = composed(living(kernel), 100.0);
    const std::set<float> levels(got.data.begin(), got.data.end());
    double largest = 0.0;  // step, where most of the values are
    std::vector<float> sorted(got.data);
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = sorted.size() / 20; i < sorted.size() * 19 / 20; ++i)
      largest = std::max<double>(largest, sorted[i] - sorted[i - 1]);
    EXPECT_GT(levels.size(), 800u);
    EXPECT_LT(largest, 0.25 / 255.0);
  }
}

TEST_F(OctavesTest, KnobsDoWhatTheySay) {
  scene::Sheet s = living(OctaveKernel::kGradient, 128);
  EXPECT_EQ(composed(s, 0.0).width, 128);
  // Another resolution samples the same pattern: its mean over blocks of four texels.
  s.living.scrollMps = 0.0;
  const Image<float> coarse = composed(s, 60.0);
  s.texels = 256;
  const Image<float> fine = composed(s, 60.0);
  double apart = 0.0;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x)
      apart += std::abs(0.25 * (fine.at(2 * x, 2 * y) + fine.at(2 * x + 1, 2 * y) +
                                fine.at(2 * x, 2 * y + 1) + fine.at(2 * x + 1, 2 * y + 1)) -
                        coarse.at(x, y)) /
               (128.0 * 128.0);
  EXPECT_LT(apart, 0.004);
  // Each octave more is rougher.
  double last = 0.0;
  for (int octaves = 1; octaves <= 5; ++octaves) {
    s.octaves = octaves;
    const Image<float> got = composed(s, 60.0);
    double rough = 0.0;
    for (int y = 0; y < 256; ++y)
      for (int x = 1; x < 256; ++x) rough += std::abs(got.at(x, y) - got.at(x - 1, y));
    EXPECT_GT(rough, 1.02 * last) << octaves;
    last = rough;
  }
  // Between updates it stays.
  s.living.updatesPerS = 0.5;
  EXPECT_EQ(composed(s, 60.0).data, composed(s, 61.9).data);
  EXPECT_NE(composed(s, 60.0).data, composed(s, 62.0).data);
  s.living.updatesPerS = 0.0;
  EXPECT_NE(composed(s, 60.0).data, composed(s, 60.1).data);
}

scene::Scene livingScene() {
  scene::Scene s = cloudyScene(40.0, {weather::Genus::kStratocumulus});
  s.technique = scene::Technique::kOctaves;
  s.camera.pitchDeg = 35.0;
  s.output.width = 96;
  s.output.height = 54;
  return s;
}

// Ten seconds of video at a minute a second. Ten minutes hold several keyframes of every octave.
TEST_F(OctavesTest, NothingPopsInAVideo) {
  for (const scene::SheetTier tier :
       {scene::SheetTier::kFlat, scene::SheetTier::kEmbossed, scene::SheetTier::kLit}) {
    scene::Scene s = livingScene();
    s.tier = tier;
    ASSERT_GT(600.0, 2.0 * s.octaves.living.intervalS);
    LiveSky sky;
    const gpu::Texture2D texture(96, 54, {.format = gpu::Format::kRgba32F});
    const gpu::Framebuffer target(texture);
    std::vector<double> differences;
    Image<float> last;
    for (int i = 0; i < 240; ++i) {
      sky.update(s, 60.0 * i / 24.0);
      sky.draw(shading::viewOf(sky.state()), target, {.scale = 1e-4f});
      Image<float> frame = target.readPicture(0, 3);
      if (i > 0) differences.push_back(meanDifference(frame, last));
      last = std::move(frame);
    }
    const double largest = *std::max_element(differences.begin(), differences.end());
    std::nth_element(differences.begin(), differences.begin() + 120, differences.end());
    EXPECT_LT(largest, 3.0 * differences[120]);
    EXPECT_GT(differences[120], 0.001);  // it moves
  }
}

// Without wind clouds still form and go.
TEST_F(OctavesTest, CloudsFormWithoutWind) {
  scene::Scene s = livingScene();
  s.layers[0].windSpeedMps = 0.0;
  s.octaves.living.scrollMps = 0.0;
  LiveSky sky;
  const gpu::Texture2D texture(96, 54, {.format = gpu::Format::kRgba32F});
  const gpu::Framebuffer target(texture);
  const auto at = [&](double t) {
    sky.update(s, t);
    sky.draw(shading::viewOf(sky.state()), target, {.scale = 1e-4f});
    return target.readPicture(0, 3);
  };
  const Image<float> start = at(0.0);
  EXPECT_GT(meanDifference(at(300.0), start), 3.0 * meanDifference(at(10.0), start));
  EXPECT_EQ(at(0.0).data, start.data);
}

}  // namespace
}  // namespace welkin::render
