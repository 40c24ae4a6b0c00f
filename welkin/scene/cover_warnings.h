// SPDX-License-Identifier: Apache-2.0
// Sentences about covers that cannot be met.
#pragma once

#include <string>
#include <vector>

#include "welkin/scene/cloud_cover.h"

namespace welkin::scene {

// "the cirrus from 9000 to 10200 m covers 2.6 oktas and not 6".
std::string coversLess(const weather::Layer& layer, double coveredOktas, double askedOktas);

// Volumes and sheets that cover clearly less than was asked of them, and sheets that only do because their
// gaps are as good as cloud. Metaballs say so themselves (metaballs.h). `calibration` and `cover` are those
// of the weather's layers.
std::vector<std::string> coverWarnings(const Scene& scene, const weather::Weather& weather,
                                       const std::vector<LayerCalibration>& calibration,
                                       const DeliveredCover& cover);

}  // namespace welkin::scene
