// SPDX-License-Identifier: Apache-2.0
#include "welkin/weather/present_weather.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>

namespace welkin::weather {
namespace {

enum class Intensity { kLight, kModerate, kHeavy };

struct Phenomenon {
  std::string_view code;
  PrecipitationKind kind;
  std::array<double, 3> rateMmPerH;  // light, moderate, heavy
};

// Rates inside the bounds of the AMS Glossary of Meteorology, which WMO-No. 8 (annex 14.A) shares in
// substance: rain light below 2.5 mm/h, moderate to 7.6, heavy above; drizzle 0.1 and 0.5 mm/h; snow, as
// water, 1 and 5 mm/h. The first two, hail, win wherever they stand in a group; else what stands first in it
// does.
constexpr std::array<Phenomenon, 9> kPhenomena = {{
    {"GR", PrecipitationKind::kHail, {2.0, 8.0, 25.0}},
    {"GS", PrecipitationKind::kHail, {1.0, 4.0, 10.0}},
    {"PL", PrecipitationKind::kIcePellets, {1.0, 3.0, 8.0}},
    {"RA", PrecipitationKind::kRain, {1.2, 5.0, 15.0}},
    {"SN", PrecipitationKind::kSnow, {0.5, 2.5, 6.0}},
    {"SG", PrecipitationKind::kSnow, {0.1, 0.3, 0.8}},
    {"IC", PrecipitationKind::kSnow, {0.02, 0.05, 0.1}},
    {"DZ", PrecipitationKind::kDrizzle, {0.08, 0.3, 0.8}},
    {"UP", PrecipitationKind::kRain, {0.5, 3.0, 10.0}},
}};

constexpr double kShowerFactor = 1.6;  // showers are short and dense; the classes above are hourly means

FogKind fogKind(std::string_view body) {
  if (body.starts_with("BC")) return FogKind::kPatches;
  if (body.starts_with("PR")) return FogKind::kPartial;
  if (body.starts_with("MI")) return FogKind::kShallow;
  return FogKind::kFog;
}

// Groups are made of codes of two letters: "SGRA" has no "GR".
bool hasCode(std::string_view body, std::string_view code) {
  for (std::size_t at = 0; at + 2 <= body.size(); at += 2)
    if (body.substr(at, 2) == code) return true;
  return false;
}

// The dominant one stands first in the group (WMO-No. 306, 15.8.9); hail is named wherever it is.
const Phenomenon* dominant(std::string_view body) {
  for (const Phenomenon& p : std::span(kPhenomena).first(2))
    if (hasCode(body, p.code)) return &p;
  for (std::size_t at = 0; at + 2 <= body.size(); at += 2) {
    const auto it = std::find_if(kPhenomena.begin(), kPhenomena.end(),
                                 [&](const Phenomenon& p) { return p.code == body.substr(at, 2); });
    if (it != kPhenomena.end()) return &*it;
  }
  return nullptr;
}

}  // namespace

PresentWeather readPresentWeather(std::span<const std::string> groups, double temperatureC) {
  PresentWeather w;
  for (const std::string& group : groups) {
    std::string_view body = group;
    if (body.starts_with("VC")) {
      w.vicinity += (w.vicinity.empty() ? "" : " ") + group;
      continue;
    }
    Intensity intensity = Intensity::kModerate;
    if (body.starts_with('-')) intensity = Intensity::kLight;
    if (body.starts_with('+')) intensity = Intensity::kHeavy;
    if (intensity != Intensity::kModerate) body.remove_prefix(1);

    const auto has = [&](std::string_view code) { return hasCode(body, code); };
    if (has("FG")) w.fog = fogKind(body);
    for (const std::string_view code : {"DU", "SA", "SS", "DS", "PO", "FU", "VA", "HZ"})
      w.lithometeors = w.lithometeors || has(code);
    w.snowInAir = w.snowInAir || has("SN") || has("SG");
    const bool storm = has("TS");
    w.thunder = w.thunder || storm;
    // Drifting and blowing snow comes from the ground, not from a cloud.
    if (has("BL") || has("DR")) continue;

    const Phenomenon* p = dominant(body);
    if (p == nullptr || w.kind != PrecipitationKind::kNone) continue;
    w.kind = p->code == "UP" && temperatureC <= 0.5 ? PrecipitationKind::kSnow : p->kind;
    w.heavy = intensity == Intensity::kHeavy;
    w.rateMmPerH = p->rateMmPerH[static_cast<std::size_t>(intensity)];
    const bool showers = storm || has("SH") || w.kind == PrecipitationKind::kHail;
    if (showers) w.rateMmPerH *= kShowerFactor;
    w.character = showers                              ? PrecipitationCharacter::kShowers
                  : p->code == "DZ" || p->code == "SG" ? PrecipitationCharacter::kDrizzle
                  : p->code == "IC"                    ? PrecipitationCharacter::kNone
                                                       : PrecipitationCharacter::kSteady;
  }
  return w;
}

Aerosol aerosolOf(const Metar& metar) {
  constexpr double kDriftVisibilityM = 5000.0;
  Aerosol heaviest = Aerosol::kHaze;
  for (const std::string& group : metar.weather) {
    std::string_view body = group;
    if (body.starts_with("VC")) continue;
    if (body.starts_with('-') || body.starts_with('+')) body.remove_prefix(1);
    const auto hasAny = [&](std::initializer_list<std::string_view> codes) {
      return std::any_of(codes.begin(), codes.end(), [&](auto code) { return hasCode(body, code); });
    };
    const bool low =
        hasCode(body, "DR") && metar.visibilityM.value_or(kDriftVisibilityM) >= kDriftVisibilityM;
    if (hasCode(body, "VA")) return Aerosol::kAsh;
    if (hasAny({"DU", "SA", "SS", "DS", "PO"}) && !low)
      heaviest = Aerosol::kDust;
    else if (hasCode(body, "FU") && heaviest == Aerosol::kHaze)
      heaviest = Aerosol::kSmoke;
  }
  return heaviest;
}

bool snowLiesOnGround(const Metar& metar) {
  constexpr double kMeltingC = 0.5;
  if (metar.snowOnRunway) return true;
  if (metar.temperatureC.value_or(0.0) >= kMeltingC) return false;
  return std::any_of(metar.weather.begin(), metar.weather.end(), [](std::string_view body) {
    if (body.starts_with("VC")) {
      body.remove_prefix(2);
    } else if (body.starts_with('-') || body.starts_with('+')) {
      body.remove_prefix(1);
    }
    return (hasCode(body, "SN") || hasCode(body, "SG")) && !hasCode(body, "FZ");
  });
}

}  // namespace welkin::weather
