// SPDX-License-Identifier: Apache-2.0
// The clouds of metaballs of a still for pass/sky.frag, which meets them with its rays as one more surface
// (lib/splat_layer.glsl): drawn on the picture's own plane, or for other projections on the faces of a cube.
#pragma once

#include <optional>
#include <vector>

#include "welkin/gpu/program.h"
#include "welkin/render/splat_pass.h"
#include "welkin/scene/sky_state.h"
#include "welkin/shading/uniforms.h"

namespace welkin::render {

// What SplatPass draws, as spans of those balls, and of what shades in their place.
void splatClouds(const scene::CloudBalls& balls, const scene::CloudBalls& shades,
                 std::vector<SplatCloud>& out);

class SkySplats {
 public:
  // Those of a sky that are drawn as splats; may be none.
  void update(const scene::SkyState& state);
  bool empty() const { return clouds_.empty(); }

  // To be added to the march's.
  static void addDefines(shading::ShaderDefines& defines) { defines.emplace_back("WELKIN_SPLATS", "1"); }
  // Draws them for the state's camera, and sets up a program with that define. The state is the one of
  // update() but for camera, heading and size.
  void draw(const scene::SkyState& state, const SkyTextures& tables, gpu::Program& program);
  void bind(gpu::Program& program) const;

 private:
  scene::CloudBalls balls_, shadowBalls_;
  std::vector<SplatCloud> clouds_, shadowClouds_;
  std::optional<SplatPass> pass_;
  gpu::Texture2D light_, distance_;
  std::optional<gpu::Framebuffer> target_;
};

}  // namespace welkin::render
