// SPDX-License-Identifier: Apache-2.0
// `welkin sun`: where sun and moon stand.
#pragma once

#include "welkin/core/utc_time.h"

namespace welkin::app {

// Prints to standard output the topocentric, geometric (no refraction) places of sun and moon; as one line of
// JSON when asked. Latitude (north) and longitude (east) in degrees, altitude above mean sea level in metres.
// Returns the exit code. Throws ParameterError for a place that is not on earth.
int runSunCommand(double latitudeDeg, double longitudeDeg, double altitudeM, const UtcTime& time, bool json);

}  // namespace welkin::app
