// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs in a frame loop: what LiveSky draws of them, lit anew in every frame.
#pragma once

#include <vector>

#include "welkin/gpu/program.h"
#include "welkin/render/splat_pass.h"
#include "welkin/scene/sky_state.h"
#include "welkin/shading/uniforms.h"

namespace welkin::render {

class LiveSplats {
 public:
  // Whether a sky has any.
  static bool in(const scene::SkyState& state);

  // Another scene: forgets all that was found for an eye, and makes room for what the sky holds.
  void change(const scene::SkyState& state);
  // Another instant of it. skyUniforms: shading::skyUniforms of the state as it is to be drawn.
  void update(const scene::SkyState& state, const shading::Uniforms& skyUniforms);

  // Finds the clouds and their shadow for an eye, before the rest; nothing to do where neither eye nor
  // instant has changed.
  void lookFrom(const scene::SkyState& state, const glm::dvec3& eyeM);
  // The middle of their heights.
  double heightM() const { return heightM_; }
  // lib/splat_layer.glsl's shadow, for programs with WELKIN_SPLATS.
  void setShadow(gpu::Program& program) const { pass_.setShadow(program); }
  // The share of light from behind it all that comes to the eye of lookFrom() out of a unit direction, as
  // soft as their shadow.
  float lightFrom(const glm::vec3& direction) const;
  void draw(const shading::ViewParts& view, const SkyTextures& tables, const SplatTarget& to);

 private:
  SplatPass pass_{SplatDetail::kLive};
  scene::CloudBalls balls_, shadowBalls_;
  std::vector<SplatCloud> clouds_, shadowClouds_;
  std::optional<glm::dvec3> eyeM_;  // that they were found for
  double heightM_ = 0.0;
};

}  // namespace welkin::render
