// SPDX-License-Identifier: Apache-2.0
// Composes living octaves into the pattern of a sheet, on the device.
//
// The processor blends the octaves' lattices, a few thousand numbers, and uploads them; a pass over the
// pattern adds up what the kernel makes of them, another takes the slopes for embossed sheets, and mipmaps
// follow. Each instant costs the same: no keyframe is ever made or kept.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "welkin/gpu/draw.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/texture.h"
#include "welkin/scene/living_pattern.h"

namespace welkin::render {

// The living pattern of one sheet.
class LivingTexture {
 public:
  LivingTexture(const scene::Sheet& sheet, std::uint64_t seed);

  const scene::LivingPattern& pattern() const { return pattern_; }

 private:
  friend class OctavesPass;
  scene::LivingPattern pattern_;
  scene::LivingInstant instant_;
  std::array<gpu::Texture2D, scene::kMaxLivingOctaves> lattices_;
  gpu::Texture2D values_;  // of embossed sheets, before their slopes are taken
  gpu::Framebuffer target_;
  std::optional<double> shown_;  // the instant that is in the texture
};

class OctavesPass {
 public:
  OctavesPass();

  // Compiles what the pattern takes, so that compose() need not.
  void prepare(const LivingTexture& living);
  // Makes `texture` the pattern at an instant: R16F, or RGBA16F with slopes; texels x texels, repeating. Does
  // nothing where it is that already. Always the same texture for one LivingTexture. Allocates nothing after
  // the first time.
  void compose(LivingTexture& living, double secondsAfter, gpu::Texture2D& texture);

 private:
  gpu::Program& program(const scene::LivingPattern& pattern);
  std::map<std::pair<scene::OctaveKernel, int>, gpu::Program> programs_;  // by kernel and number of octaves
  gpu::Program slopes_;
  gpu::FullscreenTriangle triangle_;
};

}  // namespace welkin::render
