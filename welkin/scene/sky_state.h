// SPDX-License-Identifier: Apache-2.0
// The sky of a scene at one instant, ready to be drawn by any renderer: weather made into fields, cover
// calibrated, lights placed, atmosphere computed. A pure function of (scene, instant).
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"
#include "welkin/scene/ambient_light.h"
#include "welkin/scene/cloud_cover.h"
#include "welkin/scene/metaballs.h"
#include "welkin/scene/scene.h"
#include "welkin/sky/atmosphere.h"
#include "welkin/sky/ephemeris.h"
#include "welkin/weather/weather.h"

namespace welkin::scene {

// Light of the clear sky alone at a key instant: whole multiples of kKeyS. In between it is blended, as it
// takes milliseconds to compute: linearly, within half a hundredth at dusk.
struct ClearSkyKey {
  static constexpr double kKeyS = 30.0;
  static constexpr double kLowM = 2000.0, kHighM = 10000.0;  // above the ground, and above the sea
  // Above the sea, where the light high up is looked for: above high ground higher.
  static double highAltitudeM(double groundAltitudeM) { return std::max(kHighM, groundAltitudeM + 1000.0); }
  double atS = 0.0;
  sky::LightMoments ground, low, high;  // of the sky above the horizon at the ground, at kLowM, at kHighM
  sky::LightMoments lowAir, highAir;    // of the air below it at kLowM, at kHighM

  bool operator==(const ClearSkyKey&) const = default;
};

// Sun and moon of a scene at an instant.
struct SkyLights {
  UtcTime time;
  sky::Ephemeris ephemeris;
  std::array<sky::Light, 2> lights;  // sun and moon; lights[0] is the one that lights the clouds
  bool bySun = true;                 // it is the sun
  // One takes the other's place while neither lights much: by how much it counts from where lights[0] comes,
  // and how much of its light volumes get.
  float keyCounts = 1.0f, keyShown = 1.0f;
};
SkyLights lightsAt(const Scene& scene, double secondsAfter);

struct SkyState {
  Scene scene;
  UtcTime time;  // scene.time + secondsAfter
  double secondsAfter = 0.0;
  weather::Weather weather;
  sky::Ephemeris ephemeris;
  std::array<sky::Light, 2> lights;  // as SkyLights
  bool litBySun = true;
  float keyCounts = 1.0f, keyShown = 1.0f;
  std::shared_ptr<const sky::Atmosphere> atmosphere;
  std::optional<field::CloudField> clouds;       // always there
  std::shared_ptr<const MetaballSky> metaballs;  // beside them; of all instants
  double coverKeyS = 0.0;                        // coverKeyInterval()
  std::array<CoverKey, 2> coverKeys;             // about the instant; the second may be any at the first
  std::optional<CoverKey> coverKeyAhead;         // of another, where it is known: saves time to a move there
  std::vector<LayerCalibration> calibration;  // of the instant; a layer each, in the order of weather.layers
  std::array<ClearSkyKey, 2> clearSky;        // before and after the instant
  std::optional<ClearSkyKey> clearSkyAhead;   // of another, where it is known: saves time to a move there
  AmbientLight ambient;
  std::vector<LayerCover> cover;       // a layer each, in the order of weather.layers
  std::vector<LayerCover> sheetCover;  // a sheet by hand each, in the scene's order
  LayerCover skyCover;                 // the whole sky
  std::vector<std::string> warnings;   // files that could not be used, covers that cannot be met
  // The direction that is drawn: the camera's, with "absent" resolved, the same at all instants. To look
  // elsewhere in the same sky, change this and not the scene's.
  double headingDeg = 0.0;
};

// The weather of a scene: its report decoded, or its layers by hand. Throws ParseError for a report that
// cannot be read.
weather::Weather weatherOf(const Scene& scene);

// Reflectance of the ground, linear Rec. 709: of snow where it lies.
glm::dvec3 groundAlbedo(const Scene& scene, const weather::Weather& weather);

// Builds the sky `secondsAfter` the scene's time. What does not depend on the instant (noise, patterns), and
// key instants that both need, are taken from `previous` when given, which must come from the same scene; the
// sky is the same either way. The delivered cover is measured only without `previous`, as it costs more than
// the rest: a sequence carries that of its first picture.
// Throws ParameterError where validate(scene) does, for scenes with a slab and for instants of other years
// than 1900 to 2100; ParseError for a report that cannot be read. Files that cannot be used are warnings.
SkyState buildSky(const Scene& scene, double secondsAfter, const SkyState* previous = nullptr);

// The same in the place of the sky of the same scene at another instant. Allocates nothing, unless cover is
// to be calibrated at a key instant that is neither there nor in coverKeyAhead: some hundredths of a second.
// Throws ParameterError for such instants.
void moveSky(SkyState& state, double secondsAfter);

// A key instant in portions, for frame loops: the same key whatever the portions.
class ClearSkyKeyInProgress {
 public:
  static constexpr int kParts = 3 * sky::Atmosphere::kSkyRings + 2 * sky::Atmosphere::kAirRings;
  void start(const SkyState& state, double atS);   // of which it keeps the atmosphere
  void computeTo(int part);                        // the first `part` of them
  const ClearSkyKey& key() const { return key_; }  // complete after computeTo(kParts)

 private:
  std::shared_ptr<const sky::Atmosphere> atmosphere_;
  std::array<sky::Light, 2> lights_;
  ClearSkyKey key_;
  int done_ = 0;
};

}  // namespace welkin::scene
