// SPDX-License-Identifier: Apache-2.0
// Frames of a frame loop, to compare with stills.
#pragma once

#include "welkin/core/image.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/live_sky.h"
#include "welkin/render/live_volumes.h"
#include "welkin/scene/scene.h"
#include "welkin/shading/view.h"

namespace welkin::testing {

// Luminance in cd/m2 of a scene's own picture at its own time, after so many frames of one view that volumes
// show no more of how they began. In the current OpenGL context.
inline Image<float> settledLiveFrame(const scene::Scene& s) {
  const gpu::Texture2D texture(static_cast<int>(s.output.width), static_cast<int>(s.output.height),
                               {.format = gpu::Format::kRgba32F});
  const gpu::Framebuffer target(texture);
  render::LiveSky sky;
  sky.update(s, 0.0);
  const shading::View view = shading::viewOf(sky.state());
  for (int i = 0; i < 12 * render::LiveVolumes::kFramesInRound; ++i) sky.draw(view, target);
  return target.readPicture(0, 3);
}

}  // namespace welkin::testing
