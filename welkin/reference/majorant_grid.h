// SPDX-License-Identifier: Apache-2.0
// Bounds of the clouds' extinction on a grid: what null-collision tracking steps by. Tiles of 2 km hold
// bricks of some hundred metres near the eye and wider ones far from it; slices between the layers' bases and
// tops are cut to match. A brick that holds an edge of dense cloud is divided into voxels. Bounds are made,
// and voxels take memory, where light comes by: two bytes a box, boxes near each other in one cache line.
//
// Safe to use from several threads: bounds do not depend on who asks first.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "welkin/reference/cloud_bounds.h"

namespace welkin::reference {

// A straight line of cloud positions, from + slope t.
struct CloudLine {
  glm::vec3 from, slope, inverse;  // inverse: of the slope; 0 where it has none

  static constexpr float kLeastSlope = 1e-9f;

  CloudLine(const glm::vec3& start, const glm::vec3& along) : from(start), slope(along) {
    for (int k = 0; k < 3; ++k) inverse[k] = std::abs(slope[k]) > kLeastSlope ? 1.0f / slope[k] : 0.0f;
  }
  // Where it crosses a plane across axis k; never: far away.
  float crosses(int k, float side) const {
    return inverse[k] != 0.0f ? (side - from[k]) * inverse[k] : 1e30f;
  }
};

// Lines of the cache with codes of boxes, zero at first and handed out where somebody asks for them, so that
// only what light comes by takes memory.
class CodeLines {
 public:
  static constexpr std::size_t kCodes = 32;  // a line

  // The codes that a place holds; one that is 0 gets so many lines. For several threads.
  std::uint16_t* at(std::atomic<std::uint32_t>& place, std::uint32_t lines) {
    std::uint32_t first = place.load(std::memory_order_acquire);
    if (first == 0) first = take(place, lines);
    return chunks_[first >> kChunkBits].load(std::memory_order_relaxed)[first & (kChunk - 1)].codes.data();
  }

  CodeLines() : chunks_(std::size_t{1} << (32 - kChunkBits)) {}
  ~CodeLines();
  CodeLines(const CodeLines&) = delete;
  CodeLines& operator=(const CodeLines&) = delete;

 private:
  struct alignas(64) Line {
    std::array<std::uint16_t, kCodes> codes{};
  };
  static constexpr std::uint32_t kChunkBits = 14, kChunk = 1u << kChunkBits;  // lines: a MiB
  std::uint32_t take(std::atomic<std::uint32_t>& place, std::uint32_t lines);

  std::vector<std::atomic<Line*>> chunks_;
  std::mutex mutex_;
  std::uint32_t next_ = kChunk;  // the first chunk is for nobody: 0 is no place
};

class MajorantGrid {
 public:
  // Boxes are taken to be wider than they are by this much on all sides: so far may a position be from
  // where it is looked up.
  static constexpr float kMarginM = 0.5f;

  // layers: indices of those that are traced.
  MajorantGrid(const field::CloudField& field, std::vector<int> layers);
  ~MajorantGrid();
  MajorantGrid(const MajorantGrid&) = delete;
  MajorantGrid& operator=(const MajorantGrid&) = delete;

  float lowM() const { return slices_.edges.front(); }  // heights between which there may be cloud
  float highM() const { return slices_.edges.back(); }
  std::span<const int> layers() const { return layers_; }

  struct Bounds {
    float majorant = 0.0f, minorant = 0.0f;  // 1/m
  };
  // What holds all over a box; layers: that may reach into its slice, bit i for the field's layer i.
  struct Cell {
    Bounds bounds;
    std::uint16_t layers = 0;
    CloudBox box;
  };
  // The smallest cell at q, which is within lowM() and highM(); else the answer is of the nearest slice.
  // Beyond kReachM there is no cloud.
  Cell at(glm::vec3 q) const;

  // Calls f(bounds, layers, t0, t1) for the cells along [0, length] of a line, those without cloud left out,
  // until it returns true; which it then returns.
  template <class F>
  bool walk(const CloudLine& line, float length, F&& f) const;

  static constexpr float kReachM = 1024e3f;  // of the grid from the eye, east and north
  static bool isBeyond(const glm::vec3& q) { return std::max(std::abs(q.x), std::abs(q.y)) > kReachM; }

  // The boxes themselves, for those who step from one to the next: cloud_walks.h.

  static constexpr float kTileM = 2048.0f;
  static constexpr int kVoxelsAcross = 4;  // a multiple of 4
  static constexpr float kNudgeM = 2e-3f;  // over a side of a box
  static constexpr float kGuideM = 10.0f;
  // A code has steps of the greatest extinction in its high byte and of the least in its low one. 0 is a box
  // that nobody has asked for.
  static constexpr std::uint16_t kUnknown = 0, kClear = 0x100;

  // Of each slice, from below.
  struct Slices {
    std::vector<float> edges;               // one more than there are slices
    std::vector<float> voxelM, voxelsPerM;  // of height
    std::vector<std::int32_t> voxelsHigh;
    std::vector<std::uint32_t> lines;  // of the voxels of a brick
    std::vector<std::uint16_t> layers;
    // The slice of each kGuideM of height, or the first of them, so many as there are at most being further
    // up.
    std::vector<std::int32_t> guide;
    float guideFromM = 0.0f;
    std::int32_t last = 0, lastGuide = 0, mostInGuide = 0;
  };
  const Slices& slices() const { return slices_; }
  const std::array<float, 256>& steps() const { return steps_; }

  struct Free {
    void operator()(void* p) const { std::free(p); }
  };
  using Codes = std::unique_ptr<std::uint16_t[], Free>;
  struct Run {  // slices [low, high) without cloud; low == high: there may be
    std::uint16_t low = 0, high = 0;
  };
  struct Tile {
    glm::vec2 low{0.0f};
    int side = 4;  // bricks, a multiple of 4
    float brickM = 0.0f, voxelM = 0.0f, bricksPerM = 0.0f, voxelsPerM = 0.0f;
    float needless = 0.0f;   // a brick is divided whose bounds are farther apart, 1/m
    std::vector<Run> clear;  // by slice: those around that have no cloud anywhere in the tile
    Codes bricks;            // blocked
    // Of each brick, as they are blocked: where its voxels' codes are in voxels_, blocked; 0: nowhere yet.
    std::unique_ptr<std::atomic<std::uint32_t>[]> voxels;
  };
  const Tile* tileAt(const glm::vec2& q) const;  // none: beyond reach

  // What is known of a box, made if need be. brick: where it stands among its tile's, blocked.
  std::uint16_t brickCode(const Tile& tile, std::size_t brick, const glm::ivec3& i) const {
    return known(tile.bricks[brick], [&] { return brickBox(tile, i); });
  }
  // The codes of a brick's voxels, blocked; and one of them, whose voxel has its corner there.
  std::uint16_t* voxelCodes(const Tile& tile, std::size_t brick, std::size_t slice) const {
    return voxels_.at(tile.voxels[brick], slices_.lines[slice]);
  }
  std::uint16_t voxelCode(const Tile& tile, std::size_t slice, std::uint16_t& code,
                          const glm::vec3& low) const {
    return known(code, [&] {
      return CloudBox{low, low + glm::vec3(tile.voxelM, tile.voxelM, slices_.voxelM[slice])};
    });
  }

 private:
  static constexpr int kTiles = static_cast<int>(2.0f * kReachM / kTileM);  // a side
  static Codes zeros(std::size_t n);
  struct Brick {
    glm::vec3 low, sizeM, perM;  // of a voxel, and voxels a metre
    glm::ivec3 n;                // voxels
    std::uint16_t* codes;
  };

  // Where a box stands among others: in blocks of 4 x 4 x 2, which are 64 bytes of codes.
  static std::size_t blocked(const glm::ivec3& i, int across) {
    const int block = ((i.z >> 1) * (across >> 2) + (i.y >> 2)) * (across >> 2) + (i.x >> 2);
    return static_cast<std::size_t>(block * 32 + (i.z & 1) * 16 + (i.y & 3) * 4 + (i.x & 3));
  }
  std::unique_ptr<Tile> makeTile(int x, int y) const;
  glm::ivec3 brickAt(const Tile& tile, const glm::vec3& q) const;
  int sliceAt(float z) const;
  std::uint16_t compute(const CloudBox& box) const;
  Bounds boundsOf(std::uint16_t code) const { return {steps_[code >> 8], steps_[code & 0xff]}; }

  CloudBox brickBox(const Tile& tile, const glm::ivec3& i) const {
    const auto k = static_cast<std::size_t>(i.z);
    const glm::vec2 low = tile.low + tile.brickM * glm::vec2(i.x, i.y);
    return {{low.x, low.y, slices_.edges[k]},
            {low.x + tile.brickM, low.y + tile.brickM, slices_.edges[k + 1]}};
  }
  Brick brickOf(const Tile& tile, const glm::ivec3& i) const {
    const auto k = static_cast<std::size_t>(i.z);
    return {brickBox(tile, i).low,
            {tile.voxelM, tile.voxelM, slices_.voxelM[k]},
            {tile.voxelsPerM, tile.voxelsPerM, slices_.voxelsPerM[k]},
            {kVoxelsAcross, kVoxelsAcross, slices_.voxelsHigh[k]},
            voxels_.at(tile.voxels[blocked(i, tile.side)], slices_.lines[k])};
  }
  // What is known of a box, made if need be.
  template <class Box>
  std::uint16_t known(std::uint16_t& code, Box&& box) const {
    const std::atomic_ref<std::uint16_t> entry(code);
    std::uint16_t c = entry.load(std::memory_order_relaxed);
    if (c == kUnknown) {
      c = compute(box());
      entry.store(c, std::memory_order_relaxed);
    }
    return c;
  }
  std::uint16_t brickCode(const Tile& tile, const glm::ivec3& i) const {
    return brickCode(tile, blocked(i, tile.side), i);
  }
  std::uint16_t voxelCode(const Brick& brick, const glm::ivec3& i) const {
    return known(brick.codes[blocked(i, kVoxelsAcross)], [&] {
      const glm::vec3 low = brick.low + brick.sizeM * glm::vec3(i);
      return CloudBox{low, low + brick.sizeM};
    });
  }

  template <class F>
  bool walkTile(const Tile& tile, const CloudLine& line, float& t, float end, F&& f) const;
  template <class F>
  bool walkBrick(const Brick& brick, const CloudLine& line, float t, float end, F&& f) const;

  CloudBounds bounds_;
  std::vector<int> layers_;
  Slices slices_;
  std::array<float, 256> steps_{};  // of extinction, rising
  mutable std::vector<std::atomic<Tile*>> tiles_;
  mutable CodeLines voxels_;
};

// J. Amanatides and A. Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing", at each of three sizes.
template <class F>
bool MajorantGrid::walk(const CloudLine& line, float length, F&& f) const {
  for (float t = 0.0f; t < length;) {
    const glm::vec3 q = line.from + line.slope * (t + kNudgeM);
    const Tile* tile = tileAt(glm::vec2(q));
    if (!tile) return false;
    float end = length;
    for (int k = 0; k < 2; ++k)
      end = std::min(end, line.crosses(k, tile->low[k] + (line.inverse[k] > 0.0f ? kTileM : 0.0f)));
    const float before = t;
    if (const Run run = tile->clear[static_cast<std::size_t>(sliceAt(q.z))]; run.low < run.high) {
      t = std::min(end,
                   line.crosses(2, line.inverse.z > 0.0f ? slices_.edges[run.high] : slices_.edges[run.low]));
    } else if (walkTile(*tile, line, t, end, f)) {
      return true;
    }
    t = std::max(t, before + kNudgeM);
  }
  return false;
}

// Leaves t where the line leaves the tile, or what is clear of it begins.
template <class F>
bool MajorantGrid::walkTile(const Tile& tile, const CloudLine& line, float& t, float end, F&& f) const {
  const int slices = slices_.last + 1;
  glm::ivec3 i = brickAt(tile, line.from + line.slope * (t + kNudgeM)), turn;
  glm::vec3 next;   // where the line leaves through each side
  glm::vec2 apart;  // from side to side
  for (int k = 0; k < 3; ++k) turn[k] = line.inverse[k] > 0.0f ? 1 : -1;
  for (int k = 0; k < 2; ++k) {
    next[k] = line.crosses(k, tile.low[k] + tile.brickM * static_cast<float>(i[k] + (turn[k] > 0 ? 1 : 0)));
    apart[k] = tile.brickM * std::abs(line.inverse[k]);
  }
  auto nextSlice = [&] {
    return line.crosses(2, slices_.edges[static_cast<std::size_t>(i.z + (turn.z > 0 ? 1 : 0))]);
  };
  next.z = nextSlice();
  for (;;) {
    const int k = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
    const float out = std::min(next[k], end);
    if (out > t) {
      const std::uint16_t code = brickCode(tile, i);
      if (code != kClear) {
        const Bounds bounds = boundsOf(code);
        if (bounds.majorant - bounds.minorant > tile.needless) {
          if (walkBrick(brickOf(tile, i), line, t, out, [&](const Bounds& b, float t0, float t1) {
                return f(b, slices_.layers[static_cast<std::size_t>(i.z)], t0, t1);
              }))
            return true;
        } else if (f(bounds, slices_.layers[static_cast<std::size_t>(i.z)], t, out)) {
          return true;
        }
      }
      t = out;
    }
    if (t >= end) return false;
    i[k] += turn[k];
    if (k < 2) {
      if (i[k] < 0 || i[k] >= tile.side) return false;
      next[k] += apart[k];
    } else {
      if (i.z < 0 || i.z >= slices) {  // out of the shell but for rounding
        i.z -= turn.z;
        next.z = 1e30f;
        continue;
      }
      next.z = nextSlice();
    }
  }
}

template <class F>
bool MajorantGrid::walkBrick(const Brick& brick, const CloudLine& line, float t, float end, F&& f) const {
  glm::ivec3 i, turn;
  glm::vec3 next, apart;
  for (int k = 0; k < 3; ++k) {
    const float at = (line.from[k] + line.slope[k] * (t + kNudgeM) - brick.low[k]) * brick.perM[k];
    i[k] = std::clamp(static_cast<int>(at), 0, brick.n[k] - 1);
    turn[k] = line.inverse[k] > 0.0f ? 1 : -1;
    next[k] =
        line.crosses(k, brick.low[k] + brick.sizeM[k] * static_cast<float>(i[k] + (turn[k] > 0 ? 1 : 0)));
    apart[k] = brick.sizeM[k] * std::abs(line.inverse[k]);
  }
  for (;;) {
    const int k = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
    const bool last = i[k] + turn[k] < 0 || i[k] + turn[k] >= brick.n[k];
    const float out = last ? end : std::min(next[k], end);
    if (out > t) {
      const std::uint16_t code = voxelCode(brick, i);
      if (code != kClear && f(boundsOf(code), t, out)) return true;
      t = out;
    }
    if (last || t >= end) return false;
    i[k] += turn[k];
    next[k] += apart[k];
  }
}

}  // namespace welkin::reference
