// SPDX-License-Identifier: Apache-2.0
// The sky's air and clouds between the eye and any distance, for what an engine draws itself and that lets
// light through: glass, water, particles. A surface of colour c at a distance along a view's ray arrives as
//
//   transmittance(uv, distance) * c + colour(uv, distance)
//
// for which shaders/lib/air_volume.glsl has a function, to include or to copy.
//
// In it: the air with the shadows that volumes cast in it, marched layers and thin sheets in their order, the
// curved earth. Not in it: clouds of metaballs, which LiveSky draws as splats, the lens flare, and whatever
// is behind the last slice. Behind Welkin's ground nothing is added any more. Each column is one ray through
// its middle, and its clouds are as detailed as its width; for what is opaque and large, draw in front of
// the sky with this too.
#pragma once

#include "welkin/core/error.h"

namespace welkin::render {

struct AirVolumeOptions {
  int width = 80, height = 45, slices = 32;  // columns across and up, 1 to 512; slices, 2 to 512
  float nearM = 50.0f, farM = 60000.0f;      // distances of the first slice and of the last, 0 < near < far
  float scale = 1.0f;   // of colour for each cd/m2, > 0; halves end at 65504, and are fine about 1
  unsigned view = 0;    // number of the view, where several are drawn in a frame: each has its textures
  bool compute = true;  // one dispatch where the context has compute shaders (OpenGL 4.3); else, and without
                        // them, a fragment pass for each slice; they come to the same
};

struct AirVolume {
  // GL names of 3D textures of width x height x slices, RGBA16F, linear, clamped: luminance that arrives from
  // in front of a slice, linear Rec. 709, times the scale; share of each primary that arrives from behind.
  // Row 0 is the bottom of the picture; columns are seen at the middle of their texels.
  unsigned colour = 0, transmittance = 0;
  int width = 0, height = 0, slices = 0;
  float nearM = 0.0f, farM = 0.0f;

  // Of a slice from the eye along the ray: near * (far / near)^(slice / (slices - 1)), metres.
  double distanceM(int slice) const;
};

// Throws ParameterError, see above.
void checkAirVolume(const AirVolumeOptions& options);

}  // namespace welkin::render
