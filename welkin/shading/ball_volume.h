// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs as textures that the march samples (lib/ball_volume.glsl): the field of each shape on a
// grid, and a table that says which clouds stand in each cell of the ground. Pure; no OpenGL.
//
// Between grid points the field is linear. Of the library's clouds (scene/cumulus_library.h) that changes it
// by 1 to 3 % in the relative L2 norm (tests/unit/shading/ball_volume_test.cpp); more where a file has
// balls that are small in its cloud: grids have at most kFinestSide points a side, and fewer where there are
// many shapes.
#pragma once

#include "welkin/core/image.h"
#include "welkin/scene/metaballs.h"
#include "welkin/shading/shader_library.h"
#include "welkin/shading/uniforms.h"

namespace welkin::shading {

struct BallVolume {
  static constexpr int kFinestSide = 128;
  static constexpr int kTableWidth = 192;

  Volume<float> shapes;  // all of them beside one another: density, and how far from the nearest ball
  Image<float> table;    // RGBA: cells, then what stands in them
  Uniforms uniforms;
  int sidePoints = 0;               // of each shape's grid
  float lowM = 0.0f, highM = 0.0f;  // above the ground, of all clouds

  bool empty() const { return shapes.data.empty(); }
};

BallVolume ballVolume(const scene::MetaballInstances& clouds);

}  // namespace welkin::shading
