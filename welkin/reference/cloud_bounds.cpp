// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/cloud_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>

#include "welkin/core/glsl.h"

namespace welkin::reference {
namespace {

namespace shared {
using namespace welkin::glsl;
using field::CloudLayer;
#include "shaders/lib/clouds.glsl"
}  // namespace shared

constexpr float kRounding = 1e-4f;  // relative to what is summed; floats round to 6e-8

Interval operator+(Interval a, Interval b) {
  return {a.low + b.low, a.high + b.high};
}
Interval operator*(Interval a, Interval b) {
  const float x[4] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
  return {std::min(std::min(x[0], x[1]), std::min(x[2], x[3])),
          std::max(std::max(x[0], x[1]), std::max(x[2], x[3]))};
}
Interval operator*(float a, Interval b) {
  return a < 0.0f ? Interval{a * b.high, a * b.low} : Interval{a * b.low, a * b.high};
}
Interval shifted(Interval a, float by) {
  return {a.low + by, a.high + by};
}
// No std::floor(), which is a call on plain x86-64.
int floorOf(float x) {
  const int i = static_cast<int>(x);
  return i - (static_cast<float>(i) > x);
}

Interval smoothstep(float a, float b, Interval x) {
  return {glm::smoothstep(a, b, x.low), glm::smoothstep(a, b, x.high)};
}

// From a to b by shares.
Interval mixed(float a, float b, Interval shares) {
  return shifted((b - a) * shares, a);
}

// Along and across a direction.
struct Turned {
  Interval x, y;
};
Turned turned(Interval x, Interval y, float c, float s) {
  return {c * x + s * y, c * y + (-s) * x};
}

}  // namespace

TexelExtremes::Level::Level(int nx, int ny, int nz, int cellSize)
    : n{nx, ny, nz},
      rowSize(static_cast<std::size_t>((nx + kMostCells - 1) * cellSize)),
      cells(rowSize * static_cast<std::size_t>(ny * nz), std::int16_t{-32768}) {}

void TexelExtremes::Level::repeatRows(int cellSize) {
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int i = n[0] * cellSize; i < static_cast<int>(rowSize); ++i)
        row(y, z)[i] = row(y, z)[i - n[0] * cellSize];
}

TexelExtremes::TexelExtremes(const std::vector<float>& values, int nx, int ny, int nz, int channels)
    : channels_(channels > 1 ? kMostChannels : 1) {
  float most = 1e-6f;
  for (const float v : values) most = std::max(most, std::abs(v));
  step_ = most / 32000.0f;
  auto rounded = [&](float x) { return static_cast<std::int16_t>(std::ceil(x / step_ + 0.01f)); };
  const int cellSize = 2 * channels_;
  levels_.emplace_back(nx, ny, nz, cellSize);
  const float* v = values.data();
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x)
        for (int c = 0; c < channels; ++c, ++v) {
          std::int16_t* cell = levels_[0].row(y, z) + x * cellSize + 2 * c;
          cell[0] = rounded(-*v);
          cell[1] = rounded(*v);
        }
  levels_[0].repeatRows(cellSize);
  while (levels_.back().n[0] > 1 || levels_.back().n[1] > 1 || levels_.back().n[2] > 1) {
    const Level& fine = levels_.back();
    Level coarse((fine.n[0] + 1) / 2, (fine.n[1] + 1) / 2, (fine.n[2] + 1) / 2, cellSize);
    for (int z = 0; z < fine.n[2]; ++z)
      for (int y = 0; y < fine.n[1]; ++y)
        for (int x = 0; x < fine.n[0]; ++x)
          for (int i = 0; i < cellSize; ++i) {
            std::int16_t& to = coarse.row(y / 2, z / 2)[x / 2 * cellSize + i];
            to = std::max(to, fine.row(y, z)[x * cellSize + i]);
          }
    coarse.repeatRows(cellSize);
    levels_.push_back(std::move(coarse));
  }
}

TexelExtremes::Channels TexelExtremes::over(glm::vec3 low, glm::vec3 high) const {
  const int dimensions = levels_.front().n[2] > 1 ? 3 : 2;
  // Whole texels that filtering reaches, a texel wider than need be: coordinates are rounded here too.
  int first[3] = {0, 0, 0}, last[3] = {0, 0, 0}, widest = 1;
  for (int a = 0; a < dimensions; ++a) {
    const int n = levels_.front().n[a];
    const auto size = static_cast<float>(n);
    const float x0 = low[a] * size - 0.5f, x1 = high[a] * size - 0.5f;
    if (x1 - x0 < size - 4.0f) {
      const float tiles =
          static_cast<float>(floorOf(x0 / size)) * size;  // exact: sizes are powers of two, or small
      first[a] = floorOf(x0 - tiles - 0.01f);
      last[a] = floorOf(x1 - tiles + 0.01f) + 1;
    } else {
      last[a] = n - 1;
    }
    widest = std::max(widest, last[a] - first[a] + 1);
  }
  std::size_t level = 0;
  auto cells = [&](int a) { return (last[a] >> level) - (first[a] >> level) + 1; };
  if (widest > kMostCells)
    while (level + 1 < levels_.size() && std::max({cells(0), cells(1), cells(2)}) > kMostCells) ++level;
  const Level& l = levels_[level];
  // Where the cells of each side begin.
  int at[3] = {0, 0, 0}, n[3] = {1, 1, 1};
  for (int a = 0; a < dimensions; ++a) {
    n[a] = std::min(cells(a), l.n[a]);
    const int begin = first[a] >> level, size = l.n[a];
    at[a] = (size & (size - 1)) == 0 ? begin & (size - 1) : ((begin % size) + size) % size;
  }
  // A register of cells at a time, one of several channels or several of one: of those the first n[0] count.
  using Cells = std::int16_t __attribute__((vector_size(16)));
  constexpr int kRegister = 8;
  const int cellSize = 2 * channels_, together = kRegister / cellSize;
  Cells all = {-32768, -32768, -32768, -32768, -32768, -32768, -32768, -32768};
  for (int k = 0, z = at[2]; k < n[2]; ++k, z = z + 1 == l.n[2] ? 0 : z + 1)
    for (int j = 0, y = at[1]; j < n[1]; ++j, y = y + 1 == l.n[1] ? 0 : y + 1) {
      const std::int16_t* row = l.row(y, z) + at[0] * cellSize;
      for (int i = 0; i < n[0]; i += together) {
        Cells some;
        // The last reads some once more rather than those beyond.
        std::memcpy(&some, row + std::clamp(n[0] - together, 0, i) * cellSize, sizeof some);
        all = some > all ? some : all;
      }
    }
  Channels channels;
  for (int c = 0; c < channels_; ++c) {
    int least = -32768, most = -32768;
    for (int i = 0; i < std::min(n[0], together); ++i) {
      least = std::max<int>(least, all[i * cellSize + 2 * c]);
      most = std::max<int>(most, all[i * cellSize + 2 * c + 1]);
    }
    channels[static_cast<std::size_t>(c)] = {-step_ * static_cast<float>(least),
                                             step_ * static_cast<float>(most)};
  }
  return channels;
}

CloudBounds::CloudBounds(const field::CloudField& field) : field_(field) {
  const field::CloudNoise& n = field.noise();
  const Image<float>& p = n.placement;
  placement_ = TexelExtremes(p.data, p.width, p.height, 1, p.channels);
  auto volume = [](const Volume<float>& v) { return TexelExtremes(v.data, v.nx, v.ny, v.nz, v.channels); };
  shape_ = volume(n.shape);
  detail_ = volume(n.detail);
}

CloudBounds::Layer CloudBounds::layer(std::size_t index, const CloudBox& box) const {
  const field::CloudLayer& l = field_.layers()[index];
  if (box.high.z <= l.baseM || box.low.z >= l.topM) return {};
  const float depth = l.topM - l.baseM;
  const Interval h{std::clamp((box.low.z - l.baseM) / depth, 0.0f, 1.0f),
                   std::clamp((box.high.z - l.baseM) / depth, 0.0f, 1.0f)};

  // cloudPatternPosition, cloudPlacement.
  const Interval east = shifted(Interval{box.low.x, box.high.x}, -l.driftM.x) + (-l.shearM.x) * h;
  const Interval north = shifted(Interval{box.low.y, box.high.y}, -l.driftM.y) + (-l.shearM.y) * h;
  const Turned p = turned(east, north, l.along.x, l.along.y);
  const Interval ax = 1.0f / l.stretch * p.x, ay = p.y;
  const float cosine = shared::kPatchCosine / l.patchM, sine = shared::kPatchSine / l.patchM;
  const Interval ux = shifted(cosine * ax + -sine * ay, -l.patchShift.x),
                 uy = shifted(sine * ax + cosine * ay, -l.patchShift.y);
  const glm::vec3 patchLow(ux.low, uy.low, 0.0f), patchHigh(ux.high, uy.high, 0.0f);
  const TexelExtremes::Channels patches = placement_.over(patchLow, patchHigh);
  const Interval bx = 1.0f / l.cellM * (ax + l.warpM * patches[1]),
                 by = 1.0f / l.cellM * (ay + l.warpM * patches[0]);
  const glm::vec3 cellLow(bx.low, by.low, 0.0f), cellHigh(bx.high, by.high, 0.0f);
  const TexelExtremes::Channels cells = placement_.over(cellLow, cellHigh);
  const Interval placement =
      l.cellWeight * cells[0] + l.fractalWeight * cells[1] + l.patchWeight * patches[2];

  // cloudProfile.
  const Interval dome = l.dome * Interval{std::pow(h.low, l.domePower), std::pow(h.high, l.domePower)};
  const Interval towardsBase{1.0f - h.high, 1.0f - h.low};
  const Interval belly =
      l.belly * Interval{towardsBase.low * towardsBase.low, towardsBase.high * towardsBase.high};
  const Interval anvil{shared::cloudAnvil(l, h.low), shared::cloudAnvil(l, h.high)};
  const Interval profile = dome + belly + -l.anvil * anvil;
  const float slack = kRounding * (1.0f + std::abs(l.threshold));
  Interval s = shifted(placement, -l.threshold) + -1.0f * profile;
  s = {s.low - slack, s.high + slack};

  // cloudShapeAmount, cloudClearance.
  const Interval amounts = l.shapeAmount > 0.0f
                               ? l.shapeAmount * (mixed(l.shapeAtBase, 1.0f, smoothstep(0.0f, 0.35f, h)) *
                                                  mixed(1.0f, shared::kAnvilShape, anvil) *
                                                  smoothstep(-1.8f * l.shapeAmount, -0.2f * l.shapeAmount, s))
                               : Interval{};
  if (s.high + 2.5f * amounts.high + 2.0f * l.detailAmount <= 0.0f) return {};
  bool clear = s.low + 2.5f * amounts.low + 2.0f * l.detailAmount <= slack;  // somewhere, maybe

  // cloudExtinctionFrom.
  const Interval qx = 1.0f / l.shapeStretch * p.x, qy = p.y,
                 qz = 1.0f / l.shapeTall * Interval{box.low.z, box.high.z};
  auto over = [&](const TexelExtremes& noise, const field::vec3& shift, float period) {
    return noise.over(
        {(qx.low - shift.x) / period, (qy.low - shift.y) / period, (qz.low - shift.z) / period},
        {(qx.high - shift.x) / period, (qy.high - shift.y) / period, (qz.high - shift.z) / period})[0];
  };
  s = s + amounts * over(shape_, l.shapeShiftM, l.shapeM);
  if (s.high + 2.0f * l.detailAmount <= 0.0f) return {};
  clear = clear || s.low + 2.0f * l.detailAmount <= slack;
  const Interval edge = l.edge * mixed(1.0f, shared::kAnvilEdge, anvil);
  if (l.detailAmount > 0.0f && s.low < edge.high + 2.0f * l.detailAmount) {
    const Interval byHeight = mixed(l.shapeAtBase, 1.0f, smoothstep(0.0f, 0.2f, h));
    const Interval detail = l.detailAmount * (byHeight * over(detail_, l.detailShiftM, l.detailM));
    s = s + Interval{std::min(detail.low, 0.0f), std::max(detail.high, 0.0f)};  // may be left out
  }
  s = {s.low - slack, s.high + slack};
  if (s.high <= 0.0f) return {};
  const float thin =
      glm::smoothstep(0.0f, l.bottomSoft, h.low) * glm::smoothstep(0.0f, l.topSoft, 1.0f - h.high);
  const float thick =
      glm::smoothstep(0.0f, l.bottomSoft, h.high) * glm::smoothstep(0.0f, l.topSoft, 1.0f - h.low);
  const Interval lifted{0.4f + 0.9f * std::sqrt(h.low), 0.4f + 0.9f * std::sqrt(h.high)};
  const Interval body =
      l.extinction * (Interval{thin, thick} * shifted(l.lift * shifted(lifted, -1.0f), 1.0f) *
                      mixed(1.0f, shared::kAnvilExtinction, anvil));
  return {body.high * std::clamp(s.high / edge.low, 0.0f, 1.0f) * (1.0f + kRounding),
          clear ? 0.0f
                : std::max(body.low * std::clamp(s.low / edge.high, 0.0f, 1.0f) * (1.0f - kRounding), 0.0f),
          s.low >= edge.high};
}

}  // namespace welkin::reference
