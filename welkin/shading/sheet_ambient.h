// SPDX-License-Identifier: Apache-2.0
// What thin layers do to the light of all that is beneath them: they dim the sun, and send down part of what
// they take from it, so that it gets brighter all around under broken cloud and grey and dark under thick.
// Means over the layers' whole patterns; where the shadows lie the patterns themselves say. Pure.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "welkin/scene/sky_state.h"
#include "welkin/shading/sheet_look.h"

namespace welkin::shading {

// What a layer lets down, mean over its pattern.
struct SheetTransmittance {
  double direct = 1.0;    // of a light's direct light
  double diffused = 0.0;  // of the same, scattered on the way
  double sky = 1.0;       // of light from all directions
};

// Of one optical depth, seen square on, for a light of this sine of elevation. Conservative cloud in the
// two-stream (Eddington) approximation, scaled by similarity, t = (1 - g) depth (E. P. Shettle and J. A.
// Weinman 1970, "The Transfer of Solar Irradiance Through Inhomogeneous Turbid Atmospheres Evaluated by
// Eddington's Approximation"; J. H. Joseph, W. J. Wiscombe and J. A. Weinman 1976, "The Delta-Eddington
// Approximation for Radiative Flux Transfer"):
//
//   direct + diffused = ((2/3 + mu) + (2/3 - mu) exp(-t / mu)) / (4/3 + t),  direct = exp(-depth / mu),
//   sky = 1 / (1 + 3/4 t).
//
// mu is at least 0.1, as for shadows (lib/sheet_shadows.glsl). bias: the most that the layer hides.
SheetTransmittance transmittanceOf(double depth, double sine, double bias);

// The mean over a pattern: each of its columns for itself, the independent column approximation (R. F.
// Cahalan et al. 1994, "The Albedo of Fractal Stratocumulus Clouds").
SheetTransmittance transmittanceOf(const SheetMatter& matter, double sine);

// The light on a layer from above.
struct LightOnSheet {
  float sun = 1.0f;     // share of the key light that reaches it
  glm::vec3 sky{0.0f};  // mean luminance of the upper hemisphere, cd/m2
};

struct LightUnderSheets {
  scene::AmbientLight ambient;       // at the ground; of the sky above all clouds where it says so
  std::vector<LightOnSheet> sheets;  // a layer each, in their order
  std::vector<float> sunThrough;     // mean share of the key light that each lets through
  glm::vec3 onHaze{1}, onGlow{1};    // what they leave of the air's light; of what volumes add to it
  bool amongVolumes = false;
};

struct SheetInSky {
  double heightM = 0.0;
  const SheetMatter* matter = nullptr;
};

// A layer of the weather that is drawn as a volume, as light from above sees it: a slab with holes.
struct VolumeInSky {
  double heightM = 0.0;  // of its middle
  double depth = 0.0;    // typical optical depth
  double cover = 0.0;    // [0, 1]
};
std::vector<VolumeInSky> volumesIn(const scene::SkyState& state);

// sheets: from the ground up. Light that goes to and fro between the ground and the clouds counts; between
// clouds not.
//
// Beside volumes the state's ambient light, which knows of them, is taken times what the sheets change of it.
// They dim the sky over a sheet, too; the share of the key light that reaches one leaves them out, as their
// shadows are drawn.
LightUnderSheets lightUnder(const scene::SkyState& state, std::span<const SheetInSky> sheets,
                            std::span<const VolumeInSky> volumes = {});
// The same into `out`, which allocates nothing once it has held as many sheets.
void lightUnder(const scene::SkyState& state, std::span<const SheetInSky> sheets,
                std::span<const VolumeInSky> volumes, LightUnderSheets& out);

// The air about eyes at a height above the ground, m, where there are sheets. light: lightUnder() of them.
scene::EyeAir airUnder(const scene::SkyState& state, std::span<const SheetInSky> sheets,
                       const LightUnderSheets& light, double eyeM);

// Light at a height under sheets: the mean luminance of the sky there as a multiple of the clear sky's (xyz),
// and the mean share of the key light (w).
glm::vec4 lightShareUnder(const scene::SkyState& state, std::span<const SheetInSky> sheets, double heightM);

}  // namespace welkin::shading
