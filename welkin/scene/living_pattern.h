// SPDX-License-Identifier: Apache-2.0
// The pattern of a sheet with living octaves, as a pure function of time: any instant without its past.
//
// Octave k has its own interval T_k = interval * ratio^k. Keyframe j of it is a lattice of random numbers,
// all from hash(seed, k, j); at time t the lattice is that of keyframes j = floor(t / T_k) and j + 1, blended
// by w = frac(t / T_k). The octave n_k in [-1, 1] is what the kernel makes of it between the points, with
// frequency 2^k cells in a tile (the sources' kernels: 32 * 2^k), and the pattern is
//
//   p = clamp(sum_k a_k (n_k + 1) / 2, 0, 1),   a_k = amplitude persistence^k,
//
// which with amplitude and persistence 1/2 is Pallister's listing and the sum of Guthikonda et al. As kernels
// are linear in the lattice, blending lattices is blending octaves.
//
// A linear blend of two independent keyframes has sqrt(w^2 + (1 - w)^2) of their deviation: a dip to 0.71
// half way. Variance-preserving, the octave is divided by the deviation that the blend really has over the
// tile, and its mean taken off: both exactly, by sums over the lattice. So the distribution of the pattern,
// and with it the cover above a threshold, stays nearly the same.
//
// Lattices have at most 32 points a side and repeat within the tile where there are more cells. Octaves whose
// cells would be smaller than a texel are left out.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "welkin/core/image.h"
#include "welkin/scene/sheet.h"

namespace welkin::scene {

// Of a sheet with this pattern.
inline constexpr int kMaxLivingOctaves = 8, kMaxLivingTexels = 1024, kMaxLivingFrequency = 32;

// An octave of one instant, as lib/octaves.glsl reads it.
struct OctaveNow {
  Image<float> lattice;   // 4 channels, side x side: see there. Times a_k / 2
  float cells = 0.0f;     // in a tile
  glm::vec2 shift{0.0f};  // cells, added to the place in the tile
};

struct LivingInstant {
  int count = 0;
  std::array<OctaveNow, kMaxLivingOctaves> octaves;
  float base = 0.0f;  // sum of a_k / 2
};

class LivingPattern {
 public:
  // A sheet whose pattern is octaves.
  LivingPattern(const Sheet& sheet, std::uint64_t seed);

  int count() const { return static_cast<int>(octaves_.size()); }  // of octaves
  int side(int octave) const { return octaves_[static_cast<std::size_t>(octave)].side; }
  OctaveKernel kernel() const { return living_.kernel; }

  // The instant whose pattern is shown: the last one at which it is composed. Finite.
  double shown(double secondsAfter) const;

  // Fills `out` for an instant, which is shown as it is. Allocates only where `out` was not filled before.
  void at(double secondsAfter, LivingInstant& out) const;

  // The random numbers of a keyframe: side x side values in [-1, 1], or gradients (x, y), first row first.
  std::vector<glm::vec2> keyframe(int octave, double j) const;

  // The pattern at an instant on the processor, texels x texels: the reference for what render draws.
  Image<float> image(double secondsAfter, int texels) const;

  // Values of the pattern at instants all over its keyframes, by which thresholds are chosen once for all.
  std::vector<float> samples() const;

 private:
  struct Octave {
    int cells, side;
    double amplitude, intervalS;
  };
  struct Term {  // of the covariance of the kernel: between channels of points (dx, dy) apart
    int dx, dy;
    float xx, xy, yy;
  };
  struct Numbers;
  void add(int octave, double j, double weight, Numbers& numbers) const;
  double preserve(const Octave& octave, Numbers& numbers) const;

  LivingOctaves living_;
  std::uint64_t seed_;
  glm::dvec2 scroll_;  // tiles a second and octave
  std::vector<Octave> octaves_;
  std::vector<Term> covariance_;
  double deviation_ = 1.0;  // of an octave over all seeds
};

}  // namespace welkin::scene
