// SPDX-License-Identifier: Apache-2.0
// Wind at a height from the wind at the ground, when nothing else is known. Climatology, not a forecast.
#pragma once

#include <glm/vec2.hpp>

namespace welkin::weather {

struct Wind {
  double fromDeg = 270.0;  // true direction it comes from, 0 to 360
  double speedMps = 5.0;
};

// `surface` is the wind ten metres above the ground, `heightM` above the ground, `month` 1 to 12.
//
// Up to 1 km: the speed grows as height to the power 1/7 (Hellmann's law as in WMO-No. 8, 5.9, neutral, open
// country), and the direction turns with height, clockwise in the northern hemisphere, by 25 degrees in all
// (between Ekman's 45 degrees of a laminar layer and the 10 to 30 observed; Stull, Practical Meteorology,
// 2017, 18.5), less than that within 30 degrees of the equator where the earth's turning is weak. Above: the
// thermal wind. Air is colder towards the pole, so the westerly component grows with height: 2.5 m/s a
// kilometre in the middle latitudes in winter, 1.5 in summer (zonal means of Peixoto and Oort, Physics of
// Climate, 1992, figure 7.15, at 45 degrees between 850 and 300 hPa), little in the tropics and near the
// pole; no further growth above 11 km.
Wind windAloft(const Wind& surface, double heightM, double latitudeDeg, int month);

// Where air goes that comes from this true direction: unit vector, east and north.
glm::dvec2 windTowards(double fromDeg);

// 1 in midwinter to 0 in midsummer of the hemisphere.
double winterness(double latitudeDeg, int month);

}  // namespace welkin::weather
