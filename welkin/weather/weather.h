// SPDX-License-Identifier: Apache-2.0
// The state of the sky as layers of cloud, whatever it came from: a report, a scene file or a program.
// Heights are metres above the ground at the place. The ground is the aerodrome's level, as in a METAR.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "welkin/core/params.h"

namespace welkin::weather {

// The ten genera of the WMO International Cloud Atlas, and fog (a cloud on the ground).
enum class Genus {
  kCumulus,
  kStratocumulus,
  kStratus,
  kNimbostratus,
  kCumulonimbus,
  kAltocumulus,
  kAltostratus,
  kCirrus,
  kCirrocumulus,
  kCirrostratus,
  kFog,
};

// How a layer is drawn.
enum class Technique {
  kAuto,    // as the scene needs: volumes; of a layer: as the scene's technique says
  kVolume,  // marched volumes
  kPlane,   // thin sheets on the surface of that name (scene::SheetSurface)
  kSkyPlane,
  kDome,
  kOctaves,    // sky planes with living octaves
  kMetaballs,  // clouds of metaballs (scene::MetaballLayer)
};

// Whether clouds of the genus are made of ice crystals.
bool isIce(Genus genus);

// One layer of cloud.
struct Layer {
  Genus genus = Genus::kCumulus;
  double baseM = 1000.0;  // height of the base above the ground
  double topM = 2000.0;   // height of the highest tops above the ground; > baseM
  double oktas = 3.5;     // the layer's own cover of the sky hemisphere, 0 to 8, whatever lies below it
  double effectiveRadiusUm = 8.0;  // of droplets; without effect where the genus is of ice
  double extinctionPerM = 0.05;    // typical extinction in the body of the cloud at visible wavelengths, 1/m
  double windFromDeg = 270.0;      // true direction the layer's wind comes from
  double windSpeedMps = 8.0;
  double rainMmPerH = 0.0;   // of water, seen to fall from the thickest parts; 0: none
  bool baseAssumed = false;  // the report did not give the base; it is climatological
  Technique technique = Technique::kAuto;

  bool operator==(const Layer&) const = default;
};
// Of a layer of ice without the droplets' radius.
void describe(Layer& layer, ParamVisitor& v);

// Throws ParameterError when the values contradict one another (a top that is not above its base) or are out
// of range.
void validate(const Layer& layer);

// A layer of the genus as it is most often met at the latitude (degrees, either sign): heights, extinction,
// size of droplets, and wind are typical, the cover is the struct's default. See genus.h.
Layer typicalLayer(Genus genus, double latitudeDeg);
// Its cover where nothing is said about it.
double typicalOktas(Genus genus);

// Most layers that a Weather has.
inline constexpr std::size_t kMaxLayers = 8;
// Of these, rain is drawn beneath the lowest two from which it falls.
inline constexpr std::size_t kMaxRainingLayers = 2;

enum class PrecipitationKind { kNone, kDrizzle, kRain, kSnow, kIcePellets, kHail };

// What floats in the air besides droplets, by the kind that gives it its colour.
enum class Aerosol {
  kHaze,   // water-soluble particles and mist: all that is none of the others
  kDust,   // mineral dust and sand
  kSmoke,  // soot and organic matter of fires
  kAsh,    // of volcanoes
};

// Everything about the weather that the sky depends on.
struct Weather {
  std::vector<Layer> layers;    // from the lowest base to the highest
  double requestedOktas = 0.0;  // cover of the whole sky by all layers together
  // At the ground, for haze: by a contrast of 2 % (Koschmieder), and so 1.31 times what a report says.
  double visibilityM = 40000.0;
  double temperatureC = 15.0;
  double surfaceWindFromDeg = 270.0;
  double surfaceWindSpeedMps = 5.0;
  PrecipitationKind precipitation = PrecipitationKind::kNone;
  double precipitationMmPerH = 0.0;
  bool thunder = false;
  Aerosol aerosol = Aerosol::kHaze;  // at the station; of its amount the visibility says all
  bool snowOnGround = false;
  std::vector<std::string> notes;  // what was assumed or decided, one sentence each, for the report
};

}  // namespace welkin::weather

namespace welkin {
template <>
inline constexpr auto kEnumNames<weather::Genus> = std::array<std::string_view, 11>{
    "cumulus",     "stratocumulus", "stratus",      "nimbostratus", "cumulonimbus", "altocumulus",
    "altostratus", "cirrus",        "cirrocumulus", "cirrostratus", "fog"};
template <>
inline constexpr auto kEnumNames<weather::Technique> =
    std::array<std::string_view, 7>{"auto", "volume", "plane", "skyplane", "dome", "octaves", "metaballs"};
template <>
inline constexpr auto kEnumNames<weather::PrecipitationKind> =
    std::array<std::string_view, 6>{"none", "drizzle", "rain", "snow", "ice_pellets", "hail"};
template <>
inline constexpr auto kEnumNames<weather::Aerosol> =
    std::array<std::string_view, 4>{"haze", "dust", "smoke", "ash"};
}  // namespace welkin
