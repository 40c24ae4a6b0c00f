// SPDX-License-Identifier: Apache-2.0
// Pictures of far clouds of metaballs, in the place of their balls ("impostors": P. Maciel and P. Shirley
// 1995, "Visual Navigation of Large Environments Using Textured Clusters"; of clouds M. J. Harris and A.
// Lastra 2001): of each a few texels, drawn anew in every frame from where the eye is and in the light that
// there is, so that there is nothing to go stale. They are cheap as all clouds of one shape share its field
// on a grid, through which a picture's rays go, and its light's.
//
// A texel is as large in view wherever the cloud is, and one is on its middle: nothing jumps as it comes
// nearer.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "welkin/gpu/draw.h"
#include "welkin/gpu/instances.h"
#include "welkin/gpu/program.h"
#include "welkin/render/sky_textures.h"
#include "welkin/scene/metaballs.h"
#include "welkin/shading/splat_lights.h"
#include "welkin/shading/uniforms.h"
#include "welkin/shading/view.h"

namespace welkin::render {

struct PictureFineness {
  double texelPx;  // pixels on the side of a texel
  double texels;   // of all of them together, before they get coarser
};

class SplatPictures {
 public:
  explicit SplatPictures(const PictureFineness& fineness);

  // Room for so many; with the fields of the clouds' shapes, which are made at the first picture of one else.
  void reserve(std::size_t pictures, std::span<const scene::LibraryCloud* const> shapes);
  void setSky(const shading::Uniforms& sky, const shading::SplatLights& lights);

  // In a texture for all of them; and the stack of what shades each, in lib/splat_stack.glsl's.
  struct Picture {
    glm::vec3 centreM{0.0f};  // from the eye
    float radiusM = 0.0f;     // half of it along the line of view
    float texelM = 1.0f;      // on a texel's side, at the centre's distance
    glm::ivec2 corner{0}, texels{0};
    glm::ivec2 shade{0};
    glm::vec2 shadeHalves{0.0f};
    double halfRightM = 0.0, halfUpM = 0.0;
    scene::CloudBalls::Far cloud;
  };
  void clear() { pictures_.clear(); }
  // The middle of its box from the eye, and half the box's diagonal: whether it is in view is asked before.
  struct Bounds {
    glm::dvec3 centreM{0.0};
    double radiusM = 0.0;
  };
  Bounds boundsOf(const scene::CloudBalls::Far& cloud, const glm::dvec3& eyeM);
  void add(const scene::CloudBalls::Far& cloud, const glm::dvec3& eyeM);
  std::span<Picture> all() { return pictures_; }
  std::span<const Picture> all() const { return pictures_; }

  // Gives each its texels, in rows from one on; returns the row after them.
  int findTiles(double pixelRad, int widthPx, int row);

  struct Light {
    const gpu::Texture2D& depths;  // with the stacks
    int shadePx;                   // on a slice's side of those
  };
  void draw(const shading::ViewParts& view, const SkyTextures& tables, const Light& light,
            const gpu::Target& to);

 private:
  struct Shape {
    const scene::LibraryCloud* cloud;
    glm::dvec3 middle, half;  // of its box
  };
  gpu::Program& lightProgram() { return lightPrograms_[lights_.toSecond ? 1 : 0]; }
  std::size_t shapeOf(const scene::LibraryCloud& cloud);
  void fillGrids();

  PictureFineness fineness_;
  std::array<gpu::Program, 2> lightPrograms_;  // with the key light, with both lights
  shading::SplatLights lights_;
  gpu::Instances tiles_{6};
  gpu::Texture3D grids_;
  int columns_ = 0;         // shapes beside one another
  bool gridsKnow_ = false;  // all shapes
  std::vector<Shape> shapes_;
  std::vector<Picture> pictures_;
  std::vector<std::uint32_t> byHeight_;
  std::vector<float> values_;
};

}  // namespace welkin::render
