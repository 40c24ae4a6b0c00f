// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "welkin/core/error.h"
#include "welkin/scene/sky_state.h"
#include "welkin/weather/metar.h"

namespace welkin::scene {

weather::Weather weatherOf(const Scene& scene) {
  weather::Weather w;
  w.layers = scene.layers;
  std::stable_sort(w.layers.begin(), w.layers.end(),
                   [](const weather::Layer& a, const weather::Layer& b) { return a.baseM < b.baseM; });
  // Layers by hand lie over one another at random.
  double clear = 1.0;
  for (const weather::Layer& layer : w.layers) clear *= 1.0 - layer.oktas / 8.0;
  w.requestedOktas = 8.0 * (1.0 - clear);
  if (scene.visibilityM) w.visibilityM = *scene.visibilityM;
  return w;
}

}  // namespace welkin::scene
