// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/cloud_cover.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"
#include "welkin/field/cover.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/metaballs.h"
#include "welkin/scene/rain_shafts.h"

namespace welkin::scene {
namespace {

constexpr field::CoverView kReportView{.directions = 3000};  // other directions than those of the calibration

std::vector<float> sumOf(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<float> sum(a.size());
  std::transform(a.begin(), a.end(), b.begin(), sum.begin(), std::plus<>());
  return sum;
}

}  // namespace

glm::dvec2 windDriftM(const Scene& scene, const weather::Layer& layer, double secondsAfter) {
  return layer.windSpeedMps * windPath(scene.drift, windSeed(scene), layer.windFromDeg, secondsAfter);
}

namespace {

// The layer at the instant, not yet moved.
field::CloudLayer settledLayer(const weather::Layer& layer, const LayerCalibration& calibration,
                               double secondsAfter) {
  field::CloudLayer shape = shapeOf(layer, calibration.seed, secondsAfter);
  shape.threshold = calibration.threshold;
  shape.extinction = calibration.extinction;
  return shape;
}

// Those of the weather, then what rain falls from them.
void layersAt(const Scene& scene, const weather::Weather& weather,
              const std::vector<LayerCalibration>& calibration, double secondsAfter,
              std::span<field::CloudLayer> layers) {
  const std::size_t own = weather.layers.size();
  for (std::size_t i = 0; i < own; ++i)
    layers[i] = settledLayer(weather.layers[i], calibration[i], secondsAfter);
  const RainingLayers raining = rainingLayers(scene, weather);
  for (std::size_t k = 0; k < raining.count; ++k) {
    const std::size_t i = raining.of[k];
    layers[own + k] = shaftBeneath(weather, weather.layers[i], layers[i], secondsAfter);
    field::moveLayer(layers[own + k], windDriftM(scene, weather.layers[i], secondsAfter));
  }
  for (std::size_t i = 0; i < own; ++i)
    field::moveLayer(layers[i], windDriftM(scene, weather.layers[i], secondsAfter));
}

}  // namespace

field::CloudLayer layerAt(const Scene& scene, const weather::Layer& layer,
                          const LayerCalibration& calibration, double secondsAfter) {
  field::CloudLayer shape = settledLayer(layer, calibration, secondsAfter);
  field::moveLayer(shape, windDriftM(scene, layer, secondsAfter));
  return shape;
}

field::CloudField cloudsAt(const Scene& scene, const weather::Weather& weather,
                           const std::vector<LayerCalibration>& calibration,
                           std::shared_ptr<const field::CloudNoise> noise, double secondsAfter) {
  std::vector<field::CloudLayer> layers(weather.layers.size() + rainingLayers(scene, weather).count);
  layersAt(scene, weather, calibration, secondsAfter, layers);
  return {std::move(noise), std::move(layers), scene.place.altitudeM};
}

void moveClouds(const Scene& scene, const weather::Weather& weather,
                const std::vector<LayerCalibration>& calibration, double secondsAfter,
                field::CloudField& clouds) {
  std::array<field::CloudLayer, field::kMaxLayers> layers;
  const std::size_t count = clouds.layers().size();
  layersAt(scene, weather, calibration, secondsAfter, std::span(layers).first(count));
  clouds.setLayers(std::span(layers).first(count));
}

DeliveredCover measureCover(const Scene& scene, const weather::Weather& weather,
                            const field::CloudField& clouds, double secondsAfter,
                            const MetaballSky* metaballs) {
  DeliveredCover cover;
  const std::vector<Sheet> sheets = sheetsOf(scene, weather);
  std::vector<float> together(kReportView.directions);
  double clear = 1.0, clearAsked = 1.0;  // shares of the sky that clouds leave
  std::size_t sheet = 0;
  const auto addSheet = [&] {
    const double share = deliveredCover(sheets[sheet], sheetSeed(scene, sheet), secondsAfter);
    ++sheet;
    clear *= 1.0 - share;
    return kOktas * share;
  };
  // What is asked of the sheet that comes next, as its cover drifts.
  const auto askedOf = [&](double oktas) {
    return oktasAt(scene.drift, sheets[sheet].drift.coverSeed, oktas, secondsAfter);
  };
  for (std::size_t i = 0; i < weather.layers.size(); ++i) {
    const weather::Layer& layer = weather.layers[i];
    if (isSheet(scene, layer)) {
      const double asked = askedOf(layer.oktas);
      cover.layers.push_back({asked, addSheet()});
      clearAsked *= 1.0 - asked / kOktas;
      continue;
    }
    clearAsked *= 1.0 - layer.oktas / kOktas;
    const std::vector<float> depths =
        metaballs && isMetaballs(scene, layer)
            ? metaballs->layerOpticalDepths(i, secondsAfter, kReportView.directions)
            : field::layerOpticalDepths(clouds, kReportView, static_cast<int>(i));
    cover.layers.push_back({layer.oktas, kOktas * field::coverOf(depths)});
    together = sumOf(together, depths);
  }
  // As the weather has it, unless drift has changed its layers since.
  if (scene.drift.coverOktas == 0.0 || sheets.empty()) clearAsked = 1.0 - weather.requestedOktas / kOktas;
  while (sheet < sheets.size()) {
    std::optional<double> asked = sheets[sheet].oktas;
    if (asked) asked = askedOf(*asked);
    const double delivered = addSheet();
    cover.sheets.push_back({asked.value_or(delivered), delivered});
    clearAsked *= 1.0 - cover.sheets.back().requestedOktas / kOktas;
  }
  clear *= 1.0 - field::coverOf(together);
  // The weather's own number stays as it is, to the last bit, where there is nothing beside it.
  cover.sky = {sheets.empty() ? weather.requestedOktas : kOktas * (1.0 - clearAsked),
               sheets.empty() ? kOktas * field::coverOf(together) : kOktas * (1.0 - clear)};
  return cover;
}

}  // namespace welkin::scene
