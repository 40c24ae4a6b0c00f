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
        "\"sun\": {{\"azimuth_deg\": {:.6f}, \"elevation_deg\": {:.6f}, \"illuminance_lux\": {:.1f}, "
        "\"obscuration\": {:.6f}}}, "
        "\"moon\": {{\"azimuth_deg\": {:.6f}, \"elevation_deg\": {:.6f}, \"illuminated_fraction\": {:.6f}, "
        "\"illuminance_lux\": {:.6f}, \"umbral_magnitude\": {:.4f}, \"penumbral_magnitude\": {:.4f}}}, "
        "\"planets\": [",
        formatUtcTime(time), latitudeDeg, longitudeDeg, altitudeM, e.sun.azimuthDeg, e.sun.elevationDeg,
        e.sunIlluminanceLux, e.solarEclipse.obscuration, e.moon.azimuthDeg, e.moon.elevationDeg,
        e.moonIlluminatedFraction, e.moonIlluminanceLux, e.lunarEclipse.umbralMagnitude,
        e.lunarEclipse.penumbralMagnitude);
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
    fmt::print("sun     azimuth {:9.4f}  elevation {:8.4f} degrees", e.sun.azimuthDeg, e.sun.elevationDeg);
    if (e.solarEclipse.obscuration > 0.0)
      fmt::print(", {:.2f} % hidden by the moon", 100.0 * e.solarEclipse.obscuration);
    fmt::print("\nmoon    azimuth {:9.4f}  elevation {:8.4f} degrees, {:.1f} % lit", e.moon.azimuthDeg,
               e.moon.elevationDeg, 100.0 * e.moonIlluminatedFraction);
    if (e.lunarEclipse.umbralMagnitude > 0.0)
      fmt::print(", eclipsed by the earth, magnitude {:.3f}", e.lunarEclipse.umbralMagnitude);
    else if (e.lunarEclipse.any())
      fmt::print(", in the earth's penumbra, magnitude {:.3f}", e.lunarEclipse.penumbralMagnitude);
    fmt::print("\n");
    for (const sky::Planet& p : e.planets)
      if (p.body.elevationDeg > 0.0)
        fmt::print("{:7} azimuth {:9.4f}  elevation {:8.4f} degrees, magnitude {:.1f}\n", p.name,
                   p.body.azimuthDeg, p.body.elevationDeg, p.magnitude);
  }
  return 0;
}

}  // namespace welkin::app
