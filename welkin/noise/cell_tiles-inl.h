// SPDX-License-Identifier: Apache-2.0
// Blocks of cellular noise. Compiled for every instruction set.
//
// A block is cut into tiles of 8 samples along x by a few rows and slices, small against a cell. For each
// tile the feature points that can be nearest to any of its samples are found first (cell_near-inl.h). Some
// four are left of 27 or more, and the samples look at these alone. The result is exact.
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
#include <cmath>
#include <cstdint>

#include "welkin/noise/cell_cubes-inl.h"
#include "welkin/noise/cell_near-inl.h"
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
    // The points around a tile.
    std::size_t most = 1;
    for (int a = 0; a < 3; ++a) most *= static_cast<std::size_t>(mostCells(a) + 2 * reach_[a]);
    most = (most + kTileX - 1) / kTileX * kTileX;
    for (NearPoints* points : {&around_, &near_})
      for (float*& p : points->place) p = scratch.take<float>(most + 2 * kLanes);
    squares_ = scratch.take<float>(most + kLanes);
    if (tables.cubes) {
      cubes_ = CellCubes(tables, block, most, scratch);
      return;
    }
    for (float*& along : along_) along = scratch.take<float>(most * kTileMost);
    beside_ = scratch.take<float>(most * kTileMost);
    for (int a = 0; a < tables.lattice->axes(); ++a) {
      const CellPlaces& p = axis(a);
      const int tile = tables.tile[a];
      inTile_[a] = scratch.take<float>(static_cast<std::size_t>(samples(a) + kTileMost));
      for (int i = 0; i < samples(a); ++i) {
        const int at = first(a) + i;
        inTile_[a][i] = static_cast<float>(p.cell[at] - p.cell[at - i % tile]) + p.inside[at];
      }
      std::fill_n(inTile_[a] + samples(a), kTileMost, 0.0f);
    }
  }

  void fill(Feature feature, const CellOutput& to) {
    to_ = to;
    if (tables_.cubes) return fillCubes();
    if (tables_.dense && feature == Feature::kF1) return fillDense();
    const int ty = tables_.tile[1], tz = tables_.tile[2];
    for (int x = 0; x < block_.width; x += kTileX)
      for (int z = 0; z < block_.slices; z += tz)
        for (int y = 0; y < block_.rows; y += ty) {
          const float safe = findNear(x, y, z, feature != Feature::kF1);
          if (fillTile(feature, x, y, z) <= safe) continue;
          // Some sample's point may be farther than those that were looked at.
          collect(kCellReach, feature != Feature::kF1);
          fillTile(feature, x, y, z);
        }
  }

 private:
  void fillCubes() {
    const CellOutput to = to_;
    const auto tile = [&](int x, int y, int z) HWY_ATTR { return cubes_.fillTile(x, y, z, near_, to); };
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

  // Cells that a tile lies in at most.
  int mostCells(int a) const {
    if (a >= tables_.lattice->axes()) return 1;
    const std::int32_t* cell = axis(a).cell + first(a);
    int most = 0;
    for (int i = 0, tile = tables_.tile[a]; i < samples(a); i += tile)
      most = std::max(most, cell[i + tile - 1] - cell[i] + 1);
    return most;
  }

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
    if (collect(1, second) <= safe || !to_.add) return safe;
    collect(kCellReach, second);
    return kFar;
  }

  // Collects the points that can matter among those at most `reach` cells from the tile's; returns the square
  // of the distance within which they lie.
  float collect(int reach, bool second) {
    gather(reach);
    return tables_.lattice->axes() == 3 ? collectAs<3>(second) : collectAs<2>(second);
  }

  template <int kAxes>
  HWY_INLINE float collectAs(bool second) {
    NearBox box;
    for (int a = 0; a < kAxes; ++a) box.lo[a] = box_[a].lo, box.hi[a] = box_[a].hi;
    NearSearch<kAxes> search(box, squares_);
    search.keep(around_, second, near_);
    return to_.add ? search.bound(around_, second) : 0.0f;
  }

  // The cells of a tile and how far around.
  struct Gathered {
    int reach = -1, first[3] = {}, more[3] = {};
    bool operator==(const Gathered&) const = default;
  };

  // Places of all points at most `reach` cells from the tile's, relative to its first.
  void gather(int reach) {
    const D d;
    // Tiles one after the other often lie in the same cells.
    const Gathered cells{
        reach, {box_[0].cell, box_[1].cell, box_[2].cell}, {box_[0].cells, box_[1].cells, box_[2].cells}};
    if (cells == gathered_) return;
    gathered_ = cells;
    const int deep = tables_.lattice->axes() == 3 ? reach : 0, across = box_[0].cells + 1 + 2 * reach;
    int count = 0;
    for (int k = -deep; k <= box_[2].cells + deep; ++k)
      for (int j = -reach; j <= box_[1].cells + reach; ++j) {
        const std::size_t at =
            rowAt(box_[1].cell + j, box_[2].cell + k) + static_cast<std::size_t>(box_[0].cell - reach);
        const auto y = hn::Set(d, static_cast<float>(j)), z = hn::Set(d, static_cast<float>(k));
        for (int i = 0; i < across; i += kLanes) {
          const auto put = [&](int a, V cell) HWY_ATTR {
            hn::StoreU(hn::Add(hn::LoadU(d, points_[a] + at + i), cell), d, around_.place[a] + count + i);
          };
          put(0, hn::Iota(d, static_cast<float>(i - reach)));
          put(1, y);
          if (deep > 0) put(2, z);
        }
        count += across;
      }
    around_.count = count;
    for (int a = 0; a < tables_.lattice->axes(); ++a)
      hn::StoreU(hn::Set(d, kFar), d, around_.place[a] + count);
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
    seen_ = 0;
    for (int k = solid ? -1 : 0; k <= (solid ? 1 : 0); ++k)
      for (int j = -1; j <= 1; ++j) {
        const std::size_t at = rowAt(cellY + j, cellZ + k) + static_cast<std::size_t>(cellX);
        for (int i = -1; i <= 1; ++i, ++seen_) {
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
          hn::Store(hn::Mul(dx, dx), d, seenX_ + seen_ * kLanes);
          hn::Store(hn::Add(p[1], hn::Set(d, static_cast<float>(j))), d, seenY_ + seen_ * kLanes);
          if (solid) hn::Store(hn::Add(p[2], hn::Set(d, static_cast<float>(k))), d, seenZ_ + seen_ * kLanes);
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
    for (int q = 0; q < seen_; ++q) {
      auto nearest = hn::Load(d, seenX_ + q * kLanes), farthest = nearest;
      addBounds(seenY_ + q * kLanes, y, nearest, farthest);
      if (solid) addBounds(seenZ_ + q * kLanes, z, nearest, farthest);
      hn::Store(nearest, d, least + q * kLanes);
      most = hn::Min(most, farthest);
    }
    most = hn::Mul(most, hn::Set(d, 1.00001f));
    int kept = 0;
    const auto move = [&](int q) HWY_ATTR {
      for (float* around : {seenX_, seenY_, seenZ_})
        hn::Store(hn::Load(d, around + q * kLanes), d, around + kept * kLanes);
    };
    for (int q = 0; q < seen_; ++q) {
      const bool keep = !hn::AllFalse(d, hn::Le(hn::Load(d, least + q * kLanes), most));
      move(q);
      kept += keep ? 1 : 0;
    }
    if (kept % 2 != 0) {
      move(kept - 1);
      ++kept;
    }
    seen_ = kept;
  }

  // Row r of the slices z to z1, which lie in one cell.
  HWY_INLINE void fillRows(int x, int r, int z, int z1) {
    const D d;
    const bool solid = tables_.lattice->axes() == 3;
    HWY_ALIGN float flat[28 * kTileX];  // squares of the distances in x and y
    const auto uy = hn::Set(d, axis(1).inside[block_.y + r]);
    auto least = hn::Set(d, kFar);
    for (int q = 0; q < seen_; ++q) {
      const auto dy = hn::Sub(hn::Load(d, seenY_ + q * kLanes), uy);
      const auto square = hn::MulAdd(dy, dy, hn::Load(d, seenX_ + q * kLanes));
      least = hn::Min(least, square);
      hn::Store(square, d, flat + q * kLanes);
    }
    for (int s = z; s < z1; ++s) {
      if (solid) {
        const auto uz = hn::Set(d, axis(2).inside[block_.z + s]);
        auto other = least = hn::Set(d, kFar);  // two chains
        for (int q = 0; q < seen_; q += 2) {
          const auto dz0 = hn::Sub(hn::Load(d, seenZ_ + q * kLanes), uz);
          const auto dz1 = hn::Sub(hn::Load(d, seenZ_ + (q + 1) * kLanes), uz);
          least = hn::Min(least, hn::MulAdd(dz0, dz0, hn::Load(d, flat + q * kLanes)));
          other = hn::Min(other, hn::MulAdd(dz1, dz1, hn::Load(d, flat + (q + 1) * kLanes)));
        }
        least = hn::Min(least, other);
      }
      auto value = hn::Sqrt(least);
      // Points beyond the cells around are farther than 1; so, rarely, is the nearest of these.
      if (!hn::AllTrue(d, hn::Le(least, hn::Set(d, 1.0f)))) value = exactly(x, r, s, value);
      to_.put(d, value, to_.at(x, r, s));
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

  // Squares of the distances on one axis from the points that matter to the samples of the tile: kTileMost a
  // point.
  HWY_INLINE void squaresOn(int a, int tile) const {
    const D d;
    const float* HWY_RESTRICT near = near_.place[a];
    float* HWY_RESTRICT out = along_[a];
    for (int v = 0; v < kTileMost; v += kLanes) {
      const auto p = hn::LoadU(d, inTile_[a] + tile + v);
      for (int q = 0, count = near_.count; q < count; ++q) {
        const auto away = hn::Sub(hn::Set(d, near[q]), p);
        hn::Store(hn::Mul(away, away), d, out + q * kTileMost + v);
      }
    }
  }

  // Returns the square of the greatest distance that decided over a sample.
  float fillTile(Feature feature, int x, int y, int z) {
    const bool few = tables_.tile[1] <= 4;
    switch (feature) {
      case Feature::kF1:
        return few ? fillTileAs<Feature::kF1, 4>(x, y, z) : fillTileAs<Feature::kF1, 8>(x, y, z);
      case Feature::kF2:
        return fillTileAs<Feature::kF2, 4>(x, y, z);
      case Feature::kF2MinusF1:
        break;
    }
    return fillTileAs<Feature::kF2MinusF1, 4>(x, y, z);
  }

  // kRows rows share the loads; in a tile of fewer some are done in vain.
  template <Feature kFeature, int kRows>
  HWY_INLINE float fillTileAs(int x, int y, int z) {
    const D d;
    const bool solid = tables_.lattice->axes() == 3;
    const int rows = tables_.tile[1], slices = tables_.tile[2], count = near_.count;
    const CellOutput to = to_;
    squaresOn(0, x);
    squaresOn(1, y);
    if (solid) squaresOn(2, z);
    const float* HWY_RESTRICT const alongX = along_[0];
    const float* HWY_RESTRICT const alongY = along_[1];
    const float* HWY_RESTRICT const alongZ = along_[2];
    auto greatest = hn::Zero(d);
    for (int s = 0; s < slices; ++s) {
      const float* HWY_RESTRICT beside = alongY;
      if (solid) {
        // All rows before the first is needed: what is stored as vectors is read number by number.
        for (int q = 0; q < count; ++q) {
          const auto dz = hn::Set(d, alongZ[q * kTileMost + s]);
          for (int v = 0; v < kTileMost; v += kLanes)
            hn::Store(hn::Add(hn::Load(d, alongY + q * kTileMost + v), dz), d, beside_ + q * kTileMost + v);
        }
        beside = beside_;
      }
      for (int i = 0; i < kTileX; i += kLanes)
        for (int r = 0; r < rows; r += kRows) {
          V first[kRows], second[kRows];
          for (int k = 0; k < kRows; ++k) first[k] = second[k] = hn::Set(d, kFar);
          for (int q = 0; q < count; ++q) {
            const auto dx = hn::Load(d, alongX + q * kTileMost + i);
            const float* HWY_RESTRICT row = beside + q * kTileMost + r;
            for (int k = 0; k < kRows; ++k) {
              const auto square = hn::Add(dx, hn::Set(d, row[k]));
              if constexpr (kFeature != Feature::kF1)
                second[k] = hn::Min(second[k], hn::Max(first[k], square));
              first[k] = hn::Min(first[k], square);
            }
          }
          float* out = to.at(x + i, y + r, z + s);
          for (int k = 0; k < kRows; ++k, out += to.row) {
            if (kRows < kTileMost && r + k >= rows) break;
            greatest = hn::Max(greatest, kFeature == Feature::kF1 ? first[k] : second[k]);
            to.put(d, value<kFeature>(first[k], second[k]), out);
          }
        }
    }
    return hn::GetLane(hn::MaxOfLanes(d, greatest));
  }

  template <Feature kFeature>
  static HWY_INLINE V value(V first, V second) {
    const auto distance = hn::Sqrt(kFeature == Feature::kF2 ? second : first);
    return kFeature == Feature::kF2MinusF1 ? hn::Sub(hn::Sqrt(second), distance) : distance;
  }

  const CellTables& tables_;
  const Block block_;
  CellCubes cubes_;
  int origin_[3], count_[3], reach_[3], stride_ = 0;  // of the cells whose points are known
  float* points_[3] = {};                             // within their cells
  Extent box_[3];
  Gathered gathered_;
  NearPoints around_,
      near_;               // relative to the tile's first cell: the points about it, those that matter in it
  float* squares_;         // of distances, of the points about the tile
  float* inTile_[3] = {};  // by axis, places of samples relative to their tile's first cell
  // Squares of distances of the points that matter, kTileMost a point: on each axis to the tile's samples; to
  // the rows of a slice in y and z.
  float *along_[3] = {}, *beside_;
  int seen_ = 0;  // points around the cells of a vector: the squares of their distances in x, their y and z
  HWY_ALIGN float seenX_[28 * kTileX], seenY_[28 * kTileX], seenZ_[28 * kTileX];
  CellOutput to_{};
};

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
