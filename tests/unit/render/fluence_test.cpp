// SPDX-License-Identifier: Apache-2.0
// The fluence on the GPU against the same equations solved on the CPU, and what they must keep.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/field/cloud_field.h"
#include "welkin/gpu/context.h"
#include "welkin/render/light_volume_pass.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using weather::Genus;

constexpr int kSide = shading::LightVolumeLayout::kFewColumns / 2;
constexpr double kSimilarity = 0.14, kAirPathM = 1000.0;  // of lib/cloud_light.glsl, pass/fluence_relax.frag

// The narrowest cascade of a sky: as drawn, and its equations.
struct Spread {
  explicit Spread(const scene::Scene& scene)
      : state(scene::buildSky(scene, 0.0)),
        volume(shading::lightVolumeLayout(state)),
        layout(shading::fluenceLayout(volume)),
        count(static_cast<int>(layout.cells.size())) {
    static gpu::Context context({.debug = true});
    static LightVolumePass pass;
    pass.draw(state, volume, CloudTextures(state.clouds->sharedNoise()));
    const Volume<float> texels = pass.volume().read();
    fluence = pass.fluence().read();
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
    const auto slices = static_cast<int>(volume.heightsM.size());
    columnM = 2.0 * static_cast<double>(volume.kHalfM[kCascade]) / kSide;
    depths.assign(static_cast<std::size_t>(kSide) * kSide * count, 0.0);
    sources = depths;
    for (int y = 0; y < 2 * kSide; ++y)
      for (int x = 0; x < 2 * kSide; ++x)
        for (int k = 0; k < count; ++k) {
          const auto slice = [&](float s) { return kCascade * slices + static_cast<int>(std::lround(s)); };
          const int below = slice(cell(k).x), above = slice(cell(k).y);
          const double depth =
              0.25 * kSimilarity * std::max(texels.at(x, y, below, 1) - texels.at(x, y, above, 1), 0.0f);
          const double a = kSimilarity * static_cast<double>(texels.at(x, y, above, 0)),
                       b = kSimilarity * static_cast<double>(texels.at(x, y, below, 0));
          depths[at(x / 2, y / 2, k)] += depth;
          sources[at(x / 2, y / 2, k)] +=
              depth * (std::abs(b - a) > 0.01 ? (std::exp(-a) - std::exp(-b)) / (b - a) : std::exp(-a));
        }
  }

  static constexpr int kCascade = 0;
  const glm::vec4& cell(int k) const { return layout.cells[static_cast<std::size_t>(k)]; }
  std::size_t at(int x, int y, int k) const { return (static_cast<std::size_t>(y) * kSide + x) * count + k; }
  double drawn(int x, int y, int k) const { return fluence.at(x, y, kCascade * count + k, 0); }

  double diffusivity(std::size_t i, int k) const {
    return 1.0 / (3.0 * (depths[i] / static_cast<double>(cell(k).z) + 1.0 / kAirPathM));
  }
  // What half a cell holds up.
  double resistance(std::size_t i, int k) const {
    return 0.5 * static_cast<double>(cell(k).z) / diffusivity(i, k);
  }

  // Until nothing changes any more, cell by cell.
  std::vector<double> solved() const {
    std::vector<double> f(depths.size(), 0.2);
    for (int iteration = 0; iteration < 400; ++iteration)
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
          for (int k = 0; k < count; ++k) {
            const std::size_t i = at(x, y, k);
            const double own = diffusivity(i, k);
            double leaving = 0.0, coming = sources[i];
            for (const auto& [dx, dy] : {std::array{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
              const std::size_t other =
                  at(std::clamp(x + dx, 0, kSide - 1), std::clamp(y + dy, 0, kSide - 1), k);
              const double d = diffusivity(other, k), through = 2.0 * own * d / (own + d) *
                                                                static_cast<double>(cell(k).z) /
                                                                (columnM * columnM);
              leaving += through;
              coming += through * f[other];
            }
            for (const int other : {k - 1, k + 1}) {
              const bool inside = other >= 0 && other < count;
              const double through =
                  1.0 / (resistance(i, k) + (inside ? resistance(at(x, y, other), other) : 2.0));
              leaving += through;
              if (inside) coming += through * f[at(x, y, other)];
            }
            f[i] += 1.5 * (coming / leaving - f[i]);
          }
    return f;
  }

  scene::SkyState state;
  shading::LightVolumeLayout volume;
  shading::FluenceLayout layout;
  int count;
  double columnM = 0.0;
  Volume<float> fluence;
  std::vector<double> depths, sources;  // by columns
};

TEST(Fluence, IsThatOfTheEquations) {
  const Spread s(cloudyScene(50.0, {Genus::kCumulus}, 4.0));
  const std::vector<double> wanted = s.solved();
  double sum = 0.0, error = 0.0, bias = 0.0;
  for (int y = 8; y < kSide - 8; ++y)  // beyond is the next cascade's
    for (int x = 8; x < kSide - 8; ++x)
      for (int k = 0; k < s.count; ++k) {
        const double want = wanted[s.at(x, y, k)], got = s.drawn(x, y, k);
        sum += want;
        error += std::abs(got - want);
        bias += got - want;
      }
  EXPECT_GT(sum, 0.0);
  EXPECT_LT(error / sum, 0.02);  // some steps do not solve them to the end
  EXPECT_LT(std::abs(bias) / sum, 0.01);
}

// Nothing is lost: what the sun sends in leaves through top and bottom.
TEST(Fluence, LeavesAsMuchAsComes) {
  for (const Genus genus : {Genus::kStratus, Genus::kCumulus}) {
    const Spread s(cloudyScene(50.0, {genus}, genus == Genus::kStratus ? 8.0 : 4.0));
    double in = 0.0, out = 0.0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        for (int k = 0; k < s.count; ++k) in += s.sources[s.at(x, y, k)];
        for (const int k : {0, s.count - 1}) out += s.drawn(x, y, k) / (s.resistance(s.at(x, y, k), k) + 2.0);
      }
    EXPECT_GT(in, 0.05 * kSide * kSide);
    EXPECT_NEAR(out / in, 1.0, 0.035);
  }
}

// Columns half as wide are no other clouds.
TEST(Fluence, AnOvercastOfDeepCloudIsAsBrightInHighQuality) {
  scene::Scene s = looking(cloudyScene(60.0, {Genus::kCumulonimbus}, 8.0), 120.0, 20.0);
  const auto luminanceIn = [&](scene::Quality quality) {
    s.output.quality = quality;
    return luminanceOf(meanOf(SkyRenderer().draw(scene::buildSky(s, 0.0)).luminance, 0, 10));
  };
  EXPECT_NEAR(luminanceIn(scene::Quality::kHigh) / luminanceIn(scene::Quality::kMedium), 1.0, 0.1);
}

}  // namespace
}  // namespace welkin::render
