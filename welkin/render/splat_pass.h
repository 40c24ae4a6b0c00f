// SPDX-License-Identifier: Apache-2.0
// Draws clouds of metaballs in two passes, both of them every frame, after Y. Dobashi et al. 2000, "A Simple,
// Efficient Method for Realistic Animation of Clouds", M. J. Harris and A. Lastra 2001, "Real-Time Cloud
// Rendering", and P. Man 2006, "Generating and Real-Time Rendering of Clouds". Nothing is read back.
//
// Light pass: the balls' optical depths add up in slices across the light's direction, whatever their order,
// for the sun (or moon) and for the zenith. Eye pass: the balls from far to near, each with its exact optical
// depth along every ray, lit by what the slices say at four places in it; light scattered more than once is
// lib/cloud_light.glsl's, as in marched volumes. The phase function is the first scattering's; all later ones
// are those of droplets.
//
// Of other things in the sky it knows nothing: it draws over what is in the target.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "welkin/field/metaballs.h"
#include "welkin/gpu/draw.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/instances.h"
#include "welkin/render/sky_textures.h"
#include "welkin/shading/uniforms.h"
#include "welkin/shading/view.h"

namespace welkin::render {

enum class SplatPhase { kDroplets, kRayleigh, kIsotropic };

struct SplatLook {
  SplatPhase phase = SplatPhase::kDroplets;
  float albedo = 1.0f;  // 0.9 in P. Man
  float scale = 1.0f;   // written value for each cd/m2
};

class SplatPass {
 public:
  SplatPass();

  // What all draws under one sky share; before draws and whenever the sky has changed.
  void setSky(const shading::Uniforms& sky, const glm::vec3& toLight);

  // Over what is in the target. balls: in the view's world, densities being extinctions, 1/m; negative ones
  // take away. Ones of radius 0 or density 0 are left out. The picture depends on the arguments alone, not on
  // the balls' order unless two are equally far. Allocates nothing once it has drawn as many balls.
  void draw(std::span<const field::Metaball> balls, const SplatLook& look, const shading::ViewParts& view,
            const SkyTextures& tables, const gpu::Target& target);

 private:
  struct Stack;
  struct StackTextures {
    gpu::Texture2D slices, depths;
    gpu::Framebuffer toSlices, toDepths;
  };
  void drawStack(std::span<const field::Metaball> balls, const glm::dvec3& eyeM, const glm::vec3& toLight,
                 const std::string* names, const StackTextures& to);
  void sort(std::span<const field::Metaball> balls, const glm::dvec3& eyeM);

  gpu::Program depth_, sum_, eye_;
  gpu::FullscreenTriangle triangle_;
  gpu::Instances slices_{2}, quads_{2};
  StackTextures sun_, sky_;
  glm::vec3 toLight_{0.0f, 0.0f, 1.0f};
  std::vector<std::uint32_t> order_;  // far to near, as the last frame had it
  std::vector<double> distances_;     // of each ball, squared
  std::vector<float> values_;
};

}  // namespace welkin::render
