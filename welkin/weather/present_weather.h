// SPDX-License-Identifier: Apache-2.0
// What the groups of present weather of a report mean for the sky.
#pragma once

#include <span>
#include <string>

#include "welkin/weather/choose_genus.h"
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
  std::string vicinity;  // the groups that begin with VC, for a note
};

// `groups` as in Metar::weather; `temperatureC` decides what precipitation of unknown kind (UP) is.
PresentWeather readPresentWeather(std::span<const std::string> groups, double temperatureC);

}  // namespace welkin::weather
