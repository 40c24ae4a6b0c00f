// SPDX-License-Identifier: Apache-2.0
#include "welkin/weather/from_metar.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "welkin/core/units.h"
#include "welkin/weather/choose_genus.h"
#include "welkin/weather/cover.h"
#include "welkin/weather/genus.h"
#include "welkin/weather/metar_remarks.h"
#include "welkin/weather/present_weather.h"
#include "welkin/weather/wind.h"

namespace welkin::weather {
namespace {

// Meteorological optical range: transmission 5 % over that length (WMO-No. 8, Guide to Instruments, 9.1), so
// extinction is -ln(0.05) = 2.996 divided by it.
constexpr double kMorOpticalDepth = 2.996;

// Weather::visibilityM is the range of a contrast of 2 %: of the same air it is longer.
constexpr double kVisibilityOfMor = kVisibilityDepth / kMorOpticalDepth;

constexpr double kFogVisibilityM = 1000.0;  // fog is what makes visibility less than this (code table 4678)

// Haze of the air around and above fog. The fog itself makes the low visibility; the air over it is that of a
// clear night.
constexpr double kVisibilityOutsideFogM = 10000.0;

// A sky is no longer discerned through this optical depth: the sun's disc is lost in its aureole (Linskens
// and Bohren, Appearance of the sun and the moon seen through clouds, 1994: about 6 to 10).
constexpr double kObscuringOpticalDepth = 6.0;
// Visibility in dust, smoke or snow that hides the sky, where it is missing.
constexpr double kObscuringVisibilityM = 500.0;
constexpr double kLeastObscuringDepthM = 60.0, kMostObscuringDepthM = 1500.0;

// Fog through which clouds or a clear sky are reported. Its vertical optical depth makes it hide what is seen
// through it at kCoverDepth or more: elevations whose sine is below 0.06 / 0.3, that fraction of the
// hemisphere, 1.6 oktas.
constexpr double kThinFogOpticalDepth = 0.06;

// Rain where a report does not say how much falls: moderate showers, and the core of a storm.
constexpr double kShowerMmPerH = 5.0, kStormRainMmPerH = 25.0;

std::string metres(double m) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f m", m);
  return text;
}

class Builder {
 public:
  Builder(const Metar& metar, double latitudeDeg, int month, double solarHour)
      : metar_(metar),
        latitudeDeg_(latitudeDeg),
        month_(month),
        heated_(groundIsHeated(latitudeDeg, month, solarHour)) {}

  Weather build();

 private:
  // A reported layer with its base settled.
  struct Reported {
    MetarCover cover;
    MetarCloudType type;
    double baseM;
    bool assumed;
    std::optional<Genus> genus = {};  // by the remarks
  };
  void readRemarks(std::vector<Reported>& layers);

  void note(std::string sentence) { weather_.notes.push_back(std::move(sentence)); }
  void setSurface();
  std::vector<Reported> settleBases();
  double climatologicalBaseM(const MetarLayer& layer) const;
  void addClouds();
  void limitDepths();
  double depthM(const Layer& layer, MetarCover cover, bool towering) const;
  void addThunderstorm();
  void addRain();
  void addFog();
  void setVisibility();
  void setWinds();

  const Metar& metar_;
  double latitudeDeg_;
  int month_;
  bool heated_;
  PresentWeather present_;
  std::optional<double> condensationM_;
  bool fogLayer_ = false;
  bool airObscures_ = false;  // VV by what floats in the air or by snow, not by fog
  std::size_t thickest_ = 0;  // of the layers, the lowest of the largest amount
  Weather weather_;
};

Weather Builder::build() {
  if (metar_.nil) {
    note("The report is NIL; nothing is known of the weather and the sky is drawn clear.");
    return weather_;
  }
  setSurface();
  addClouds();
  addThunderstorm();
  addRain();
  limitDepths();
  addFog();
  setVisibility();
  setWinds();
  return std::move(weather_);
}

void Builder::setSurface() {
  if (metar_.temperatureC) {
    weather_.temperatureC = *metar_.temperatureC;
    if (metar_.dewPointC) condensationM_ = condensationLevelM(*metar_.temperatureC, *metar_.dewPointC);
  } else {
    note("The temperature is missing; 15 C is assumed.");
  }

  const bool tropical = std::abs(latitudeDeg_) < 25.0;
  weather_.surfaceWindFromDeg = tropical ? 90.0 : 270.0;  // trade winds and westerlies
  if (metar_.wind.directionDeg) {
    weather_.surfaceWindFromDeg = *metar_.wind.directionDeg;
  } else if (metar_.wind.speedMps.value_or(1.0) > 0.0) {
    note(std::string("The wind's direction is ") + (metar_.wind.variable ? "variable" : "missing") +
         "; the " + (tropical ? "easterly of the tropics" : "westerly of the middle latitudes") +
         " is assumed.");
  }
  if (metar_.wind.speedMps) {
    weather_.surfaceWindSpeedMps = *metar_.wind.speedMps;
  } else {
    weather_.surfaceWindSpeedMps = 4.0;
    note("The wind's speed is missing; 4 m/s is assumed.");
  }

  present_ = readPresentWeather(metar_.weather, weather_.temperatureC);
  // Where CB or TCU is reported and no overcast, what falls without the name of a shower falls from them all
  // the same.
  const auto anyLayer = [&](auto test) {
    return std::any_of(metar_.layers.begin(), metar_.layers.end(), test);
  };
  if (present_.character == PrecipitationCharacter::kSteady &&
      anyLayer([](const MetarLayer& l) { return l.type != MetarCloudType::kNone; }) &&
      !anyLayer([](const MetarLayer& l) {
        return l.cover == MetarCover::kOvercast && l.type == MetarCloudType::kNone;
      })) {
    present_.character = PrecipitationCharacter::kShowers;
  }
  airObscures_ =
      metar_.skyObscured && present_.fog == FogKind::kNone && (present_.lithometeors || present_.snowInAir);
  weather_.precipitation = present_.kind;
  weather_.precipitationMmPerH = present_.rateMmPerH;
  weather_.thunder = present_.thunder;
  weather_.aerosol = aerosolOf(metar_);
  weather_.snowOnGround = snowLiesOnGround(metar_);
}

// Bases that a report does not give: the condensation level for convective cloud where temperature and dew
// point are known, else the middle of the genus' range in Shuttleworth's table 10.3. The same report gives
// the same base every time.
double Builder::climatologicalBaseM(const MetarLayer& layer) const {
  const bool convective = layer.type != MetarCloudType::kNone;
  if (convective) return condensationM_ ? std::clamp(*condensationM_, 300.0, 2500.0) : 1000.0;
  if (present_.fog == FogKind::kFog || present_.character == PrecipitationCharacter::kDrizzle)
    return 250.0;                                                            // stratus
  if (present_.character == PrecipitationCharacter::kSteady) return 1000.0;  // nimbostratus
  if (layer.cover == MetarCover::kFew || layer.cover == MetarCover::kScattered) {
    return condensationM_ ? std::clamp(*condensationM_, 300.0, 2500.0) : 1000.0;  // cumulus
  }
  return 1250.0;  // stratocumulus
}

// What the observer calls them in the remarks wins over what can be guessed.
void Builder::readRemarks(std::vector<Reported>& layers) {
  if (metar_.cloudRemarks.empty() && !metar_.cloudCodes) return;
  std::vector<NamedLayer> named;
  named.reserve(layers.size());
  for (const Reported& r : layers) {
    const int feet = static_cast<int>(std::lround(r.baseM / kMetresPerFoot));
    named.push_back({r.baseM, r.assumed ? std::nullopt : std::optional(feet), r.type, {}});
  }
  const bool steady = present_.character == PrecipitationCharacter::kSteady;
  nameByRemarks(metar_, latitudeDeg_, steady, named);
  bool any = false;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    layers[i].genus = named[i].genus;
    layers[i].type = named[i].type;
    any = any || named[i].genus;
  }
  note(any ? "The remarks name kinds of cloud; they are taken from there."
           : "The remarks name kinds of cloud that cannot be told which layers they are; they are left out.");
}

std::vector<Builder::Reported> Builder::settleBases() {
  std::vector<Reported> layers;
  bool unobserved = false;
  const auto lower = [](const Reported& a, const Reported& b) { return a.baseM < b.baseM; };
  for (const MetarLayer& l : metar_.layers) {
    Reported r{l.cover, l.type, 0.0, !l.baseFt};
    if (l.cover == MetarCover::kUnknown && l.type == MetarCloudType::kNone) {
      if (!l.baseFt) {
        unobserved = true;
        continue;
      }
      r.cover = MetarCover::kScattered;
      note("The amount of the cloud at " + metres(*l.baseFt * kMetresPerFoot) +
           " is missing; scattered is assumed.");
    }
    r.baseM = l.baseFt ? *l.baseFt * kMetresPerFoot : climatologicalBaseM(l);
    const std::string name = r.type == MetarCloudType::kCumulonimbus      ? "CB"
                             : r.type == MetarCloudType::kToweringCumulus ? "TCU"
                                                                          : "Cloud";
    if (r.assumed)
      note(name + " is reported without its base; the climatological " + metres(r.baseM) + " is assumed.");
    if (r.cover == MetarCover::kUnknown) {
      r.cover = MetarCover::kFew;
      note(name + " is reported without its amount; few is assumed.");
    }
    // From the ground up; what is at one height stays in the report's order.
    layers.insert(std::upper_bound(layers.begin(), layers.end(), r, lower), r);
  }
  readRemarks(layers);
  if (layers.empty() && !metar_.cavok && (!metar_.skyObscured || airObscures_) &&
      present_.fog != FogKind::kFog) {
    const bool falls =
        present_.kind != PrecipitationKind::kNone && present_.character != PrecipitationCharacter::kNone;
    const bool clear = !unobserved && metar_.clear != MetarClear::kNotSaid;
    const std::string why =
        unobserved ? "The station cannot observe cloud" : "The report says nothing about cloud";
    if (clear) {
      if (falls) note("Precipitation falls from a sky that is said to be without cloud; none is drawn.");
    } else if (falls) {
      // It falls from somewhere.
      const bool showers = present_.character == PrecipitationCharacter::kShowers && !airObscures_;
      const MetarLayer assumed{showers ? MetarCover::kBroken : MetarCover::kOvercast,
                               {},
                               showers ? MetarCloudType::kToweringCumulus : MetarCloudType::kNone};
      layers.push_back({assumed.cover, assumed.type, climatologicalBaseM(assumed), true});
      note(why +
           ", but precipitation falls: " + std::string(showers ? "broken towering cumulus" : "an overcast") +
           " at the climatological " + metres(layers.back().baseM) + " is assumed.");
    } else {
      note(why + "; none is drawn.");
    }
  }
  if (layers.size() > kMaxLayers - 1) {  // one place is kept for fog
    // The smallest go first, of equals the highest, so that the total stays; what is named CB or TCU goes
    // last.
    const auto smaller = [](const Reported& a, const Reported& b) {
      return std::tuple(a.type != MetarCloudType::kNone, a.cover, -a.baseM) <
             std::tuple(b.type != MetarCloudType::kNone, b.cover, -b.baseM);
    };
    note(std::to_string(kMaxLayers - 1) + " of the " + std::to_string(layers.size()) +
         " layers are drawn, without the smallest.");
    while (layers.size() > kMaxLayers - 1)
      layers.erase(std::min_element(layers.begin(), layers.end(), smaller));
  }
  return layers;
}

// Depth of the layer. Sources in genus.cpp; what more there is stands here.
double Builder::depthM(const Layer& layer, MetarCover cover, bool towering) const {
  const Layer typical = typicalLayer(layer.genus, latitudeDeg_);
  const double typicalM = typical.topM - typical.baseM;
  const Levels levels = levelsAt(latitudeDeg_);
  switch (layer.genus) {
    case Genus::kCumulus: {
      if (towering) return congestusDepthM(latitudeDeg_);
      if (present_.character == PrecipitationCharacter::kShowers) return 0.75 * congestusDepthM(latitudeDeg_);
      // Heaps grow sideways and upwards together; few small ones are humilis, a broken field mediocris
      // (Stull 6.6: width ~ depth).
      return cover == MetarCover::kFew         ? 0.6 * typicalM
             : cover == MetarCover::kScattered ? 0.9 * typicalM
                                               : 1.2 * typicalM;
    }
    case Genus::kCumulonimbus: {
      // Winter storms are shallower: in cold air the tropopause and the equilibrium level are low.
      const double cold = std::clamp((15.0 - weather_.temperatureC) / 25.0, 0.0, 1.0);
      const double top = 0.85 * levels.highTopM * (1.0 - 0.4 * cold);
      return std::max(top - layer.baseM, 3000.0);
    }
    case Genus::kNimbostratus:
      return present_.heavy ? 1.4 * typicalM : typicalM;
    case Genus::kStratocumulus:
      return cover == MetarCover::kOvercast ? 1.3 * typicalM
             : cover == MetarCover::kFew    ? 0.8 * typicalM
                                            : typicalM;
    case Genus::kStratus:
      return cover == MetarCover::kFew || cover == MetarCover::kScattered ? 0.5 * typicalM : typicalM;
    default:
      return typicalM;
  }
}

void Builder::addClouds() {
  const std::vector<Reported> reported = settleBases();
  std::vector<MetarCover> covers;
  covers.reserve(reported.size());
  for (const Reported& r : reported) covers.push_back(r.cover);
  const CoverStack stack = stackCover(covers);
  weather_.requestedOktas = stack.totalOktas;

  // What falls comes from the lowest layer of the largest amount.
  thickest_ = static_cast<std::size_t>(std::max_element(covers.begin(), covers.end()) - covers.begin());
  const bool convectionNamed = std::any_of(reported.begin(), reported.end(),
                                           [](const Reported& r) { return r.type != MetarCloudType::kNone; });
  bool convectionBelow = false, heapsBelow = false;
  for (std::size_t i = 0; i < reported.size(); ++i) {
    const Reported& r = reported[i];
    GenusQuestion q;
    q.cover = r.cover;
    q.type = r.type;
    q.baseM = r.baseM;
    q.thickest = i == thickest_;
    q.convectionBelow = convectionBelow;
    q.convectionNamed = convectionNamed;
    q.heapsBelow = heapsBelow;
    q.precipitation = present_.character;
    q.fog = present_.fog == FogKind::kFog;
    q.condensationM = condensationM_;
    q.latitudeDeg = latitudeDeg_;
    q.heated = heated_;
    convectionBelow = convectionBelow || r.type != MetarCloudType::kNone;

    const Genus genus = r.genus.value_or(chooseGenus(q));
    heapsBelow = heapsBelow || genus == Genus::kCumulus || genus == Genus::kCumulonimbus;
    Layer layer = typicalLayer(genus, latitudeDeg_);
    layer.baseM = r.baseM;
    layer.oktas = std::clamp(stack.ownOktas[i], 0.0, 8.0);
    layer.baseAssumed = r.assumed;
    layer.topM = r.baseM + depthM(layer, r.cover, r.type == MetarCloudType::kToweringCumulus);
    weather_.layers.push_back(layer);
  }
}

// Thunder without CB in the report (automatic stations, and the code form leaves CB out where a layer hides
// it): the convective layer with the largest cover is made one, or, without any, the largest of those with a
// base below 3 km.
void Builder::addThunderstorm() {
  auto& layers = weather_.layers;
  const auto isCb = [](const Layer& l) { return l.genus == Genus::kCumulonimbus; };
  if (!present_.thunder || std::any_of(layers.begin(), layers.end(), isCb)) return;
  Layer* best = nullptr;
  bool bestConvective = false;
  for (Layer& l : layers) {
    if (l.baseM >= 3000.0) continue;
    const bool convective = l.genus == Genus::kCumulus;
    if (best == nullptr || std::pair(convective, l.oktas) > std::pair(bestConvective, best->oktas)) {
      best = &l;
      bestConvective = convective;
    }
  }
  if (best == nullptr) {
    note("Thunder is reported but no cloud that it could come from; none is drawn.");
    return;
  }
  Layer storm = typicalLayer(Genus::kCumulonimbus, latitudeDeg_);
  storm.baseM = best->baseM;
  storm.oktas = best->oktas;
  storm.baseAssumed = best->baseAssumed;
  storm.topM = storm.baseM + depthM(storm, MetarCover::kBroken, false);
  *best = storm;
  note("Thunder is reported without CB; the layer at " + metres(storm.baseM) + " is taken for it.");
}

// Shafts of rain beneath heaps, storms and sheets that showers fall from. Steady rain falls everywhere and is
// in the visibility. A storm rains somewhere, whatever falls at the station (International Cloud Atlas:
// cumulonimbus is often accompanied by precipitation); towering cumulus and other heaps where showers are
// reported, there or in the vicinity; nimbostratus where it is the overcast of showers, and any other sheet
// where no heap is.
void Builder::addRain() {
  const bool showers = present_.character == PrecipitationCharacter::kShowers;
  const bool around =
      present_.vicinity.find("SH") != std::string::npos || present_.vicinity.find("TS") != std::string::npos;
  bool falls = false;
  auto& layers = weather_.layers;
  const bool heaps = std::any_of(layers.begin(), layers.end(), [](const Layer& l) {
    return l.genus == Genus::kCumulus || l.genus == Genus::kCumulonimbus;
  });
  for (std::size_t i = 0; i < layers.size(); ++i) {
    Layer& layer = layers[i];
    if (layer.genus == Genus::kCumulonimbus) {
      layer.rainMmPerH = showers ? std::max(present_.rateMmPerH, kStormRainMmPerH) : kStormRainMmPerH;
    } else if (layer.genus == Genus::kCumulus && (showers || around)) {
      layer.rainMmPerH = showers ? present_.rateMmPerH : kShowerMmPerH;
    } else if (showers && i == thickest_ && !isIce(layer.genus) &&
               (layer.genus == Genus::kNimbostratus || !heaps)) {
      layer.rainMmPerH = present_.rateMmPerH;
      note("Showers fall from a sheet of cloud at " + metres(layer.baseM) + "; it is taken for " +
           std::string(kEnumNames<Genus>[static_cast<std::size_t>(layer.genus)]) + ".");
    }
    falls = falls || layer.rainMmPerH > 0.0;
  }
  if (showers && !falls && !layers.empty())
    note("Showers are reported but no cloud that they could fall from; they are not drawn.");
  if (!present_.vicinity.empty() && !(falls && around))
    note("In the vicinity only, and not drawn: " + present_.vicinity + ".");
}

// A sheet reported under another ends below it. Heaps and storms rise through what is above them.
void Builder::limitDepths() {
  auto& layers = weather_.layers;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    Layer& l = layers[i];
    if (l.genus == Genus::kCumulus || l.genus == Genus::kCumulonimbus || l.genus == Genus::kNimbostratus)
      continue;
    for (std::size_t k = i + 1; k < layers.size(); ++k) {
      const double gapM = layers[k].baseM - l.baseM;
      if (gapM <= 0.0) continue;
      const double limitedM = std::min(std::max(0.85 * gapM, std::min(80.0, gapM)), l.topM - l.baseM);
      // Thinner, but no more transparent than it was: a reported amount is one that hides.
      if (limitedM < l.topM - l.baseM) {
        l.extinctionPerM *= std::min((l.topM - l.baseM) / limitedM, 2.0);
        l.topM = l.baseM + limitedM;
      }
      break;
    }
  }
}

void Builder::addFog() {
  const bool fog = present_.fog == FogKind::kFog;
  if (airObscures_) {
    note(std::string("The sky is obscured by ") + (present_.snowInAir ? "snow" : "dust, smoke or haze") +
         " and not by fog: the air has the reported visibility.");
    return;
  }
  if (!metar_.skyObscured && present_.fog == FogKind::kNone) return;

  const double reportedM = metar_.visibilityM.value_or(300.0);
  const bool skySeen = metar_.clear != MetarClear::kNotSaid || metar_.cavok ||
                       std::any_of(metar_.layers.begin(), metar_.layers.end(),
                                   [](const MetarLayer& l) { return l.cover != MetarCover::kUnknown; });
  Layer layer = typicalLayer(Genus::kFog, latitudeDeg_);
  layer.baseM = 0.0;
  fogLayer_ = true;

  if (metar_.skyObscured || (fog && !skySeen && reportedM < kFogVisibilityM)) {
    // The vertical visibility is a lower bound of the depth; from there on, as deep as it takes to hide the
    // sky.
    const double visibilityM = std::clamp(reportedM, 25.0, 10000.0);
    layer.extinctionPerM = kMorOpticalDepth / visibilityM;
    const double verticalM =
        metar_.verticalVisibilityFt ? *metar_.verticalVisibilityFt * kMetresPerFoot : 0.0;
    layer.topM = std::clamp(std::max(kObscuringOpticalDepth / layer.extinctionPerM, 1.5 * verticalM),
                            kLeastObscuringDepthM, kMostObscuringDepthM);
    layer.oktas = 8.0;
    weather_.requestedOktas = 8.0;
    if (!metar_.skyObscured) note("Fog and no sky reported: the fog is taken to hide the sky.");
  } else {
    // Fog that lets the sky be seen. Patches and banks are given the visibility of fog, whatever prevails
    // around them.
    const double visibilityM = fog ? std::clamp(reportedM, 50.0, kFogVisibilityM) : 500.0;
    layer.extinctionPerM = kMorOpticalDepth / visibilityM;
    // MIFG is less than 2 m deep (WMO-No. 306, table 4678).
    layer.topM = present_.fog == FogKind::kShallow
                     ? 2.0
                     : std::clamp(kThinFogOpticalDepth / layer.extinctionPerM, 4.0, 50.0);
    const double opticalDepth = layer.extinctionPerM * layer.topM;
    // Banks cover a part of the aerodrome, patches less, and what ends beneath the eye none of the sky.
    const double share = present_.fog == FogKind::kPartial   ? 0.5
                         : present_.fog == FogKind::kPatches ? 0.3
                         : present_.fog == FogKind::kShallow ? 0.0
                                                             : 1.0;
    layer.oktas = 8.0 * share * std::min(opticalDepth / kCoverDepth, 1.0);
    weather_.requestedOktas = combinedOktas(weather_.requestedOktas, layer.oktas);
    note("The fog lets the sky be seen: it is drawn " + metres(layer.topM) + " deep" +
         (present_.fog == FogKind::kShallow ? ", below the eye." : "."));
  }
  weather_.layers.insert(weather_.layers.begin(), layer);
}

void Builder::setVisibility() {
  const double humidity = metar_.temperatureC && metar_.dewPointC
                              ? relativeHumidity(*metar_.temperatureC, *metar_.dewPointC)
                              : 0.6;
  const double clearM = clearVisibilityM(humidity);
  if (!metar_.visibilityM) {
    weather_.visibilityM = fogLayer_      ? kVisibilityOutsideFogM
                           : airObscures_ ? kVisibilityOfMor * kObscuringVisibilityM
                                          : clearM;
    note("The visibility is missing; " + metres(weather_.visibilityM) + " is assumed.");
    return;
  }
  const double reportedM = *metar_.visibilityM, ofAirM = kVisibilityOfMor * reportedM;
  // Shallow fog leaves 1000 m at eye height, banks and patches cover a part alone: more than that is the
  // air's (code table 4678).
  const bool fogMakesIt =
      fogLayer_ && (present_.fog == FogKind::kFog || metar_.skyObscured || reportedM < kFogVisibilityM);
  if (fogMakesIt && ofAirM < kVisibilityOutsideFogM) {
    weather_.visibilityM = kVisibilityOutsideFogM;
    note("What lies on the ground makes the visibility of " + metres(reportedM) +
         "; the air above it is given " + metres(kVisibilityOutsideFogM) + ".");
    return;
  }
  // Ten statute miles is as far as most American stations report (FMH-1, table 6-1).
  const bool atLeast = metar_.visibilityBound == MetarBound::kAtLeast ||
                       std::abs(reportedM - 10.0 * kMetresPerStatuteMile) < 1.0;
  weather_.visibilityM = std::max(atLeast ? std::max(clearM, ofAirM) : ofAirM, 25.0);
}

void Builder::setWinds() {
  const Wind surface{weather_.surfaceWindFromDeg, weather_.surfaceWindSpeedMps};
  for (Layer& l : weather_.layers) {
    const double heightM = l.genus == Genus::kFog ? 10.0 : 0.5 * (l.baseM + l.topM);
    const Wind wind = windAloft(surface, heightM, latitudeDeg_, month_);
    l.windFromDeg = wind.fromDeg;
    l.windSpeedMps = wind.speedMps;
  }
}

}  // namespace

double relativeHumidity(double temperatureC, double dewPointC) {
  const auto vapourPressure = [](double t) { return std::exp(17.62 * t / (243.12 + t)); };
  return std::clamp(vapourPressure(dewPointC) / vapourPressure(temperatureC), 0.0, 1.0);
}

double clearVisibilityM(double relativeHumidity) {
  constexpr double kDryRangeM = 40000.0, kDryHumidity = 0.6, kMostHumidity = 0.97;
  const double humidity = std::clamp(relativeHumidity, kDryHumidity, kMostHumidity);
  return kDryRangeM * std::sqrt((1.0 - humidity) / (1.0 - kDryHumidity));
}

Weather weatherFromMetar(const Metar& metar, double latitudeDeg, int month, double solarHour) {
  return Builder(metar, latitudeDeg, month, solarHour).build();
}

}  // namespace welkin::weather
