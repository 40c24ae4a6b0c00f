// SPDX-License-Identifier: Apache-2.0
// Thin layers among marched volumes: the order in which a ray meets them all, compiled into the march
// (shaders/lib/march.glsl), and the sheets as its uniforms (shaders/lib/sheet_ray.glsl). Pure.
//
// Bands of volumes are cut where a sheet goes through them. The order is by height overhead. That is exact
// for sky planes, which keep their height over the earth, as bands do. A plane stays level while the earth
// falls away, 20 heights out by 200 times the square of its height over the earth's radius (63 m at 1,400 m,
// 2 km at 8,000 m), and a dome or a hemisphere comes down to the ground: where that takes them through
// volumes they are drawn in the order that they have overhead.
#pragma once

#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "welkin/scene/sheet.h"
#include "welkin/shading/sheet_ambient.h"
#include "welkin/shading/sheet_look.h"
#include "welkin/shading/sheet_mesh.h"
#include "welkin/shading/uniforms.h"

namespace welkin::shading {

// A sheet as rays meet it.
struct SheetOnRay {
  scene::SheetSurface surface = scene::SheetSurface::kSkyPlane;
  scene::SheetTier tier = scene::SheetTier::kLit;
  SheetLook look{};  // for pixels of 1 rad
  SheetShape shape{};
  LightOnSheet light{};
  float sunThrough = 1.0f;  // mean share of the key light
};

// A step of the order: a sheet, or a piece of a band.
struct SkyPiece {
  int sheet = -1;  // its index, or
  int band = -1;   // the layout's
  float baseM = 0.0f, topM = 0.0f;
};
// sheets: from the ground up. The pieces come so, too.
std::vector<SkyPiece> piecesOf(const LightVolumeLayout& layout, std::span<const SheetOnRay> sheets);

// In place of marchDefines, where there are sheets.
ShaderDefines sheetDefines(const LightVolumeLayout& layout, std::span<const SheetOnRay> sheets, double eyeM);

// Beside those of the march; not uSheets, for which render/sheet_pass.h has a function. bandSky: of each
// band, lightShareUnder().
Uniforms sheetUniforms(const LightVolumeLayout& layout, std::span<const SheetOnRay> sheets,
                       std::span<const glm::vec4> bandSky, double eyeM);

}  // namespace welkin::shading
