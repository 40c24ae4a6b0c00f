// SPDX-License-Identifier: Apache-2.0
// Which genus a reported layer is. A METAR names only CB and TCU; the rest follows from what goes with it.
#pragma once

#include <optional>

#include "welkin/weather/metar.h"
#include "welkin/weather/weather.h"

namespace welkin::weather {

// What falls, in the sense of the choice: from convective clouds, from sheets, or as drizzle from low sheets.
enum class PrecipitationCharacter { kNone, kShowers, kSteady, kDrizzle };

struct GenusQuestion {
  MetarCover cover = MetarCover::kUnknown;
  MetarCloudType type = MetarCloudType::kNone;
  double baseM = 0.0;     // above the ground
  bool thickest = false;  // the lowest of the layers with the largest amount: what falls, falls from it
  bool convectionBelow = false;  // a lower layer is CB or TCU
  bool convectionNamed = false;  // any layer is
  bool heapsBelow = false;       // a lower layer is of heaps or storms
  PrecipitationCharacter precipitation = PrecipitationCharacter::kNone;
  bool fog = false;
  std::optional<double> condensationM;  // lifting condensation level above the ground
  double latitudeDeg = 45.0;
  bool heated = false;  // the ground is warmed by the sun, or was until lately
};

Genus chooseGenus(const GenusQuestion& q);

// Height at which air lifted from the ground forms cloud: 125 m for each degree between temperature and dew
// point (Espy's rule; Lawrence, The relationship between relative humidity and the dewpoint temperature,
// 2005).
double condensationLevelM(double temperatureC, double dewPointC);

// Whether convection from heated ground is likely: the sun an hour and a half ago stood above 12 degrees
// (convection follows the sun with that delay and ends with it; Stull, Practical Meteorology, 2017, 18.3).
bool groundIsHeated(double latitudeDeg, int month, double solarHour);

}  // namespace welkin::weather
