// SPDX-License-Identifier: Apache-2.0
// What the groups of present weather of a report mean for the sky.
#pragma once

#include <span>
#include <string>

#include "welkin/weather/choose_genus.h"
#include "welkin/weather/metar.h"
#include "welkin/weather/weather.h"

namespace welkin::weather {

enum class FogKind { kNone, kFog, kPatches, kPartial, kShallow };  // FG, BCFG, PRFG, MIFG

struct PresentWeather {
  PrecipitationKind kind = PrecipitationKind::kNone;
  double rateMmPerH = 0.0;  // of water
  PrecipitationCharacter character = PrecipitationCharacter::kNone;
  bool heavy = false;
  bool thunder = false;
  FogKind fog = FogKind::kNone;
  // What hides the sky without fog, there or blown there: dust, sand, smoke, ash and haze; snow.
  bool lithometeors = false;
  bool snowInAir = false;
  std::string vicinity;  // the groups that begin with VC, for a note
};

// `groups` as in Metar::weather; `temperatureC` decides what precipitation of unknown kind (UP) is.
PresentWeather readPresentWeather(std::span<const std::string> groups, double temperatureC);

// The heaviest of what is reported at the station: ash, dust or sand, smoke. Drifting dust and sand stay
// below the eye and count only where visibility is less than 5 km.
Aerosol aerosolOf(const Metar& metar);

// Whether snow lies there, by the report alone: it falls, drifts or blows, unmixed with freezing rain, below
// 0.5 C (or without a temperature), or lies on a runway.
bool snowLiesOnGround(const Metar& metar);

}  // namespace welkin::weather
