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

// Of the wind, by which the large and the small 3D noise stay behind.
inline constexpr double kShapeLag = 0.06, kDetailLag = 0.10;

// The diameter of droplets whose phase function all layers of water have: their mean, weighted by cover;
// micrometres.
double dropletDiameterUm(const weather::Weather& weather);

}  // namespace welkin::scene
