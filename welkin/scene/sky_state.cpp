// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/sky_state.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

#include "welkin/core/error.h"
#include "welkin/core/param_range.h"
#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/cover_warnings.h"
#include "welkin/scene/sheet_texture.h"
#include "welkin/sky/light.h"

namespace welkin::scene {
namespace {

ClearSkyKey clearSkyKey(const SkyState& s, double atS) {
  for (const ClearSkyKey& key : s.clearSky)
    if (key.atS == atS) return key;
  if (s.clearSkyAhead && s.clearSkyAhead->atS == atS) return *s.clearSkyAhead;
  ClearSkyKeyInProgress making;
  making.start(s, atS);
  making.computeTo(ClearSkyKeyInProgress::kParts);
  return making.key();
}

std::array<ClearSkyKey, 2> clearSkyKeys(const SkyState& s) {
  const double before = std::floor(s.secondsAfter / ClearSkyKey::kKeyS) * ClearSkyKey::kKeyS;
  const ClearSkyKey key = clearSkyKey(s, before);
  if (s.secondsAfter == before) return {key, key};
  return {key, clearSkyKey(s, before + ClearSkyKey::kKeyS)};
}

void makeCoverKey(const SkyState& s, CoverKey& key, double atS) {
  if (key.atS == atS) return;
  if (s.coverKeyAhead && s.coverKeyAhead->atS == atS) {
    key = *s.coverKeyAhead;
    return;
  }
  CoverKeyInProgress making;
  making.start(s.scene, s.weather, s.clouds->sharedNoise(), s.calibration, atS);
  making.computeTo(making.parts());
  key = making.key();
}

// Calibrates cover for the state's instant.
void settleCover(SkyState& s) {
  if (s.coverKeyS == 0.0) return;
  auto& [first, second] = s.coverKeys;
  const double before = std::floor(s.secondsAfter / s.coverKeyS) * s.coverKeyS, after = before + s.coverKeyS;
  if (first.atS == after || second.atS == before) std::swap(first, second);
  makeCoverKey(s, first, before);
  if (s.secondsAfter != before) makeCoverKey(s, second, after);
  blendCover(first, second, s.secondsAfter, s.calibration);
}

// What is wrong with the files of the sheets by hand.
std::vector<std::string> textureWarnings(const Scene& scene) {
  std::vector<std::string> warnings;
  for (const Sheet& sheet : scene.sheets)
    if (sheet.texture)
      if (std::string warning = patternOf(sheet, 0).warning; !warning.empty())
        warnings.push_back(std::move(warning));
  return warnings;
}

// Of the camera, which stands still: whatever the instant, it looks towards the light of the scene's time.
// The moon counts where it is up; else the sky is brightest over the sun.
double headingOf(const Scene& scene) {
  if (scene.camera.headingDeg) return *scene.camera.headingDeg;
  if (scene.camera.projection != Projection::kPerspective) return 0.0;
  const SkyLights at = lightsAt(scene, 0.0);
  const bool byMoon = !at.bySun && at.ephemeris.moon.elevationDeg > 0.0;
  const sky::Body& light = byMoon ? at.ephemeris.moon : at.ephemeris.sun;
  return std::fmod(light.azimuthDeg + 60.0, 360.0);
}

}  // namespace

SkyLights lightsAt(const Scene& scene, double secondsAfter) {
  SkyLights l;
  l.time = addSeconds(scene.time, secondsAfter);
  l.ephemeris = sky::ephemeris(
      l.time, {scene.place.latitudeDeg, scene.place.longitudeDeg, scene.place.altitudeM + scene.camera.eyeM});
  const sky::Light sun = sky::sunLight(l.ephemeris), moon = sky::moonLight(l.ephemeris);
  // The sun lights the clouds until it stands where its light no longer reaches any of them. Twilight is then
  // several times as bright as a full moon.
  constexpr float kChangesAt = -7.0f;
  const auto sunDeg = static_cast<float>(l.ephemeris.sun.elevationDeg),
             moonDeg = static_cast<float>(l.ephemeris.moon.elevationDeg);
  l.bySun = sunDeg > kChangesAt;
  l.lights = l.bySun ? std::array{sun, moon} : std::array{moon, sun};
  if (l.bySun) {
    l.keyCounts = glm::smoothstep(kChangesAt, kChangesAt + 2.0f, sunDeg);
  } else {
    l.keyCounts = glm::smoothstep(0.0f, 2.0f, kChangesAt - sunDeg) * glm::smoothstep(-1.0f, 3.0f, moonDeg);
    l.keyShown = glm::smoothstep(0.0f, 1.5f, kChangesAt - sunDeg);
  }
  return l;
}

void ClearSkyKeyInProgress::start(const SkyState& state, double atS) {
  atmosphere_ = state.atmosphere;
  lights_ = lightsAt(state.scene, atS).lights;
  key_ = {};
  key_.atS = atS;
  done_ = 0;
}

void ClearSkyKeyInProgress::computeTo(int part) {
  constexpr int kSky = sky::Atmosphere::kSkyRings, kAir = sky::Atmosphere::kAirRings;
  const double ground = atmosphere_->groundAltitudeM(), low = ground + ClearSkyKey::kLowM,
               high = ClearSkyKey::highAltitudeM(ground);
  for (; done_ < std::min(part, kParts); ++done_) {
    int ring = done_;
    const auto add = [&](int rings, sky::LightMoments& sum, const auto& lightOf) {
      if (ring >= 0 && ring < rings) sum = sum + lightOf(ring);
      ring -= rings;
    };
    const auto sky = [&](double altitude) {
      return [&, altitude](int r) { return atmosphere_->skyLightOfRing(altitude, lights_, r); };
    };
    const auto air = [&](double altitude) {
      return [&, altitude](int r) { return atmosphere_->airLightOfRing(altitude, lights_, r); };
    };
    add(kSky, key_.ground, sky(ground));
    add(kSky, key_.low, sky(low));
    add(kSky, key_.high, sky(high));
    add(kAir, key_.lowAir, air(low));
    add(kAir, key_.highAir, air(high));
  }
}

glm::dvec3 groundAlbedo(const Scene& scene, const weather::Weather& weather) {
  // Of fields and woods under new snow, together.
  constexpr glm::dvec3 kSnow(0.65, 0.67, 0.70);
  const bool lies =
      scene.ground.snow == Snow::kLying || (scene.ground.snow == Snow::kAuto && weather.snowOnGround);
  return lies ? kSnow : scene.ground.albedo;
}

namespace {

// Of the years that the ephemeris knows.
void requireInstant(const Scene& scene, double secondsAfter) {
  constexpr double kFarS = 200.0 * 366.0 * 86400.0;
  if (std::abs(secondsAfter) <= kFarS) {
    const int year = addSeconds(scene.time, secondsAfter).year;
    if (year >= 1900 && year <= 2100) return;
  }
  throw ParameterError("the instant is " + numberText(secondsAfter) + " s after " +
                       formatUtcTime(scene.time) + "; expected one of the years 1900 to 2100");
}

// What the report says of it, where the scene leaves that to it.
sky::AtmosphereParams atmosphereOf(const Scene& scene, const weather::Weather& weather) {
  sky::AtmosphereParams params = scene.atmosphere;
  if (params.aerosol != sky::Aerosol::kAuto) return params;
  switch (weather.aerosol) {
    case weather::Aerosol::kHaze:
      params.aerosol = sky::Aerosol::kHaze;
      break;
    case weather::Aerosol::kDust:
      params.aerosol = sky::Aerosol::kDust;
      break;
    case weather::Aerosol::kSmoke:
      params.aerosol = sky::Aerosol::kSmoke;
      break;
    case weather::Aerosol::kAsh:
      params.aerosol = sky::Aerosol::kAsh;
      break;
  }
  return params;
}

}  // namespace

SkyState buildSky(const Scene& scene, double secondsAfter, const SkyState* previous) {
  if (previous) {
    SkyState s = *previous;
    s.scene = scene;
    moveSky(s, secondsAfter);
    return s;
  }
  validate(scene);
  requireInstant(scene, secondsAfter);
  if (!scene.slab.empty())
    throw ParameterError("a scene with [slab] has no sky; expected traceSlab() of reference/slab_tracer.h");
  SkyState s;
  s.scene = scene;
  s.secondsAfter = secondsAfter;
  s.weather = weatherOf(scene);
  const auto noise = field::makeCloudNoise(static_cast<std::uint64_t>(scene.seed));
  s.coverKeyS = coverKeyInterval(scene, s.weather);
  const bool keyIsFar = std::abs(secondsAfter) >= s.coverKeyS;
  CoverKey start = firstCoverKey(scene, s.weather, noise, keyIsFar);
  s.calibration = start.layers;
  if (!keyIsFar) s.coverKeys[0] = std::move(start);
  s.clouds = cloudsAt(scene, s.weather, s.calibration, noise, secondsAfter);
  settleCover(s);
  moveClouds(scene, s.weather, s.calibration, secondsAfter, *s.clouds);
  s.metaballs = std::make_shared<MetaballSky>(scene, s.weather, s.clouds->earthRadiusM());
  DeliveredCover cover = measureCover(scene, s.weather, *s.clouds, secondsAfter, s.metaballs.get());
  s.warnings = textureWarnings(scene);
  for (std::string& warning : coverWarnings(scene, s.weather, s.calibration, cover))
    s.warnings.push_back(std::move(warning));
  s.cover = std::move(cover.layers);
  s.sheetCover = std::move(cover.sheets);
  s.skyCover = cover.sky;
  for (std::string& warning : s.metaballs->warnings()) s.warnings.push_back(std::move(warning));
  s.atmosphere =
      std::make_shared<sky::Atmosphere>(atmosphereOf(scene, s.weather), s.weather.visibilityM,
                                        scene.place.altitudeM, glm::vec3(groundAlbedo(scene, s.weather)));
  for (ClearSkyKey& none : s.clearSky) none.atS = std::numeric_limits<double>::quiet_NaN();
  moveSky(s, secondsAfter);
  return s;
}

void moveSky(SkyState& s, double secondsAfter) {
  requireInstant(s.scene, secondsAfter);
  s.secondsAfter = secondsAfter;
  settleCover(s);
  moveClouds(s.scene, s.weather, s.calibration, secondsAfter, *s.clouds);
  const SkyLights lights = lightsAt(s.scene, secondsAfter);
  s.time = lights.time;
  s.ephemeris = lights.ephemeris;
  s.lights = lights.lights;
  s.litBySun = lights.bySun;
  s.keyCounts = lights.keyCounts;
  s.keyShown = lights.keyShown;
  s.headingDeg = headingOf(s.scene);
  s.clearSky = clearSkyKeys(s);
  s.ambient = ambientLight(s);
}

}  // namespace welkin::scene
