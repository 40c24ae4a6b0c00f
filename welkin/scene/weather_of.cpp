// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <tuple>

#include "welkin/core/error.h"
#include "welkin/scene/sky_state.h"
#include "welkin/weather/from_metar.h"
#include "welkin/weather/metar.h"

namespace welkin::scene {
namespace {

weather::Weather fromReport(const Scene& scene) {
  const weather::MetarResult result = weather::parseMetar(*scene.metar);
  if (!result.ok())
    throw ParseError("METAR", 0, static_cast<int>(result.errors.front().column),
                     result.errors.front().reason);
  if (result.metar.nil)
    throw ParseError("METAR", 0, 0, "the report is NIL, which says nothing about the weather");
  // Mean solar time: the equation of time is at most a quarter of an hour, which the rules do not feel.
  const UtcTime local = addSeconds(scene.time, scene.place.longitudeDeg / 15.0 * 3600.0);
  return weather::weatherFromMetar(result.metar, scene.place.latitudeDeg, local.month,
                                   local.hour + local.minute / 60.0);
}

weather::Weather byHand(const Scene& scene) {
  weather::Weather w;
  w.layers = scene.layers;
  // By all that tells two layers apart, so that their order in the file does not matter.
  const auto key = [](const weather::Layer& l) { return std::tuple(l.baseM, l.topM, l.genus, l.oktas); };
  std::sort(w.layers.begin(), w.layers.end(),
            [&](const weather::Layer& a, const weather::Layer& b) { return key(a) < key(b); });
  // Layers by hand lie over one another at random.
  double clear = 1.0;
  for (const weather::Layer& layer : w.layers) clear *= 1.0 - layer.oktas / 8.0;
  w.requestedOktas = 8.0 * (1.0 - clear);
  return w;
}

}  // namespace

weather::Weather weatherOf(const Scene& scene) {
  weather::Weather w = scene.metar ? fromReport(scene) : byHand(scene);
  if (scene.visibilityM) w.visibilityM = *scene.visibilityM;
  return w;
}

}  // namespace welkin::scene
