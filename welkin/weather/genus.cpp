// SPDX-License-Identifier: Apache-2.0
#include "welkin/weather/genus.h"

#include <algorithm>
#include <cmath>

#include "welkin/weather/wind.h"

namespace welkin::weather {
namespace {

// Tropical up to 20 degrees, temperate at 45, polar from 70, and a straight line between: the Atlas names the
// regions, not their borders.
double byLatitude(double latitudeDeg, double tropical, double temperate, double polar) {
  const double d = std::min(std::abs(latitudeDeg), 90.0);
  if (d < 45.0) return tropical + (temperate - tropical) * std::clamp((d - 20.0) / 25.0, 0.0, 1.0);
  return temperate + (polar - temperate) * std::clamp((d - 45.0) / 25.0, 0.0, 1.0);
}

struct Habit {
  double effectiveRadiusUm;
  double extinctionPerM;
};

constexpr double kOfIce = Layer{}.effectiveRadiusUm;  // crystals have none

Habit habitOf(Genus genus) {
  switch (genus) {
    // OPAC, continental clean cumulus 5.8 um, .068/m; maritime 12.7 um, .052/m.
    case Genus::kCumulus:
      return {6.5, 0.05};
    // OPAC, continental stratus 7.3 um, .057/m; Salby has .03/m for stratocumulus. With the depths below:
    // optical depth 10 to 16.
    case Genus::kStratocumulus:
      return {7.3, 0.035};
    // OPAC .04 (maritime) to .057; optical depth 12 and more. Salby's .135/m belongs to small droplets and is
    // not met in the mean.
    case Genus::kStratus:
      return {7.3, 0.045};
    // Shuttleworth .5 g/m3 at drops grown to 20 um: .037/m; in the lower half mostly snow and rain, thinner:
    // optical depth 60.
    case Genus::kNimbostratus:
      return {12.0, 0.025};
    // Salby .038/m.
    case Genus::kCumulonimbus:
      return {10.0, 0.04};
    // Shuttleworth .1 g/m3 at 8 um: .019/m in the middle of a cell; optical depth under ISCCP's 3.6 to 5.
    case Genus::kAltocumulus:
      return {8.0, 0.012};
    // Shuttleworth .1 g/m3 at 12 um: .0125/m; optical depth about 10, the sun as through ground glass.
    case Genus::kAltostratus:
      return {12.0, 0.01};
    // Salby .5/km; the fibres are denser than the mean over their height, and optical depth about 1 is below
    // ISCCP's 3.6.
    case Genus::kCirrus:
      return {kOfIce, 0.001};
    // Small crystals in a thin sheet: optical depth 0.5.
    case Genus::kCirrocumulus:
      return {kOfIce, 0.0018};
    // Deep and even: optical depth 1.2, halo and disc of the sun remain visible.
    case Genus::kCirrostratus:
      return {kOfIce, 0.0006};
    // OPAC: 10.7 um, .0081/m, a visibility of 370 m.
    case Genus::kFog:
      return {10.7, 0.0081};
  }
  return {8.0, 0.05};
}

}  // namespace

Levels levelsAt(double latitudeDeg) {
  return {2000.0, byLatitude(latitudeDeg, 7000.0, 6000.0, 3500.0),
          byLatitude(latitudeDeg, 16500.0, 11500.0, 8500.0)};
}

double congestusDepthM(double latitudeDeg) {
  // Tops near the melting level and the stable layer there (Johnson et al., Trimodal characteristics of
  // tropical convection, 1999): 5 km in the tropics, lower with the tropopause.
  return byLatitude(latitudeDeg, 4000.0, 3500.0, 2200.0);
}

// From what the Atlas calls them: stratus, nimbostratus, altostratus and cirrostratus are layers or veils
// that are seen to cover all of the sky or most of it, stratocumulus and altocumulus patches or layers of
// elements side by side, cumulus, cumulonimbus and cirrus detached clouds, cirrocumulus a small patch.
double typicalOktas(Genus genus) {
  switch (genus) {
    case Genus::kStratus:
    case Genus::kNimbostratus:
    case Genus::kAltostratus:
    case Genus::kCirrostratus:
    case Genus::kFog:
      return 8.0;
    case Genus::kStratocumulus:
      return 6.0;
    case Genus::kAltocumulus:
      return 5.0;
    case Genus::kCirrocumulus:
      return 2.0;
    case Genus::kCumulus:
    case Genus::kCumulonimbus:
    case Genus::kCirrus:
      break;
  }
  return 3.5;
}

Layer typicalLayer(Genus genus, double latitudeDeg) {
  const Levels levels = levelsAt(latitudeDeg);
  Layer layer;
  layer.genus = genus;
  const Habit habit = habitOf(genus);
  layer.effectiveRadiusUm = habit.effectiveRadiusUm;
  layer.extinctionPerM = habit.extinctionPerM;

  const auto place = [&](double baseM, double depthM) {
    layer.baseM = baseM;
    layer.topM = baseM + depthM;
  };
  switch (genus) {
    case Genus::kCumulus:
      place(1000.0, 1000.0);
      break;  // Shuttleworth: base 500-2000, depth 1000
    case Genus::kStratocumulus:
      place(1000.0, 350.0);
      break;  // Shuttleworth: base 500-2000
    case Genus::kStratus:
      place(250.0, 300.0);
      break;  // Shuttleworth: base 0-500, depth 500
    case Genus::kNimbostratus:
      place(1000.0, 2500.0);
      break;                    // Shuttleworth: base 1000-3000, depth 2000
    case Genus::kCumulonimbus:  // Shuttleworth: base 500-2000, depth 6000; anvil below the
      place(1000.0, 0.85 * levels.highTopM - 1000.0);  // tropopause
      break;
    case Genus::kAltocumulus:
      place(0.5 * (levels.middleBaseM + levels.highBaseM), 400.0);
      break;
    case Genus::kAltostratus:
      place(0.5 * (levels.middleBaseM + levels.highBaseM), 1000.0);
      break;
    case Genus::kCirrus:
      place(0.5 * (levels.highBaseM + levels.highTopM), 1200.0);
      break;
    case Genus::kCirrocumulus:
      place(0.5 * (levels.highBaseM + levels.highTopM), 300.0);
      break;
    case Genus::kCirrostratus:
      place(0.5 * (levels.highBaseM + levels.highTopM), 2000.0);
      break;
    case Genus::kFog:
      place(0.0, 150.0);
      break;
  }
  const Wind wind =
      windAloft({latitudeDeg < 25.0 && latitudeDeg > -25.0 ? 90.0 : 270.0, 4.0}, layer.baseM, latitudeDeg, 4);
  layer.windFromDeg = wind.fromDeg;
  layer.windSpeedMps = wind.speedMps;
  return layer;
}

}  // namespace welkin::weather
