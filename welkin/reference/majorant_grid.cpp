// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/majorant_grid.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace welkin::reference {
namespace {

constexpr float kTileM = 2048.0f;
constexpr int kTiles = static_cast<int>(2.0f * MajorantGrid::kReachM / kTileM);  // a side
constexpr float kGuideM = 10.0f;
constexpr float kThinnestSliceM = 30.0f, kThickestSliceM = 200.0f;
constexpr int kSlicesOfLayer = 28;

constexpr std::uint64_t kUnknown = ~std::uint64_t{0};

std::uint64_t packed(float majorant, unsigned layers, unsigned full) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(majorant)} | std::uint64_t{layers} << 32 |
         std::uint64_t{full} << 40;
}

}  // namespace

struct MajorantGrid::Tile {
  glm::vec2 low{0.0f};
  int side = 1;  // bricks
  float brickM = 0.0f;
  std::vector<std::uint8_t> clear;                         // by slice: no cloud anywhere in the tile
  std::vector<float> clearLow, clearHigh;                  // how far the slices around are clear too
  mutable std::vector<std::atomic<std::uint64_t>> bricks;  // by slice, row, column
};

MajorantGrid::MajorantGrid(const field::CloudField& field, std::vector<int> layers)
    : bounds_(field), layers_(std::move(layers)), tiles_(static_cast<std::size_t>(kTiles) * kTiles) {
  assert(!layers_.empty());
  std::vector<float> cuts;
  float thinnest = 1e9f;
  for (const int i : layers_) {
    const field::CloudLayer& l = field.layers()[static_cast<std::size_t>(i)];
    cuts.insert(cuts.end(), {l.baseM, l.topM});
    thinnest = std::min(thinnest, l.topM - l.baseM);
  }
  std::sort(cuts.begin(), cuts.end());
  const float sliceM = std::clamp(thinnest / kSlicesOfLayer, kThinnestSliceM, kThickestSliceM);
  edges_.push_back(cuts.front());
  for (std::size_t c = 1; c < cuts.size(); ++c) {
    const float from = edges_.back(), to = cuts[c];
    if (to - from < 0.1f) continue;
    const int n = std::max(1, static_cast<int>(std::ceil((to - from) / sliceM)));
    for (int i = 1; i <= n; ++i)
      edges_.push_back(i == n ? to : from + (to - from) * static_cast<float>(i) / static_cast<float>(n));
  }
  int slice = 0;
  for (float z = edges_.front(); z < edges_.back() + kGuideM; z += kGuideM) {
    while (slice + 2 < static_cast<int>(edges_.size()) && edges_[static_cast<std::size_t>(slice) + 1] <= z)
      ++slice;
    sliceGuide_.push_back(slice);
  }
}

MajorantGrid::~MajorantGrid() {
  for (std::atomic<Tile*>& tile : tiles_) delete tile.load();
}

int MajorantGrid::sliceAt(float z) const {
  const int most = static_cast<int>(sliceGuide_.size()) - 1;
  int slice = sliceGuide_[static_cast<std::size_t>(
      std::clamp(static_cast<int>((z - edges_.front()) / kGuideM), 0, most))];
  while (slice + 2 < static_cast<int>(edges_.size()) && edges_[static_cast<std::size_t>(slice) + 1] <= z)
    ++slice;
  return slice;
}

std::uint64_t MajorantGrid::compute(const CloudBox& box) const {
  const CloudBox wide{box.low - kMarginM, box.high + kMarginM};
  float majorant = 0.0f;
  unsigned there = 0, full = 0;
  for (const int i : layers_) {
    const CloudBounds::Layer l = bounds_.layer(static_cast<std::size_t>(i), wide);
    if (l.highest <= 0.0f) continue;
    majorant += l.highest;
    there |= 1u << i;
    if (l.full) full |= 1u << i;
  }
  return packed(majorant, there, full);
}

const MajorantGrid::Tile& MajorantGrid::tileAt(int x, int y) const {
  std::atomic<Tile*>& slot = tiles_[static_cast<std::size_t>(y) * kTiles + static_cast<std::size_t>(x)];
  if (Tile* tile = slot.load(std::memory_order_acquire)) return *tile;
  auto tile = std::make_unique<Tile>();
  tile->low = {static_cast<float>(x) * kTileM - kReachM, static_cast<float>(y) * kTileM - kReachM};
  const float away = std::max(std::abs(tile->low.x + 0.5f * kTileM), std::abs(tile->low.y + 0.5f * kTileM));
  tile->side = away < 12e3f ? 16 : away < 40e3f ? 8 : away < 120e3f ? 4 : 2;
  tile->brickM = kTileM / static_cast<float>(tile->side);
  const std::size_t slices = edges_.size() - 1;
  for (std::size_t k = 0; k < slices; ++k) {
    const CloudBox whole{{tile->low.x, tile->low.y, edges_[k]},
                         {tile->low.x + kTileM, tile->low.y + kTileM, edges_[k + 1]}};
    tile->clear.push_back((compute(whole) >> 32 & 0xff) == 0 ? 1 : 0);
  }
  tile->clearLow.assign(edges_.begin(), edges_.end() - 1);
  tile->clearHigh.assign(edges_.begin() + 1, edges_.end());
  for (std::size_t k = 1; k < slices; ++k)
    if (tile->clear[k] && tile->clear[k - 1]) tile->clearLow[k] = tile->clearLow[k - 1];
  for (std::size_t k = slices - 1; k-- > 0;)
    if (tile->clear[k] && tile->clear[k + 1]) tile->clearHigh[k] = tile->clearHigh[k + 1];
  const std::size_t bricks = slices * static_cast<std::size_t>(tile->side * tile->side);
  tile->bricks = std::vector<std::atomic<std::uint64_t>>(bricks);
  for (auto& brick : tile->bricks) brick.store(kUnknown, std::memory_order_relaxed);
  Tile* none = nullptr;
  if (slot.compare_exchange_strong(none, tile.get(), std::memory_order_acq_rel)) return *tile.release();
  return *none;  // another thread's, which is the same
}

MajorantGrid::Brick MajorantGrid::at(glm::vec3 q) const {
  const float fx = (q.x + kReachM) / kTileM, fy = (q.y + kReachM) / kTileM;
  if (!(fx >= 0.0f && fy >= 0.0f && fx < static_cast<float>(kTiles) && fy < static_cast<float>(kTiles))) {
    constexpr float kFar = 1e9f;
    return {0.0f, 0, 0, {glm::vec3(-kFar), glm::vec3(kFar)}};
  }
  const Tile& tile = tileAt(static_cast<int>(fx), static_cast<int>(fy));
  const auto slice = static_cast<std::size_t>(sliceAt(q.z));
  if (tile.clear[slice])
    return {0.0f,
            0,
            0,
            {{tile.low.x, tile.low.y, tile.clearLow[slice]},
             {tile.low.x + kTileM, tile.low.y + kTileM, tile.clearHigh[slice]}}};
  const int i = std::clamp(static_cast<int>((q.x - tile.low.x) / tile.brickM), 0, tile.side - 1),
            j = std::clamp(static_cast<int>((q.y - tile.low.y) / tile.brickM), 0, tile.side - 1);
  const glm::vec3 low(tile.low.x + tile.brickM * static_cast<float>(i),
                      tile.low.y + tile.brickM * static_cast<float>(j), edges_[slice]);
  const CloudBox box{low, {low.x + tile.brickM, low.y + tile.brickM, edges_[slice + 1]}};
  std::atomic<std::uint64_t>& entry =
      tile.bricks[(slice * static_cast<std::size_t>(tile.side) + static_cast<std::size_t>(j)) *
                      static_cast<std::size_t>(tile.side) +
                  static_cast<std::size_t>(i)];
  std::uint64_t bits = entry.load(std::memory_order_relaxed);
  if (bits == kUnknown) {
    bits = compute(box);
    entry.store(bits, std::memory_order_relaxed);
  }
  return {std::bit_cast<float>(static_cast<std::uint32_t>(bits)), static_cast<std::uint8_t>(bits >> 32),
          static_cast<std::uint8_t>(bits >> 40), box};
}

}  // namespace welkin::reference
