// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/traced_sky.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <span>
#include <string>

#include "welkin/core/error.h"
#include "welkin/core/glsl.h"
#include "welkin/optics/ice_phase.h"
#include "welkin/optics/phase.h"
#include "welkin/optics/rain_phase.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/rain_shafts.h"
#include "welkin/sky/milky_way.h"

namespace welkin::reference {
namespace {

namespace shared {
using namespace welkin::glsl;
using field::CloudLayer;
#include "shaders/lib/clouds.glsl"
#include "shaders/lib/ground.glsl"
#include "shaders/lib/milky_way.glsl"
#include "shaders/lib/stars.glsl"
}  // namespace shared

// The layers that are volumes. Throws for what this renderer does not trace.
std::vector<int> tracedLayers(const scene::SkyState& state) {
  const std::string who = "the reference renderer does not trace ";
  if (!state.scene.sheets.empty())
    throw ParameterError(who + "[[sheet]]s; expected a scene of volumes, or the renderer gpu");
  if (!state.scene.skyBox.empty())
    throw ParameterError(who + "a [sky_box]; expected a scene without one, or the renderer gpu");
  std::vector<int> layers;
  for (std::size_t i = 0; i < state.weather.layers.size(); ++i) {
    if (scene::isSheet(state.scene, state.weather.layers[i]))
      throw ParameterError(who + "layers drawn as thin sheets (layer " + std::to_string(i + 1) +
                           "); expected the technique volume, or the renderer gpu");
  }
  for (std::size_t i = 0; i < state.clouds->layers().size(); ++i)
    if (scene::isVolumeInField(state.scene, state.weather, i)) layers.push_back(static_cast<int>(i));
  return layers;
}

// With all their detail at any distance.
MetaballMedium tracedMetaballs(const scene::SkyState& state) {
  scene::CloudBalls balls;
  if (state.metaballs)
    state.metaballs->at(state.secondsAfter, {0.0, 0.0, state.scene.camera.eyeM}, state.clouds->earthRadiusM(),
                        balls, scene::MetaballDetail::kFinest);
  return MetaballMedium(balls);
}

std::vector<scene::CloudMatter> matterOf(const scene::SkyState& state) {
  std::vector<scene::CloudMatter> matter;
  for (std::size_t i = 0; i < state.clouds->layers().size(); ++i)
    matter.push_back(scene::matterInField(state.scene, state.weather, i));
  return matter;
}

}  // namespace

TracedSky::TracedSky(const scene::SkyState& s, const SkySettings& settings)
    : state(s),
      seed(settings.seed),
      projector(scene::projectorOf(s)),
      earth(s.clouds->earthRadiusM()),
      clouds(*state.clouds, tracedLayers(s), matterOf(s)),  // keeps to the field
      balls(tracedMetaballs(s)),
      air(s.atmosphere->uniforms()),
      lights(s, air, earth),
      droplets(dropletPhase(scene::dropletDiameterUm(s.weather), settings.droplets)),
      snow(snowPhase()),
      molecules(
          PhaseSampler::tabulated([](double c) { return optics::phaseRayleigh(static_cast<float>(c)); })),
      isotropic(PhaseSampler::henyeyGreenstein(0.0)),
      rain(optics::rainPhase()),
      ice(optics::icePhase()),
      peak(dropletPeak(droplets)),
      airglow(s.atmosphere->uniforms().airglow),
      airglowHeight(s.atmosphere->uniforms().airglowAltitudeM - s.atmosphere->uniforms().groundAltitudeM),
      starlight(s.scene.output.stars ? sky::starlightShare(sky::darknessElevationDeg(s.ephemeris)) : 0.0f),
      galaxyShare(s.scene.output.stars ? sky::milkyWayShare(sky::darknessElevationDeg(s.ephemeris)) : 0.0f),
      celestialFromEnu(glm::transpose(s.ephemeris.enuFromCelestial)),
      planets(s.scene.output.stars
                  ? sky::planetSpots(s.ephemeris, s.scene.camera.eyeM, scene::middlePixelRad(projector))
                  : sky::PlanetSpots{}) {
  if (starlight > 0.0f)
    stars = sky::starCells(sky::starLights(s.scene.time), sky::starLevel(scene::middlePixelRad(projector)));
}

const PhaseSampler& TracedSky::phaseOf(scene::CloudMatter matter) const {
  return matter == scene::CloudMatter::kIce    ? ice.mean()
         : matter == scene::CloudMatter::kSnow ? snow
         : matter == scene::CloudMatter::kRain ? rain.mean()
                                               : droplets;
}

const PhaseSampler& TracedSky::phaseOf(scene::MetaballPhase phase) const {
  return phase == scene::MetaballPhase::kDroplets   ? droplets
         : phase == scene::MetaballPhase::kRayleigh ? molecules
                                                    : isotropic;
}

double TracedSky::end(const Ray& ray) const {
  double near = 0.0, far = 0.0;
  const double out = earth.crossings(ray, air.topM(), near, far) ? std::max(far, 0.0) : 0.0;
  return earth.toGround(ray, out);
}

glm::dvec3 TracedSky::groundAlbedo(const glm::dvec3& p) const {
  const auto q = shared::cloudPosition(glm::vec3(p), static_cast<float>(earth.radiusM()));
  const shared::sampler2D placement{&state.clouds->noise().placement, shared::Wrap::kRepeat,
                                    shared::Wrap::kRepeat};
  return glm::dvec3(shared::groundAlbedoAt(glm::vec3(scene::groundAlbedo(state.scene, state.weather)),
                                           placement, glm::vec2(q)));
}

glm::dvec3 TracedSky::above(const Ray& ray) const {
  const double h = earth.height(ray.from);
  if (h >= airglowHeight) return glm::dvec3(0.0);
  const double mu = earth.cosine(ray.from, ray.way),
               q = (earth.radiusM() + h) / (earth.radiusM() + airglowHeight);
  return airglow / std::sqrt(std::max(1.0 - q * q * (1.0 - mu * mu), 1e-4));
}

glm::dvec3 TracedSky::starsBeyond(const glm::dvec3& way, bool discs, float pixelRad) const {
  const sky::Body& moon = state.ephemeris.moon;
  if (discs && glm::length(way - moon.direction) < moon.angularRadiusRad) return glm::dvec3(0.0);
  glm::vec3 luminance(0.0f);
  if (starlight > 0.0f) {
    const shared::sampler2D texels{&stars.texels, shared::Wrap::kClamp, shared::Wrap::kClamp};
    luminance =
        starlight * shared::starLuminance(texels, stars.cells, glm::vec3(celestialFromEnu * way), pixelRad);
  }
  if (galaxyShare > 0.0f) {
    const shared::sampler2D map{&sky::milkyWay(), shared::Wrap::kRepeat, shared::Wrap::kClamp};
    luminance += galaxyShare * glm::vec3(shared::textureLod(
                                   map, shared::milkyWayAt(glm::vec3(celestialFromEnu * way)), 0.0f));
  }
  for (const sky::PlanetSpot& p : std::span(planets.spots).first(static_cast<std::size_t>(planets.count)))
    luminance +=
        p.illuminance * shared::planetShare(glm::vec3(way) - p.direction, p.brighter, p.leastRad, pixelRad);
  return glm::dvec3(luminance);
}

}  // namespace welkin::reference
