// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/ray_pieces.h"

// This file once for each target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "welkin/reference/ray_pieces.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h.
#include <hwy/highway.h>

#include "welkin/reference/cloud_density-inl.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::reference::HWY_NAMESPACE {
namespace {

using Doubles = hn::CappedTag<double, 8>;
using VD = hn::Vec<Doubles>;
using MD = hn::Mask<Doubles>;

struct Places {
  VD x, y, z;
};
HWY_INLINE Places load(const RayPieces::Vectors<double>& of, std::size_t at) {
  const Doubles d;
  return {hn::Load(d, of.x.data() + at), hn::Load(d, of.y.data() + at), hn::Load(d, of.z.data() + at)};
}

// As Sphere::crossings().
struct Crossings {
  MD any;
  VD near, far;
};
HWY_INLINE Crossings crossingsOf(VD along, VD excess, double radius, double heightM) {
  const Doubles d;
  const VD zero = hn::Zero(d), c = excess - hn::Set(d, heightM * (2.0 * radius + heightM)),
           disc = along * along - c, root = hn::Sqrt(hn::Max(disc, zero));
  const VD q = hn::IfThenElse(hn::Gt(along, zero), hn::Neg(along) - root, root - along);
  const VD other = hn::IfThenElse(hn::Ne(q, zero), c / q, zero);
  return {hn::Gt(disc, zero), hn::Min(q, other), hn::Max(q, other)};
}

}  // namespace

void stretches(double radius, double low, double high, RayPieces& r) {
  const Doubles d;
  const VD zero = hn::Zero(d), twoR = hn::Set(d, 2.0 * radius), one = hn::Set(d, radius);
  for (std::size_t o = 0; o < r.count; o += hn::Lanes(d)) {
    const Places p = load(r.from, o), w = load(r.way, o);
    const VD end = hn::Load(d, r.end.data() + o);
    const VD excess = p.z * (twoR + p.z) + p.x * p.x + p.y * p.y,
             along = p.x * w.x + p.y * w.y + (one + p.z) * w.z;
    const Crossings outer = crossingsOf(along, excess, radius, high),
                    inner = crossingsOf(along, excess, radius, low),
                    ground = crossingsOf(along, excess, radius, 0.0);
    // Of those that rise above the base, its sphere is behind.
    const MD above = hn::And(hn::Gt(along, zero), hn::Gt(excess, hn::Set(d, low * (2.0 * radius + low)))),
             meets = hn::AndNot(above, inner.any), misses = hn::Or(hn::Ge(along, zero), hn::Not(ground.any));
    const VD last = hn::Min(outer.far, end);
    hn::Store(hn::Max(outer.near, zero), d, r.starts[0].data() + o);
    hn::Store(hn::IfThenElseZero(outer.any, hn::IfThenElse(meets, hn::Min(inner.near, end), last)), d,
              r.ends[0].data() + o);
    hn::Store(hn::Max(inner.far, zero), d, r.starts[1].data() + o);
    hn::Store(hn::IfThenElseZero(hn::And(outer.any, hn::And(meets, misses)), last), d, r.ends[1].data() + o);
  }
}

void lines(double radius, RayPieces& r) {
  const Doubles d;
  const hn::Rebind<float, Doubles> half;
  for (std::size_t o = 0; o < r.count; o += hn::Lanes(d)) {
    const Places p = load(r.from, o), w = load(r.way, o);
    const VD t = hn::Load(d, r.start.data() + o),
             u = t + hn::PromoteTo(d, hn::Load(half, r.length.data() + o));
    auto put = [&](VD from, VD way, RayPieces::Each<float>& first, RayPieces::Each<float>& last) HWY_ATTR {
      hn::Store(hn::DemoteTo(half, from + way * t), half, first.data() + o);
      hn::Store(hn::DemoteTo(half, from + way * u), half, last.data() + o);
    };
    put(p.x, w.x, r.placeInSpace.x, r.againInSpace.x);
    put(p.y, w.y, r.placeInSpace.y, r.againInSpace.y);
    put(p.z, w.z, r.placeInSpace.z, r.againInSpace.z);
  }
  const Floats df;
  for (std::size_t o = 0; o < r.count; o += hn::Lanes(df)) {
    auto points = [&](const RayPieces::Vectors<float>& of) HWY_ATTR {
      return cloudPositionOf(
          {hn::Load(df, of.x.data() + o), hn::Load(df, of.y.data() + o), hn::Load(df, of.z.data() + o)},
          static_cast<float>(radius));
    };
    const Points a = points(r.placeInSpace), b = points(r.againInSpace);
    const VF length = hn::Load(df, r.length.data() + o);
    auto put = [&](VF from, VF to, RayPieces::Each<float>& place, RayPieces::Each<float>& slope,
                   RayPieces::Each<float>& inverse) HWY_ATTR {
      const VF s = (to - from) / length;
      hn::Store(from, df, place.data() + o);
      hn::Store(s, df, slope.data() + o);
      hn::Store(hn::IfThenElseZero(hn::Gt(hn::Abs(s), all(CloudLine::kLeastSlope)), all(1.0f) / s), df,
                inverse.data() + o);
    };
    put(a.x, b.x, r.place.x, r.slope.x, r.inverse.x);
    put(a.y, b.y, r.place.y, r.slope.y, r.inverse.y);
    put(a.z, b.z, r.place.z, r.slope.z, r.inverse.z);
  }
}

}  // namespace welkin::reference::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace welkin::reference {

HWY_EXPORT(stretches);
HWY_EXPORT(lines);

void findStretches(const CloudMedium& medium, RayPieces& rays) {
  HWY_DYNAMIC_DISPATCH(stretches)
  (medium.earth().radiusM(), medium.grid()->lowM(), medium.grid()->highM(), rays);
}

void layLines(const Sphere& earth, RayPieces& rays) {
  HWY_DYNAMIC_DISPATCH(lines)(earth.radiusM(), rays);
}

}  // namespace welkin::reference

#endif
