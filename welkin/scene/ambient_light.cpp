// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/ambient_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include "welkin/core/colour.h"
#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"
#include "welkin/optics/phase.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/hazy_deck.h"
#include "welkin/scene/sky_state.h"

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

// Light from the upper (side 1) or lower (-1) hemisphere, of one luminance.
sky::LightMoments hemisphere(const glm::vec3& luminance, float side) {
  const auto pi = static_cast<float>(kPi);
  return {2.0f * pi * luminance, {glm::vec3(0.0f), glm::vec3(0.0f), side * pi * luminance}};
}

// What hazy air makes of the light about it. It scatters forward; what goes on nearly as it came is taken for
// light that was not scattered (shaders/lib/air_shadows.glsl), and of the rest this is the mean cosine.
constexpr float kHazeScatters = 0.93f;  // of what it takes from a ray, with the air in it
constexpr float kHazeAlbedo = 0.9f;     // of itself; dust and smoke have others
constexpr float kHazeAsymmetry = 0.4f;
AirLight airLight(const sky::Atmosphere& air, const sky::LightMoments& about) {
  const sky::AtmosphereUniforms& u = air.uniforms();
  const glm::vec3 albedo = u.aerosolScattering / glm::max(u.aerosolExtinction, glm::vec3(1e-12f));
  const glm::vec3 scatters = glm::mix(glm::vec3(kHazeScatters), albedo * (kHazeScatters / kHazeAlbedo),
                                      glm::vec3(glm::greaterThan(u.aerosolExtinction, glm::vec3(1e-12f))));
  const glm::vec3 mean = scatters / static_cast<float>(4.0 * kPi), along = 3.0f * kHazeAsymmetry * mean;
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

// Light of the clear sky from above the horizon at a height above the ground.
sky::LightMoments clearSkyAt(const sky::Atmosphere& atmosphere, const AirSources& from, double heightM) {
  const auto mix = [](const sky::LightMoments& x, const sky::LightMoments& y, double w) {
    const auto share = static_cast<float>(std::clamp(w, 0.0, 1.0));
    return (1.0f - share) * x + share * y;
  };
  constexpr double kLowM = ClearSkyKey::kLowM;
  const double ground = atmosphere.groundAltitudeM(), highM = ClearSkyKey::highAltitudeM(ground) - ground;
  if (heightM < kLowM) return mix(from.ground, from.low, heightM / kLowM);
  return mix(from.low, from.high, (heightM - kLowM) / (highM - kLowM));
}

// What the air sends back down at an altitude of the light that clouds send up beyond what the ground alone
// would: luminance.
glm::vec3 sentBack(const sky::Atmosphere& atmosphere, const AirSources& from, double altitudeM) {
  return atmosphere.sphericalAlbedo(altitudeM) * (from.upward - from.bare);
}

// The same from air over the clouds as luminance that it tends to, from whatever side: a ray has as much of
// that as the air along it takes from what comes through, and the upper hemisphere then has what is sent
// back.
glm::vec3 overClouds(const sky::Atmosphere& atmosphere, const AirSources& from, double heightM) {
  const double altitudeM = atmosphere.groundAltitudeM() + heightM;
  const glm::vec3 taken = 1.0f - atmosphere.transmittanceToSpace(altitudeM, kDiffuseMu);
  return glm::max(sentBack(atmosphere, from, altitudeM), glm::vec3(0.0f)) / glm::max(taken, glm::vec3(1e-4f));
}

// airAbout(), whatever the eye is there for.
EyeAir airAtHeight(const sky::Atmosphere& atmosphere, const AirSources& from, float cover, double heightM) {
  EyeAir air;
  const sky::LightMoments clear = clearSkyAt(atmosphere, from, heightM);
  // From above the clouds most of the air in view is sunlit.
  constexpr float kOutOfThemM = 400.0f;
  if (from.anyVolumes)
    air.clearAir = 1.0f - cover * (1.0f - glm::smoothstep(from.lowM, from.lowM + kOutOfThemM,
                                                          static_cast<float>(heightM)));
  // Around the eye beneath the clouds, where they are overhead; and above, where they are in the place of the
  // ground.
  const float above =
      from.anyVolumes
          ? std::clamp((static_cast<float>(heightM) - from.lowM) / std::max(from.highM - from.lowM, 1.0f),
                       0.0f, 1.0f)
          : 0.0f;
  const sky::LightMoments over =
      clear + hemisphere(sentBack(atmosphere, from, atmosphere.groundAltitudeM() + heightM), 1.0f) +
      hemisphere(from.upward, -1.0f);
  const sky::LightMoments under = throughGaps(clear, from.gapsOverhead, from.gapsLevel) + from.underClouds;
  air.haze = airLight(atmosphere, (1.0f - above) * under + above * over);
  air.cloudGlow = excess(air.haze, airLight(atmosphere, clear + hemisphere(from.bare, -1.0f)));
  if (!from.anyVolumes) return air;
  air.overCloudsM = from.highM;
  air.overClouds = overClouds(atmosphere, from, std::max(heightM, static_cast<double>(from.highM)));
  return air;
}

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
  const glm::vec3 low = through(ground + ClearSkyKey::kLowM),
                  high = through(ClearSkyKey::highAltitudeM(ground)),
                  haze = airAtHeight(*s.atmosphere, a.airSources, a.cover, 0.0).haze.mean;
  const sky::LightMoments shade = shaded * (hemisphere((1.0f - low) * haze, -1.0f) + -1.0f * lowAir);
  a.below = lowAir + shade + hemisphere(low * a.ground, -1.0f);
  a.belowHigh = highAir + shade + hemisphere(high * a.ground, -1.0f);
}

}  // namespace

AirLight operator*(const glm::vec3& share, const AirLight& light) {
  return {share * light.mean, {share * light.along[0], share * light.along[1], share * light.along[2]}};
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
  AirSources& from = a.airSources;
  from.ground = now(before.ground, after.ground);
  from.low = now(before.low, after.low);
  from.high = now(before.high, after.high);
  const double ground = atmosphere.groundAltitudeM();
  const glm::vec3 skyOnGround = from.ground.along[2];
  a.skyLow = skyOnGround / pi;
  a.skyHigh = from.high.along[2] / pi;
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
  const glm::vec3 albedo(groundAlbedo(s.scene, s.weather));
  // What goes through clouds fell on them where the sky is darker and less blue than at the ground.
  const glm::vec3 skyOnClouds = clearSkyAt(atmosphere, from, shade.lightM).along[2];
  const float gaps = std::min(1.0f - cover, through);
  const HazyLight hazy = lightThroughHaze(shade.deck, atmosphere.uniforms());
  a.skyOnGround =
      skyOnGround * gaps + hazy.onGround * (skyOnClouds * (through - gaps) + onClouds * scatteredDown);
  a.ground = albedo / pi * (a.skyOnGround + direct * (1.0f - taken));
  // Clouds are whiter than the ground, and what they send up the air sends down again, most of it blue.
  from.bare = albedo / pi * (skyOnGround + direct);
  from.upward =
      (onClouds * (1.0f - passes) + skyOnClouds * (1.0f - through)) / pi + a.ground * (1.0f - cover);
  const auto back = [&](double altitudeM) { return sentBack(atmosphere, from, altitudeM); };
  const glm::vec3 moreOnGround = pi * back(ground);
  const glm::vec3 moreThrough =
      moreOnGround * gaps + hazy.onGround * pi * back(ground + shade.lightM) * (through - gaps);
  a.above = from.ground + hemisphere(back(ground), 1.0f);
  a.aboveLow = from.low + hemisphere(back(ground + ClearSkyKey::kLowM), 1.0f);
  a.aboveHigh = from.high + hemisphere(back(ClearSkyKey::highAltitudeM(ground)), 1.0f);
  a.skyOnGround += moreThrough;
  a.ground += albedo / pi * moreThrough;
  // Clouds send as much down as up from all sides; the rest, of broken ones, goes on downwards much as it
  // came, and counts three quarters. What they turn by a few degrees only lights the air as it did before.
  const float onwards = std::max(scatteredDown - (1.0f - passes), 0.0f);
  const float fromAllSides = scatteredDown - 0.25f * onwards;
  const glm::vec3 onHaze = 0.5f * (hazy.onGround + hazy.underDeck);
  from.underClouds =
      hemisphere(moreThrough / pi, 1.0f) + hemisphere(a.ground, -1.0f) +
      fromClouds(onHaze * (skyOnClouds * (through - gaps) + onClouds * (aside * fromAllSides)), cover);
  for (int i = 0; i < 2; ++i)
    from.underClouds.along[i] +=
        2.0f * kOnwards * s.keyCounts * s.lights[0].direction[i] * (aside * onwards) * onHaze * onClouds;
  from.gapsOverhead = gaps;
  from.gapsLevel = 1.0f - taken;
  from.lowM = static_cast<float>(shade.lowM);
  from.highM = static_cast<float>(shade.highM);
  from.anyVolumes = shade.any;
  a.air = airAtHeight(atmosphere, from, a.cover, s.scene.camera.eyeM);
  // Under a low sun nearly all of it is in their shade.
  addLightFromBelow(s, now(before.lowAir, after.lowAir), now(before.highAir, after.highAir), taken * aside,
                    a);
  return a;
}

EyeAir airAbout(const SkyState& s, double eyeM) {
  return airAtHeight(*s.atmosphere, s.ambient.airSources, s.ambient.cover, eyeM);
}

}  // namespace welkin::scene
