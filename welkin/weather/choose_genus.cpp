// SPDX-License-Identifier: Apache-2.0
#include "welkin/weather/choose_genus.h"

#include <algorithm>
#include <cmath>

#include "welkin/core/units.h"
#include "welkin/weather/genus.h"

namespace welkin::weather {
namespace {

// Heaps have their base at the condensation level; spread sheets and remnants have not. Espy's rule with the
// screen's dew point gives a level too low by a quarter or more once the sun has mixed the air, and whole
// degrees alone are worth 125 m.
bool nearCondensationLevel(const GenusQuestion& q) {
  if (!q.condensationM) return true;
  return std::abs(q.baseM - *q.condensationM) <= std::max(250.0, 0.45 * q.baseM);
}

Genus chooseHigh(const GenusQuestion& q) {
  // Veils cover the sky; fibres do not, and the ice of anvils spreads in fibres. Cirrocumulus cannot be told
  // from a report: it is the rarest of the ten (Atlas) and is left to scenes by hand.
  if (q.cover == MetarCover::kOvercast) return Genus::kCirrostratus;
  if (q.cover == MetarCover::kBroken && !q.convectionBelow) return Genus::kCirrostratus;
  return Genus::kCirrus;
}

// Showers fall from what is named CB or TCU; without these, from heaps, and where the sky is overcast from
// the one sheet that is dark enough: convection embedded in nimbostratus (Houze, Cloud Dynamics, 1993,
// chapter 6).
bool showersFallFromIt(const GenusQuestion& q) {
  return q.precipitation == PrecipitationCharacter::kShowers && q.thickest && !q.convectionNamed;
}

Genus chooseMiddle(const GenusQuestion& q) {
  const bool steady = q.precipitation == PrecipitationCharacter::kSteady;
  // Steady rain or snow that falls out of a middle sheet: nimbostratus below 3 km, where it merges (Atlas),
  // else altostratus.
  if (steady && q.thickest && q.cover >= MetarCover::kBroken)
    return q.baseM < 3000.0 ? Genus::kNimbostratus : Genus::kAltostratus;
  if (showersFallFromIt(q)) {
    if (q.cover == MetarCover::kOvercast)
      return q.baseM < 3000.0 ? Genus::kNimbostratus : Genus::kAltostratus;
    if (!q.heapsBelow && q.baseM < 4500.0) return Genus::kCumulus;
  }
  if (q.cover == MetarCover::kOvercast) return Genus::kAltostratus;
  // Heaps over hot dry land have their bases this high.
  const bool hotAndDry = q.condensationM && *q.condensationM > 1800.0;
  if (q.heated && hotAndDry && nearCondensationLevel(q) && q.baseM < 4500.0) return Genus::kCumulus;
  return Genus::kAltocumulus;
}

Genus chooseLow(const GenusQuestion& q) {
  const bool muchCover = q.cover == MetarCover::kBroken || q.cover == MetarCover::kOvercast;
  // Ragged low cloud under rain, lifted fog and drizzle's sheets are stratus (Atlas: base mostly below 600
  // m).
  if (q.precipitation == PrecipitationCharacter::kDrizzle && q.baseM < 600.0) return Genus::kStratus;
  if (q.precipitation == PrecipitationCharacter::kSteady) {
    if (q.thickest && muchCover) return Genus::kNimbostratus;
    if (q.baseM < 600.0) return Genus::kStratus;
    return Genus::kStratocumulus;
  }
  if (muchCover && showersFallFromIt(q))
    return q.cover == MetarCover::kOvercast ? Genus::kNimbostratus : Genus::kCumulus;
  if (q.fog && q.baseM < 300.0) return Genus::kStratus;
  if (muchCover) {
    if (q.baseM < 300.0) return Genus::kStratus;
    // A broken low deck in near-saturated air without sun is a sheet as well.
    if (q.baseM < 450.0 && q.condensationM && *q.condensationM <= 250.0) return Genus::kStratus;
    const bool showers = q.precipitation == PrecipitationCharacter::kShowers;
    if (q.cover == MetarCover::kBroken && showers) return Genus::kCumulus;
    return Genus::kStratocumulus;
  }
  if (q.baseM < 150.0) return Genus::kStratus;
  // Few and scattered: heaps by day over land, at every hour over warm seas (trade-wind cumulus), and
  // wherever showers fall.
  const bool tropical = std::abs(q.latitudeDeg) < 25.0;
  if (q.precipitation == PrecipitationCharacter::kShowers || tropical) return Genus::kCumulus;
  if (q.heated && nearCondensationLevel(q)) return Genus::kCumulus;
  return q.baseM < 300.0 ? Genus::kStratus : Genus::kStratocumulus;
}

}  // namespace

double condensationLevelM(double temperatureC, double dewPointC) {
  return 125.0 * std::max(temperatureC - dewPointC, 0.0);
}

bool groundIsHeated(double latitudeDeg, int month, double solarHour) {
  // Declination of the middle of the month to about a degree (Cooper 1969); the season does not need more.
  const double day = 30.4 * (month - 0.5);
  const double declination = radians(23.45) * std::sin(2.0 * kPi * (284.0 + day) / 365.0);
  const double hourAngle = radians(15.0 * (solarHour - 1.5 - 12.0));
  const double latitude = radians(latitudeDeg);
  const double sinElevation = std::sin(latitude) * std::sin(declination) +
                              std::cos(latitude) * std::cos(declination) * std::cos(hourAngle);
  return sinElevation > std::sin(radians(12.0));
}

Genus chooseGenus(const GenusQuestion& q) {
  if (q.type == MetarCloudType::kCumulonimbus) return Genus::kCumulonimbus;
  if (q.type == MetarCloudType::kToweringCumulus) return Genus::kCumulus;
  const Levels levels = levelsAt(q.latitudeDeg);
  if (q.baseM >= levels.highBaseM) return chooseHigh(q);
  if (q.baseM >= levels.middleBaseM) return chooseMiddle(q);
  return chooseLow(q);
}

}  // namespace welkin::weather
