// SPDX-License-Identifier: Apache-2.0
// Draws thin layers of cloud: a mesh about the eye with a pattern on it.
#pragma once

#include <array>
#include <string>

#include "welkin/gpu/mesh.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/sky_textures.h"
#include "welkin/shading/sheet_ambient.h"
#include "welkin/shading/sheet_look.h"
#include "welkin/shading/uniforms.h"
#include "welkin/shading/view.h"

namespace welkin::render {

// A sheet ready to be drawn. The pattern is a Texture2D, or a Texture3D for domes: its value, and for
// embossed sheets the differences across a texel along the axes in the other channels.
struct SheetDraw {
  const gpu::Mesh* mesh;
  const gpu::Texture* pattern;
  scene::SheetTier tier;
  shading::SheetLook look;
  shading::LightOnSheet light;
};

class SheetPass {
 public:
  SheetPass();  // compiles all tiers, so that no frame has to

  // Sets what all sheets of a frame share; before draws and whenever the sky has changed.
  void setSky(const shading::Uniforms& sky);
  // Over what is in the target. scale: written value for each cd/m2.
  void draw(const SheetDraw& sheet, const shading::ViewParts& view, const SkyTextures& tables,
            const gpu::Target& target, float scale);

 private:
  gpu::Program& program(const SheetDraw& sheet);
  std::array<gpu::Program, 6> programs_;  // by tier, flat patterns first
};

// Sets `name`.offset and the other members of lib/sheet.glsl's struct. `names` as sheetUniformNames gives.
using SheetUniformNames = std::array<std::string, 10>;
SheetUniformNames sheetUniformNames(const std::string& name);
void setSheet(gpu::Program& program, const SheetUniformNames& names, const shading::SheetLook& look);

}  // namespace welkin::render
