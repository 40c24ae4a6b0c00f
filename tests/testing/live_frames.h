// SPDX-License-Identifier: Apache-2.0
// Frames of a frame loop, to compare with stills.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/testing/pictures.h"
#include "welkin/core/image.h"
#include "welkin/gpu/context.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/live_sky.h"
#include "welkin/render/live_volumes.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/scene.h"
#include "welkin/scene/sky_state.h"
#include "welkin/shading/view.h"

namespace welkin::testing {

struct LiveAndStill {
  Image<float> live, still;
};
// Luminance in cd/m2 of a scene's own picture at its own time both ways, which agree within 3 %: live after
// so many frames of one view that volumes show no more of how they began.
inline LiveAndStill liveAndStill(const scene::Scene& s) {
  LiveAndStill both;
  both.still = render::SkyRenderer().draw(scene::buildSky(s, 0.0)).luminance;

  gpu::Context context{{.debug = true}};
  context.makeCurrent();
  const gpu::Texture2D texture(static_cast<int>(s.output.width), static_cast<int>(s.output.height),
                               {.format = gpu::Format::kRgba32F});
  const gpu::Framebuffer target(texture);
  render::LiveSky sky;
  sky.update(s, 0.0);
  const shading::View view = shading::viewOf(sky.state());
  for (int i = 0; i < 12 * render::LiveVolumes::kFramesInRound; ++i) sky.draw(view, target);
  both.live = target.readPicture(0, 3);
  for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  EXPECT_LT(relativeDifference(both.live, both.still), 0.03);
  return both;
}

}  // namespace welkin::testing
