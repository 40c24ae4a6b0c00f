// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/living_pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "welkin/core/error.h"
#include "welkin/noise/gradient.h"
#include "welkin/scene/scene.h"
#include "welkin/scene/scene_file.h"

namespace welkin::scene {
namespace {

constexpr OctaveKernel kKernels[] = {OctaveKernel::kGradient, OctaveKernel::kPallister,
                                     OctaveKernel::kCourse};

Sheet living(OctaveKernel kernel = OctaveKernel::kGradient) {
  Sheet s;
  s.pattern = SheetPattern::kOctaves;
  s.living.kernel = kernel;
  s.texels = 128;
  s.frequency = 8;
  s.octaves = 4;
  s.amplitude = 0.5;
  return s;
}

struct Moments {
  double mean, deviation;
};
Moments momentsOf(const Image<float>& image) {
  double sum = 0.0, squares = 0.0;
  for (const float p : image.data) sum += p, squares += static_cast<double>(p) * p;
  const double n = static_cast<double>(image.data.size());
  return {sum / n, std::sqrt(squares / n - sum * sum / n / n)};
}

double meanDifference(const Image<float>& a, const Image<float>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.data.size(); ++i) sum += std::abs(a.data[i] - b.data[i]);
  return sum / static_cast<double>(a.data.size());
}

TEST(LivingPattern, AnInstantHasNoPast) {
  for (const OctaveKernel kernel : kKernels) {
    const LivingPattern one(living(kernel), 7), other(living(kernel), 7);
    LivingInstant reused;
    for (int i = 0; i < 50; ++i) one.at(33.3 * i, reused);
    for (const double t : {0.0, 1234.5, -1234.5, 3e7, -3e7, 1e15, 1e300}) {
      LivingInstant fresh;
      one.at(t, reused);
      other.at(t, fresh);
      for (int k = 0; k < one.count(); ++k) {
        const OctaveNow &a = reused.octaves[static_cast<std::size_t>(k)],
                        &b = fresh.octaves[static_cast<std::size_t>(k)];
        EXPECT_EQ(a.lattice.data, b.lattice.data) << t;
        EXPECT_EQ(a.shift, b.shift) << t;
        for (const float x : a.lattice.data) ASSERT_TRUE(std::isfinite(x)) << t;
      }
      const Moments m = momentsOf(one.image(t, 64));
      EXPECT_GT(m.deviation, 0.03) << t;
    }
    EXPECT_NE(one.image(0.0, 64).data, LivingPattern(living(kernel), 8).image(0.0, 64).data);
    EXPECT_GT(meanDifference(one.image(-1000.0, 64), one.image(1000.0, 64)), 0.02);
  }
}

TEST(LivingPattern, NothingJumpsAtKeyframesOfAnyOctave) {
  for (const OctaveKernel kernel : kKernels)
    for (const OctaveBlend blend : {OctaveBlend::kVariancePreserving, OctaveBlend::kLinear}) {
      Sheet s = living(kernel);
      s.living.blend = blend;
      const LivingPattern p(s, 3);
      for (int k = 0; k < p.count(); ++k)
        for (const int j : {-2, 0, 5}) {
          const double t = s.living.intervalS * std::pow(s.living.intervalRatio, k) * j;
          EXPECT_LT(meanDifference(p.image(t - 1e-4, 64), p.image(t + 1e-4, 64)), 1e-5);
        }
    }
}

TEST(LivingPattern, DetailsChangeFaster) {
  const LivingPattern p(living(), 3);
  LivingInstant before, after;
  p.at(0.0, before);
  p.at(20.0, after);
  double last = 1.0;
  for (int k = 0; k < p.count(); ++k) {
    const auto &a = before.octaves[static_cast<std::size_t>(k)].lattice.data,
               &b = after.octaves[static_cast<std::size_t>(k)].lattice.data;
    double ab = 0.0, aa = 0.0, bb = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) ab += a[i] * b[i], aa += a[i] * a[i], bb += b[i] * b[i];
    const double alike = ab / std::sqrt(aa * bb);
    EXPECT_LT(alike, last) << k;
    last = alike;
  }
}

// Pallister: "the noise becomes more focused at the actual sample points".
TEST(LivingPattern, ContrastIsKeptOrDipsAsTheBlendSays) {
  for (const OctaveKernel kernel : kKernels) {
    Sheet s = living(kernel);
    s.octaves = 1;
    const double period = s.living.intervalS;
    for (const OctaveBlend blend : {OctaveBlend::kVariancePreserving, OctaveBlend::kLinear}) {
      s.living.blend = blend;
      const LivingPattern p(s, 11);
      const Moments still = momentsOf(p.image(0.0, 128));
      for (int i = 0; i <= 16; ++i) {
        const double w = i / 8.0 - std::floor(i / 8.0);
        const Moments m = momentsOf(p.image(period * i / 8.0, 128));
        if (blend == OctaveBlend::kVariancePreserving) {
          EXPECT_NEAR(m.deviation / still.deviation, 1.0, 0.01) << i;
          EXPECT_NEAR(m.mean, 0.25, 0.001) << i;  // amplitude / 2
        } else {
          // But for how alike two keyframes are, and one is like another.
          EXPECT_NEAR(m.deviation / still.deviation, std::sqrt(w * w + (1.0 - w) * (1.0 - w)), 0.09) << i;
        }
      }
    }
    // Of all octaves together, which may add up by chance.
    const LivingPattern all(living(kernel), 12);
    const double still = momentsOf(all.image(0.0, 128)).deviation;
    for (int i = 1; i <= 24; ++i)
      EXPECT_NEAR(momentsOf(all.image(period * i / 12.0, 128)).deviation / still, 1.0, 0.04) << i;
  }
}

TEST(LivingPattern, TheGradientKernelIsGradientNoise) {
  Sheet s = living();
  s.octaves = 1;
  EXPECT_NEAR(momentsOf(LivingPattern(s, 1).image(100.0, 256)).deviation,
              0.5 * s.amplitude * noise::GradientLattice::deviation(2), 0.001);
}

TEST(LivingPattern, TilesAtAllTimes) {
  for (const OctaveKernel kernel : kKernels) {
    Sheet s = living(kernel);
    s.living.scrollMps = 3.0;
    const int n = 256;
    const Image<float> a = LivingPattern(s, 5).image(77.7, n);
    // As large a step from the last column to the first, and row, as there is between others.
    std::vector<double> columns(n, 0.0), rows(n, 0.0);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) {
        columns[static_cast<std::size_t>(i)] += std::abs(a.at((i + 1) % n, k) - a.at(i, k));
        rows[static_cast<std::size_t>(i)] += std::abs(a.at(k, (i + 1) % n) - a.at(k, i));
      }
    EXPECT_LE(columns.back(), *std::max_element(columns.begin(), columns.end() - 1));
    EXPECT_LE(rows.back(), *std::max_element(rows.begin(), rows.end() - 1));
  }
}

// The second octave drifts along the wind, the first stays.
TEST(LivingPattern, OctavesScrollByTheirNumber) {
  Sheet s = living();
  s.windFromDeg = 270.0;
  s.tileM = 1000.0;
  s.living.scrollMps = 10.0;
  const LivingPattern p(s, 1);
  LivingInstant now;
  p.at(3.0, now);
  EXPECT_EQ(now.octaves[0].shift, glm::vec2(0.0f));
  // 30 m of 1000, each of 16 cells: what is seen at a place was 0.48 cells further west.
  EXPECT_NEAR(now.octaves[1].shift.x, 16.0 - 0.48, 1e-4);
  EXPECT_NEAR(std::remainder(now.octaves[1].shift.y, 16.0f), 0.0, 1e-4);
  EXPECT_NEAR(now.octaves[2].shift.x, 32.0 - 1.92, 1e-4);
}

TEST(LivingPattern, UpdatesComeAtTheirRate) {
  Sheet s = living();
  EXPECT_EQ(LivingPattern(s, 1).shown(1.2345), 1.2345);
  s.living.updatesPerS = 4.0;
  const LivingPattern p(s, 1);
  EXPECT_EQ(p.shown(1.24), 1.0);
  EXPECT_EQ(p.shown(1.25), 1.25);
  EXPECT_EQ(p.shown(-0.01), -0.25);
}

TEST(LivingPattern, OctavesBelowATexelAreLeftOut) {
  Sheet s = living();
  s.octaves = 8;
  s.texels = 64;
  EXPECT_EQ(LivingPattern(s, 1).count(), 4);  // 8, 16, 32 and 64 cells
  s.living.kernel = OctaveKernel::kCourse;
  s.texels = 256;
  EXPECT_EQ(LivingPattern(s, 1).count(), 4);  // the source's
}

// Eighths of a pattern that are cloud to an observer.
double oktasOf(const Image<float>& pattern, const field::Condensation& law) {
  double count = 0.0;
  for (const float p : pattern.data) count += law.opacity(p) >= 0.2591;  // 1 - exp(-0.3), a little less
  return 8.0 * count / static_cast<double>(pattern.data.size());
}

TEST(LivingPattern, CoverIsDeliveredAtAllTimes) {
  for (const OctaveKernel kernel : kKernels) {
    constexpr int kTimes = 40;
    Sheet s = living(kernel);
    const LivingPattern pattern(s, 21);
    const std::vector<float> samples = pattern.samples();
    std::vector<Image<float>> images;
    for (int i = 0; i < kTimes; ++i) images.push_back(pattern.image(53.0 * i, 128));
    for (const double oktas : {0.0, 1.0, 3.0, 4.0, 6.0, 7.5, 8.0}) {
      s.oktas = oktas;
      const field::Condensation law = condensationOf(s, samples);
      double sum = 0.0, worst = 0.0;
      for (const Image<float>& image : images) {
        const double got = oktasOf(image, law);
        sum += got / kTimes;
        worst = std::max(worst, std::abs(got - oktas));
      }
      EXPECT_LT(worst, 0.4) << oktas << " with kernel " << static_cast<int>(kernel);
      EXPECT_NEAR(sum, oktas, 0.1) << oktas << " with kernel " << static_cast<int>(kernel);
      EXPECT_NEAR(8.0 * deliveredCover(s, 21, 53.0 * 7), oktasOf(images[7], law), 0.01);
    }
  }
}

TEST(LivingPattern, WhatCannotBeIsSaid) {
  const auto broken = [](auto change) {
    Sheet s = living();
    change(s);
    return s;
  };
  EXPECT_NO_THROW(validate(living()));
  EXPECT_THROW(validate(broken([](Sheet& s) { s.surface = SheetSurface::kDome; })), ParameterError);
  EXPECT_THROW(validate(broken([](Sheet& s) { s.texels = 2048; })), ParameterError);
  EXPECT_THROW(validate(broken([](Sheet& s) { s.octaves = 9; })), ParameterError);
  EXPECT_THROW(validate(broken([](Sheet& s) { s.frequency = 33; })), ParameterError);
  EXPECT_NO_THROW(validate(broken([](Sheet& s) {
    s.frequency = 33;
    s.living.kernel = OctaveKernel::kPallister;  // which has its own
  })));
}

TEST(LivingPattern, IsReadFromSceneFiles) {
  const Scene s = parseScene(
                      "technique = \"octaves\"\n[octaves]\nresolution = 128\ncount = 3\nkernel = \"course\"\n"
                      "[[sheet]]\npattern = \"octaves\"\nblend = \"linear\"\ninterval_s = 60\n",
                      "t.toml")
                      .scene;
  EXPECT_EQ(s.technique, Technique::kOctaves);
  EXPECT_EQ(s.octaves.resolution, 128);
  EXPECT_EQ(s.octaves.living.kernel, OctaveKernel::kCourse);
  ASSERT_EQ(s.sheets.size(), 1u);
  EXPECT_EQ(s.sheets[0].pattern, SheetPattern::kOctaves);
  EXPECT_EQ(s.sheets[0].living.blend, OctaveBlend::kLinear);
  EXPECT_EQ(s.sheets[0].living.intervalS, 60.0);
  EXPECT_EQ(parseScene(sceneToToml(s), "again.toml").scene, s);
  EXPECT_THROW(parseScene("[octaves]\ncount = 9\n", "t.toml"), ParseError);
}

// The technique: sky planes whose clouds are as large as those of still patterns.
TEST(LivingPattern, LayersOfTheWeatherLive) {
  Scene s;
  weather::Weather w;
  w.layers = s.layers = {weather::typicalLayer(weather::Genus::kStratocumulus, 47.0)};
  s.technique = Technique::kSkyPlane;
  const Sheet still = sheetsOf(s, w).front();
  s.technique = Technique::kOctaves;
  s.tier = SheetTier::kEmbossed;
  for (const OctaveKernel kernel : kKernels) {
    s.octaves.living.kernel = kernel;
    const Sheet sheet = sheetsOf(s, w).front();
    EXPECT_NO_THROW(validate(sheet));
    EXPECT_EQ(sheet.surface, SheetSurface::kSkyPlane);
    EXPECT_EQ(sheet.pattern, SheetPattern::kOctaves);
    EXPECT_EQ(sheet.tier, SheetTier::kEmbossed);
    EXPECT_EQ(sheet.texels, 256);
    EXPECT_NEAR(sheet.tileM / static_cast<double>(cellsOf(sheet)),
                still.tileM / static_cast<double>(still.frequency), 1e-6);
  }
}

}  // namespace
}  // namespace welkin::scene
