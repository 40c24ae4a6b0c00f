// SPDX-License-Identifier: Apache-2.0
// The clouds' extinction at many points at once: shaders/lib/clouds.glsl, a lane a point. Compiled for every
// instruction set. Nothing is contracted to fused operations, so that sets differ by what Exp() and Log() do
// alone.
#if defined(WELKIN_REFERENCE_CLOUD_DENSITY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WELKIN_REFERENCE_CLOUD_DENSITY_INL_H_
#undef WELKIN_REFERENCE_CLOUD_DENSITY_INL_H_
#else
#define WELKIN_REFERENCE_CLOUD_DENSITY_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <cstdint>
#include <cstring>

#include "welkin/reference/cloud_density.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::reference::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Ints = hn::RebindToSigned<Floats>;
using VF = hn::Vec<Floats>;
using VI = hn::Vec<Ints>;
using MF = hn::Mask<Floats>;

HWY_INLINE VF all(float x) {
  return hn::Set(Floats(), x);
}
HWY_INLINE VI allOf(int x) {
  return hn::Set(Ints(), x);
}
HWY_INLINE VF clampedUnit(VF x) {
  return hn::Min(hn::Max(x, all(0.0f)), all(1.0f));
}
// Hermite's step from 0 to 1 as `share` does so.
HWY_INLINE VF smoothShare(VF share) {
  const VF t = clampedUnit(share);
  return t * t * (all(3.0f) - all(2.0f) * t);
}
HWY_INLINE VF mixed(float a, float b, VF share) {
  return all(a) + all(b - a) * share;
}

struct Points {
  VF x, y, z;
};

// The texels beside a coordinate of a tiling texture n wide, a power of two, and the weight of the second.
struct Taps {
  VI low, high;
  VF weight;
};
HWY_INLINE Taps tapsOf(VF u, int n) {
  const Ints di;
  const VF x = u * all(static_cast<float>(n)) - all(0.5f), floor = hn::Floor(x);
  const VI i = hn::ConvertTo(di, floor), wrap = allOf(n - 1);
  return {hn::And(i, wrap), hn::And(hn::Add(i, allOf(1)), wrap), x - floor};
}
HWY_INLINE VF between(VF a, VF b, VF share) {
  return a + (b - a) * share;
}

// Two numbers of 16 bits at each offset, bytes, which need not be aligned.
struct Pairs {
  VF first, second;
};
HWY_INLINE Pairs pairsAt(const std::int16_t* texels, VI offsets) {
  const Floats df;
  const Ints di;
#if HWY_TARGET <= HWY_AVX2 && HWY_ARCH_X86
  const VI both = hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(texels), offsets);
#else
  alignas(64) std::int32_t at[16], two[16];
  hn::Store(offsets, di, at);
  for (std::size_t i = 0; i < hn::Lanes(di); ++i)
    std::memcpy(&two[i], reinterpret_cast<const char*>(texels) + at[i], sizeof two[i]);
  const VI both = hn::Load(di, two);
#endif
  return {hn::ConvertTo(df, hn::ShiftRight<16>(hn::ShiftLeft<16>(both))),
          hn::ConvertTo(df, hn::ShiftRight<16>(both))};
}
HWY_INLINE Pairs between(const Pairs& a, const Pairs& b, VF share) {
  return {between(a.first, b.first, share), between(a.second, b.second, share)};
}

// Two channels of the placement map, the first two or the last. Lanes that are not asked read its first
// texel.
struct Placement {
  const CloudTexture* map;
  VI offsets[2][2];
  VF weightX, weightY;

  HWY_INLINE Placement(const CloudTexture& texture, VF u, VF v, MF asked) : map(&texture) {
    const Taps x = tapsOf(u, texture.nx), y = tapsOf(v, texture.ny);
    const VI asking = hn::VecFromMask(Ints(), hn::RebindMask(Ints(), asked));
    auto offset = [&](VI i, VI j) HWY_ATTR {
      return hn::And(hn::ShiftLeft<3>(hn::Add(hn::Mul(j, allOf(texture.nx)), i)), asking);
    };
    offsets[0][0] = offset(x.low, y.low), offsets[0][1] = offset(x.high, y.low);
    offsets[1][0] = offset(x.low, y.high), offsets[1][1] = offset(x.high, y.high);
    weightX = x.weight, weightY = y.weight;
  }
  HWY_INLINE Pairs channels(int first) const {
    const std::int16_t* p = map->texels + first;
    const Pairs v = between(between(pairsAt(p, offsets[0][0]), pairsAt(p, offsets[0][1]), weightX),
                            between(pairsAt(p, offsets[1][0]), pairsAt(p, offsets[1][1]), weightX), weightY);
    return {v.first * all(map->step), v.second * all(map->step)};
  }
};

HWY_INLINE VF noiseAt(const CloudTexture& noise, const Points& p, MF asked) {
  const Taps x = tapsOf(p.x, noise.nx), y = tapsOf(p.y, noise.ny), z = tapsOf(p.z, noise.nz);
  const VI asking = hn::VecFromMask(Ints(), hn::RebindMask(Ints(), asked));
  auto row = [&](VI j, VI k) HWY_ATTR {
    const VI at = hn::Mul(hn::Add(hn::Mul(k, allOf(noise.ny)), j), allOf(noise.rowTexels));
    const Pairs v = pairsAt(noise.texels, hn::And(hn::ShiftLeft<1>(hn::Add(at, x.low)), asking));
    return between(v.first, v.second, x.weight);
  };
  return all(noise.step) * between(between(row(y.low, z.low), row(y.high, z.low), y.weight),
                                   between(row(y.low, z.high), row(y.high, z.high), y.weight), z.weight);
}

// Extinction of one layer at cloud positions, 1/m; 0 for lanes that are not asked.
HWY_INLINE VF extinctionAt(const CloudTextures& textures, const CloudLayerFactors& f, const Points& q,
                           MF asked) {
  const Floats df;
  const field::CloudLayer& l = f.layer;
  const VF h = (q.z - all(l.baseM)) * all(f.perDepth);
  MF alive = hn::And(asked, hn::And(hn::Gt(h, all(0.0f)), hn::Lt(h, all(1.0f))));
  if (hn::AllFalse(df, alive)) return all(0.0f);
  const MF inLayer = alive;
  const VF inside = hn::IfThenElse(alive, h, all(0.5f));

  // cloudPatternPosition(), cloudPlacement().
  const VF east = q.x - all(l.driftM.x) - all(l.shearM.x) * h,
           north = q.y - all(l.driftM.y) - all(l.shearM.y) * h;
  const VF along = east * all(l.along.x) + north * all(l.along.y),
           across = north * all(l.along.x) - east * all(l.along.y);
  const VF drawn = along * all(f.perStretch);
  const VF cosine = all(f.patchCosine), sine = all(f.patchSine);
  const Placement around(textures.placement, cosine * drawn - sine * across - all(l.patchShift.x),
                         sine * drawn + cosine * across - all(l.patchShift.y), alive);
  const Pairs warp = around.channels(0);
  const Pairs cells = Placement(textures.placement, (drawn + all(l.warpM) * warp.second) * all(f.perCell),
                                (across + all(l.warpM) * warp.first) * all(f.perCell), alive)
                          .channels(0);
  const VF placement = all(l.cellWeight) * cells.first + all(l.fractalWeight) * cells.second +
                       all(l.patchWeight) * around.channels(2).first;

  // cloudAnvil(), cloudProfile().
  const VF anvil = l.anvil > 0.0f ? smoothShare((h - all(f.anvilFrom)) * all(f.perAnvil)) : all(0.0f);
  const VF towardsBase = all(1.0f) - h;
  const VF dome = all(l.dome) * hn::Exp(df, all(l.domePower) * hn::Log(df, inside));
  VF s =
      placement - all(l.threshold) - (dome + all(l.belly) * towardsBase * towardsBase - all(l.anvil) * anvil);

  // cloudShapeAmount(), cloudClearance().
  const float small = 2.0f * l.detailAmount;
  VF shape = all(0.0f);
  if (l.shapeAmount > 0.0f)
    shape = all(l.shapeAmount) * mixed(l.shapeAtBase, 1.0f, smoothShare(h * all(1.0f / 0.35f))) *
            mixed(1.0f, f.anvilShape, anvil) *
            smoothShare((s + all(1.8f * l.shapeAmount)) * all(f.perShapeAmount));
  alive = hn::And(alive, hn::Gt(s + all(2.5f) * shape + all(small), all(0.0f)));
  if (hn::AllFalse(df, alive)) return all(0.0f);

  // cloudExtinctionFrom().
  const Points p{along * all(f.perShapeStretch), across, q.z * all(f.perShapeTall)};
  auto noise = [&](const CloudTexture& of, const field::vec3& shift, float perM, MF where) HWY_ATTR {
    return noiseAt(of,
                   {(p.x - all(shift.x)) * all(perM), (p.y - all(shift.y)) * all(perM),
                    (p.z - all(shift.z)) * all(perM)},
                   where);
  };
  s = s + shape * noise(textures.shape, l.shapeShiftM, f.perShape, inLayer);
  alive = hn::And(alive, hn::Gt(s + all(small), all(0.0f)));
  const VF edge = all(l.edge) * mixed(1.0f, f.anvilEdge, anvil);
  if (l.detailAmount > 0.0f) {
    const MF rough = hn::And(alive, hn::Lt(s, edge + all(small)));
    if (!hn::AllFalse(df, rough)) {
      const VF amount = all(l.detailAmount) * mixed(l.shapeAtBase, 1.0f, smoothShare(h * all(1.0f / 0.2f)));
      s = hn::IfThenElse(rough, s + amount * noise(textures.detail, l.detailShiftM, f.perDetail, rough), s);
    }
  }
  // cloudBodyExtinction().
  const VF vertical = smoothShare(h * all(f.perBottomSoft)) * smoothShare(towardsBase * all(f.perTopSoft));
  const VF lifted = all(1.0f) + (all(0.4f) + all(0.9f) * hn::Sqrt(inside) - all(1.0f)) * all(l.lift);
  const VF body = all(l.extinction) * vertical * lifted * mixed(1.0f, f.anvilExtinction, anvil);
  return hn::IfThenElseZero(hn::And(alive, hn::Gt(s, all(0.0f))), body * clampedUnit(s / edge));
}

// cloudPosition().
HWY_INLINE Points cloudPositionOf(const Points& p, float radius) {
  const VF r = all(radius), horizontal2 = p.x * p.x + p.y * p.y;
  const VF up = r + p.z, t2 = horizontal2 / (up * up);
  const VF k = r / up * (all(1.0f) - t2 * (all(1.0f / 3.0f) - t2 * all(0.2f)));
  const VF excess = p.z * (all(2.0f * radius) + p.z) + horizontal2;
  return {p.x * k, p.y * k, excess / (hn::Sqrt(r * r + excess) + r)};
}

}  // namespace welkin::reference::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // WELKIN_REFERENCE_CLOUD_DENSITY_INL_H_
