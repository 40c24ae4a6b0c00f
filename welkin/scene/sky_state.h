// SPDX-License-Identifier: Apache-2.0
// The sky of a scene at one instant, ready to be drawn by any renderer: weather made into fields, cover
// calibrated, lights placed, atmosphere computed. A pure function of (scene, instant).
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "welkin/scene/cloud_cover.h"
#include "welkin/scene/scene.h"
#include "welkin/sky/atmosphere.h"
#include "welkin/sky/ephemeris.h"
#include "welkin/weather/weather.h"

namespace welkin::scene {

// Light that reaches clouds and ground from all directions at once, past the layers that are drawn as
// volumes; what thin sheets make of it: shading/sheet_ambient.h. Linear Rec. 709.
struct AmbientLight {
  glm::vec3 skyLow{0};       // mean luminance of the upper hemisphere of the clear sky at the ground, cd/m2
  glm::vec3 skyHigh{0};      // the same at 10 km
  glm::vec3 skyOnGround{0};  // illuminance of the ground by sky and clouds, lux
  glm::vec3 ground{0};       // mean luminance of the ground, cd/m2
  float clearAir = 1.0f;     // share of the air beneath the clouds that the sun reaches
  glm::vec3 haze{0};         // mean luminance about the eye where it does not, cd/m2
};

// Illuminance by the clear sky alone of a plane facing up, at a key instant: whole multiples of kKeyS. In
// between it is blended, as it takes milliseconds to compute: linearly, within half a hundredth at dusk.
struct ClearSkyKey {
  static constexpr double kKeyS = 30.0;
  double atS = 0.0;
  glm::vec3 ground{0}, high{0};  // at the ground, at 10 km; lux
};

// Sun and moon of a scene at an instant.
struct SkyLights {
  UtcTime time;
  sky::Ephemeris ephemeris;
  std::vector<sky::Light> lights;  // lights[0] is the one that lights the clouds
  bool bySun = true;               // it is the sun
};
SkyLights lightsAt(const Scene& scene, double secondsAfter);

struct SkyState {
  Scene scene;
  UtcTime time;  // scene.time + secondsAfter
  double secondsAfter = 0.0;
  weather::Weather weather;
  sky::Ephemeris ephemeris;
  std::vector<sky::Light> lights;  // as SkyLights
  bool litBySun = true;
  std::shared_ptr<const sky::Atmosphere> atmosphere;
  std::shared_ptr<const field::CloudField> clouds;
  std::vector<LayerCalibration> calibration;  // a layer each, in the order of weather.layers
  std::array<ClearSkyKey, 2> clearSky;        // before and after the instant
  AmbientLight ambient;
  std::vector<LayerCover> cover;       // a layer each, in the order of weather.layers
  std::vector<LayerCover> sheetCover;  // a sheet by hand each, in the scene's order
  LayerCover skyCover;                 // the whole sky
  std::vector<std::string> warnings;   // files that could not be used, and what stands in for them
  double headingDeg = 0.0;             // the camera's, with "absent" resolved
};

// The weather of a scene: its report decoded, or its layers by hand. Throws ParseError for a report that
// cannot be read.
weather::Weather weatherOf(const Scene& scene);

// Builds the sky `secondsAfter` the scene's time. What does not depend on the instant (noise, cover) is taken
// from `previous` when given, which must come from the same scene; the sky is the same either way. The
// delivered cover is measured only without `previous`, as it costs more than the rest: a sequence carries
// that of its first picture.
SkyState buildSky(const Scene& scene, double secondsAfter, const SkyState* previous = nullptr);

}  // namespace welkin::scene
