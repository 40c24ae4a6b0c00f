// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/rain_shafts.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

#include "welkin/core/normal.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/weather/wind.h"

namespace welkin::scene {
namespace {

static_assert(weather::kMaxLayers + weather::kMaxRainingLayers ==
              static_cast<std::size_t>(field::kMaxLayers));

constexpr double kRainingShare = 0.3;  // of what a layer's base covers: the cores of showers
constexpr double kLeastShare = 1e-12;  // of places
constexpr double kLeastBaseM = 50.0;   // beneath which nothing is seen of a shaft
constexpr double kSnowBelowC = 1.0;    // at the ground, where nobody says what falls

// What falls, by its rate in mm/h of water.
struct Falling {
  double extinctionAtOne, power;  // 1/m: the first times the rate to the second
  double speedMps;
  double evaporatesM;  // what 1 mm/h falls through before it is gone; grows as the square root of the rate
};
// The cross-section of the drops of J. S. Marshall and W. McK. Palmer 1948, "The distribution of raindrops
// with size": pi N0 / (2 Lambda^3), N0 = 8e6 / m^4, Lambda = 4100 rate^-0.21 / m. (They take as much light
// again, but turn that by hundredths of a degree: optics/rain_phase.h.) Speed of drops of 2 mm (R. Gunn and
// G. D. Kinzer 1949).
constexpr Falling kRain = {1.825e-4, 0.63, 6.0, 1300.0};
// About 1 km of visibility in 1 mm/h (R. M. Rasmussen et al. 1999, "The estimation of snowfall rate using
// visibility").
constexpr Falling kSnow = {3.0e-3, 0.7, 1.2, 1300.0};

bool fallsAsSnow(const weather::Weather& weather) {
  using weather::PrecipitationKind;
  return weather.precipitation == PrecipitationKind::kSnow ||
         (weather.precipitation == PrecipitationKind::kNone && weather.temperatureC < kSnowBelowC);
}

}  // namespace

RainingLayers rainingLayers(const Scene& scene, const weather::Weather& weather) {
  RainingLayers raining;
  for (std::size_t i = 0; i < weather.layers.size() && raining.count < raining.of.size(); ++i) {
    const weather::Layer& layer = weather.layers[i];
    if (layer.rainMmPerH > 0.0 && layer.baseM >= kLeastBaseM && isVolume(scene, layer))
      raining.of[raining.count++] = i;
  }
  return raining;
}

LayerOfField layerOfField(const Scene& scene, const weather::Weather& weather, std::size_t index) {
  const std::size_t own = weather.layers.size();
  if (index < own) return {index, false};
  return {rainingLayers(scene, weather).of[index - own], true};
}

bool isVolumeInField(const Scene& scene, const weather::Weather& weather, std::size_t index) {
  return isVolume(scene, weather.layers[layerOfField(scene, weather, index).of]);
}

CloudMatter matterInField(const Scene& scene, const weather::Weather& weather, std::size_t index) {
  const LayerOfField layer = layerOfField(scene, weather, index);
  if (layer.isShaft) return fallsAsSnow(weather) ? CloudMatter::kSnow : CloudMatter::kRain;
  return isIce(weather.layers[layer.of].genus) ? CloudMatter::kIce : CloudMatter::kDroplets;
}

bool hasRain(const Scene& scene, const weather::Weather& weather) {
  return !fallsAsSnow(weather) && rainingLayers(scene, weather).count > 0;
}

bool hasIce(const Scene& scene, const weather::Weather& weather) {
  return std::any_of(weather.layers.begin(), weather.layers.end(), [&](const weather::Layer& layer) {
    return isIce(layer.genus) && isVolume(scene, layer);
  });
}

field::CloudLayer shaftBeneath(const weather::Weather& weather, const weather::Layer& layer,
                               const field::CloudLayer& shape, double secondsAfter) {
  const Falling& falling = fallsAsSnow(weather) ? kSnow : kRain;
  const double topM = shape.baseM;
  // Unless much falls it is gone before it comes to the ground; what comes there from a little higher is
  // thinner.
  const double fallsM = falling.evaporatesM * std::sqrt(layer.rainMmPerH);
  const double baseM = std::max(topM - fallsM, 0.0), depthM = topM - baseM;
  constexpr double kFading = 0.7;  // share of its depth over which it thins out
  const double fading = kFading * std::clamp(2.0 - fallsM / topM, 0.0, 1.0);
  // Drops fall out of the cloud's wind into ever less of it and stay behind.
  const glm::dvec2 lagMps = layer.windSpeedMps * weather::windTowards(layer.windFromDeg) -
                            weather.surfaceWindSpeedMps * weather::windTowards(weather.surfaceWindFromDeg);
  const glm::dvec2 shearM = 0.5 * lagMps * (depthM / topM) * std::min(depthM / falling.speedMps, 600.0);

  field::CloudLayer s = shape;  // the same pattern
  s.baseM = static_cast<float>(baseM);
  s.topM = static_cast<float>(topM);
  s.extinction = static_cast<float>(falling.extinctionAtOne * std::pow(layer.rainMmPerH, falling.power));
  s.shearM = glm::vec2(shearM);
  s.driftM = shape.driftM - s.shearM;  // the top is where the cloud's base is
  s.dome = 0.0f;
  s.domePower = 1.0f;
  s.belly = 0.15f;
  s.anvil = 0.0f;
  const double covered = normalBelow(-static_cast<double>(shape.threshold + shape.belly));
  s.threshold = static_cast<float>(-normalQuantile(std::max(kRainingShare * covered, kLeastShare)));
  s.bottomSoft = static_cast<float>(std::max(fading, 1e-3));
  s.topSoft = 1e-3f;
  // Streaks, long and fine, that fall.
  s.shapeM = 5.0f * 500.0f;
  s.shapeAmount = 0.35f;
  s.shapeAtBase = 1.0f;
  s.shapeStretch = 1.0f;
  s.shapeTall = 8.0f;
  s.detailM = 5.0f * 90.0f;
  s.detailAmount = 0.12f;
  const double riseMps = -falling.speedMps / static_cast<double>(s.shapeTall);
  s.shapeShiftM = noiseShiftM(layer, kShapeLag, riseMps, s.shapeM, secondsAfter);
  s.detailShiftM = noiseShiftM(layer, kDetailLag, riseMps, s.detailM, secondsAfter);
  s.edge = 0.9f;
  s.lift = 0.0f;
  return s;
}

}  // namespace welkin::scene
