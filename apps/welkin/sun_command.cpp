// SPDX-License-Identifier: Apache-2.0
#include "sun_command.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "welkin/core/error.h"
#include "welkin/sky/ephemeris.h"

namespace welkin::app {
namespace {

void requireRange(const char* what, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw ParameterError(fmt::format("{} is {}, expected {} to {} degrees", what, value, low, high));
  }
}

}  // namespace

int runSunCommand(double latitudeDeg, double longitudeDeg, double altitudeM, const UtcTime& time, bool json) {
  requireRange("the latitude", latitudeDeg, -90.0, 90.0);
  requireRange("the longitude", longitudeDeg, -180.0, 360.0);
  const sky::Ephemeris e = sky::ephemeris(time, {latitudeDeg, longitudeDeg, altitudeM});
  // Numbers and fixed keys only: nothing here needs escaping.
  if (json) {
    fmt::print(
        "{{\"time\": \"{}\", \"place\": {{\"latitude_deg\": {}, \"longitude_deg\": {}, \"altitude_m\": {}}}, "
        "\"sun\": {{\"azimuth_deg\": {:.6f}, \"elevation_deg\": {:.6f}, \"illuminance_lux\": {:.1f}}}, "
        "\"moon\": {{\"azimuth_deg\": {:.6f}, \"elevation_deg\": {:.6f}, \"illuminated_fraction\": {:.6f}, "
        "\"illuminance_lux\": {:.6f}}}, \"planets\": [",
        formatUtcTime(time), latitudeDeg, longitudeDeg, altitudeM, e.sun.azimuthDeg, e.sun.elevationDeg,
        e.sunIlluminanceLux, e.moon.azimuthDeg, e.moon.elevationDeg, e.moonIlluminatedFraction,
        e.moonIlluminanceLux);
    const char* before = "";
    for (const sky::Planet& p : e.planets) {
      if (p.body.elevationDeg <= 0.0) continue;
      fmt::print(
          "{}{{\"name\": \"{}\", \"azimuth_deg\": {:.6f}, \"elevation_deg\": {:.6f}, \"magnitude\": {:.2f}}}",
          before, p.name, p.body.azimuthDeg, p.body.elevationDeg, p.magnitude);
      before = ", ";
    }
    fmt::print("]}}\n");
  } else {
    fmt::print("sun     azimuth {:9.4f}  elevation {:8.4f} degrees\n", e.sun.azimuthDeg, e.sun.elevationDeg);
    fmt::print("moon    azimuth {:9.4f}  elevation {:8.4f} degrees, {:.1f} % lit\n", e.moon.azimuthDeg,
               e.moon.elevationDeg, 100.0 * e.moonIlluminatedFraction);
    for (const sky::Planet& p : e.planets)
      if (p.body.elevationDeg > 0.0)
        fmt::print("{:7} azimuth {:9.4f}  elevation {:8.4f} degrees, magnitude {:.1f}\n", p.name,
                   p.body.azimuthDeg, p.body.elevationDeg, p.magnitude);
  }
  return 0;
}

}  // namespace welkin::app
