// SPDX-License-Identifier: Apache-2.0
// Value noise after P. Man 2006, "Generating and Real-Time Rendering of Clouds": a hash at each lattice
// point, smoothed over its 26 neighbours, interpolated between lattice points.
//
// The hash is Man's (after H. Elias), with m = x + 57 y + 57^2 z in 32 bits:
//   n = (m << 13) xor m,   g = 1 - ((n (n n 15731 + 789221) + 1376312589) & 0x7fffffff) / 2^30.
// It repeats exactly under shifts such as (57, -1, 0) and (0, 57, -1) cells. Seed 0 keeps it for the sake of
// the source; every other seed takes the project's own hash, which has no such shifts.
//
// With a time the noise evolves: each lattice point's hash is interpolated between those of the whole times
// around, as it is between lattice points in space, and then smoothed, over space alone. Whole times are
// noises of seeds of their own, which points meet at one of 16 phases, by chance. Were the phase the same
// everywhere, all of the noise would halt at every whole time (cosine), and between them be weaker (linear
// and cosine: to 0.71); so all times are alike.
//
// Immutable; safe to share between threads.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "welkin/core/params.h"
#include "welkin/noise/value_clock.h"

namespace welkin::noise {

enum class Interpolation { kLinear, kCosine, kCubic };  // Man's three; continuous slopes but for linear

// A position on one axis: inside = 0.3 in cell 7 is 7.3. Cells repeat every 2^32.
struct CellPlace {
  std::int64_t cell = 0;
  double inside = 0.0;  // [0, 1)
};

struct ValueSettings {
  std::uint64_t seed = 0;  // 0: the source's hash
  Interpolation interpolation = Interpolation::kCosine;
  bool smooth = true;    // the 27-point average; without it the lattice values are the bare hash
  glm::ivec3 period{0};  // cells after which the noise repeats on each axis; 0: never
  std::optional<CellPlace> time = std::nullopt;  // none: no evolution; not with the source's hash
  int timePeriod = 0;                            // as `period`
};

// Samples on a regular grid, or a box of them: sample i of an axis lies at origin + step * (begin + i). The
// same sample has the same value in any box that holds it.
struct SampleBox {
  glm::dvec3 origin{0.0};  // of the grid, in lattice cells
  glm::dvec3 step{1.0};    // cells between samples, each > 0
  glm::ivec3 begin{0};     // first sample of the box
  glm::ivec3 count{1};     // samples of the box, each >= 1

  double position(int axis, int i) const {
    return origin[axis] + step[axis] * (static_cast<double>(begin[axis]) + i);
  }
};

struct ValueAndSlope {
  double value = 0.0;
  glm::dvec3 slope{0.0};  // derivative along each axis, by one cell
};

class Value {
 public:
  explicit Value(const ValueSettings& settings = {});
  const ValueSettings& settings() const { return settings_; }

  const ValueClock& clock() const { return clock_; }  // what the time comes to, for fills

  // The bare hash g of a lattice point, at the time if there is one: in [-1, 1], with cubic interpolation
  // between times in [-1.5, 1.5].
  float hash(std::int64_t x, std::int64_t y, std::int64_t z) const;
  // The lattice value that is interpolated, within the same: f, or g where `smooth` is off. Weights 9/18 for
  // the point, 4/18 for its 6 faces together, 3/18 for the 12 edges, 2/18 for the 8 corners.
  float lattice(std::int64_t x, std::int64_t y, std::int64_t z) const;

  // The noise at a finite position in cells. Within [-1, 1], but for cubic interpolation, which
  // overshoots (below 1.2 when smooth, in practice). Mean 0; standard deviation with linear, cosine and cubic
  // interpolation 0.19, 0.21, 0.27 when smooth and 0.31, 0.38, 0.50 when bare; with a time 0.82, 0.87 and
  // 0.95 of that, whatever the time.
  double operator()(double x, double y, double z) const;
  // The same and its analytic derivative, which for linear interpolation jumps at cell borders.
  ValueAndSlope withSlope(double x, double y, double z) const;
  ValueAndSlope withSlope(CellPlace x, CellPlace y, CellPlace z) const;

  // out += weight * noise for a box (x fastest, then y, then z; out.size() is the product of box.count), in
  // floats that agree with the point function within 1e-6 * weight. Each lattice point is hashed once.
  // Memory beside `out`: a few planes of the lattice under strips of the box, kept for the next.
  void add(std::span<float> out, float weight, const SampleBox& box) const;
  // The same at the places given for each axis, best in rising order.
  void add(std::span<float> out, float weight, std::span<const CellPlace> x, std::span<const CellPlace> y,
           std::span<const CellPlace> z) const;

  // Standard deviation over space, or over the planes z = whole number, at any time; and the least bound on
  // the absolute value that holds for any hash.
  double deviation(int dimensions) const;
  double bound(int dimensions) const;

 private:
  ValueSettings settings_;
  ValueClock clock_;
};

}  // namespace welkin::noise

namespace welkin {
template <>
inline constexpr auto kEnumNames<noise::Interpolation> =
    std::to_array<std::string_view>({"linear", "cosine", "cubic"});
}  // namespace welkin
