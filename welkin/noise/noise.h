// SPDX-License-Identifier: Apache-2.0
// Procedural noise, evaluated in two ways: at a point (the reference, in double) and over grids into the
// caller's buffer (fast; agrees with the point function to 2e-6 of the amplitude, however far the offset;
// curl to 2e-6 of its greatest value, which is large where cells are much narrower on one axis than on x;
// distorted noise that is bent, whose slopes multiply, to 6e-6).
//
//   const Noise noise({.frequency = {6, 6, 6}, .octaves = 6, .normalisation = Normalisation::kThesis});
//   std::vector<std::uint8_t> texels(128 * 128 * 128);
//   noise.fill(Grid::tile({128, 128, 128}), std::span(texels));
//
// A fill gives the same bytes for any number of threads, for a whole grid and its sub-boxes, and on any
// processor with fused multiply-add. Filling again allocates nothing (but what starting threads takes).
// Immutable after construction; safe to share between threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "welkin/core/error.h"
#include "welkin/noise/params.h"

namespace welkin::noise {

// IEEE 754 binary16, by its bits.
struct Half {
  std::uint16_t bits = 0;
};

// Places of samples. Sample (i, j, k) lies at ((i, j, k) + 0.5) * spacing, in units of the domain.
struct Grid {
  glm::ivec3 size{1};       // samples of the whole; in a plane size.z is 1
  glm::dvec3 spacing{1.0};  // > 0

  // One tile of the domain: spacing 1 / size.
  static Grid tile(glm::ivec3 size) { return {size, 1.0 / glm::dvec3(size)}; }
};

// Part of a grid: rows, slices or any box.
struct Box {
  glm::ivec3 first{0};
  glm::ivec3 size{1};
};

class Noise {
 public:
  // Throws ParameterError as validate() does.
  explicit Noise(const NoiseParams& params);
  ~Noise();
  Noise(Noise&&) noexcept;
  Noise& operator=(Noise&&) noexcept;

  const NoiseParams& params() const { return params_; }

  // 1; curl: a channel for each dimension, in units of amplitude per cell of the first octave along x;
  // Perlin-Worley: 4.
  int channels() const;

  // The value at p, in units of the domain, normalised; NaN where p is not finite. 0 <= channel < channels().
  double sample(const glm::dvec3& p, int channel = 0) const;

  // Value and derivatives by p, of the raw sum; NaN where p is not finite. For Fractal::kFbm of Kind::kPerlin
  // and Kind::kValue; throws ParameterError for others.
  struct Slope {
    double value;
    glm::dvec3 gradient;  // per unit of the domain
  };
  Slope sampleSlope(const glm::dvec3& p) const;

  // Fills `out` with a grid, or the part `box` of it: channels interleaved, x fastest, then y, then z. The
  // normalised value v becomes, by T:
  //   float, Half        v; out of the range of halves: infinity
  //   uint8_t, uint16_t  round(255 u), round(65535 u), u clamped to [0, 1]: v lifted as liftOf() says, of
  //                      unit variance four deviations either way
  // Throws ParameterError when out is not as long as box.size times channels(), the box leaves the grid, or
  // a plane's grid has several slices.
  template <class T>
  void fill(const Grid& grid, const Box& box, std::span<T> out) const;
  template <class T>
  void fill(const Grid& grid, std::span<T> out) const {
    fill(grid, Box{glm::ivec3(0), grid.size}, out);
  }

 private:
  struct Impl;
  NoiseParams params_;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace welkin::noise
