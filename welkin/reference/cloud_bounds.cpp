// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/cloud_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
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
constexpr int kMostCells = 4;       // along a side of what is looked up at one level

Interval operator+(Interval a, Interval b) {
  return {a.low + b.low, a.high + b.high};
}
Interval operator*(Interval a, Interval b) {
  const auto [low, high] = std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
  return {low, high};
}
Interval operator*(float a, Interval b) {
  return Interval{a, a} * b;
}
Interval shifted(Interval a, float by) {
  return {a.low + by, a.high + by};
}
Interval united(Interval a, Interval b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
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

TexelExtremes::TexelExtremes(const std::vector<float>& values, int nx, int ny, int nz, int channels,
                             int channel) {
  Level base{{nx, ny, nz}, {}};
  for (std::size_t i = static_cast<std::size_t>(channel); i < values.size();
       i += static_cast<std::size_t>(channels))
    base.cells.push_back({values[i], values[i]});
  levels_.push_back(std::move(base));
  while (levels_.back().n[0] > 1 || levels_.back().n[1] > 1 || levels_.back().n[2] > 1) {
    const Level& fine = levels_.back();
    Level coarse{{(fine.n[0] + 1) / 2, (fine.n[1] + 1) / 2, (fine.n[2] + 1) / 2}, {}};
    for (int z = 0; z < coarse.n[2]; ++z)
      for (int y = 0; y < coarse.n[1]; ++y)
        for (int x = 0; x < coarse.n[0]; ++x) {
          Interval all{1e30f, -1e30f};
          for (int k = 2 * z; k < std::min(2 * z + 2, fine.n[2]); ++k)
            for (int j = 2 * y; j < std::min(2 * y + 2, fine.n[1]); ++j)
              for (int i = 2 * x; i < std::min(2 * x + 2, fine.n[0]); ++i)
                all = united(all, fine.cells[static_cast<std::size_t>((k * fine.n[1] + j) * fine.n[0] + i)]);
          coarse.cells.push_back(all);
        }
    levels_.push_back(std::move(coarse));
  }
}

Interval TexelExtremes::over(glm::vec3 low, glm::vec3 high) const {
  const int dimensions = levels_.front().n[2] > 1 ? 3 : 2;
  // Whole texels that filtering reaches, a texel wider than need be: coordinates are rounded here too.
  int first[3] = {0, 0, 0}, last[3] = {0, 0, 0};
  for (int a = 0; a < dimensions; ++a) {
    const int n = levels_.front().n[a];
    const auto size = static_cast<float>(n);
    const float x0 = low[a] * size - 0.5f, x1 = high[a] * size - 0.5f;
    if (!(x1 - x0 < size - 4.0f)) {
      first[a] = 0, last[a] = n - 1;
      continue;
    }
    const float tiles = std::floor(x0 / size) * size;  // exact: sizes are powers of two, or small
    first[a] = static_cast<int>(std::floor(x0 - tiles - 0.01f));
    last[a] = static_cast<int>(std::floor(x1 - tiles + 0.01f)) + 1;
  }
  std::size_t level = 0;
  auto cells = [&](int a) { return (last[a] >> level) - (first[a] >> level) + 1; };
  while (level + 1 < levels_.size() && std::max({cells(0), cells(1), cells(2)}) > kMostCells) ++level;
  const Level& l = levels_[level];
  // Where the cells of each side stand.
  std::array<int, kMostCells + 1> at[3];
  int n[3] = {1, 1, 1};
  for (int a = 0; a < 3; ++a) {
    const int begin = first[a] >> level;
    n[a] = std::min((last[a] >> level) - begin + 1, l.n[a]);
    for (int i = 0, x = ((begin % l.n[a]) + l.n[a]) % l.n[a]; i < n[a]; ++i) {
      at[a][static_cast<std::size_t>(i)] = x;
      if (++x == l.n[a]) x = 0;
    }
  }
  Interval all{1e30f, -1e30f};
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j) {
      const Interval* row = &l.cells[static_cast<std::size_t>((at[2][k] * l.n[1] + at[1][j]) * l.n[0])];
      for (int i = 0; i < n[0]; ++i) all = united(all, row[at[0][i]]);
    }
  return all;
}

CloudBounds::CloudBounds(const field::CloudField& field) : field_(field) {
  const field::CloudNoise& n = field.noise();
  auto plane = [&](int channel) {
    return TexelExtremes(n.placement.data, n.placement.width, n.placement.height, 1, n.placement.channels,
                         channel);
  };
  cells_ = plane(0), fractal_ = plane(1), patchX_ = plane(0), patchY_ = plane(1), patchZ_ = plane(2);
  auto volume = [](const Volume<float>& v) { return TexelExtremes(v.data, v.nx, v.ny, v.nz, v.channels, 0); };
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
  const Interval ux = 0.8f / l.patchM * ax + (-0.6f / l.patchM) * ay,
                 uy = 0.6f / l.patchM * ax + 0.8f / l.patchM * ay;
  const glm::vec3 patchLow(ux.low, uy.low, 0.0f), patchHigh(ux.high, uy.high, 0.0f);
  const Interval px = patchX_.over(patchLow, patchHigh), py = patchY_.over(patchLow, patchHigh),
                 pz = patchZ_.over(patchLow, patchHigh);
  const Interval bx = 1.0f / l.cellM * (ax + l.warpM * py), by = 1.0f / l.cellM * (ay + l.warpM * px);
  const glm::vec3 cellLow(bx.low, by.low, 0.0f), cellHigh(bx.high, by.high, 0.0f);
  const Interval placement = l.cellWeight * cells_.over(cellLow, cellHigh) +
                             l.fractalWeight * fractal_.over(cellLow, cellHigh) + l.patchWeight * pz;

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
        {(qx.high - shift.x) / period, (qy.high - shift.y) / period, (qz.high - shift.z) / period});
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
