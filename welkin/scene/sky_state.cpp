// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/sky_state.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

#include "welkin/core/colour.h"
#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"
#include "welkin/optics/phase.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/cover_warnings.h"
#include "welkin/scene/hazy_deck.h"
#include "welkin/scene/sheet_texture.h"
#include "welkin/sky/light.h"

namespace welkin::scene {
namespace {

// How many cells more a slanting ray comes by at most.
constexpr double kMoreCells = 3.0;

// Illuminance that a light sends through the air onto a horizontal plane at a height above the ground.
glm::vec3 horizontalIlluminance(const sky::Atmosphere& atmosphere, const sky::Light& light, double heightM) {
  const double mu = light.direction.z;
  if (mu <= 0.0) return glm::vec3(0.0f);
  return light.illuminance * atmosphere.transmittanceToSpace(atmosphere.groundAltitudeM() + heightM, mu) *
         static_cast<float>(mu);
}

// Conservative cloud sends back that much of light that falls on it at a cosine, by Eddington's solution (E.
// P. Shettle and J. A. Weinman 1970). depth: optical, times 1 - g.
double slabReflectance(double depth, double mu) {
  return 1.0 - (2.0 / 3.0 + mu + (2.0 / 3.0 - mu) * std::exp(-depth / mu)) / (4.0 / 3.0 + depth);
}
constexpr double kDiffuseMu = 2.0 / 3.0;
// Of broken cloud light leaves downwards through the sides: what it sends back is less by a power of the
// clouds' share of the plane, that grows with how tall they are for their width, and with the sun's height.
// Fitted to the light of sky and clouds on the ground under skies of the reference renderer (cumulus of 2 to
// 6 oktas, congestus of 3, stratocumulus of 3 to 7, each under suns of 15 to 66 degrees, four to twelve skies
// each): it agrees within 11 %, RMS. Out of clouds so thick as thunderclouds little comes but on the side
// where it went in.
constexpr double kLeaks = 2.2, kTallCells = 0.6, kLeaksUpTo = 10.0;

// How many more cells a slanting ray comes by than an upright one. tangent: of its zenith angle; cells: how
// deep a layer is for the distance of its clouds.
double moreCells(double tangent, double cells) {
  return std::min(0.5 * tangent * cells, kMoreCells);
}

// The clouds' share of the plane, overhead. From the ground one sees their sides too: the cover of the sky is
// more, by the mean of what moreCells() adds over the hemisphere, of which sparse clouds have a little less.
double shareOverhead(double cover, double cells) {
  const double half = std::max(0.5 * cells, 1e-6),
               added = half * std::log(std::max(2.0 * kMoreCells / half, 1.0));
  constexpr double kSparse = 0.83;
  return 1.0 - std::pow(1.0 - cover, 1.0 / (1.0 + kSparse * added));
}

// What the volumes do with light on its way to the ground, on average over the sky.
struct CloudShade {
  double cover = 0.0;       // of the sky, [0, 1]
  double slantCover = 0.0;  // share of the key light's rays that meet cloud from lowest base to highest top
  double passes = 1.0;      // share of the key light that goes on downwards, scattered or not
  double diffuse = 1.0;     // the same of diffuse light
  double aside = 0.0;  // of what clouds take from rays, the share that is turned by more than a few degrees
  double lowM = 0.0, highM = 0.0;  // the lowest base and the highest top
  double lightM = 0.0;             // where light falls on what is thick enough to scatter it all
  bool any = false;
  Deck deck;  // the layer that takes most of it
  // Share of the key light that goes on downwards after clouds have scattered it.
  double scatteredDown() const { return std::max(passes - (1.0 - slantCover), 0.0); }
};

// sunHeight: sine of the elevation of the key light.
CloudShade cloudShade(const Scene& scene, const weather::Weather& weather, const field::CloudField& clouds,
                      double sunHeight) {
  CloudShade shade;
  double clear = 1.0, straight = 1.0, slantwise = 1.0, most = 0.0;
  const double mu = std::max(sunHeight, 0.05), tangent = std::sqrt(1.0 - sunHeight * sunHeight) / mu;
  bool all = true;
  for (std::size_t i = 0; i < weather.layers.size(); ++i) {
    if (isSheet(scene, weather.layers[i])) {
      all = false;
      continue;
    }
    const field::CloudLayer& layer = clouds.layers()[i];
    const double cover = weather.layers[i].oktas / kOktas, depth = layer.topM - layer.baseM;
    const double tau = depth * layer.extinction, cells = depth / cloudSpacingM(layer);
    const double overhead = shareOverhead(cover, cells);
    const double depthBySimilarity = (1.0 - optics::dropletAsymmetry()) * kMeanDensity * tau;
    const double thick = depthBySimilarity / kLeaksUpTo,
                 leaks = kLeaks * std::min(cells, kTallCells) / (1.0 + thick * thick);
    const auto reflected = [&](double cosine) {
      const double among = std::pow(overhead, leaks * cosine);
      return among * slabReflectance(depthBySimilarity, cosine);
    };
    const double taken = cover * reflected(kDiffuseMu);
    if (taken > most) {
      most = taken;
      shade.deck = {layer.baseM, layer.topM, cover * depthBySimilarity};
    }
    shade.diffuse *= 1.0 - taken;
    clear *= 1.0 - cover;
    // A slanting ray comes by more clouds; a few at most, as gaps are in line.
    const double past = std::pow(1.0 - overhead, 1.0 + moreCells(tangent, cells));
    slantwise *= past;
    shade.passes *= 1.0 - (1.0 - past) * reflected(mu);
    straight *= 1.0 - cover * (1.0 - std::exp(-optics::dropletAside() * tau));
    shade.lowM = shade.any ? std::min(shade.lowM, static_cast<double>(layer.baseM)) : layer.baseM;
    shade.highM = std::max(shade.highM, static_cast<double>(layer.topM));
    if (tau > 3.0)
      shade.lightM = std::max(shade.lightM, cover >= 0.5 ? layer.topM : 0.5 * (layer.baseM + layer.topM));
    shade.any = true;
  }
  shade.cover = all ? weather.requestedOktas / kOktas : 1.0 - clear;
  shade.slantCover = 1.0 - slantwise;
  shade.aside = (1.0 - straight) / std::max(1.0 - clear, 1e-6);
  return shade;
}

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

// Where the light high up is looked for.
double highAltitude(double groundAltitudeM) {
  return std::max(ClearSkyKey::kHighM, groundAltitudeM + 1000.0);
}

// Light from the upper (side 1) or lower (-1) hemisphere, of one luminance.
sky::LightMoments hemisphere(const glm::vec3& luminance, float side) {
  const auto pi = static_cast<float>(kPi);
  return {2.0f * pi * luminance, {glm::vec3(0.0f), glm::vec3(0.0f), side * pi * luminance}};
}

// What hazy air makes of the light about it. It scatters forward; what goes on nearly as it came is taken for
// light that was not scattered (shaders/lib/air_shadows.glsl), and of the rest this is the mean cosine.
constexpr float kHazeScatters = 0.93f;  // of what it takes from a ray
constexpr float kHazeAsymmetry = 0.4f;
AirLight airLight(const sky::LightMoments& about) {
  const float mean = kHazeScatters / static_cast<float>(4.0 * kPi), along = 3.0f * kHazeAsymmetry * mean;
  return {mean * about.total, {along * about.along[0], along * about.along[1], along * about.along[2]}};
}

// By how much light is more than another. Where it is less in the mean there is none of it from any side, and
// what is linear in directions is never more than a single light of that mean has.
AirLight excess(const AirLight& light, const AirLight& other) {
  AirLight more{glm::max(light.mean - other.mean, glm::vec3(0.0f)), {}};
  for (int c = 0; c < 3; ++c) {
    glm::vec3 along;
    for (int i = 0; i < 3; ++i) along[i] = light.along[i][c] - other.along[i][c];
    const float most = 3.0f * kHazeAsymmetry * more.mean[c], length = glm::length(along);
    for (int i = 0; i < 3; ++i) more.along[i][c] = length > most ? along[i] * (most / length) : along[i];
  }
  return more;
}

// Of the clear sky, what comes overhead and what comes level; the sky about the sun makes most of that.
sky::LightMoments throughGaps(const sky::LightMoments& clear, float overhead, float level) {
  return {overhead * clear.total,
          {level * clear.along[0], level * clear.along[1], overhead * clear.along[2]}};
}

// Light that clouds let through to a level plane, lux. Closed ones are darker towards the horizon: there is
// 6/7 of the light of an even sky on a small ball (P. Moon and D. E. Spencer 1942, "Illumination from a
// Non-Uniform Sky").
sky::LightMoments fromClouds(const glm::vec3& illuminance, float cover) {
  return {2.0f * (1.0f - cover / 7.0f) * illuminance, {glm::vec3(0.0f), glm::vec3(0.0f), illuminance}};
}
// Mean cosine to the light's own way, level, of light that broken clouds have scattered downwards much as it
// came; on a small ball there is twice as much of it as on a level plane.
constexpr float kOnwards = 0.4f;

// Fills in below and belowHigh: the air that clouds see beneath them, a share of it shaded by them, and the
// ground through it.
void addLightFromBelow(const SkyState& s, const sky::LightMoments& lowAir, const sky::LightMoments& highAir,
                       float shaded, AmbientLight& a) {
  // The mean way through a layer of the air of light from all sides is as long as that at this cosine.
  constexpr double kMeanCosine = 0.6;
  const double ground = s.atmosphere->groundAltitudeM();
  const glm::vec3 here = s.atmosphere->transmittanceToSpace(ground, kMeanCosine);
  const auto through = [&](double altitudeM) {
    return here / glm::max(s.atmosphere->transmittanceToSpace(altitudeM, kMeanCosine), glm::vec3(1e-6f));
  };
  const glm::vec3 low = through(ground + ClearSkyKey::kLowM), high = through(highAltitude(ground));
  const sky::LightMoments shade = shaded * (hemisphere((1.0f - low) * a.haze.mean, -1.0f) + -1.0f * lowAir);
  a.below = lowAir + shade + hemisphere(low * a.ground, -1.0f);
  a.belowHigh = highAir + shade + hemisphere(high * a.ground, -1.0f);
}

// Light of the sky at a height above the ground; highM: that of the highest known.
sky::LightMoments skyAt(const AmbientLight& a, double heightM, double highM) {
  const auto mix = [](const sky::LightMoments& x, const sky::LightMoments& y, double w) {
    const auto share = static_cast<float>(std::clamp(w, 0.0, 1.0));
    return (1.0f - share) * x + share * y;
  };
  if (heightM < ClearSkyKey::kLowM) return mix(a.above, a.aboveLow, heightM / ClearSkyKey::kLowM);
  return mix(a.aboveLow, a.aboveHigh, (heightM - ClearSkyKey::kLowM) / (highM - ClearSkyKey::kLowM));
}

AmbientLight ambientLight(const SkyState& s) {
  AmbientLight a;
  const sky::Atmosphere& atmosphere = *s.atmosphere;
  const float pi = static_cast<float>(kPi);
  const ClearSkyKey &before = s.clearSky[0], &after = s.clearSky[1];
  const float w = static_cast<float>((s.secondsAfter - before.atS) / ClearSkyKey::kKeyS);
  const auto now = [&](const sky::LightMoments& x, const sky::LightMoments& y) {
    return (1.0f - w) * x + w * y;
  };
  a.above = now(before.ground, after.ground);
  a.aboveLow = now(before.low, after.low);
  a.aboveHigh = now(before.high, after.high);
  const double ground = atmosphere.groundAltitudeM(), highM = highAltitude(ground) - ground,
               eyeM = s.scene.camera.eyeM;
  const sky::LightMoments clear = skyAt(a, eyeM, highM);
  const glm::vec3 skyOnGround = a.above.along[2];
  a.skyLow = skyOnGround / pi;
  a.skyHigh = a.aboveHigh.along[2] / pi;
  constexpr float kMeanHeight = 0.4f;  // sine, of light from no side
  const CloudShade shade =
      cloudShade(s.scene, s.weather, *s.clouds,
                 static_cast<double>(glm::mix(kMeanHeight, s.lights[0].direction.z, s.keyCounts)));
  glm::vec3 direct(0.0f), onClouds(0.0f);
  for (const sky::Light& light : s.lights) {
    direct += horizontalIlluminance(atmosphere, light, 0.0);
    // What falls on the clouds has not yet passed the air beneath their tops.
    onClouds += horizontalIlluminance(atmosphere, light, shade.lightM);
  }
  a.cover = static_cast<float>(shade.cover);
  a.cloudsM = static_cast<float>(shade.lightM);
  a.sunOverSky = luminanceOf(&direct.x) / std::max(luminanceOf(&skyOnGround.x), 1e-9f);
  const auto cover = static_cast<float>(shade.cover);
  const auto taken = static_cast<float>(shade.slantCover), passes = static_cast<float>(shade.passes),
             scatteredDown = static_cast<float>(shade.scatteredDown()),
             through = static_cast<float>(shade.diffuse), aside = static_cast<float>(shade.aside);
  const glm::vec3 albedo(s.scene.ground.albedo);
  // What goes through clouds fell on them where the sky is darker and less blue than at the ground.
  const glm::vec3 skyOnClouds = skyAt(a, shade.lightM, highM).along[2];
  const float gaps = std::min(1.0f - cover, through);
  const HazyLight hazy = lightThroughHaze(shade.deck, atmosphere.uniforms());
  a.skyOnGround =
      skyOnGround * gaps + hazy.onGround * (skyOnClouds * (through - gaps) + onClouds * scatteredDown);
  a.ground = albedo / pi * (a.skyOnGround + direct * (1.0f - taken));
  // Clouds are whiter than the ground, and what they send up the air sends down again, most of it blue.
  const glm::vec3 bare = albedo / pi * (skyOnGround + direct);
  const glm::vec3 upward =
      (onClouds * (1.0f - passes) + skyOnClouds * (1.0f - through)) / pi + a.ground * (1.0f - cover);
  const auto sentBack = [&](double altitudeM) {
    return atmosphere.sphericalAlbedo(altitudeM) * (upward - bare);
  };
  const glm::vec3 moreOnGround = pi * sentBack(ground);
  const glm::vec3 moreThrough =
      moreOnGround * gaps + hazy.onGround * pi * sentBack(ground + shade.lightM) * (through - gaps);
  a.above = a.above + hemisphere(sentBack(ground), 1.0f);
  a.aboveLow = a.aboveLow + hemisphere(sentBack(ground + ClearSkyKey::kLowM), 1.0f);
  a.aboveHigh = a.aboveHigh + hemisphere(sentBack(highAltitude(ground)), 1.0f);
  a.skyOnGround += moreThrough;
  a.ground += albedo / pi * moreThrough;
  // From above the clouds most of the air in view is sunlit.
  a.clearAir = shade.any && eyeM < shade.lowM + 200.0 ? 1.0f - cover : 1.0f;
  // Around the eye beneath the clouds, where they are overhead; and above, where they are in the place of the
  // ground. What they turn by a few degrees only lights the air as it did before.
  const float above = static_cast<float>(
      shade.any ? std::clamp((eyeM - shade.lowM) / std::max(shade.highM - shade.lowM, 1.0), 0.0, 1.0) : 0.0);
  const sky::LightMoments over =
      clear + hemisphere(sentBack(ground + eyeM), 1.0f) + hemisphere(upward, -1.0f);
  // Clouds send as much down as up from all sides; the rest, of broken ones, goes on downwards much as it
  // came, and counts three quarters.
  const float onwards = std::max(scatteredDown - (1.0f - passes), 0.0f);
  const float fromAllSides = scatteredDown - 0.25f * onwards;
  const glm::vec3 onHaze = 0.5f * (hazy.onGround + hazy.underDeck);
  sky::LightMoments under =
      throughGaps(clear, gaps, 1.0f - taken) + hemisphere(moreThrough / pi, 1.0f) +
      hemisphere(a.ground, -1.0f) +
      fromClouds(onHaze * (skyOnClouds * (through - gaps) + onClouds * (aside * fromAllSides)), cover);
  for (int i = 0; i < 2; ++i)
    under.along[i] +=
        2.0f * kOnwards * s.keyCounts * s.lights[0].direction[i] * (aside * onwards) * onHaze * onClouds;
  const AirLight none = airLight(clear + hemisphere(bare, -1.0f));
  a.haze = airLight((1.0f - above) * under + above * over);
  a.cloudGlow = excess(a.haze, none);
  // Under a low sun nearly all of it is in their shade.
  addLightFromBelow(s, now(before.lowAir, after.lowAir), now(before.highAir, after.highAir), taken * aside,
                    a);
  return a;
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

AirLight operator*(const glm::vec3& share, const AirLight& light) {
  return {share * light.mean, {share * light.along[0], share * light.along[1], share * light.along[2]}};
}

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
               high = highAltitude(ground);
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

SkyState buildSky(const Scene& scene, double secondsAfter, const SkyState* previous) {
  if (previous) {
    SkyState s = *previous;
    s.scene = scene;
    moveSky(s, secondsAfter);
    return s;
  }
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
  s.atmosphere = std::make_shared<sky::Atmosphere>(scene.atmosphere, s.weather.visibilityM,
                                                   scene.place.altitudeM, glm::vec3(scene.ground.albedo));
  for (ClearSkyKey& none : s.clearSky) none.atS = std::numeric_limits<double>::quiet_NaN();
  moveSky(s, secondsAfter);
  return s;
}

void moveSky(SkyState& s, double secondsAfter) {
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
