// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/gradient.h"

#include <cassert>
#include <cmath>

namespace welkin::noise {

const std::array<std::uint8_t, 256> kPublishedPermutation = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,
    69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,
    94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136,
    171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122,
    60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161,
    1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196, 135, 130, 116, 188, 159, 86,
    164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124, 123, 5,   202, 38,  147, 118, 126,
    255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189, 28,  42,  223, 183, 170, 213,
    119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,   129, 22,  39,  253,
    19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,  242, 193,
    238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,
    222, 114, 67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

GradientLattice::GradientLattice(int axes, const std::array<Axis, 4>& axis, bool published)
    : axes_(axes), axis_(axis), published_(published) {
  assert(axes >= 2 && axes <= 4 && (!published || axes == 3));
}

std::uint32_t GradientLattice::hash(const std::array<std::uint32_t, 4>& index) const {
  if (published_) {
    const auto& p = kPublishedPermutation;
    return p[(p[(p[index[0] & 255] + index[1]) & 255] + index[2]) & 255];
  }
  std::uint32_t sum = 0;
  for (int i = 1; i < axes_; ++i) sum += axis_[i].hash(index[i]);
  return pointHash(axis_[0].hash(index[0]), rowHash(sum)) >> kGradientShift;
}

ValueAndGradient GradientLattice::at(const std::array<double, 4>& position,
                                     const std::array<double, 4>& shiftCells) const {
  std::array<Span, 4> span{};
  for (int i = 0; i < axes_; ++i) span[i] = axis_[i].at(position[i], shiftCells[i]);

  // Each corner's linear function, then the corners blended along one axis after the other.
  std::array<ValueAndGradient, 16> corner;
  const int corners = 1 << axes_;
  for (int c = 0; c < corners; ++c) {
    std::array<std::uint32_t, 4> index{};
    for (int i = 0; i < axes_; ++i) index[i] = (c >> i & 1) != 0 ? span[i].high : span[i].low;
    const std::array<float, 4> g = gradientOf(axes_, hash(index));
    corner[c] = {0.0, {g[0], g[1], g[2], g[3]}};
    for (int i = 0; i < axes_; ++i)
      corner[c].value += corner[c].gradient[i] * (span[i].inside - (c >> i & 1));
  }
  for (int axis = 0, n = corners; axis < axes_; ++axis, n /= 2) {
    const double t = fade(span[axis].inside), slope = fadeSlope(span[axis].inside);
    for (int c = 0; c < n / 2; ++c) {
      const ValueAndGradient low = corner[2 * c], high = corner[2 * c + 1];
      ValueAndGradient& out = corner[c];
      out.value = low.value + t * (high.value - low.value);
      for (int i = 0; i < axes_; ++i)
        out.gradient[i] = low.gradient[i] + t * (high.gradient[i] - low.gradient[i]);
      out.gradient[axis] += slope * (high.value - low.value);
    }
  }
  return corner[0];
}

double GradientLattice::bound(int axes) {
  constexpr double kBound[] = {0.935, 1.0364, 1.465};  // searched on grids over the cell
  return kBound[axes - 2];
}

namespace {

// Integrals over a cell, w = 1 - fade: of w^2, (w u)^2, w'^2 and ((w u)')^2. Cross terms vanish, since
// corners are independent and the components of a gradient uncorrelated.
constexpr double kW = 181.0 / 462.0, kWu = 535.0 / 18018.0, kSlopeW = 10.0 / 7.0, kSlopeWu = 30.0 / 77.0;

// Mean square of a gradient's component.
double meanSquare(int axes, int axis) {
  double sum = 0.0;
  for (std::uint32_t h = 0; h < 16; ++h) {
    const double g = gradientOf(axes, h)[static_cast<std::size_t>(axis)];
    sum += g * g / 16.0;
  }
  return sum;
}

}  // namespace

double GradientLattice::deviation(int axes) {
  double sum = 0.0;
  for (int i = 0; i < axes; ++i) sum += meanSquare(axes, i);
  return std::sqrt(std::pow(2.0, axes) * sum * kWu * std::pow(kW, axes - 1));
}

double GradientLattice::slopeDeviation(int axes, int axis) {
  double sum = 0.0;
  for (int i = 0; i < axes; ++i)
    sum += meanSquare(axes, i) *
           (i == axis ? kSlopeWu * std::pow(kW, axes - 1) : kSlopeW * kWu * std::pow(kW, axes - 2));
  return std::sqrt(std::pow(2.0, axes) * sum);
}

}  // namespace welkin::noise
