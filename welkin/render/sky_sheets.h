// SPDX-License-Identifier: Apache-2.0
// The thin layers of a still for pass/sky.frag, which meets them with its rays among the volumes that it
// marches through: in every projection and from any height.
#pragma once

#include <optional>
#include <vector>

#include "welkin/gpu/program.h"
#include "welkin/render/octaves_pass.h"
#include "welkin/render/sheet_pass.h"
#include "welkin/render/thin_layer.h"
#include "welkin/scene/sky_state.h"
#include "welkin/shading/sheet_order.h"
#include "welkin/shading/uniforms.h"

namespace welkin::render {

class SkySheets {
 public:
  // Prepares those of a sky. Patterns are kept for the next sky of the same scene.
  void update(const scene::SkyState& state);
  bool empty() const { return layers_.empty(); }

  // Of the sky under them, in place of the state's.
  const scene::AmbientLight& ambient() const { return ambient_; }

  // In place of shading::marchDefines.
  shading::ShaderDefines defines(const shading::LightVolumeLayout& layout, double eyeM) const;
  // Sets the uniforms of a program with those defines; bind() before each draw.
  void set(gpu::Program& program, const scene::SkyState& state,
           const shading::LightVolumeLayout& layout) const;
  void bind(gpu::Program& program) const;

 private:
  std::vector<shading::SheetInSky> inSky() const;

  std::optional<scene::Scene> scene_;  // that the layers are of
  std::vector<ThinLayer> layers_;      // from the ground up
  std::optional<OctavesPass> octaves_;
  std::vector<shading::SheetOnRay> onRay_;
  scene::AmbientLight ambient_;
};

}  // namespace welkin::render
