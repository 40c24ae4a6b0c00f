// SPDX-License-Identifier: Apache-2.0
// What each genus looks like: from a layer of weather to the numbers that shape its density.
#pragma once

#include <cstdint>

#include "welkin/field/cloud_layer.h"
#include "welkin/weather/weather.h"

namespace welkin::scene {

// The layer's shape `secondsAfter` the moment of the weather, where it was then: wind moves it on by
// field::moveLayer(). `seed` is the layer's own. The threshold is that of half cover, to be calibrated.
field::CloudLayer shapeOf(const weather::Layer& layer, std::uint64_t seed, double secondsAfter);

// Of a layer's clouds, of their extinction.
inline constexpr double kMeanDensity = 0.5;
// How far apart its clouds are: a period of the cells' noise has so many.
inline constexpr double kCloudsAPeriod = 12.0;
inline double cloudSpacingM(const field::CloudLayer& layer) {
  return static_cast<double>(layer.cellM) / kCloudsAPeriod;
}

// Of the wind, by which the large and the small 3D noise stay behind.
inline constexpr double kShapeLag = 0.06, kDetailLag = 0.10;
// The shift of a 3D noise of a period that stays behind so and rises, or falls, from a height.
glm::vec3 noiseShiftM(const weather::Layer& layer, double lag, double riseMps, float periodM,
                      double secondsAfter, double fromM = 0.0);

// The diameter of droplets whose phase function all layers of water have: their mean, weighted by cover;
// micrometres.
double dropletDiameterUm(const weather::Weather& weather);

}  // namespace welkin::scene
