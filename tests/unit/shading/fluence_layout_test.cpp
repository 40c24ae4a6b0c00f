// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/fluence_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "tests/testing/skies.h"
#include "welkin/field/cloud_layer.h"

namespace welkin::shading {
namespace {

using testing::clearScene;
using testing::cloudyScene;
using weather::Genus;

LightVolumeLayout bandsAt(const std::vector<std::pair<float, float>>& heights, int slices) {
  LightVolumeLayout volume;
  for (const auto& [base, top] : heights) {
    const int first = static_cast<int>(volume.heightsM.size());
    volume.bands.push_back({base, top, first, first + slices - 1, {0}, false});
    for (int k = 0; k < slices; ++k)
      volume.heightsM.push_back(base + (top - base) * static_cast<float>(k) / static_cast<float>(slices - 1));
  }
  return volume;
}

// From the lowest base to the highest top, each metre once, in at most so many cells.
void expectWhole(const LightVolumeLayout& volume) {
  const FluenceLayout layout = fluenceLayout(volume);
  ASSERT_EQ(layout.bands.size(), volume.bands.size());
  EXPECT_LE(layout.cells.size(), static_cast<std::size_t>(FluenceLayout::kMostCells));
  float sum = 0.0f;
  for (const glm::vec4& cell : layout.cells) {
    EXPECT_LT(cell.x, cell.y);
    EXPECT_GT(cell.z, 0.0f);
    sum += cell.z;
  }
  EXPECT_NEAR(sum, volume.bands.back().topM - volume.bands.front().baseM, 0.1f);
  for (std::size_t b = 0; b < layout.bands.size(); ++b) {
    const glm::vec4& own = layout.bands[b];
    EXPECT_EQ(layout.cells[static_cast<std::size_t>(own.x)].x,
              static_cast<float>(volume.bands[b].firstSlice));
    EXPECT_EQ(layout.cells[static_cast<std::size_t>(own.y) - 1].y,
              static_cast<float>(volume.bands[b].lastSlice));
    EXPECT_LE(own.z, own.w);
    EXPECT_GE(own.z, own.x);
    EXPECT_LE(own.w, own.y);
  }
}

TEST(FluenceLayout, HasCellsForAllHeights) {
  expectWhole(bandsAt({{1000, 2000}}, 14));
  expectWhole(bandsAt({{1000, 9000}}, 24));
  expectWhole(bandsAt({{1000, 2000}, {2000, 9000}}, 24));             // touching
  expectWhole(bandsAt({{600, 900}, {3000, 3400}, {7000, 9000}}, 5));  // apart
  std::vector<std::pair<float, float>> eight;
  eight.reserve(8);
  for (int i = 0; i < 8; ++i)
    eight.emplace_back(1000.0f * static_cast<float>(i + 1), 1000.0f * static_cast<float>(i + 1) + 500.0f);
  expectWhole(bandsAt(eight, 24));
  expectWhole(lightVolumeLayout(
      scene::buildSky(cloudyScene(40.0, {Genus::kCumulus, Genus::kCumulonimbus, Genus::kAltocumulus}), 0.0)));
}

// All layers there can be, apart, with metaballs as a volume: more bands and gaps than cells.
TEST(FluenceLayout, HasRoomForAllBands) {
  std::vector<std::pair<float, float>> many;
  for (int bands = 1; bands <= field::kMaxLayers; ++bands) {
    SCOPED_TRACE(bands);
    // Gaps of 501, 502, ... m.
    const float baseM = many.empty() ? 1000.0f : many.back().second + 500.0f + static_cast<float>(bands - 1);
    many.emplace_back(baseM, baseM + 500.0f);
    const LightVolumeLayout volume = bandsAt(many, 3);
    const FluenceLayout layout = fluenceLayout(volume);
    const int air = std::min(bands - 1, FluenceLayout::kMostCells - bands);
    EXPECT_LE(layout.cells.size(), static_cast<std::size_t>(FluenceLayout::kMostCells));
    EXPECT_GE(layout.cells.size(), static_cast<std::size_t>(bands + air));
    for (int b = 0; b < bands; ++b) {
      const glm::vec4& own = layout.bands[static_cast<std::size_t>(b)];
      EXPECT_EQ(layout.cells[static_cast<std::size_t>(own.x)].x, static_cast<float>(3 * b));
      EXPECT_EQ(layout.cells[static_cast<std::size_t>(own.y) - 1].y, static_cast<float>(3 * b + 2));
      // The widest gaps, which are the upper ones, have a cell.
      const bool hasAir = b + 1 < bands && layout.bands[static_cast<std::size_t>(b) + 1].x > own.y;
      EXPECT_EQ(hasAir, b + 1 < bands && b >= bands - 1 - air);
    }
  }
}

TEST(FluenceLayout, LooksAcrossBandsOnlyWhereTheyTouch) {
  const FluenceLayout apart = fluenceLayout(bandsAt({{1000, 2000}, {3000, 4000}}, 5));
  EXPECT_EQ(apart.bands[0], glm::vec4(0, 4, 0.5f, 3.5f));
  EXPECT_EQ(apart.bands[1], glm::vec4(5, 9, 5.5f, 8.5f));
  EXPECT_EQ(apart.cells[4], glm::vec4(4, 5, 1000, 0));
  const FluenceLayout touching = fluenceLayout(bandsAt({{1000, 2000}, {2000, 4000}}, 5));
  EXPECT_EQ(touching.bands[0], glm::vec4(0, 4, 0.5f, 4.0f));
  EXPECT_EQ(touching.bands[1], glm::vec4(4, 8, 4.0f, 7.5f));
}

TEST(FluenceLayout, AClearSkyHasNone) {
  EXPECT_TRUE(fluenceLayout(lightVolumeLayout(scene::buildSky(clearScene(40.0), 0.0))).cells.empty());
}

}  // namespace
}  // namespace welkin::shading
