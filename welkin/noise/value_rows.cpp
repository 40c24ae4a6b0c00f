// SPDX-License-Identifier: Apache-2.0
// Plain loops, which compilers turn into vectors of every instruction set; the best is chosen at run time.
#include "welkin/noise/value_rows.h"

// This file once for each target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "welkin/noise/value_rows.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace welkin::noise::HWY_NAMESPACE {

void sourceHashes(const std::uint32_t* HWY_RESTRICT x, int count, std::uint32_t row,
                  float* HWY_RESTRICT out) {
  for (int i = 0; i < count; ++i) out[i] = sourceHash(x[i] + row);
}

void ownHashes(const std::uint64_t* HWY_RESTRICT hashedX, int count, const OwnRow& row,
               float* HWY_RESTRICT out) {
  const OwnRow of = row;
  for (int i = 0; i < count; ++i) out[i] = ownHash(hashedX[i], of);
}

void sumBoxes(const float* HWY_RESTRICT row, int width, double* HWY_RESTRICT out) {
  const float *above = row - width, *below = row + width;
  const auto column = [&](int i) {
    return static_cast<double>(above[i]) + static_cast<double>(row[i]) + static_cast<double>(below[i]);
  };
  for (int i = 1; i + 1 < width; ++i) out[i] = column(i - 1) + column(i) + column(i + 1);
}

void smoothRow(const Three<float>& values, const Three<double>& boxes, int width, float* HWY_RESTRICT out) {
  const auto [below, here, above] = values;
  const auto [boxBelow, boxHere, boxAbove] = boxes;
  for (int i = 1; i + 1 < width; ++i) {
    const double cube = boxBelow[i] + boxHere[i] + boxAbove[i];
    const auto face = [&](const float* v, int at) { return static_cast<double>(v[at]); };
    const double faces = face(below, i) + face(here, i - width) + face(here, i - 1) + face(here, i + 1) +
                         face(here, i + width) + face(above, i);
    out[i] = smoothedValue(cube, faces, here[i]);
  }
}

template <int kTaps>
void mixSome(const std::span<const Tap> taps, int count, float* HWY_RESTRICT out) {
  Tap tap[kTaps];
  for (int t = 0; t < kTaps; ++t) tap[t] = taps[t];
  for (int i = 0; i < count; ++i) {
    float sum = tap[0].weight * tap[0].row[i];
    for (int t = 1; t < kTaps; ++t) sum += tap[t].weight * tap[t].row[i];
    out[i] = sum;
  }
}

void mixRows(const std::span<const Tap> taps, int count, float* out) {
  switch (taps.size()) {
    case 1:
      return mixSome<1>(taps, count, out);
    case 2:
      return mixSome<2>(taps, count, out);
    case 3:
      return mixSome<3>(taps, count, out);
    default:
      return mixSome<4>(taps, count, out);
  }
}

}  // namespace welkin::noise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace welkin::noise {

HWY_EXPORT(sourceHashes);
HWY_EXPORT(ownHashes);
HWY_EXPORT(sumBoxes);
HWY_EXPORT(smoothRow);
HWY_EXPORT(mixRows);

void sourceHashes(const std::uint32_t* x, int count, std::uint32_t row, float* out) {
  HWY_DYNAMIC_DISPATCH(sourceHashes)(x, count, row, out);
}
void ownHashes(const std::uint64_t* hashedX, int count, const OwnRow& row, float* out) {
  HWY_DYNAMIC_DISPATCH(ownHashes)(hashedX, count, row, out);
}
void sumBoxes(const float* row, int width, double* out) {
  HWY_DYNAMIC_DISPATCH(sumBoxes)(row, width, out);
}
void smoothRow(const Three<float>& values, const Three<double>& boxes, int width, float* out) {
  HWY_DYNAMIC_DISPATCH(smoothRow)(values, boxes, width, out);
}
void mixRows(std::span<const Tap> taps, int count, float* out) {
  HWY_DYNAMIC_DISPATCH(mixRows)(taps, count, out);
}

}  // namespace welkin::noise

#endif
