// SPDX-License-Identifier: Apache-2.0
// From noise to cloud. Beer and Lambert's law with an optical depth proportional to the excess of the noise
// over a threshold:
//
//   opacity = bias (1 - exp(-k max(n - threshold, 0))), clamped to [0, 1].
//
// The clamping-and-exponentiating of the thesis (G. Tarantilis 2004, "Simulating Clouds with Procedural
// Texturing Techniques Using the GPU"), of "Realistic Real-Time Skies" (Guthikonda, Meena, Linder, Yi) and of
// K. Pallister ("Generating Procedural Clouds Using 3D Hardware") are this law with other names for its
// parameters.
//
// Noise is in [0, 1]; a level is 1/255 of it.
#pragma once

#include <optional>
#include <span>

#include "welkin/core/params.h"

namespace welkin::field {

struct Condensation {
  double threshold = 0.0;  // noise below it is clear air
  double k = 0.0;          // optical depth for each unit of noise above the threshold, >= 0; may be infinite
  double bias = 1.0;       // opacity of what lets no light through, >= 0

  double opacity(double noise) const;
  // The least excess over the threshold that is that opaque, >= 0; infinite if nothing is.
  double excessOf(double opacity) const;
  // The whole row, in floats: equal to opacity() within 1e-6 where bias <= 1.
  void apply(std::span<float> noise) const;
};

// Tarantilis's textures: noise and cutoff in levels, opacity 1 - density^(noise - cutoff). cutoff in [0, 1]
// as he gives it to his classes, density in [0, 1].
Condensation thesisTexture(double cutoff, double density);

// His fragment shader: bias (1 - exponent^(noise - cutoff)), exponent in [0, 1].
Condensation thesisShader(double cutoff, double exponent, double bias);

// Guthikonda et al.: 1 - (1 - sharpness)^(255 max(noise - (1 - cover), 0)), both in [0, 1]. Their cover is a
// threshold, not the fraction of sky that is hidden: that is withCover() below.
Condensation realisticSkies(double cover, double sharpness);

// Pallister: scale max(noise - subtract, 0), saturated: the law's limit of small optical depth, where opacity
// is proportional to it. scale >= 0.
Condensation pallister(double subtract, double scale);

// The law as people ask for it. Noise condenses where a cutoff or a cover is given; how fast, one of the
// sources' parameters says.
struct CondensationParams {
  std::optional<double> cutoff = {}, cover = {};  // at most one
  // At most one; none: kDensity.
  std::optional<double> density = {}, exponent = {}, sharpness = {}, scale = {};
  double bias = 1.0;

  static constexpr double kDensity = 0.96;
  bool condenses() const { return cutoff || cover; }
};
void describe(CondensationParams& params, ParamVisitor& v);
// Throws ParameterError for parameters that exclude one another or have no meaning without a cutoff or a
// cover.
void validate(const CondensationParams& params);
// The law with the given cutoff; with a cover its threshold is still 0 and comes from withCover().
Condensation lawOf(const CondensationParams& params);

// The law with its threshold moved so that the samples above `quantile` (field/quantile.h) are those whose
// opacity is at least `visible`: 0.5 / 255 for 8-bit texels, which are then not zero; 0: any opacity.
// Throws ParameterError if the law makes nothing that opaque.
Condensation withCover(Condensation law, double quantile, double visible);

// A monotone curve for noise before it condenses: `inLow` to `inHigh` are stretched to 0..1, clamped, raised
// to the power `gamma` and mapped to `outLow`..`outHigh`.
struct ToneCurve {
  double inLow = 0.0, inHigh = 1.0;  // different
  double gamma = 1.0;                // > 0; above 1 darkens the middle
  double outLow = 0.0, outHigh = 1.0;

  double operator()(double noise) const;
  void apply(std::span<float> noise) const;
  bool operator==(const ToneCurve&) const = default;
};
void describe(ToneCurve& curve, ParamVisitor& v);
// Throws ParameterError if inLow equals inHigh.
void validate(const ToneCurve& curve);

}  // namespace welkin::field
