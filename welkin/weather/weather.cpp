// SPDX-License-Identifier: Apache-2.0
#include "welkin/weather/weather.h"

#include <cmath>
#include <string>

#include "welkin/core/error.h"

namespace welkin::weather {
namespace {

constexpr double kMaxHeightM = 25000.0;
constexpr double kMostRainMmPerH = 300.0;

void require(bool condition, const Layer& layer, const std::string& message) {
  if (condition) return;
  throw ParameterError("layer of " + std::string(kEnumNames<Genus>[static_cast<std::size_t>(layer.genus)]) +
                       ": " + message);
}

bool within(double x, double least, double most) {
  return x >= least && x <= most;
}  // false for NaN

}  // namespace

void describe(Layer& layer, ParamVisitor& v) {
  v.choice({"genus", "", "kind of cloud"}, layer.genus);
  v.value({"base_m", "m", "height of the base above the ground", 0.0, kMaxHeightM}, layer.baseM);
  v.value({"top_m", "m", "height of the highest tops above the ground; above base_m", 0.0, kMaxHeightM},
          layer.topM);
  v.value({"oktas", "okta", "eighths of the sky that the layer covers, whatever lies below it", 0.0, 8.0},
          layer.oktas);
  v.value({"effective_radius_um", "um", "effective radius of the droplets or ice crystals", 1.0, 200.0},
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
  require(within(layer.baseM, 0.0, kMaxHeightM), layer, "base_m must be from 0 to 25000");
  require(within(layer.topM, 0.0, kMaxHeightM), layer, "top_m must be from 0 to 25000");
  require(layer.topM > layer.baseM, layer, "top_m must be above base_m");
  require(within(layer.oktas, 0.0, 8.0), layer, "oktas must be from 0 to 8");
  require(within(layer.effectiveRadiusUm, 1.0, 200.0), layer, "effective_radius_um must be from 1 to 200");
  require(within(layer.extinctionPerM, 0.0, 1.0), layer, "extinction_per_m must be from 0 to 1");
  require(within(layer.windFromDeg, 0.0, 360.0), layer, "wind_from_deg must be from 0 to 360");
  require(within(layer.windSpeedMps, 0.0, 150.0), layer, "wind_speed_mps must be from 0 to 150");
  require(within(layer.rainMmPerH, 0.0, kMostRainMmPerH), layer, "rain_mm_per_h must be from 0 to 300");
}

}  // namespace welkin::weather
