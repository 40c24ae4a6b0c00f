// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/majorant_grid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <new>

namespace welkin::reference {
namespace {

constexpr float kThinnestSliceM = 60.0f, kThickestSliceM = 200.0f;
constexpr int kSlicesOfLayer = 14;
// A brick is divided where light would meet so many needless collisions on its way across it, about.
constexpr float kNeedless = 0.5f;
constexpr float kVoxelM = 32.0f;         // high, about
constexpr float kStepsAnOctave = 16.0f;  // of codes: 4.4 % apart

std::size_t blockedSize(int across, int high) {
  return static_cast<std::size_t>(across * across * ((high + 1) & ~1));
}

}  // namespace

CodeLines::~CodeLines() {
  for (std::atomic<Line*>& chunk : chunks_) delete[] chunk.load();
}

std::uint32_t CodeLines::take(std::atomic<std::uint32_t>& place, std::uint32_t lines) {
  const std::lock_guard lock(mutex_);
  if (const std::uint32_t taken = place.load(std::memory_order_relaxed)) return taken;  // by another thread
  if ((next_ & (kChunk - 1)) + lines > kChunk) next_ = (next_ | (kChunk - 1)) + 1;
  const std::uint32_t first = next_;
  std::atomic<Line*>& chunk = chunks_[first >> kChunkBits];
  if (!chunk.load(std::memory_order_relaxed)) chunk.store(new Line[kChunk], std::memory_order_relaxed);
  next_ += lines;
  place.store(first, std::memory_order_release);
  return first;
}

// Takes no memory before it is written to.
MajorantGrid::Codes MajorantGrid::zeros(std::size_t n) {
  Codes codes(static_cast<std::uint16_t*>(std::calloc(n, sizeof(std::uint16_t))));
  if (!codes) throw std::bad_alloc();
  return codes;
}

MajorantGrid::MajorantGrid(const field::CloudField& field, std::vector<int> layers)
    : bounds_(field), layers_(std::move(layers)), tiles_(static_cast<std::size_t>(kTiles) * kTiles) {
  assert(!layers_.empty());
  std::vector<float> cuts;
  float most = 0.0f;
  for (const int i : layers_) {
    const field::CloudLayer& l = field.layers()[static_cast<std::size_t>(i)];
    cuts.insert(cuts.end(), {l.baseM, l.topM});
    most +=
        bounds_.layer(static_cast<std::size_t>(i), {{-1e9f, -1e9f, l.baseM}, {1e9f, 1e9f, l.topM}}).highest;
  }
  for (std::size_t i = 1; i < steps_.size(); ++i)
    steps_[i] = 1.01f * most * std::exp2((static_cast<float>(i) - 255.0f) / kStepsAnOctave);
  steps_[1] = 0.0f;  // of kClear; the least may be 0 or 1
  std::sort(cuts.begin(), cuts.end());
  // Slices as thin as the thinnest layer around asks for: a thin layer beside a deep one does not cut all of
  // that.
  const auto sliceM = [&](float from, float to) {
    float thinnest = 1e9f;
    for (const int i : layers_) {
      const field::CloudLayer& l = field.layers()[static_cast<std::size_t>(i)];
      if (l.baseM < to && l.topM > from) thinnest = std::min(thinnest, l.topM - l.baseM);
    }
    return std::clamp(thinnest / kSlicesOfLayer, kThinnestSliceM, kThickestSliceM);
  };
  slices_.edges.push_back(cuts.front());
  for (std::size_t c = 1; c < cuts.size(); ++c) {
    const float from = slices_.edges.back(), to = cuts[c];
    if (to - from < 0.1f) continue;
    const int n = std::max(1, static_cast<int>(std::ceil((to - from) / sliceM(from, to))));
    for (int i = 1; i <= n; ++i)
      slices_.edges.push_back(i == n ? to
                                     : from + (to - from) * static_cast<float>(i) / static_cast<float>(n));
  }
  for (std::size_t k = 0; k + 1 < slices_.edges.size(); ++k) {
    const float high = slices_.edges[k + 1] - slices_.edges[k];
    const int voxels = std::clamp(static_cast<int>(std::lround(high / kVoxelM)), 1, kVoxelsAcross);
    slices_.voxelsHigh.push_back(voxels);
    slices_.voxelM.push_back(high / static_cast<float>(voxels));
    slices_.voxelsPerM.push_back(1.0f / slices_.voxelM.back());
    slices_.lines.push_back(
        static_cast<std::uint32_t>(blockedSize(kVoxelsAcross, voxels) / CodeLines::kCodes));
    std::uint16_t there = 0;
    for (const int i : layers_) {
      const field::CloudLayer& l = field.layers()[static_cast<std::size_t>(i)];
      if (l.baseM < slices_.edges[k + 1] + kMarginM && l.topM > slices_.edges[k] - kMarginM)
        there |= static_cast<std::uint16_t>(1u << i);
    }
    slices_.layers.push_back(there);
  }
  slices_.last = static_cast<std::int32_t>(slices_.layers.size()) - 1;
  slices_.guideFromM = slices_.edges.front();
  std::int32_t slice = 0;
  for (float z = slices_.edges.front(); z < slices_.edges.back() + kGuideM; z += kGuideM) {
    const std::int32_t before = slice;
    while (slice < slices_.last && slices_.edges[static_cast<std::size_t>(slice) + 1] <= z) ++slice;
    slices_.guide.push_back(slice);
    slices_.mostInGuide = std::max(slices_.mostInGuide, slice - before + 1);
  }
  slices_.lastGuide = static_cast<std::int32_t>(slices_.guide.size()) - 1;
}

MajorantGrid::~MajorantGrid() {
  for (std::atomic<Tile*>& tile : tiles_) delete tile.load();
}

int MajorantGrid::sliceAt(float z) const {
  std::int32_t slice = slices_.guide[static_cast<std::size_t>(
      std::clamp(static_cast<int>((z - slices_.guideFromM) / kGuideM), 0, slices_.lastGuide))];
  while (slice < slices_.last && slices_.edges[static_cast<std::size_t>(slice) + 1] <= z) ++slice;
  return slice;
}

std::uint16_t MajorantGrid::compute(const CloudBox& box) const {
  const CloudBox wide{box.low - kMarginM, box.high + kMarginM};
  Bounds sum;
  for (const int i : layers_) {
    const CloudBounds::Layer l = bounds_.layer(static_cast<std::size_t>(i), wide);
    sum.majorant += l.highest;
    sum.minorant += l.lowest;
  }
  if (sum.majorant <= 0.0f) return kClear;
  const auto most = std::lower_bound(steps_.begin() + 2, steps_.end() - 1, sum.majorant) - steps_.begin();
  const auto least = std::upper_bound(steps_.begin() + 1, steps_.end(), sum.minorant) - steps_.begin() - 1;
  return static_cast<std::uint16_t>(most << 8 | least);
}

std::unique_ptr<MajorantGrid::Tile> MajorantGrid::makeTile(int x, int y) const {
  auto tile = std::make_unique<Tile>();
  tile->low = {static_cast<float>(x) * kTileM - kReachM, static_cast<float>(y) * kTileM - kReachM};
  const float away = std::max(std::abs(tile->low.x + 0.5f * kTileM), std::abs(tile->low.y + 0.5f * kTileM));
  tile->side = away < 12e3f ? 16 : away < 40e3f ? 8 : 4;
  tile->brickM = kTileM / static_cast<float>(tile->side);
  tile->voxelM = tile->brickM / static_cast<float>(kVoxelsAcross);
  tile->bricksPerM = 1.0f / tile->brickM;
  tile->voxelsPerM = 1.0f / tile->voxelM;
  tile->needless = kNeedless / tile->brickM;
  const std::size_t slices = slices_.layers.size();
  tile->clear.resize(slices);
  for (std::size_t k = 0, first = 0; k <= slices; ++k) {
    if (k < slices && compute({{tile->low.x, tile->low.y, slices_.edges[k]},
                               {tile->low.x + kTileM, tile->low.y + kTileM, slices_.edges[k + 1]}}) == kClear)
      continue;
    for (std::size_t i = first; i < k; ++i)
      tile->clear[i] = {static_cast<std::uint16_t>(first), static_cast<std::uint16_t>(k)};
    first = k + 1;
  }
  const std::size_t bricks = blockedSize(tile->side, static_cast<int>(slices));
  tile->bricks = zeros(bricks);
  tile->voxels = std::make_unique<std::atomic<std::uint32_t>[]>(bricks);
  return tile;
}

const MajorantGrid::Tile* MajorantGrid::tileAt(const glm::vec2& q) const {
  // Exact: a tile is a power of two wide. Beside the eye's kilometres the reach would cost the last bits.
  const glm::vec2 at = glm::floor(q / kTileM) + 0.5f * static_cast<float>(kTiles);
  if (!(at.x >= 0.0f && at.y >= 0.0f && at.x < static_cast<float>(kTiles) &&
        at.y < static_cast<float>(kTiles)))
    return nullptr;
  const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
  std::atomic<Tile*>& slot = tiles_[static_cast<std::size_t>(y) * kTiles + static_cast<std::size_t>(x)];
  if (Tile* tile = slot.load(std::memory_order_acquire)) return tile;
  std::unique_ptr<Tile> tile = makeTile(x, y);
  Tile* none = nullptr;
  if (slot.compare_exchange_strong(none, tile.get(), std::memory_order_acq_rel)) return tile.release();
  return none;  // another thread's, which is the same
}

glm::ivec3 MajorantGrid::brickAt(const Tile& tile, const glm::vec3& q) const {
  auto along = [&](float x) { return std::clamp(static_cast<int>(x * tile.bricksPerM), 0, tile.side - 1); };
  return {along(q.x - tile.low.x), along(q.y - tile.low.y), sliceAt(q.z)};
}

MajorantGrid::Cell MajorantGrid::at(glm::vec3 q) const {
  const Tile* tile = tileAt(glm::vec2(q));
  constexpr float kFar = 1e9f;
  if (!tile) return {{}, 0, {glm::vec3(-kFar), glm::vec3(kFar)}};
  const glm::ivec3 i = brickAt(*tile, q);
  const std::uint16_t layers = slices_.layers[static_cast<std::size_t>(i.z)];
  const Bounds bounds = boundsOf(brickCode(*tile, i));
  if (bounds.majorant - bounds.minorant <= tile->needless) return {bounds, layers, brickBox(*tile, i)};
  const Brick brick = brickOf(*tile, i);
  const glm::ivec3 v = glm::clamp(glm::ivec3((q - brick.low) * brick.perM), glm::ivec3(0), brick.n - 1);
  const glm::vec3 low = brick.low + brick.sizeM * glm::vec3(v);
  return {boundsOf(voxelCode(brick, v)), layers, {low, low + brick.sizeM}};
}

}  // namespace welkin::reference
