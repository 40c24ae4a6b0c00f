// SPDX-License-Identifier: Apache-2.0
// Marched layers of cloud in a frame loop, with the thin layers among them: what LiveSky draws where a sky
// has volumes.
//
// A frame marches one pixel of each block of kBlock x kBlock; the others are what they were, moved with the
// eye and the wind. While neither eye nor time moves, every frame adds to a mean that converges to the still
// of the same scene, time and eye; after kRounds rounds through the blocks nothing is marched any more. The
// light volume follows time and eye a few slices a frame.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/cloud_textures.h"
#include "welkin/render/light_volume_pass.h"
#include "welkin/render/sheet_pass.h"
#include "welkin/render/sky_textures.h"
#include "welkin/render/thin_layer.h"
#include "welkin/scene/sky_state.h"
#include "welkin/shading/sheet_order.h"
#include "welkin/shading/uniforms.h"
#include "welkin/shading/view.h"

namespace welkin::render {

class LiveVolumes {
 public:
  static constexpr int kBlock = 4;
  static constexpr int kFramesInRound = kBlock * kBlock;
  static constexpr int kRounds = 32;
  // That a new light volume is spread over, of few columns (shading::LightVolumeLayout); twice as many, twice
  // as long.
  static constexpr int kFramesOfSweep = 16;

  LiveVolumes();

  // Another scene: compiles what its layers need and forgets all that was drawn. sheets: the sky's thin
  // layers, from the ground up.
  void change(const scene::SkyState& state, const std::vector<ThinLayer>& sheets);
  // Another instant of it. skyUniforms: shading::skyUniforms of the state as it is to be drawn.
  void update(const shading::Uniforms& skyUniforms);

  // Marches the frame's share of a view and completes it. view: its number; each has a memory of its own,
  // which is made when it is first drawn or drawn in another size. The light volume keeps to the eye of view
  // 0, and to the instant whatever views are drawn.
  void march(std::size_t view, const scene::SkyState& state, const std::vector<ThinLayer>& sheets,
             const CloudTextures& clouds, const SkyTextures& tables, const shading::ViewParts& parts,
             int width, int height);
  // For what is drawn behind it, after march() of the same view: finds the shadows of the volumes in the air,
  // and gives them to programs, with those on the ground.
  void shadeAir(std::size_t view, const scene::SkyState& state, const SkyTextures& tables,
                const shading::ViewParts& parts);
  void setShadows(gpu::Program& program, std::size_t view, const scene::SkyState& state,
                  const shading::ViewParts& parts) const;
  // The view's picture, premultiplied; w: the share of light from behind it all that goes through. After
  // march() of the same view.
  const gpu::Texture& picture(std::size_t view) const {
    return memories_[view]->history[memories_[view]->now];
  }
  // Draws it over the target. After march() of the same view.
  void show(std::size_t view, const gpu::Target& target, float scale);

  // For other marches through the same: what to compile in, what stays while the scene does, and what changes
  // with the instant and the eye (lib/march.glsl but for the sky's uniforms, and uEyeM, uEnuFromCamera,
  // uRayScale, uPixelRad).
  const shading::ShaderDefines& defines() const { return defines_; }
  void setScene(gpu::Program& program, const scene::SkyState& state) const;
  void setView(gpu::Program& program, const scene::SkyState& state, const std::vector<ThinLayer>& sheets,
               const shading::ViewParts& parts);
  // Sweeps the light volume where there is none, or none that fits the instant and the eye.
  void needLight(const scene::SkyState& state, const CloudTextures& clouds, const shading::ViewParts& parts);

  // The middle of their heights.
  double heightM() const {
    return layout_.bands.empty()
               ? 0.0
               : 0.5 * static_cast<double>(layout_.bands.front().baseM + layout_.bands.back().topM);
  }

  // For programs that want the shadows of the volumes: the uniforms of lib/light_volume.glsl, and those that
  // change with the view, with the texture.
  shading::Uniforms lightUniforms() const { return shading::lightVolumeUniforms(layout_); }
  void setLight(gpu::Program& program, const scene::SkyState& state, const shading::ViewParts& parts) const;

 private:
  // What is remembered of a view.
  struct Memory {
    gpu::Texture2D fresh, freshDepth;
    gpu::Texture2D mean, spread, nearest;  // of fresh ones, about each block
    gpu::Texture2D airShadows;
    std::array<gpu::Texture2D, 2> history, count;
    gpu::Framebuffer march, span, air;
    std::array<gpu::Framebuffer, 2> resolved;
    std::size_t now = 0;  // of the two
    bool any = false;     // something is in it
    int frame = 0;
    bool still = false;  // in the last frame neither eye nor time moved
    shading::ViewParts parts{};
    std::vector<glm::dvec2> driftM;  // of each band, at the last frame
    double seconds = 0.0;
    int light = 0;  // the light volume's number
  };
  // Where and when a light volume was swept.
  struct Swept {
    double seconds = 0.0;
    glm::dvec2 centreM{0.0};
    glm::dvec2 driftM{0.0};
    bool bySun = true;
    glm::vec3 line{0, 0, 1};
    bool towardsSun = true;
    bool operator==(const Swept&) const = default;
  };

  static Memory makeMemory(int width, int height, std::size_t bands);
  Swept wantedLight(const scene::SkyState& state, const shading::ViewParts& parts);
  bool isOfAnotherTime(const Swept& wanted) const;
  bool leaps(const Swept& wanted, glm::dvec2 eyeM) const;
  void keepLight(const scene::SkyState& state, const CloudTextures& clouds, const shading::ViewParts& parts);
  glm::dvec2 driftOfBand(const scene::SkyState& state, std::size_t band) const;
  glm::vec2 lightShiftM(const scene::SkyState& state, const shading::ViewParts& parts) const;
  void setSheets(gpu::Program& program, const scene::SkyState& state, const std::vector<ThinLayer>& sheets,
                 const shading::ViewParts& parts);
  void setMarch(const Memory& memory, const scene::SkyState& state, const std::vector<ThinLayer>& sheets,
                const shading::ViewParts& parts, int width, int height);
  void resolve(Memory& memory, const scene::SkyState& state, const shading::ViewParts& parts, bool still);

  gpu::FullscreenTriangle triangle_;
  ProgramVariants marches_{"pass/live_march.frag"};
  gpu::Program* marching_ = nullptr;  // of the scene
  gpu::Program air_, spread_, resolve_, show_;
  LightVolumePass lightVolume_;
  std::optional<Swept> light_, sweeping_;
  int lightNumber_ = 0;
  shading::LightVolumeLayout layout_;
  float reach_ = 1.0f;
  std::vector<std::unique_ptr<Memory>> memories_;

  shading::ShaderDefines defines_;
  shading::Uniforms order_;  // of sheets among bands

  // Kept for their memory.
  shading::Uniforms layers_, march_;
  std::vector<std::string> patternNames_;
  std::vector<SheetUniformNames> sheetNames_;
  std::vector<glm::vec4> shapes_, rays_, skies_, sunSteps_, bandSky_, bandMoves_;
  std::vector<shading::SheetInSky> inSky_;
};

}  // namespace welkin::render
