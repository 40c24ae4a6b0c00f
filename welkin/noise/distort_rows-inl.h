// SPDX-License-Identifier: Apache-2.0
// Gradient noise at places that differ from sample to sample: the outer noise of distorted noise. Compiled
// for every instruction set.
#if defined(WELKIN_NOISE_DISTORT_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef WELKIN_NOISE_DISTORT_ROWS_INL_H_
#undef WELKIN_NOISE_DISTORT_ROWS_INL_H_
#else
#define WELKIN_NOISE_DISTORT_ROWS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "welkin/noise/fill.h"
#include "welkin/noise/gradient_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A vector of places on one axis.
struct Places {
  VU lowHash, highHash;
  VF inside, weight;  // weight: of the upper corner
};

HWY_INLINE Places placesOn(const Axis& axis, VU low, VF inside, VF shift) {
  const Floats d;
  const Words du;
  const hn::RebindToSigned<Words> di;
  const VF moved = hn::Add(inside, shift);
  VF cell = hn::Floor(moved);
  Places p;
  p.inside = hn::Sub(moved, cell);
  VU high;
  if (axis.period() == 0) {
    low = hn::Add(low, hn::BitCast(du, hn::ConvertTo(di, cell)));
    high = hn::Add(low, hn::Set(du, 1u));
  } else {
    // The cells to go are few: a small period is taken from them before, one larger needs a step at most.
    const VU period = hn::Set(du, axis.period());
    if (axis.period() < 65536u) {
      const VF cells = hn::Set(d, static_cast<float>(axis.period()));
      cell = hn::Sub(cell, hn::Mul(cells, hn::Floor(hn::Div(cell, cells))));
    }
    const VU steps = hn::BitCast(du, hn::ConvertTo(di, cell));  // negative: a huge unsigned number
    low = hn::Add(low, hn::Min(steps, hn::Add(steps, period)));
    low = hn::Min(low, hn::Sub(low, period));
    high = hn::Add(low, hn::Set(du, 1u));
    high = hn::Min(high, hn::Sub(high, period));
  }
  const VU step = hn::Set(du, kHashStep), key = hn::Set(du, axis.key());
  p.lowHash = mixedWords(hn::Add(hn::Mul(low, step), key));
  p.highHash = mixedWords(hn::Add(hn::Mul(high, step), key));
  const VF t = p.inside;
  p.weight = hn::Mul(hn::Mul(t, hn::Mul(t, t)),
                     hn::MulAdd(t, hn::MulSub(t, hn::Set(d, 6.0f), hn::Set(d, 15.0f)), hn::Set(d, 10.0f)));
  return p;
}

template <int kAxes>
HWY_INLINE VF noiseAt(const Places* p, const Gradients<kAxes>& gradients) {
  const Floats d;
  const auto one = hn::Set(d, 1.0f);
  const VU odd = hn::Set(Words(), 1u);
  VF line[1 << (kAxes - 1)];  // noise on the edges along x
  for (int c = 0; c < 1 << (kAxes - 1); ++c) {
    VU sum = hn::Zero(Words());
    VF away[kAxes];
    for (int a = 1; a < kAxes; ++a) {
      const bool high = (c >> (a - 1) & 1) != 0;
      sum = hn::Add(sum, high ? p[a].highHash : p[a].lowHash);
      away[a] = high ? hn::Sub(p[a].inside, one) : p[a].inside;
    }
    const VU row = hn::Or(mixedWords(sum), odd);
    const VU low = gradients.where(hn::Mul(hn::Or(p[0].lowHash, odd), row));
    const VU high = gradients.where(hn::Mul(hn::Or(p[0].highHash, odd), row));
    VF atLow = hn::Mul(gradients.component(0, low), p[0].inside);
    VF atHigh = hn::Mul(gradients.component(0, high), hn::Sub(p[0].inside, one));
    for (int a = 1; a < kAxes; ++a) {
      atLow = hn::MulAdd(gradients.component(a, low), away[a], atLow);
      atHigh = hn::MulAdd(gradients.component(a, high), away[a], atHigh);
    }
    line[c] = hn::MulAdd(p[0].weight, hn::Sub(atHigh, atLow), atLow);
  }
  for (int a = 1, n = 1 << (kAxes - 1); a < kAxes; ++a, n /= 2)
    for (int c = 0; c < n / 2; ++c)
      line[c] = hn::MulAdd(p[a].weight, hn::Sub(line[2 * c + 1], line[2 * c]), line[2 * c]);
  return line[0];
}

template <int kAxes>
HWY_INLINE void distortOctave(const DistortTables& t, Fractal fractal, int dimensions,
                              const float* const* shift, int x, int y, int z, int width, float* out) {
  const Floats d;
  const Words du;
  const Gradients<kAxes> gradients;
  const GradientLattice& lattice = *t.lattice;
  const auto scale = hn::Set(d, 1.0f / gradientBytesScale(kAxes)), weight = hn::Set(d, t.weight);
  const auto one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
  const Spot rows[2] = {t.y[y], dimensions == 3 ? t.z[z] : Spot{}};
  for (int i = 0; i < width; i += static_cast<int>(hn::Lanes(d))) {
    Places p[kAxes];
    p[0] = placesOn(lattice.axis(0), hn::LoadU(du, t.xIndex + x + i), hn::LoadU(d, t.xInside + x + i),
                    hn::Load(d, shift[0] + i));
    for (int a = 1; a < dimensions; ++a)
      p[a] = placesOn(lattice.axis(a), hn::Set(du, rows[a - 1].index), hn::Set(d, rows[a - 1].inside),
                      hn::Load(d, shift[a] + i));
    if (kAxes > dimensions)
      p[kAxes - 1] = placesOn(lattice.axis(kAxes - 1), hn::Set(du, t.time.index), hn::Set(d, t.time.inside),
                              hn::Zero(d));
    VF n = hn::Mul(noiseAt<kAxes>(p, gradients), scale);
    if (fractal == Fractal::kBillow) {
      n = hn::MulSub(two, hn::Abs(n), one);
    } else if (fractal == Fractal::kRidged) {
      const VF rest = hn::Sub(one, hn::Abs(n));
      n = hn::MulSub(hn::Mul(two, rest), rest, one);
    }
    hn::Store(hn::MulAdd(weight, n, hn::Load(d, out + i)), d, out + i);
  }
}

// A row of distorted noise from the rows of its shifts, dimension by dimension and octave by octave.
inline void distortRow(const FillJob& job, const float* const* shifts, int x, int y, int z, int width,
                       float* out) {
  const Floats d;
  const int dimensions = static_cast<int>(job.params->dimensions);
  for (int i = 0; i < width; i += static_cast<int>(hn::Lanes(d))) hn::Store(hn::Set(d, job.bias), d, out + i);
  for (int o = 0; o < job.distortTerms; ++o, shifts += dimensions) {
    const DistortTables& t = job.distorts[o];
    switch (t.lattice->axes()) {
      case 2:
        distortOctave<2>(t, job.params->fractal, dimensions, shifts, x, y, z, width, out);
        break;
      case 3:
        distortOctave<3>(t, job.params->fractal, dimensions, shifts, x, y, z, width, out);
        break;
      default:
        distortOctave<4>(t, job.params->fractal, dimensions, shifts, x, y, z, width, out);
        break;
    }
  }
}

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard of each target
