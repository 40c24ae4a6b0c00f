// SPDX-License-Identifier: Apache-2.0
// From a decoded report to the weather that a sky is built from. Rules, not a model: the same report gives
// the same weather.
//
// The rules and where they come from stand at the code; in short:
// - cover: reported amounts are cumulative (cover.h)
// - genus: from height, amount, CB and TCU, precipitation, closeness to the lifting condensation level, sun
//   and season; where remarks name it, from these (metar_remarks.h)
// - depth: from genus, amount, precipitation, latitude (genus.h); a sheet does not reach into the layer above
//   it
// - missing: a base or amount that the report says exists but does not give is climatological, `baseAssumed`
//   is set and a note says so; SKC, CLR, NSC, NCD and CAVOK make no layer
// - obscured: VV, and thick fog, make a layer of fog from the ground that hides the whole sky; not
//   where dust, sand, smoke, ash, haze or snow is reported and no fog: that is in the air, by the visibility
// - thin fog: fog through which the observer reports clouds or a clear sky is a shallow layer: 1.6 oktas,
//   near the horizon
// - haze: from the visibility, by a contrast of 5 % in reports and of 2 % in Weather, where it is 1.31 times
//   as long; "10 km or more" takes a value from the humidity
// - wind: wind.h
#pragma once

#include "welkin/weather/metar.h"
#include "welkin/weather/weather.h"

namespace welkin::weather {

// `latitudeDeg` north positive; `month` 1 to 12; `solarHour` local apparent time, 0 to 24: 12 when the sun is
// highest. The layers come out from the lowest base up and pass validate(); there are at most kMaxLayers.
Weather weatherFromMetar(const Metar& metar, double latitudeDeg, int month, double solarHour);

// Relative humidity, 0 to 1, from temperature and dew point in Celsius (Magnus formula, WMO-No. 8,
// annex 4.B).
double relativeHumidity(double temperatureC, double dewPointC);

// Visibility that "10 km or more" stands for, from the humidity, in metres.
//
// 40 km in dry air, the usual of clean continental and maritime air masses. Particles grow with humidity:
// their extinction goes about as (1 - RH)^-0.5 (Haenel, The properties of atmospheric aerosol particles as
// functions of the relative humidity, 1976, gives exponents from 0.4 to 0.8), here from 60 % up to 97 %, and
// the range does not fall below what was reported.
double clearVisibilityM(double relativeHumidity);

}  // namespace welkin::weather
