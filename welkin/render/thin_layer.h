// SPDX-License-Identifier: Apache-2.0
// A thin layer of cloud with all that it needs on the device: its mesh and its pattern.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "welkin/gpu/mesh.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/octaves_pass.h"
#include "welkin/scene/scene.h"
#include "welkin/shading/sheet_ambient.h"
#include "welkin/shading/sheet_look.h"

namespace welkin::render {

struct ThinLayer {
  scene::Sheet sheet;
  shading::SheetMatter described, matter;  // at the scene's time, and at the instant
  shading::LightOnSheet light;
  float sunThrough = 1.0f;  // mean share of the key light
  gpu::Mesh mesh;
  gpu::Texture2D flat;                  // the pattern, or
  gpu::Texture3D volume;                // of a dome
  std::optional<LivingTexture> living;  // what `flat` is composed from, where it changes over time
  const gpu::Texture& pattern() const {
    return flat.id() ? static_cast<const gpu::Texture&>(flat) : static_cast<const gpu::Texture&>(volume);
  }
};

// `light` and `sunThrough` are left as they are: they depend on all layers together.
ThinLayer makeThinLayer(const scene::Sheet& sheet, std::uint64_t seed, double earthRadiusM);

// Those of a scene (scene::sheetsOf), from the ground up.
std::vector<ThinLayer> makeThinLayers(const scene::Scene& scene, const weather::Weather& weather,
                                      double earthRadiusM);

}  // namespace welkin::render
