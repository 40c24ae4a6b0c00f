// SPDX-License-Identifier: Apache-2.0
// Links the whole installed library, from the scene file to the renderer, and draws where there are graphics
// to draw with.
#include <cstdio>

#include "welkin/core/error.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/scene_file.h"
#include "welkin/scene/sky_state.h"

int main() {
  welkin::scene::Scene scene =
      welkin::scene::parseScene("[[layer]]\ngenus = \"cumulus\"\n", "consumer").scene;
  scene.output.width = 32;
  scene.output.height = 18;
  scene.output.quality = welkin::scene::Quality::kLow;
  const welkin::scene::SkyState state = welkin::scene::buildSky(scene, 0.0);
  if (state.weather.layers.size() != 1) return 1;
  try {
    welkin::render::SkyRenderer renderer;
    const welkin::render::Picture picture = renderer.draw(state);
    double sum = 0.0;
    for (const float luminance : picture.luminance.data) sum += luminance;
    std::printf("mean luminance %.0f cd/m2 on %s\n", sum / static_cast<double>(picture.luminance.data.size()),
                renderer.deviceName().c_str());
    return sum > 0.0 ? 0 : 1;
  } catch (const welkin::GpuError& e) {
    std::printf("not drawn: %s\n", e.what());
    return 0;
  }
}
