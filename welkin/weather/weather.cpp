// SPDX-License-Identifier: Apache-2.0
#include "welkin/weather/weather.h"

#include <string>

#include "welkin/core/error.h"
#include "welkin/core/param_range.h"

namespace welkin::weather {
namespace {

constexpr double kMaxHeightM = 25000.0;
constexpr double kMostRainMmPerH = 300.0;
constexpr double kLeastRadiusUm = 2.5, kMostRadiusUm = 25.0;  // of optics/phase.h

}  // namespace

bool isIce(Genus genus) {
  return genus == Genus::kCirrus || genus == Genus::kCirrocumulus || genus == Genus::kCirrostratus;
}

void describe(Layer& layer, ParamVisitor& v) {
  v.choice({"genus", "", "kind of cloud"}, layer.genus);
  v.value({"base_m", "m", "height of the base above the ground", 0.0, kMaxHeightM}, layer.baseM);
  v.value({"top_m", "m", "height of the highest tops above the ground; above base_m", 0.0, kMaxHeightM},
          layer.topM);
  v.value({"oktas", "okta", "eighths of the sky that the layer covers, whatever lies below it", 0.0, 8.0},
          layer.oktas);
  if (!isIce(layer.genus))
    v.value(
        {"effective_radius_um", "um",
         "effective radius of the droplets, of which all layers share the mean, weighted by their oktas; not "
         "of cirrus, cirrocumulus and cirrostratus, which are of ice",
         kLeastRadiusUm, kMostRadiusUm},
        layer.effectiveRadiusUm);
  v.value({"extinction_per_m", "1/m", "extinction of light inside the cloud", 0.0, 1.0},
          layer.extinctionPerM);
  v.value({"wind_from_deg", "deg", "direction the layer's wind comes from, clockwise from north", 0.0, 360.0},
          layer.windFromDeg);
  v.value({"wind_speed_mps", "m/s", "speed of the layer's wind", 0.0, 150.0}, layer.windSpeedMps);
  v.value({"rain_mm_per_h", "mm/h",
           "rain that is seen to fall from the thickest parts of a layer drawn as a volume, of two layers at "
           "most; 0 or left out: none",
           0.0, kMostRainMmPerH},
          layer.rainMmPerH);
  v.choice({"technique", "",
            "how the layer is drawn, as a volume, as a thin sheet on a surface or as clouds of metaballs; "
            "auto or left out: as the "
            "scene's technique says"},
           layer.technique);
}

void validate(const Layer& layer) {
  std::string problem = rangeProblemIn(layer);
  if (problem.empty() && layer.topM <= layer.baseM) problem = "top_m must be above base_m";
  if (problem.empty()) return;
  const auto genus = kEnumNames<Genus>[static_cast<std::size_t>(layer.genus)];
  throw ParameterError("layer of " + std::string(genus) + ": " + problem);
}

}  // namespace welkin::weather
