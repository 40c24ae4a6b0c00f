// SPDX-License-Identifier: Apache-2.0
// Uses two folders of the installed library: is it day or night at the aerodrome of a report?
#include <cmath>
#include <cstdio>

#include "welkin/core/utc_time.h"
#include "welkin/sky/ephemeris.h"
#include "welkin/weather/metar.h"

int main() {
  const auto report = welkin::weather::parseMetar("KMRY 211753Z 28010KT 10SM FEW012 SCT025 18/12 A2992");
  if (!report.ok() || report.metar.layers.size() != 2) return 1;
  const welkin::UtcTime time = welkin::parseUtcTime("2026-06-21T17:53:00Z");
  const welkin::sky::Ephemeris e = welkin::sky::ephemeris(time, {36.59, -121.85, 78.0});
  std::printf("%s: the sun stands at %.2f degrees\n", report.metar.station.c_str(), e.sun.elevationDeg);
  return e.sun.elevationDeg > 50.0 && e.sun.elevationDeg < 65.0 ? 0 : 1;
}
