// SPDX-License-Identifier: Apache-2.0
// How the octaves of a living pattern are made and change: K. Pallister, "Generating Procedural Clouds Using
// 3D Hardware", and S. Guthikonda, A. Meena, D. Linder and S. Yi, "Realistic Real-Time Skies". What comes of
// it is in scene/living_pattern.h.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "welkin/core/params.h"

namespace welkin::scene {

// What becomes of an octave's lattice between its points.
enum class OctaveKernel {
  kGradient,   // gradient noise
  kPallister,  // values on 32 x 32 points, bilinear
  kCourse,     // values on 32 x 32 points, Gaussian: Guthikonda et al.
};

// How an octave gets from one keyframe to the next.
enum class OctaveBlend {
  kVariancePreserving,  // its contrast is the same at all times
  kLinear,              // as in the sources: contrast dips between keyframes
};

struct LivingOctaves {
  OctaveKernel kernel = OctaveKernel::kGradient;
  OctaveBlend blend = OctaveBlend::kVariancePreserving;
  double intervalS = 240.0;  // between keyframes of the first octave
  // Of an octave's interval over that of the one before: 2^(-2/3), as eddies of half the size turn over in
  // turbulence (A. N. Kolmogorov 1941, "The Local Structure of Turbulence in Incompressible Viscous Fluid for
  // Very Large Reynolds' Numbers").
  double intervalRatio = 0.63;
  double scrollMps = 0.4;    // that an octave drifts faster along the wind than the one before
  double updatesPerS = 0.0;  // of the pattern; 0: at every instant

  bool operator==(const LivingOctaves&) const = default;
};
void describe(LivingOctaves& o, ParamVisitor& v);

// The layers of the weather with living octaves.
struct LayerOctaves {
  std::int64_t resolution = 256;  // texels of the pattern, a side
  std::int64_t count = 4;         // of octaves
  LivingOctaves living;

  bool operator==(const LayerOctaves&) const = default;
};
void describe(LayerOctaves& o, ParamVisitor& v);

}  // namespace welkin::scene

namespace welkin {
template <>
inline constexpr auto kEnumNames<scene::OctaveKernel> =
    std::array<std::string_view, 3>{"gradient", "pallister", "course"};
template <>
inline constexpr auto kEnumNames<scene::OctaveBlend> =
    std::array<std::string_view, 2>{"variance-preserving", "linear"};
}  // namespace welkin
