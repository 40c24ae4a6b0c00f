// SPDX-License-Identifier: Apache-2.0
// Draws the lens flare (shading/lens_flare.h) over a finished picture, as much of it as the sun's light
// arrives.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec4.hpp>
#include <span>
#include <string>

#include "welkin/gpu/mesh.h"
#include "welkin/gpu/texel_reader.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/sheet_pass.h"
#include "welkin/shading/lens_flare.h"
#include "welkin/shading/sheet_look.h"
#include "welkin/shading/sheet_mesh.h"
#include "welkin/shading/view.h"

namespace welkin::render {

// Depth that an engine has drawn, to hide the sun behind its things: an OpenGL 2D texture of exactly the
// target's part that is drawn to. Read texel by texel, whatever filter or comparison is set for it.
struct EngineDepth {
  unsigned texture = 0;   // its GL name; 0: there is none
  bool reversed = false;  // 0 where there is nothing, else 1
};

// A sheet that may stand before the sun.
struct FlareSheet {
  const gpu::Texture* pattern = nullptr;  // as SheetDraw has it
  shading::SheetShape shape;              // shading::shapeOf
  scene::SheetSurface surface = scene::SheetSurface::kSkyPlane;
  shading::SheetLook look;
};

class FlarePass {
 public:
  // So many sheets count, flat ones and domes; further ones let all light through.
  static constexpr std::size_t kMaxFlat = 6, kMaxVolumes = 2;

  FlarePass();

  // What stands before the sun.
  struct Before {
    std::span<const FlareSheet> sheets;
    const gpu::Texture* picture = nullptr;  // in their place: w is the share of light that goes through
    EngineDepth depth;
  };
  // Adds it to the target. strength: the share of the sun's light that the lens scatters; scale: written
  // value for each cd/m2. Does nothing where no flare is shown. Allocates nothing.
  void draw(const shading::LensFlare& flare, float strength, const shading::ViewParts& view,
            double earthRadiusM, const Before& before, const gpu::Target& target, float scale);

 private:
  // Where the sheets of one kind of pattern go in the program.
  struct Slots {
    std::string count, surfaces, rims;
    std::array<SheetUniformNames, kMaxFlat> sheets;
    std::array<std::string, kMaxFlat> patterns;
  };
  static Slots slotsOf(const std::string& name);
  void setSheets(const Slots& slots, bool volumes, std::size_t most, std::span<const FlareSheet> sheets);

  gpu::Program program_;
  gpu::Mesh quads_;
  gpu::TexelReader depthReader_;
  Slots flat_ = slotsOf("uFlat"), volumes_ = slotsOf("uVolume");
};

}  // namespace welkin::render
