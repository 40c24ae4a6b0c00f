// SPDX-License-Identifier: Apache-2.0
// Blocks of cellular noise. Compiled for every instruction set.
//
// A block is cut into tiles of 8 samples along x by a few rows and slices, small against a cell. For each
// tile the feature points that can be nearest to any of its samples are found first: those whose least
// distance to the tile's box is not above the smallest of all points' greatest distances. Some four are left
// of 27 or more, and the samples look at these alone. The result is exact.
//
// Where samples are 3 to 10 to a cell, tiles are 8 in each direction and cut again (cell_cubes-inl.h).
//
// Tiles lie at multiples of their size in the whole grid, and positions are relative to the cell of their
// first sample, so that a sample's value does not depend on the box that is filled.
#if defined(WELKIN_NOISE_CELL_TILES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WELKIN_NOISE_CELL_TILES_INL_H_
#undef WELKIN_NOISE_CELL_TILES_INL_H_
#else
#define WELKIN_NOISE_CELL_TILES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "welkin/noise/cell_cubes-inl.h"
#include "welkin/noise/fill.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// One octave of cells over one block.
class CellTiles {
 public:
  using D = hn::CappedTag<float, kTileX>;
  using DU = hn::RebindToUnsigned<D>;
  using DI = hn::RebindToSigned<D>;
  using V = hn::Vec<D>;
  static constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));

  // The block's x, y and z are relative to the tables' first and multiples of the tiles' sizes.
  CellTiles(const CellTables& tables, const Block& block, Scratch& scratch) : tables_(tables), block_(block) {
    makePoints(scratch);
    const std::size_t most = static_cast<std::size_t>(stride_) * count_[1] * count_[2] + kTileX;
    for (auto& q : near_) q = scratch.take<float>(most + 2 * kLanes);
    away_ = scratch.take<float>(most);
    alongX_ = scratch.take<float>(most * kTileX);
    for (float** rows : {&alongY_, &alongZ_, &beside_})
      *rows = scratch.take<float>((most + kLanes) * kTileMost);
    runs_ = scratch.take<Run>(most / std::size_t{kLanes} + 1);
    if (tables.cubes) cubes_ = CellCubes(tables, block, most, scratch);
  }

  // out[(z * rows + y) * stride + x]: weight times the distance is added to the bias, or (add) to what is
  // there.
  void fill(Feature feature, float weight, float bias, bool add, float* out, int stride) {
    out_ = out;
    outStride_ = stride;
    weight_ = weight;
    bias_ = bias;
    add_ = add;
    if (tables_.cubes) return fillCubes();
    if (tables_.dense && feature == Feature::kF1) return fillDense();
    const int ty = tables_.tile[1], tz = tables_.tile[2];
    for (int z = 0; z < block_.slices; z += tz)
      for (int y = 0; y < block_.rows; y += ty)
        for (int x = 0; x < block_.width; x += kTileX) {
          const float safe = findNear(x, y, z, feature != Feature::kF1);
          if (fillTile(feature, x, y, z) <= safe) continue;
          // Some sample's point may be farther than those that were looked at.
          collect(kCellReach, feature != Feature::kF1);
          fillTile(feature, x, y, z);
        }
  }

 private:
  void fillCubes() {
    const CellCubes::Output to{out_, outStride_, block_.rows, weight_, bias_, add_};
    const auto tile = [&](int x, int y, int z) HWY_ATTR {
      return cubes_.fillTile(x, y, z, {{near_[0], near_[1], near_[2]}, nearCount_}, to);
    };
    for (int z = 0; z < block_.slices; z += kTileMost)
      for (int y = 0; y < block_.rows; y += kTileMost)
        for (int x = 0; x < block_.width; x += kTileX) {
          const float safe = findNear(x, y, z, false);
          if (tile(x, y, z) <= safe) continue;
          collect(kCellReach, false);
          tile(x, y, z);
        }
  }

  const CellPlaces& axis(int a) const { return tables_.axis[a]; }
  int first(int a) const { return a == 0 ? block_.x : a == 1 ? block_.y : block_.z; }
  int samples(int a) const { return a == 0 ? block_.width : a == 1 ? block_.rows : block_.slices; }

  // Places of the feature points in all cells of the block and kCellReach around, each within its cell.
  void makePoints(Scratch& scratch) {
    const CellLattice& lattice = *tables_.lattice;
    std::uint32_t* hashes[3] = {};
    for (int a = 0; a < 3; ++a) {
      const bool flat = a >= lattice.axes();
      reach_[a] = flat ? 0 : kCellReach;
      const int begin = flat ? 0 : axis(a).cell[first(a)];
      const int end = flat ? 0 : axis(a).cell[first(a) + samples(a) - 1];
      origin_[a] = begin - reach_[a];
      count_[a] = end - begin + 1 + 2 * reach_[a];
      hashes[a] = scratch.take<std::uint32_t>(static_cast<std::size_t>(padded(count_[a] + kTileX)));
      for (int i = 0; i < count_[a]; ++i)
        hashes[a][i] =
            flat ? 0 : lattice.axis(a).hash(lattice.axis(a).moved(axis(a).index[first(a)], i - reach_[a]));
    }
    // A vector may reach over the last cell.
    stride_ = count_[0] + kTileX;
    const std::size_t most = static_cast<std::size_t>(stride_) * count_[1] * count_[2] + kTileX;
    for (int a = 0; a < lattice.axes(); ++a) points_[a] = scratch.take<float>(most);
    const DU du;
    const D d;
    for (int k = 0; k < count_[2]; ++k)
      for (int j = 0; j < count_[1]; ++j) {
        const std::uint32_t row = hashes[1][j] + hashes[2][k];
        const std::size_t at = rowAt(j, k);
        if (lattice.moves()) {
          for (int i = 0; i < count_[0]; ++i) {
            const FeaturePlace p = lattice.place(hashes[0][i] + row);
            for (int a = 0; a < lattice.axes(); ++a) points_[a][at + i] = p.inside[a];
          }
        } else {
          for (int i = 0; i < count_[0]; i += kLanes) {
            const auto sum = hn::Add(hn::LoadU(du, hashes[0] + i), hn::Set(du, row));
            for (int a = 0; a < lattice.axes(); ++a) {
              const auto h = mixed(hn::Add(sum, hn::Set(du, CellLattice::kAxisStep * (a + 1u))));
              const auto upper = hn::ConvertTo(d, hn::BitCast(DI(), hn::ShiftRight<8>(h)));
              hn::StoreU(hn::Mul(upper, hn::Set(d, CellLattice::kUnit)), d, points_[a] + at + i);
            }
          }
        }
        // What stands behind the row's last cell is no point.
        for (int a = 0; a < lattice.axes(); ++a) std::fill_n(points_[a] + at + count_[0], kTileX, kFar);
      }
  }

  static HWY_INLINE hn::Vec<DU> mixed(hn::Vec<DU> h) {
    const DU du;
    h = hn::Xor(h, hn::ShiftRight<16>(h));
    h = hn::Mul(h, hn::Set(du, 0x85ebca6bu));
    h = hn::Xor(h, hn::ShiftRight<13>(h));
    h = hn::Mul(h, hn::Set(du, 0xc2b2ae35u));
    return hn::Xor(h, hn::ShiftRight<16>(h));
  }

  std::size_t rowAt(int j, int k) const {
    return (static_cast<std::size_t>(k) * count_[1] + j) * static_cast<std::size_t>(stride_);
  }

  // The box of a tile: its cells and the places of its first and last sample relative to the first's cell.
  struct Extent {
    int cell;   // of the first sample, in points_
    int cells;  // from there to the last sample's
    float lo, hi;
  };
  Extent extent(int a, int sample, int count) const {
    const CellPlaces& p = axis(a);
    const int begin = first(a) + sample, end = begin + count - 1;
    const int cells = p.cell[end] - p.cell[begin];
    return {p.cell[begin] - origin_[a], cells, p.inside[begin], static_cast<float>(cells) + p.inside[end]};
  }

  // A vector of points in one row of cells.
  struct Run {
    std::size_t from;  // in points_
    int cell[3];       // of its first, relative to the tile's first
  };

  // Finds the points that can matter among those in the cells beside the tile's, and returns the square of
  // the distance within which no others lie; where sums cannot be taken back, all points at once.
  float findNear(int x, int y, int z, bool second) {
    const bool solid = tables_.lattice->axes() == 3;
    box_[0] = extent(0, x, kTileX);
    box_[1] = extent(1, y, tables_.tile[1]);
    box_[2] = solid ? extent(2, z, tables_.tile[2]) : Extent{0, 0, 0.0f, 0.0f};
    // Points outside the cells beside the tile's are at least so far away.
    float margin = 1.0f;
    for (int a = 0; a < tables_.lattice->axes(); ++a)
      margin = std::min({margin, box_[a].lo, static_cast<float>(box_[a].cells + 1) - box_[a].hi});
    const float safe = (1.0f + std::max(margin, 0.0f)) * (1.0f + std::max(margin, 0.0f));
    if (collect(1, second) <= safe || !add_) return safe;
    collect(kCellReach, second);
    return enough();
  }

  // No sample's second point is farther (square).
  float enough() const { return tables_.lattice->axes() == 3 ? 3.0f : 2.0f; }

  // Collects the points that can matter among those at most `reach` cells from the tile's; returns the square
  // of the distance within which they lie.
  float collect(int reach, bool second) {
    const D d;
    const bool solid = tables_.lattice->axes() == 3;
    const int deep = solid ? reach : 0;
    const auto loX = hn::Set(d, box_[0].lo), hiX = hn::Set(d, box_[0].hi);
    const int across = box_[0].cells + 1 + 2 * reach;
    const auto zero = hn::Zero(d), far = hn::Set(d, kFar);
    auto first = far, next = far;  // least and second least of the greatest distances' squares, by lane
    std::size_t runs = 0;
    for (int k = -deep; k <= box_[2].cells + deep; ++k)
      for (int j = -reach; j <= box_[1].cells + reach; ++j) {
        const std::size_t at = rowAt(box_[1].cell + j, box_[2].cell + k);
        for (int i = 0; i < across; i += kLanes) {
          const std::size_t from = at + static_cast<std::size_t>(box_[0].cell - reach + i);
          const auto px =
              hn::Add(hn::LoadU(d, points_[0] + from), hn::Iota(d, static_cast<float>(i - reach)));
          auto nearest = hn::Max(hn::Max(hn::Sub(loX, px), hn::Sub(px, hiX)), zero);
          auto farthest = hn::Max(hn::Sub(hiX, px), hn::Sub(px, loX));
          nearest = hn::Mul(nearest, nearest);
          farthest = hn::Mul(farthest, farthest);
          addAxis(1, from, j, nearest, farthest);
          if (solid) addAxis(2, from, k, nearest, farthest);
          next = hn::Min(next, hn::Max(first, farthest));
          first = hn::Min(first, farthest);
          hn::StoreU(nearest, d, away_ + runs * std::size_t{kLanes});
          runs_[runs++] = {from, {i - reach, j, k}};
        }
      }
    float limit = hn::GetLane(hn::MinOfLanes(d, first));
    if (second) {
      // The second least of all lanes: at most one lane's least is the least of all.
      const auto rest = hn::IfThenElse(hn::Eq(first, hn::Set(d, limit)), next, first);
      limit = hn::GetLane(hn::MinOfLanes(d, rest));
    }
    limit = std::min(limit, enough()) * 1.00001f;

    const auto most = hn::Set(d, limit);
    nearCount_ = 0;
    for (std::size_t v = 0; v < runs; ++v) {
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, hn::Le(hn::LoadU(d, away_ + v * std::size_t{kLanes}), most), bits);
      const Run& run = runs_[v];
      // Without branches, which nobody could predict: all lanes are written, those to keep first.
      const auto order = hn::SetTableIndices(d, kKeepFirst[bits[0] & ((1 << kLanes) - 1)].data());
      const auto keep = [&](int a, V plus) HWY_ATTR {
        const auto place = hn::Add(hn::LoadU(d, points_[a] + run.from), plus);
        hn::StoreU(hn::TableLookupLanes(place, order), d, near_[a] + nearCount_);
      };
      keep(0, hn::Iota(d, static_cast<float>(run.cell[0])));
      keep(1, hn::Set(d, static_cast<float>(run.cell[1])));
      if (solid) keep(2, hn::Set(d, static_cast<float>(run.cell[2])));
      nearCount_ += std::popcount(static_cast<unsigned>(bits[0]));
    }
    // Far points, so that loops over these may take two or a vector at a time.
    for (auto& q : near_) hn::StoreU(far, d, q + nearCount_);
    nearCount_ += nearCount_ % 2;
    return limit;
  }

  HWY_INLINE V placeOn(int a, std::size_t from, int cell) const {
    const D d;
    return hn::Add(hn::LoadU(d, points_[a] + from), hn::Set(d, static_cast<float>(cell)));
  }
  HWY_INLINE void addAxis(int a, std::size_t from, int cell, V& nearest, V& farthest) const {
    const D d;
    const auto p = placeOn(a, from, cell);
    const auto below = hn::Sub(hn::Set(d, box_[a].lo), p), above = hn::Sub(p, hn::Set(d, box_[a].hi));
    const auto near = hn::Max(hn::Max(below, above), hn::Zero(d));
    const auto far = hn::Max(hn::Sub(hn::Set(d, box_[a].hi), p), hn::Sub(p, hn::Set(d, box_[a].lo)));
    nearest = hn::MulAdd(near, near, nearest);
    farthest = hn::MulAdd(far, far, farthest);
  }
  // Samples at least an eighth of a cell apart: a vector spans a cell or more, and boxes leave too many
  // points. Every lane looks at the 27 (9) cells around its own. What the lanes see of these is gathered once
  // for all rows in one cell, and the distances in x and y once for all slices.
  void fillDense() {
    const DI di;
    const D d;
    const bool solid = tables_.lattice->axes() == 3;
    const CellPlaces& px = axis(0);
    HWY_ALIGN std::int32_t lane[kTileX];
    for (int x = 0; x < block_.width; x += kLanes) {
      const std::int32_t* cell = px.cell + block_.x + x;
      hn::Store(hn::Sub(hn::LoadU(di, cell), hn::Set(di, cell[0])), di, lane);
      const auto ux = hn::LoadU(d, px.inside + block_.x + x);
      for (int z = 0, z1 = 0; z < block_.slices; z = z1) {
        z1 = solid ? sameCell(2, z) : 1;
        for (int y = 0, y1 = 0; y < block_.rows; y = y1) {
          y1 = sameCell(1, y);
          gatherAround(cell[0] - origin_[0], lane, axis(1).cell[block_.y + y] - origin_[1],
                       solid ? axis(2).cell[block_.z + z] - origin_[2] : 0, ux);
          keepNear(rangeOf(1, y, y1), solid ? rangeOf(2, z, z1) : Range{0.0f, 0.0f});
          for (int r = y; r < y1; ++r) fillRows(x, r, z, z1);
        }
      }
    }
  }

  // The end of the run of samples in one cell that begins with sample i.
  int sameCell(int a, int i) const {
    const std::int32_t* cell = axis(a).cell + first(a);
    int end = i + 1;
    while (end < samples(a) && cell[end] == cell[i]) ++end;
    return end;
  }

  void gatherAround(int cellX, const std::int32_t* lane, int cellY, int cellZ, V ux) {
    const D d;
    const bool solid = tables_.lattice->axes() == 3;
    const bool near =
        lane[kLanes - 1] + 2 < kLanes;  // one vector holds all points that the lanes see in a row
    // Which point of that vector each lane sees in the cell before its own, in its own and in the one after.
    decltype(hn::IndicesFromVec(d, hn::Zero(DI()))) seen[3];
    for (int i = 0; i < 3; ++i) {
      const auto index = hn::Add(hn::Load(DI(), lane), hn::Set(DI(), i));
      seen[i] = hn::IndicesFromVec(d, near ? index : hn::Zero(DI()));
    }
    around_ = 0;
    for (int k = solid ? -1 : 0; k <= (solid ? 1 : 0); ++k)
      for (int j = -1; j <= 1; ++j) {
        const std::size_t at = rowAt(cellY + j, cellZ + k) + static_cast<std::size_t>(cellX);
        for (int i = -1; i <= 1; ++i, ++around_) {
          V p[3];
          for (int a = 0; a < tables_.lattice->axes(); ++a) {
            if (near) {
              p[a] = hn::TableLookupLanes(hn::LoadU(d, points_[a] + at - 1), seen[i + 1]);
            } else {
              HWY_ALIGN float value[kTileX];
              for (int l = 0; l < kLanes; ++l)
                value[l] = points_[a][at + static_cast<std::size_t>(lane[l]) + i];
              p[a] = hn::Load(d, value);
            }
          }
          const auto dx = hn::Sub(hn::Add(p[0], hn::Set(d, static_cast<float>(i))), ux);
          hn::Store(hn::Mul(dx, dx), d, aroundX_ + around_ * kLanes);
          hn::Store(hn::Add(p[1], hn::Set(d, static_cast<float>(j))), d, aroundY_ + around_ * kLanes);
          if (solid)
            hn::Store(hn::Add(p[2], hn::Set(d, static_cast<float>(k))), d, aroundZ_ + around_ * kLanes);
        }
      }
  }

  // Places within their cell of the samples from i to before end.
  struct Range {
    float lo, hi;
  };
  Range rangeOf(int a, int i, int end) const {
    return {axis(a).inside[first(a) + i], axis(a).inside[first(a) + end - 1]};
  }

  // Of the points around, keeps those that are the nearest of some lane for some place in the ranges, if only
  // by bounds; the last is repeated to make their number even.
  void keepNear(Range y, Range z) {
    const D d;
    const bool solid = tables_.lattice->axes() == 3;
    HWY_ALIGN float least[27 * kTileX];
    auto most = hn::Set(d, kFar);  // some point is within this of all places
    const auto addBounds = [&](const float* places, Range range, V& nearest, V& farthest) HWY_ATTR {
      const auto p = hn::Load(d, places), lo = hn::Set(d, range.lo), hi = hn::Set(d, range.hi);
      const auto near = hn::Max(hn::Max(hn::Sub(lo, p), hn::Sub(p, hi)), hn::Zero(d));
      const auto far = hn::Max(hn::Sub(hi, p), hn::Sub(p, lo));
      nearest = hn::MulAdd(near, near, nearest);
      farthest = hn::MulAdd(far, far, farthest);
    };
    for (int q = 0; q < around_; ++q) {
      auto nearest = hn::Load(d, aroundX_ + q * kLanes), farthest = nearest;
      addBounds(aroundY_ + q * kLanes, y, nearest, farthest);
      if (solid) addBounds(aroundZ_ + q * kLanes, z, nearest, farthest);
      hn::Store(nearest, d, least + q * kLanes);
      most = hn::Min(most, farthest);
    }
    most = hn::Mul(most, hn::Set(d, 1.00001f));
    int kept = 0;
    const auto move = [&](int q) HWY_ATTR {
      for (float* around : {aroundX_, aroundY_, aroundZ_})
        hn::Store(hn::Load(d, around + q * kLanes), d, around + kept * kLanes);
    };
    for (int q = 0; q < around_; ++q) {
      const bool keep = !hn::AllFalse(d, hn::Le(hn::Load(d, least + q * kLanes), most));
      move(q);
      kept += keep ? 1 : 0;
    }
    if (kept % 2 != 0) {
      move(kept - 1);
      ++kept;
    }
    around_ = kept;
  }

  // Row r of the slices z to z1, which lie in one cell.
  HWY_INLINE void fillRows(int x, int r, int z, int z1) {
    const D d;
    const bool solid = tables_.lattice->axes() == 3;
    HWY_ALIGN float flat[28 * kTileX];  // squares of the distances in x and y
    const auto uy = hn::Set(d, axis(1).inside[block_.y + r]);
    auto least = hn::Set(d, kFar);
    for (int q = 0; q < around_; ++q) {
      const auto dy = hn::Sub(hn::Load(d, aroundY_ + q * kLanes), uy);
      const auto square = hn::MulAdd(dy, dy, hn::Load(d, aroundX_ + q * kLanes));
      least = hn::Min(least, square);
      hn::Store(square, d, flat + q * kLanes);
    }
    for (int s = z; s < z1; ++s) {
      if (solid) {
        const auto uz = hn::Set(d, axis(2).inside[block_.z + s]);
        auto other = least = hn::Set(d, kFar);  // two chains
        for (int q = 0; q < around_; q += 2) {
          const auto dz0 = hn::Sub(hn::Load(d, aroundZ_ + q * kLanes), uz);
          const auto dz1 = hn::Sub(hn::Load(d, aroundZ_ + (q + 1) * kLanes), uz);
          least = hn::Min(least, hn::MulAdd(dz0, dz0, hn::Load(d, flat + q * kLanes)));
          other = hn::Min(other, hn::MulAdd(dz1, dz1, hn::Load(d, flat + (q + 1) * kLanes)));
        }
        least = hn::Min(least, other);
      }
      auto value = hn::Sqrt(least);
      // Points beyond the cells around are farther than 1; so, rarely, is the nearest of these.
      if (!hn::AllTrue(d, hn::Le(least, hn::Set(d, 1.0f)))) value = exactly(x, r, s, value);
      float* out = out_ + (static_cast<std::ptrdiff_t>(s) * block_.rows + r) * outStride_ + x;
      const auto sum = add_ ? hn::LoadU(d, out) : hn::Set(d, bias_);
      hn::StoreU(hn::MulAdd(hn::Set(d, weight_), value, sum), d, out);
    }
  }

  // The lanes whose value is above 1, from all points within kCellReach.
  HWY_NOINLINE V exactly(int x, int r, int s, V values) const {
    const D d;
    const bool solid = tables_.lattice->axes() == 3;
    HWY_ALIGN float value[kTileX];
    hn::Store(values, d, value);
    const int deep = solid ? kCellReach : 0;
    const int at[3] = {block_.x + x, block_.y + r, block_.z + s};
    for (int l = 0; l < kLanes; ++l) {
      if (value[l] <= 1.0f) continue;
      float least = value[l] * value[l];
      for (int k = -deep; k <= deep; ++k)
        for (int j = -kCellReach; j <= kCellReach; ++j)
          for (int i = -kCellReach; i <= kCellReach; ++i) {
            const int step[3] = {i, j, k};
            const std::size_t from = rowAt(axis(1).cell[at[1]] - origin_[1] + j,
                                           solid ? axis(2).cell[at[2]] - origin_[2] + k : 0) +
                                     static_cast<std::size_t>(axis(0).cell[at[0] + l] - origin_[0] + i);
            float square = 0.0f;
            for (int a = 0; a < tables_.lattice->axes(); ++a) {
              const float away =
                  points_[a][from] + static_cast<float>(step[a]) - axis(a).inside[at[a] + (a == 0 ? l : 0)];
              square += away * away;
            }
            least = std::min(least, square);
          }
      value[l] = std::sqrt(least);
    }
    return hn::Load(d, value);
  }

  // Place of a sample relative to the tile's first cell.
  float inTile(int a, int sample, int tile) const {
    const CellPlaces& p = axis(a);
    return static_cast<float>(p.cell[first(a) + sample] - p.cell[first(a) + tile]) +
           p.inside[first(a) + sample];
  }

  // Squares of the distances on one axis from the points that matter to the samples of the tile: most_ a
  // sample.
  HWY_INLINE void squaresOn(int a, int tile, float* out) const {
    const D d;
    for (int i = 0; i < tables_.tile[a]; ++i, out += most_) {
      const auto p = hn::Set(d, inTile(a, tile + i, tile));
      for (int q = 0; q < nearCount_; q += kLanes) {
        const auto away = hn::Sub(hn::LoadU(d, near_[a] + q), p);
        hn::Store(hn::Mul(away, away), d, out + q);
      }
    }
  }

  // Returns the square of the greatest distance that decided over a sample.
  float fillTile(Feature feature, int x, int y, int z) {
    switch (feature) {
      case Feature::kF1:
        return fillTileAs<Feature::kF1>(x, y, z);
      case Feature::kF2:
        return fillTileAs<Feature::kF2>(x, y, z);
      case Feature::kF2MinusF1:
        break;
    }
    return fillTileAs<Feature::kF2MinusF1>(x, y, z);
  }

  template <Feature kFeature>
  HWY_INLINE float fillTileAs(int x, int y, int z) {
    const D d;
    const DI di;
    const bool solid = tables_.lattice->axes() == 3;
    const int rows = tables_.tile[1];
    const auto anchor = hn::Set(di, axis(0).cell[block_.x + x]);
    auto greatest = hn::Zero(d);
    most_ = (nearCount_ + kLanes - 1) / kLanes * kLanes;
    squaresOn(1, y, alongY_);
    if (solid) squaresOn(2, z, alongZ_);
    for (int i = 0; i < kTileX; i += kLanes) {
      const auto cells = hn::Sub(hn::LoadU(di, axis(0).cell + block_.x + x + i), anchor);
      const auto px = hn::Add(hn::ConvertTo(d, cells), hn::LoadU(d, axis(0).inside + block_.x + x + i));
      for (int q = 0; q < nearCount_; ++q) {
        const auto dx = hn::Sub(hn::Set(d, near_[0][q]), px);
        hn::Store(hn::Mul(dx, dx), d, alongX_ + q * kLanes);
      }
      for (int s = 0; s < tables_.tile[2]; ++s) {
        const float* HWY_RESTRICT beside = alongY_;
        if (solid) {
          // All rows before the first is needed: what is stored as vectors is read number by number.
          for (int q = 0; q < nearCount_; q += kLanes) {
            const auto dz = hn::Load(d, alongZ_ + s * most_ + q);
            for (int r = 0; r < rows; ++r)
              hn::Store(hn::Add(hn::Load(d, alongY_ + r * most_ + q), dz), d, beside_ + r * most_ + q);
          }
          beside = beside_;
        }
        float* out = out_ + (static_cast<std::ptrdiff_t>(z + s) * block_.rows + y) * outStride_ + x + i;
        for (int r = 0; r < rows; r += 4, out += std::ptrdiff_t{4} * outStride_) {
          // Four rows share the loads; in a tile of fewer some are done in vain.
          const float* HWY_RESTRICT of[4];
          for (int k = 0; k < 4; ++k) of[k] = beside + std::min(r + k, rows - 1) * most_;
          V first[4], second[4];
          for (int k = 0; k < 4; ++k) first[k] = second[k] = hn::Set(d, kFar);
          for (int q = 0; q < nearCount_; q += 2)
            for (int p = q; p < q + 2; ++p) {
              const auto dx = hn::Load(d, alongX_ + p * kLanes);
              for (int k = 0; k < 4; ++k) {
                const auto square = hn::Add(dx, hn::Set(d, of[k][p]));
                if constexpr (kFeature != Feature::kF1)
                  second[k] = hn::Min(second[k], hn::Max(first[k], square));
                first[k] = hn::Min(first[k], square);
              }
            }
          for (int k = 0; k < 4; ++k) {
            greatest = hn::Max(greatest, kFeature == Feature::kF1 ? first[k] : second[k]);
            if (r + k < rows)
              put<kFeature>(first[k], second[k], out + static_cast<std::ptrdiff_t>(k) * outStride_);
          }
        }
      }
    }
    return hn::GetLane(hn::MaxOfLanes(d, greatest));
  }

  template <Feature kFeature>
  HWY_INLINE void put(V first, V second, float* out) const {
    const D d;
    auto value = hn::Sqrt(kFeature == Feature::kF2 ? second : first);
    if constexpr (kFeature == Feature::kF2MinusF1) value = hn::Sub(hn::Sqrt(second), value);
    const auto sum = add_ ? hn::LoadU(d, out) : hn::Set(d, bias_);
    hn::StoreU(hn::MulAdd(hn::Set(d, weight_), value, sum), d, out);
  }

  static constexpr float kFar = 1e9f;

  const CellTables& tables_;
  const Block block_;
  CellCubes cubes_;
  int origin_[3], count_[3], reach_[3], stride_ = 0;  // of the cells whose points are known
  float* points_[3] = {};                             // within their cells
  Extent box_[3];
  float* near_[3];  // the points that matter in the tile, relative to its first cell
  int nearCount_ = 0;
  Run* runs_;
  // Squares of distances of the points that matter: to a vector of samples in x; to the rows in y and the
  // slices in z, most_ apart; to the rows of a slice in y and z.
  float *alongX_, *alongY_, *alongZ_, *beside_;
  std::ptrdiff_t most_ = 0;
  float* away_;     // of each, the square of the distance beside x
  int around_ = 0;  // points around the cells of a vector: the squares of their distances in x, their y and z
  HWY_ALIGN float aroundX_[28 * kTileX], aroundY_[28 * kTileX], aroundZ_[28 * kTileX];
  float* out_ = nullptr;
  int outStride_ = 0;
  float weight_ = 1.0f, bias_ = 0.0f;
  bool add_ = false;
};

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
