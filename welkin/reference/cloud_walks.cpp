// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/cloud_walks.h"

// This file once for each target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "welkin/reference/cloud_walks.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "welkin/reference/cloud_density-inl.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::reference::HWY_NAMESPACE {
namespace {

using Each = CloudLanes::Each<float>;

HWY_INLINE VF load(const Each& from, std::size_t at) {
  return hn::Load(Floats(), from.data() + at);
}
HWY_INLINE VI load(const CloudLanes::Each<std::int32_t>& from, std::size_t at) {
  return hn::Load(Ints(), from.data() + at);
}
HWY_INLINE void store(VF v, Each& to, std::size_t at) {
  hn::Store(v, Floats(), to.data() + at);
}
HWY_INLINE void store(VI v, CloudLanes::Each<std::int32_t>& to, std::size_t at) {
  hn::Store(v, Ints(), to.data() + at);
}
HWY_INLINE LaneBits bitsOf(MF mask, std::size_t at) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Floats(), mask, bytes);
  LaneBits bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits << at;
}
HWY_INLINE MF maskOf(LaneBits bits, std::size_t at) {
  std::uint8_t bytes[8] = {};
  const LaneBits own = bits >> at;
  std::memcpy(bytes, &own, sizeof own);
  return hn::LoadMaskBits(Floats(), bytes);
}
// Of one vector of lanes.
HWY_INLINE LaneBits ownBits(LaneBits bits, std::size_t at) {
  return bits & (((LaneBits{1} << hn::Lanes(Floats())) - 1u) << at);
}
template <class F>
HWY_INLINE void eachBit(LaneBits bits, F&& f) {
  for (; bits != 0; bits &= bits - 1) f(static_cast<std::size_t>(std::countr_zero(bits)));
}

// Where boxes of a grid end.
struct Sides {
  VF low, high;
};
HWY_INLINE VF crossing(VF from, VF inverse, const Sides& sides) {
  const VF side = hn::IfThenElse(hn::Gt(inverse, all(0.0f)), sides.high, sides.low);
  return hn::IfThenElse(hn::Eq(inverse, all(0.0f)), all(1e30f), (side - from) * inverse);
}

HWY_INLINE VI whole(VF x, VI most) {
  const Ints di;
  return hn::Min(hn::Max(hn::ConvertTo(di, x), hn::Zero(di)), most);
}

// As MajorantGrid::blocked().
HWY_INLINE VI blockedOf(VI x, VI y, VI z, VI quads) {
  const VI block =
      hn::Add(hn::Mul(hn::Add(hn::Mul(hn::ShiftRight<1>(z), quads), hn::ShiftRight<2>(y)), quads),
              hn::ShiftRight<2>(x));
  const VI within =
      hn::Add(hn::Add(hn::ShiftLeft<4>(hn::And(z, allOf(1))), hn::ShiftLeft<2>(hn::And(y, allOf(3)))),
              hn::And(x, allOf(3)));
  return hn::Add(hn::ShiftLeft<5>(block), within);
}

}  // namespace

// One box on for each lane that walks, in three rounds over all of them: what a round is about to read is on
// its way to the nearest cache while the others are served. Those that reach a collision with the majorant
// are in `hit`, those that reach the end of their tile or piece in `out`, and in `deep` those that have an
// optical depth to look at.
void stepLanes(const MajorantGrid& grid, CloudLanes& w, LaneBits walking, LaneBits& hit, LaneBits& out,
               LaneBits& deep) {
  const Floats df;
  const Ints di;
  const std::size_t n = hn::Lanes(df);
  const MajorantGrid::Slices& slices = grid.slices();
  const float* steps = grid.steps().data();
  CloudLanes::Boxes& b = w.boxes;

  // Where each lane's brick is.
  for (std::size_t o = 0; o < kCloudLanes; o += n) {
    const LaneBits own = ownBits(walking, o);
    if (own == 0) continue;
    const VF ahead = load(w.t, o) + all(MajorantGrid::kNudgeM);
    const VF qx = load(w.from.x, o) + load(w.slope.x, o) * ahead,
             qy = load(w.from.y, o) + load(w.slope.y, o) * ahead,
             qz = load(w.from.z, o) + load(w.slope.z, o) * ahead;
    const VF brickM = load(w.brickM, o), perM = load(w.bricksPerM, o), tileX = load(w.tileX, o),
             tileY = load(w.tileY, o);
    const VI side = load(w.tileSide, o), lastBrick = hn::Sub(side, allOf(1));
    const VI x = whole((qx - tileX) * perM, lastBrick), y = whole((qy - tileY) * perM, lastBrick);
    const VI guide =
        whole((qz - all(slices.guideFromM)) * all(1.0f / MajorantGrid::kGuideM), allOf(slices.lastGuide));
    VI z = hn::GatherIndex(di, slices.guide.data(), guide);
    for (int i = 0; i < slices.mostInGuide; ++i) {
      const VF edge = hn::GatherIndex(df, slices.edges.data() + 1, z);
      const MF above = hn::And(hn::Le(edge, qz), hn::RebindMask(df, hn::Lt(z, allOf(slices.last))));
      z = hn::Sub(z, hn::VecFromMask(di, hn::RebindMask(di, above)));
    }
    store(x, b.x, o), store(y, b.y, o), store(z, b.z, o);
    store(blockedOf(x, y, z, hn::ShiftRight<2>(side)), b.brick, o);
    store(qx, b.at.x, o), store(qy, b.at.y, o), store(qz, b.at.z, o);
    const VF lowX = tileX + brickM * hn::ConvertTo(df, x), lowY = tileY + brickM * hn::ConvertTo(df, y);
    store(lowX, b.low.x, o), store(lowX + brickM, b.high.x, o);
    store(lowY, b.low.y, o), store(lowY + brickM, b.high.y, o);
    store(hn::GatherIndex(df, slices.edges.data(), z), b.low.z, o);
    store(hn::GatherIndex(df, slices.edges.data() + 1, z), b.high.z, o);
    eachBit(own, [&](std::size_t i) HWY_ATTR {
      hwy::Prefetch(&w.tile[i]->bricks[static_cast<std::size_t>(b.brick[i])]);
      hwy::Prefetch(&w.tile[i]->voxels[static_cast<std::size_t>(b.brick[i])]);
    });
  }

  // Their codes. Other threads write to these: they are read one by one.
  LaneBits divided = 0;
  eachBit(walking, [&](std::size_t i) HWY_ATTR {
    const MajorantGrid::Tile& tile = *w.tile[i];
    const auto brick = static_cast<std::size_t>(b.brick[i]), slice = static_cast<std::size_t>(b.z[i]);
    const std::uint16_t code = grid.brickCode(tile, brick, {b.x[i], b.y[i], b.z[i]});
    b.code[i] = code;
    if (code == MajorantGrid::kClear) {
      const MajorantGrid::Run run = tile.clear[slice];
      if (run.low < run.high) {
        b.low.x[i] = w.tileX[i], b.high.x[i] = w.tileX[i] + MajorantGrid::kTileM;
        b.low.y[i] = w.tileY[i], b.high.y[i] = w.tileY[i] + MajorantGrid::kTileM;
        b.low.z[i] = slices.edges[run.low], b.high.z[i] = slices.edges[run.high];
      }
    } else if (steps[code >> 8] - steps[code & 0xff] > tile.needless) {
      b.voxels[i] = grid.voxelCodes(tile, brick, slice);
      hwy::Prefetch(b.voxels[i]);
      divided |= LaneBits{1} << i;
    }
  });

  // The voxels of those that are divided, and on.
  hit = out = deep = 0;
  for (std::size_t o = 0; o < kCloudLanes; o += n) {
    if (ownBits(walking, o) == 0) continue;
    const MF walks = maskOf(walking, o);
    const VI z = load(b.z, o);
    Sides sx{load(b.low.x, o), load(b.high.x, o)}, sy{load(b.low.y, o), load(b.high.y, o)},
        sz{load(b.low.z, o), load(b.high.z, o)};
    if (const LaneBits own = ownBits(divided, o); own != 0) {
      const MF inVoxel = maskOf(divided, o);
      constexpr auto kAcross = static_cast<float>(MajorantGrid::kVoxelsAcross);
      const VF voxelM = load(w.brickM, o) * all(1.0f / kAcross),
               voxelsPerM = load(w.bricksPerM, o) * all(kAcross);
      const VF tall = hn::GatherIndex(df, slices.voxelM.data(), z),
               perTall = hn::GatherIndex(df, slices.voxelsPerM.data(), z);
      const VI most = allOf(MajorantGrid::kVoxelsAcross - 1),
               top = hn::Sub(hn::GatherIndex(di, slices.voxelsHigh.data(), z), allOf(1));
      const VI vx = whole((load(b.at.x, o) - sx.low) * voxelsPerM, most),
               vy = whole((load(b.at.y, o) - sy.low) * voxelsPerM, most),
               vz = whole((load(b.at.z, o) - sz.low) * perTall, top);
      const VF voxelX = sx.low + voxelM * hn::ConvertTo(df, vx),
               voxelY = sy.low + voxelM * hn::ConvertTo(df, vy),
               voxelZ = sz.low + tall * hn::ConvertTo(df, vz);
      store(blockedOf(vx, vy, vz, allOf(MajorantGrid::kVoxelsAcross / 4)), b.voxel, o);
      store(voxelX, b.low.x, o), store(voxelY, b.low.y, o), store(voxelZ, b.low.z, o);
      eachBit(own, [&](std::size_t i) HWY_ATTR {
        b.code[i] = grid.voxelCode(*w.tile[i], static_cast<std::size_t>(b.z[i]),
                                   b.voxels[i][static_cast<std::size_t>(b.voxel[i])],
                                   {b.low.x[i], b.low.y[i], b.low.z[i]});
      });
      sx = {hn::IfThenElse(inVoxel, voxelX, sx.low), hn::IfThenElse(inVoxel, voxelX + voxelM, sx.high)};
      sy = {hn::IfThenElse(inVoxel, voxelY, sy.low), hn::IfThenElse(inVoxel, voxelY + voxelM, sy.high)};
      sz = {hn::IfThenElse(inVoxel, voxelZ, sz.low), hn::IfThenElse(inVoxel, voxelZ + tall, sz.high)};
    }
    const VI code = load(b.code, o);
    const VF majorant = hn::GatherIndex(df, steps, hn::ShiftRight<8>(code)),
             minorant = hn::GatherIndex(df, steps, hn::And(code, allOf(0xff)));
    const VF t = load(w.t, o), tileEnd = load(w.tileEnd, o);
    const VF side = hn::Min(hn::Min(crossing(load(w.from.x, o), load(w.inverse.x, o), sx),
                                    crossing(load(w.from.y, o), load(w.inverse.y, o), sy)),
                            crossing(load(w.from.z, o), load(w.inverse.z, o), sz));
    const VF leaves = hn::Min(hn::Max(side, t + all(MajorantGrid::kNudgeM)), tileEnd);
    const MF collides = hn::RebindMask(df, hn::MaskFromVec(load(w.collides, o)));
    const VF rest = hn::IfThenElse(collides, majorant, majorant - minorant);
    const VF depth = load(w.depth, o), left = (leaves - t) * rest;
    const MF hits = hn::And(walks, hn::Lt(depth, left));
    const VF goes = hn::IfThenElse(hits, hn::Min(t + depth / hn::Max(rest, all(1e-30f)), leaves), leaves);
    const VF now = hn::IfThenElse(walks, goes, t);
    store(now, w.t, o);
    store(hn::IfThenElse(walks, hn::Max(depth - left, all(0.0f)), depth), w.depth, o);
    store(hn::IfThenElse(walks, majorant, load(w.majorant, o)), w.majorant, o);
    store(hn::IfThenElse(walks, minorant, load(w.minorant, o)), w.minorant, o);
    store(hn::IfThenElse(hn::RebindMask(di, walks), z, load(w.slice, o)), w.slice, o);
    const VF before = load(w.control, o),
             control = hn::IfThenElse(walks, before + (now - t) * minorant, before);
    store(control, w.control, o);
    hit |= bitsOf(hits, o);
    out |= bitsOf(hn::And(hn::AndNot(hits, walks), hn::Ge(now, tileEnd)), o);
    deep |= bitsOf(hn::And(hn::AndNot(collides, walks),
                           hn::Gt(control, all(static_cast<float>(CloudMedium::kMostControl)))),
                   o);
  }
}

// Extinction where some lanes are that ask for it, and their next free depths, in their order.
void lookUp(const CloudDensity& density, float radius, CloudLanes& w,
            const CloudLanes::Each<std::int32_t>& lanes, std::size_t count,
            const CloudMedium::Bits& matters) {
  const Floats df;
  const Ints di;
  CloudLanes::Answers& answers = w.answers;
  for (std::size_t o = 0; o < count; o += hn::Lanes(df)) {
    std::int32_t layers = 0;
    for (std::size_t i = o; i < std::min(o + hn::Lanes(df), count); ++i)
      layers |= w.layers[static_cast<std::size_t>(lanes[i])];
    const VI own = load(lanes, o);
    auto of = [&](const Each& each) HWY_ATTR { return hn::GatherIndex(df, each.data(), own); };
    const MF asks = hn::RebindMask(
        df, hn::Lt(hn::Iota(di, static_cast<std::int32_t>(o)), allOf(static_cast<std::int32_t>(count))));
    const VI has = hn::GatherIndex(di, w.layers.data(), own);
    const VF t = of(w.t);
    const Points q = cloudPositionOf(
        {of(w.place.x) + of(w.way.x) * t, of(w.place.y) + of(w.way.y) * t, of(w.place.z) + of(w.way.z) * t},
        radius);
    VF sum = all(0.0f), ofIce = sum, ofSnow = sum, ofRain = sum;
    for (auto left = static_cast<std::uint32_t>(layers); left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      const VI bit = allOf(1 << i);
      const VF sigma = extinctionAt(density.textures(), density.layers()[static_cast<std::size_t>(i)], q,
                                    hn::And(asks, hn::RebindMask(df, hn::Eq(hn::And(has, bit), bit))));
      sum = sum + sigma;
      if (matters.ice >> i & 1) ofIce = ofIce + sigma;
      if (matters.snow >> i & 1) ofSnow = ofSnow + sigma;
      if (matters.rain >> i & 1) ofRain = ofRain + sigma;
    }
    store(sum, answers.extinction, o), store(ofIce, answers.ice, o);
    store(ofSnow, answers.snow, o), store(ofRain, answers.rain, o);
    store(hn::Neg(hn::Log(df, of(w.free))), answers.free, o);
  }
}

// The first free depths of lanes whose rays begin.
void drawDepths(CloudLanes& w, const RayPieces& rays) {
  const Floats df;
  HWY_ALIGN float drawn[kCloudLanes];
  for (std::size_t k = 0; k < rays.count; ++k) drawn[k] = w.free[rays.lane[k]];
  for (std::size_t o = 0; o < rays.count; o += hn::Lanes(df))
    hn::Store(hn::Neg(hn::Log(df, hn::Load(df, drawn + o))), df, drawn + o);
  for (std::size_t k = 0; k < rays.count; ++k) w.depth[rays.lane[k]] = drawn[k];
}

}  // namespace welkin::reference::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace welkin::reference {
namespace {

// So many lanes wait for the density while others walk: whole vectors of any machine are looked up.
constexpr std::size_t kEnoughAsk = 16;

float freeShare(std::uint64_t bits) {
  // The least number is half a step, so that the longest free depth is 18.
  return (static_cast<float>(bits >> 16 & 0xffffff) + 0.5f) * 0x1p-24f;
}

// As above, where it is a part of each instruction set's code.
template <class F>
void eachBit(LaneBits bits, F&& f) {
  for (; bits != 0; bits &= bits - 1) f(static_cast<std::size_t>(std::countr_zero(bits)));
}

}  // namespace

HWY_EXPORT(drawDepths);
HWY_EXPORT(stepLanes);
HWY_EXPORT(lookUp);

CloudWalks::CloudWalks(const CloudMedium& medium) : medium_(medium), lanes_{} {
  lanes_.free.fill(1.0f);
  lanes_.brickM.fill(1.0f);
  lanes_.bricksPerM.fill(1.0f);
  lanes_.tileSide.fill(4);
}

void CloudWalks::begin(std::size_t i, const Ray& ray, double end, Random& random) {
  collisions_[i].reset();
  transmittances_[i] = 1.0;
  Ways& w = ways_[i];
  w.ray = ray;
  w.random = &random;
  rays_.end[rays_.count] = end;
  rays_.add(i, ray);
  lanes_.free[i] = freeShare(random.next());
  lanes_.through[i] = 1.0f;
  lanes_.control[i] = 0.0f;
}

void CloudWalks::beginRays() {
  if (rays_.count == 0) return;
  findStretches(medium_, rays_);
  HWY_DYNAMIC_DISPATCH(drawDepths)(lanes_, rays_);
  for (std::size_t k = 0; k < rays_.count; ++k) {
    const std::size_t i = rays_.lane[k];
    Ways& w = ways_[i];
    for (std::size_t s = 0; s < 2; ++s) w.stretches[s] = {rays_.starts[s][k], rays_.ends[s][k]};
    w.stretch = 0;
    w.next = w.stretches[0][0];
    if (!toNextPiece(i)) finish(i);
  }
  rays_.count = 0;
}

bool CloudWalks::toNextPiece(std::size_t i) {
  Ways& w = ways_[i];
  for (; w.stretch < 2; w.next = ++w.stretch < 2 ? w.stretches[1][0] : 0.0) {
    const double last = w.stretches[w.stretch][1];
    if (w.next >= last) continue;
    w.piece = w.next;
    w.next += CloudMedium::kPieceM;
    pieces_.start[pieces_.count] = w.piece;
    pieces_.length[pieces_.count] = static_cast<float>(std::min(CloudMedium::kPieceM, last - w.piece));
    pieces_.add(i, w.ray);
    return true;
  }
  return false;
}

void CloudWalks::beginPieces() {
  CloudLanes& l = lanes_;
  while (const std::size_t count = pieces_.count) {
    layLines(medium_.earth(), pieces_);
    pieces_.count = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = pieces_.lane[k];
      auto set = [&](CloudLanes::Vectors& v, const RayPieces::Vectors<float>& to) {
        v.x[i] = to.x[k], v.y[i] = to.y[k], v.z[i] = to.z[k];
      };
      set(l.from, pieces_.place), set(l.slope, pieces_.slope), set(l.inverse, pieces_.inverse);
      set(l.place, pieces_.placeInSpace);
      const glm::vec3 way(ways_[i].ray.way);
      l.way.x[i] = way.x, l.way.y[i] = way.y, l.way.z[i] = way.z;
      l.t[i] = 0.0f;
      l.end[i] = pieces_.length[k];
      if (nextTile(i)) {
        walking_ |= LaneBits{1} << i;
        continue;
      }
      // Those that go on are added before the one that is looked at, or in its place.
      Ways& w = ways_[i];
      if (MajorantGrid::isBeyond({l.from.x[i], l.from.y[i], l.from.z[i]})) w.next = w.stretches[w.stretch][1];
      if (!toNextPiece(i)) finish(i);
    }
  }
}

bool CloudWalks::nextTile(std::size_t i) {
  CloudLanes& l = lanes_;
  if (l.t[i] >= l.end[i]) return false;
  const glm::vec2 from(l.from.x[i], l.from.y[i]), slope(l.slope.x[i], l.slope.y[i]),
      inverse(l.inverse.x[i], l.inverse.y[i]);
  const float ahead = l.t[i] + MajorantGrid::kNudgeM;
  const glm::vec2 q = from + slope * ahead, in = q - glm::vec2(l.tileX[i], l.tileY[i]);
  // Most walks begin where the one before has ended.
  if (!l.tile[i] || !(std::min(in.x, in.y) >= 0.0f && std::max(in.x, in.y) < MajorantGrid::kTileM)) {
    const MajorantGrid::Tile* tile = medium_.grid()->tileAt(q);
    if (!tile) return false;
    l.tile[i] = tile;
    l.tileX[i] = tile->low.x, l.tileY[i] = tile->low.y;
    l.brickM[i] = tile->brickM, l.bricksPerM[i] = tile->bricksPerM;
    l.tileSide[i] = tile->side;
  }
  float end = l.end[i];
  for (const auto& [k, low] : {std::pair(0, l.tileX[i]), std::pair(1, l.tileY[i])})
    if (inverse[k] != 0.0f)
      end = std::min(end, (low + (inverse[k] > 0.0f ? MajorantGrid::kTileM : 0.0f) - from[k]) * inverse[k]);
  l.tileEnd[i] = std::max(end, std::min(ahead, l.end[i]));
  return true;
}

void CloudWalks::collide(std::size_t i, const Ray& ray, double end, Random& random) {
  lanes_.collides[i] = -1;
  begin(i, ray, end, random);
}

void CloudWalks::transmit(std::size_t i, const Ray& ray, double end, Random& random) {
  lanes_.collides[i] = 0;
  begin(i, ray, end, random);
}

void CloudWalks::finish(std::size_t i) {
  if (!lanes_.collides[i])
    transmittances_[i] =
        static_cast<double>(lanes_.through[i]) * std::exp(-static_cast<double>(lanes_.control[i]));
  walking_ &= ~(LaneBits{1} << i);
  ended_ |= LaneBits{1} << i;
}

void CloudWalks::collided(std::size_t i, CloudMedium::Matter matter) {
  collisions_[i] = {ways_[i].piece + static_cast<double>(lanes_.t[i]), matter};
  finish(i);
}

bool CloudWalks::spent(std::size_t i) {
  float& through = lanes_.through[i];
  if (static_cast<double>(through) >= CloudMedium::kRouletteBelow) return false;
  through = static_cast<double>(ways_[i].random->uniform()) * CloudMedium::kRouletteTo <
                    static_cast<double>(through)
                ? static_cast<float>(CloudMedium::kRouletteTo)
                : 0.0f;
  return through == 0.0f;
}

LaneBits CloudWalks::run() {
  ended_ = 0;
  const MajorantGrid* grid = medium_.grid();
  if (!grid) {
    for (std::size_t k = 0; k < rays_.count; ++k) finish(rays_.lane[k]);
    rays_.count = 0;
    return ended_;
  }
  CloudLanes& l = lanes_;
  const MajorantGrid::Slices& slices = grid->slices();
  while (ended_ == 0 && (rays_.count != 0 || pieces_.count != 0 || walking_ != 0 || asking_ != 0)) {
    beginRays();
    beginPieces();
    if (walking_ != 0) {
      LaneBits hit = 0, out = 0, deep = 0;
      HWY_DYNAMIC_DISPATCH(stepLanes)(*grid, l, walking_, hit, out, deep);
      eachBit(hit, [&](std::size_t i) {
        const std::uint64_t bits = ways_[i].random->next();
        l.free[i] = freeShare(bits);
        l.chance[i] = unitFloat(bits) * l.majorant[i];
        l.layers[i] = slices.layers[static_cast<std::size_t>(l.slice[i])];
        // Below the least of the extinction it need not be known.
        if (l.collides[i] && l.chance[i] < l.minorant[i])
          if (const auto matter = medium_.onlyMatter(static_cast<std::uint32_t>(l.layers[i])))
            return collided(i, *matter);
        asking_ |= LaneBits{1} << i;
        walking_ &= ~(LaneBits{1} << i);
      });
      eachBit(out, [&](std::size_t i) {
        if (l.t[i] < l.end[i] && nextTile(i)) return;
        walking_ &= ~(LaneBits{1} << i);
        if (!toNextPiece(i)) finish(i);
      });
      eachBit(deep & walking_, [&](std::size_t i) {
        l.through[i] *= std::exp(-l.control[i]);
        l.control[i] = 0.0f;
        if (spent(i)) finish(i);
      });
    }
    if (static_cast<std::size_t>(std::popcount(asking_)) >= kEnoughAsk || (walking_ == 0 && ended_ == 0))
      answer();
  }
  return ended_;
}

void CloudWalks::answer() {
  CloudLanes& l = lanes_;
  alignas(64) CloudLanes::Each<std::int32_t> lanes{};
  const std::size_t asking = static_cast<std::size_t>(std::popcount(asking_)),
                    count = asking < kEnoughAsk ? asking : asking - asking % kEnoughAsk;
  LaneBits later = asking_;
  for (std::size_t k = 0; k < count; ++k, later &= later - 1) lanes[k] = std::countr_zero(later);
  HWY_DYNAMIC_DISPATCH(lookUp)(medium_.density(), static_cast<float>(medium_.earth().radiusM()), l, lanes,
                               count, medium_.matters());
  walking_ |= asking_ & ~later;
  asking_ = later;
  for (std::size_t k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(lanes[k]);
    const CloudLanes::Answers& answers = l.answers;
    const float sigma = answers.extinction[k];
    l.depth[i] = answers.free[k];
    if (l.collides[i]) {
      const float u = l.chance[i], ice = answers.ice[k], orSnow = ice + answers.snow[k],
                  orRain = orSnow + answers.rain[k];
      if (u < sigma)
        collided(i, u < ice      ? CloudMedium::Matter::kIce
                    : u < orSnow ? CloudMedium::Matter::kSnow
                    : u < orRain ? CloudMedium::Matter::kRain
                                 : CloudMedium::Matter::kDroplets);
      continue;
    }
    const float rest = l.majorant[i] - l.minorant[i];
    l.through[i] *= std::clamp(1.0f - (sigma - l.minorant[i]) / rest, 0.0f, 1.0f);
    if (spent(i)) finish(i);
  }
}

}  // namespace welkin::reference

#endif
