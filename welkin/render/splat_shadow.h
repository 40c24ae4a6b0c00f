// SPDX-License-Identifier: Apache-2.0
// The shadow of clouds of metaballs on what is beneath them: optical depths through all of them across the
// key light, for lib/splat_layer.glsl.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/instances.h"
#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/splat_cloud.h"

namespace welkin::render {

class SplatShadow {
 public:
  static constexpr double kReachM = 20000.0;  // from the eye

  // None where the light stands below the horizon. depth: pass/splat_depth.
  void draw(std::span<const SplatCloud> clouds, const glm::dvec3& eyeM, const glm::vec3& toLight,
            gpu::Program& depth);
  void set(gpu::Program& program) const;

 private:
  gpu::Instances balls_{2};
  gpu::Texture2D shadow_;
  std::optional<gpu::Framebuffer> toShadow_;
  std::array<glm::vec4, 2> axes_{};
  float halfM_ = 0.0f;
  std::vector<float> values_;
};

}  // namespace welkin::render
