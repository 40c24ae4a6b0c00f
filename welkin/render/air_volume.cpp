// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/air_volume.h"

#include <cmath>
#include <string>

#include "welkin/core/error.h"

namespace welkin::render {

double AirVolume::distanceM(int slice) const {
  return nearM * std::pow(static_cast<double>(farM) / nearM, static_cast<double>(slice) / (slices - 1));
}

void checkAirVolume(const AirVolumeOptions& options) {
  constexpr int kMost = 512;
  const auto within = [](int value, int least) { return value >= least && value <= kMost; };
  if (!within(options.width, 1) || !within(options.height, 1) || !within(options.slices, 2))
    throw ParameterError("an air volume has 1 to 512 columns across and up and 2 to 512 slices, not " +
                         std::to_string(options.width) + " x " + std::to_string(options.height) + " x " +
                         std::to_string(options.slices));
  if (!(options.nearM > 0.0f) || !(options.farM > options.nearM) || !std::isfinite(options.farM))
    throw ParameterError("an air volume's slices go from a distance above 0 to a greater one, not from " +
                         std::to_string(options.nearM) + " m to " + std::to_string(options.farM) + " m");
  if (!(options.scale > 0.0f) || !std::isfinite(options.scale))
    throw ParameterError("an air volume's scale is above 0, not " + std::to_string(options.scale));
}

}  // namespace welkin::render
