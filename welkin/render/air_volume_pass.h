// SPDX-License-Identifier: Apache-2.0
// Fills air volumes (render/air_volume.h), by compute or by fragments.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "welkin/gpu/draw.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/air_volume.h"
#include "welkin/render/live_volumes.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {

class AirVolumePass {
 public:
  // Another scene, which the volumes know already.
  void change(const LiveVolumes& volumes, const scene::SkyState& state);

  // The program that fill() will run: compiled where it is asked for first in a scene. Sky, clouds and view
  // are to be set, and their textures bound, before that.
  gpu::Program& program(const AirVolumeOptions& options);
  const AirVolume& fill(const AirVolumeOptions& options);

 private:
  struct Volume {
    AirVolume shown;
    gpu::Texture3D colour, transmittance;
    // By fragments: what columns have come to, in turns, and for each slice where it is drawn.
    std::array<gpu::Texture2D, 2> columns;
    std::vector<gpu::Framebuffer> targets;
  };
  static Volume makeVolume(const AirVolumeOptions& options);
  static void makeTargets(Volume& volume);
  Volume& volumeOf(const AirVolumeOptions& options);

  gpu::FullscreenTriangle triangle_;
  shading::ShaderDefines defines_;
  const LiveVolumes* volumes_ = nullptr;
  const scene::SkyState* state_ = nullptr;
  gpu::Program compute_, fragments_;  // of the scene
  std::vector<std::unique_ptr<Volume>> views_;
};

}  // namespace welkin::render
