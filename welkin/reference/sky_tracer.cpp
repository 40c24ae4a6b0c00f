// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/sky_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/matrix.hpp>
#include <span>
#include <string>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/core/glsl.h"
#include "welkin/optics/ice_phase.h"
#include "welkin/optics/phase.h"
#include "welkin/optics/rain_phase.h"
#include "welkin/reference/cloud_medium.h"
#include "welkin/reference/cloud_phases.h"
#include "welkin/reference/directions.h"
#include "welkin/reference/metaball_medium.h"
#include "welkin/reference/phase_sampler.h"
#include "welkin/reference/sky_lights.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/projector.h"
#include "welkin/scene/rain_shafts.h"
#include "welkin/sky/milky_way.h"
#include "welkin/sky/star_cells.h"

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

// A path whose throughput is below the one goes on with a chance, and with the other.
constexpr double kRouletteBelow = 0.1, kRouletteTo = 0.3;
// How often air and ground look for light by way of clouds.
constexpr double kChainOfOthers = 0.25;
// Light of which a smaller share than this would leave towards the eye, 1/sr, is looked for with a chance:
// most scatterings in a cloud send little that way, and each would have its way to the sun walked.
constexpr double kLittleLight = 0.03;

double sum(const glm::dvec3& v) {
  return v.x + v.y + v.z;
}
double largest(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

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

struct SkyTracer::Impl {
  Impl(const scene::SkyState& s, const SkySettings& settings)
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
        peak(dropletPeak(droplets)),
        airglow(s.atmosphere->uniforms().airglow),
        airglowHeight(s.atmosphere->uniforms().airglowAltitudeM - s.atmosphere->uniforms().groundAltitudeM),
        starlight(s.scene.output.stars ? sky::starlightShare(s.ephemeris.sun.elevationDeg) : 0.0f),
        galaxyShare(s.scene.output.stars ? sky::milkyWayShare(s.ephemeris.sun.elevationDeg) : 0.0f),
        celestialFromEnu(glm::transpose(s.ephemeris.enuFromCelestial)),
        planets(s.scene.output.stars
                    ? sky::planetSpots(s.ephemeris, s.scene.camera.eyeM, scene::middlePixelRad(projector))
                    : sky::PlanetSpots{}) {
    if (starlight > 0.0f)
      stars = sky::starCells(sky::starLights(s.scene.time), sky::starLevel(scene::middlePixelRad(projector)));
  }

  const scene::SkyState state;
  std::uint64_t seed;
  scene::Projector projector;
  Sphere earth;
  CloudMedium clouds;
  MetaballMedium balls;
  Air air;
  SkyLights lights;
  PhaseSampler droplets, snow, molecules, isotropic;
  ColourPhase rain{optics::rainPhase()}, ice{optics::icePhase()};
  PhaseSampler peak;  // of the droplets: see gather()
  glm::dvec3 airglow;
  double airglowHeight;
  float starlight, galaxyShare;  // shares that are drawn
  glm::dmat3 celestialFromEnu;
  sky::StarCells stars;
  sky::PlanetSpots planets;

  // Stars, planets and the Milky Way above the air, behind the moon.
  glm::dvec3 starsBeyond(const glm::dvec3& way, bool discs, float pixelRad) const {
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

  // A path on its way to its next event.
  struct Path {
    Ray ray;
    glm::dvec3 throughput{1.0};
    bool first = false;  // straight from the eye
  };
  // What is carried while all parts of a path are followed.
  struct Work {
    Random random;
    SkySample sample;
  };

  SkySample traceFrom(const glm::dvec3& way, std::uint64_t seedOfPath, bool discs, float pixelRad) const;
  void follow(Path path, Work& work) const;

  double end(const Ray& ray) const {  // of a ray's way through air and clouds
    double near = 0.0, far = 0.0;
    const double out = earth.crossings(ray, air.topM(), near, far) ? std::max(far, 0.0) : 0.0;
    return earth.toGround(ray, out);
  }
  bool meetsGround(const Ray& ray) const { return earth.toGround(ray, -1.0) >= 0.0; }

  glm::dvec3 throughAir(const Ray& ray, double t) const {
    return air.empty() ? glm::dvec3(1.0) : air.transmittance(earth, ray, t);
  }

  // The night sky above the air: shaders/lib/atmosphere.glsl.
  glm::dvec3 above(const Ray& ray) const {
    const double h = earth.height(ray.from);
    if (h >= airglowHeight) return glm::dvec3(0.0);
    const double mu = earth.cosine(ray.from, ray.way),
                 q = (earth.radiusM() + h) / (earth.radiusM() + airglowHeight);
    return airglow / std::sqrt(std::max(1.0 - q * q * (1.0 - mu * mu), 1e-4));
  }

  // In a cloud, of layers or of metaballs.
  struct Collision {
    double t = 0.0;  // along the ray
    const PhaseSampler* phase = nullptr;
    double albedo = 1.0;
  };
  // The first before the ray leaves the air or meets the ground.
  std::optional<Collision> collide(const Ray& ray, Random& random) const {
    std::optional<Collision> collision;
    if (const auto c = clouds.collide(ray, CloudMedium::kToGround, random))
      collision = {c->t, &phaseOf(c->matter), 1.0};
    if (balls.empty()) return collision;
    if (const auto b = balls.collide(ray, collision ? collision->t : end(ray), random))
      collision = {b->t, &phaseOf(b->phase), b->albedo};
    return collision;
  }
  const PhaseSampler& phaseOf(scene::CloudMatter matter) const {
    return matter == scene::CloudMatter::kIce    ? ice.mean()
           : matter == scene::CloudMatter::kSnow ? snow
           : matter == scene::CloudMatter::kRain ? rain.mean()
                                                 : droplets;
  }
  const PhaseSampler& phaseOf(scene::MetaballPhase phase) const {
    return phase == scene::MetaballPhase::kDroplets   ? droplets
           : phase == scene::MetaballPhase::kRayleigh ? molecules
                                                      : isotropic;
  }

  bool mayHaveCloud() const { return clouds.grid() || !balls.empty(); }

  // Adds the light that comes to p through clouds and air, times a share of it.
  void addLight(Work& work, const glm::dvec3& p, const LightSample& light, glm::dvec3 share) const {
    if (lights.isBelow(light, p)) return;
    if (const double mean = sum(share) / 3.0; mayHaveCloud() && mean < kLittleLight) {
      if (unit(work.random) * kLittleLight >= mean) return;
      share *= kLittleLight / mean;
    }
    const Ray ray{p, light.direction};
    double through = clouds.transmittance(ray, CloudMedium::kToGround, work.random);
    if (through > 0.0 && !balls.empty()) through *= balls.transmittance(ray, end(ray), work.random);
    if (through > 0.0) work.sample.luminance += share * through * lights.illuminance(light, p);
  }

  // Adds what reaches the eye of the light that scatters or reflects at p, the path's throughput being for
  // all but the direction. value(w): the share that leaves on the path of light that comes from w, 1/sr.
  // chain: how often light is looked for that comes by way of clouds.
  template <class Value>
  void gather(const Path& path, const glm::dvec3& p, double chain, Value&& value, Work& work) const;
  template <class Value>
  void gatherByPeaks(const Path& path, const glm::dvec3& p, const LightSample& light, double chance,
                     Value&& value, Work& work) const;

  void scatterInAir(Path& path, const glm::dvec3& p, const Air::Medium& m, Work& work) const;
  void scatterInCloud(Path& path, const Collision& collision, Work& work) const;
  bool reflect(Path& path, const glm::dvec3& p, Work& work) const;
  void airEvent(Path& path, double t, const glm::dvec3& weights, double chance, Work& work) const;
};

// Scattering somewhere in [0, t] of the path's ray, which was chosen with a chance.
void SkyTracer::Impl::airEvent(Path& path, double t, const glm::dvec3& weights, double chance,
                               Work& work) const {
  const Air::Place place = air.samplePlace(earth, path.ray, t, weights, work.random);
  const glm::dvec3 p = path.ray.at(place.t);
  const Air::Medium m = air.at(earth.height(p));
  path.throughput *= throughAir(path.ray, place.t) * (m.rayleigh + m.aerosol) / (place.density * chance);
  scatterInAir(path, p, m, work);
}

// Droplets scatter half of the light by a few degrees. A path that happens to point at the sun so closely
// finds a thousand times the usual, and pictures need as many paths as it takes for that to even out. So the
// phase function is taken for a sum of a peak and a rest that is nowhere large. Of the scatterings of a way
// of light from the sun to the eye, the last ones in a cloud that are by the peak make a chain; the event
// before them, by the rest, finds the light: straight where there is no chain, else along a chain drawn from
// the sun's side, whose directions follow the peaks one after the other, and which is walked towards the sun
// from collision to collision. Each way of light is found once, and none carries much. (R. Buras and B. Mayer
// 2011, "Efficient unbiased variance reduction techniques for Monte Carlo simulations of radiative transfer
// in cloudy atmospheres: The solution", has the problem and another cure.)
template <class Value>
void SkyTracer::Impl::gather(const Path& path, const glm::dvec3& p, double chain, Value&& value,
                             Work& work) const {
  const LightSample light = lights.sample(p, work.random);
  if (light.disc < 0) return;
  const glm::dvec3 lit = path.throughput * value(light.direction);
  if (sum(lit) != 0.0) addLight(work, p, light, lit);
  if (mayHaveCloud() && unit(work.random) < chain) gatherByPeaks(path, p, light, chain, value, work);
}

template <class Value>
void SkyTracer::Impl::gatherByPeaks(const Path& path, const glm::dvec3& p, const LightSample& light,
                                    double chance, Value&& value, Work& work) const {
  Random& random = work.random;
  PeakChain chain = drawPeaks(light.direction, peak, random);
  glm::dvec3 lit = path.throughput * value(chain.ways[chain.count - 1]) * chain.weight / chance;
  if (sum(lit) == 0.0) return;
  glm::dvec3 at = p;
  while (chain.count > 0) {
    const Ray ray{at, chain.ways[--chain.count]};
    const auto collision = collide(ray, random);
    if (!collision || collision->phase != &droplets) return;  // no others have that peak
    ++work.sample.chained;
    lit *= collision->albedo * throughAir(ray, collision->t);
    at = ray.at(collision->t);
  }
  addLight(work, at, light, lit);
}

void SkyTracer::Impl::scatterInAir(Path& path, const glm::dvec3& p, const Air::Medium& m, Work& work) const {
  Random& random = work.random;
  const glm::dvec3 scattering = glm::max(m.rayleigh + m.aerosol, glm::dvec3(1e-300));
  const glm::dvec3 rayleigh = m.rayleigh / scattering, aerosol = m.aerosol / scattering;
  ++work.sample.events;
  const glm::dvec3 from = path.ray.way;
  gather(
      path, p, kChainOfOthers,
      [&](const glm::dvec3& w) {
        const double c = glm::dot(from, w);
        return rayleigh * air.phaseRayleigh(c) + aerosol * air.phaseAerosol(c);
      },
      work);
  const double share = sum(path.throughput * aerosol) / sum(path.throughput);
  const double c = unit(random) < share ? air.sampleAerosol(random) : air.sampleRayleigh(random);
  const double pr = air.phaseRayleigh(c), pa = air.phaseAerosol(c);
  path.throughput *= (rayleigh * pr + aerosol * pa) / ((1.0 - share) * pr + share * pa);
  path.ray = {p, turned(from, c, 2.0 * kPi * unit(random))};
}

void SkyTracer::Impl::scatterInCloud(Path& path, const Collision& collision, Work& work) const {
  Random& random = work.random;
  const glm::dvec3 p = path.ray.at(collision.t);
  const PhaseSampler& phase = *collision.phase;
  path.throughput *= collision.albedo;
  ++work.sample.events;
  const glm::dvec3 from = path.ray.way;
  if (const ColourPhase* colours = &phase == &rain.mean() ? &rain : &phase == &ice.mean() ? &ice : nullptr) {
    gather(
        path, p, peak.integral(), [&](const glm::dvec3& w) { return colours->density(glm::dot(from, w)); },
        work);
    const double c = phase.sampleCosine(unit(random));
    path.throughput *= colours->density(c) / phase.density(c);
    path.ray = {p, turned(from, c, 2.0 * kPi * unit(random))};
    path.first = false;
    return;
  }
  // The first event of all has none before it that would find its peak.
  const bool whole = &phase != &droplets || path.first;
  gather(
      path, p, peak.integral(),
      [&](const glm::dvec3& w) {
        const double c = glm::dot(from, w);
        return phase.density(c) - (whole ? 0.0 : peak.integral() * peak.density(c));
      },
      work);
  path.ray = {p, turned(from, phase.sampleCosine(unit(random)), 2.0 * kPi * unit(random))};
  path.first = false;
}

bool SkyTracer::Impl::reflect(Path& path, const glm::dvec3& p, Work& work) const {
  Random& random = work.random;
  ++work.sample.events;
  const glm::dvec3 up = earth.up(p);
  const auto q = shared::cloudPosition(glm::vec3(p), static_cast<float>(earth.radiusM()));
  const shared::sampler2D placement{&state.clouds->noise().placement, shared::Wrap::kRepeat,
                                    shared::Wrap::kRepeat};
  path.throughput *=
      glm::dvec3(shared::groundAlbedoAt(glm::vec3(state.scene.ground.albedo), placement, glm::vec2(q)));
  if (sum(path.throughput) <= 0.0) return false;
  gather(
      path, p, kChainOfOthers, [&](const glm::dvec3& w) { return std::max(glm::dot(w, up), 0.0) / kPi; },
      work);
  path.ray = {p, lambertDirection(up, random)};
  return true;
}

void SkyTracer::Impl::follow(Path path, Work& work) const {
  Random& random = work.random;
  for (;;) {
    const double most = largest(path.throughput);
    if (most < kRouletteBelow) {
      if (unit(random) * kRouletteTo >= most) return;
      path.throughput *= kRouletteTo / most;
    }
    const auto collision = collide(path.ray, random);
    const double t = collision ? collision->t : end(path.ray);
    if (!air.empty()) {
      // One event of the two, each with the chance of its share of the light.
      const glm::dvec3 through = throughAir(path.ray, t);
      const double chance = sum(path.throughput * (1.0 - through)) / sum(path.throughput);
      if (unit(random) < chance) {
        const glm::dvec3 weights = path.throughput;
        airEvent(path, t, weights, chance, work);
        continue;
      }
      path.throughput *= through / (1.0 - chance);
    }
    if (collision) {
      scatterInCloud(path, *collision, work);
    } else if (meetsGround(path.ray)) {
      if (!reflect(path, path.ray.at(t), work)) return;
    } else {
      work.sample.luminance += path.throughput * above(path.ray);
      return;
    }
  }
}

SkySample SkyTracer::Impl::traceFrom(const glm::dvec3& way, std::uint64_t seedOfPath, bool discs,
                                     float pixelRad) const {
  Work work{Random(seedOfPath), {}};
  Ray ray{{0.0, 0.0, state.scene.camera.eyeM}, way};
  double near = 0.0, far = 0.0;
  glm::dvec3 onDisc(0.0);
  if (discs && !meetsGround(ray)) onDisc = lights.discs(way);
  if ((starlight > 0.0f || planets.count > 0) && pixelRad > 0.0f && !meetsGround(ray))
    onDisc += starsBeyond(way, discs, pixelRad);
  if (!earth.crossings(ray, air.topM(), near, far) || far <= 0.0) {
    work.sample.luminance = onDisc;
    return work.sample;
  }
  if (near > 0.0) ray.from = ray.at(near);

  // The first piece is followed twice: to a scattering in the air, and to what is behind it.
  const auto collision = collide(ray, work.random);
  work.sample.cloud = collision.has_value();
  const double t = collision ? collision->t : end(ray);
  glm::dvec3 through(1.0);
  if (!air.empty()) {
    through = throughAir(ray, t);
    const double share = sum(1.0 - through) / 3.0;
    // Air that adds little is worth few paths.
    const double chance = std::min(1.0, 4.0 * share);
    if (share > 0.0 && unit(work.random) < chance) {
      Path path{ray, glm::dvec3(1.0), false};
      airEvent(path, t, glm::dvec3(1.0), chance, work);
      follow(path, work);
    }
  }
  Path path{ray, through, true};
  bool on = true;
  if (collision) {
    scatterInCloud(path, *collision, work);
  } else if (meetsGround(ray)) {
    on = reflect(path, ray.at(t), work);
  } else {
    work.sample.luminance += through * (above(ray) + onDisc);
    on = false;
  }
  if (on) follow(path, work);
  return work.sample;
}

SkyTracer::SkyTracer(const scene::SkyState& state, const SkySettings& settings)
    : impl_(std::make_unique<const Impl>(state, settings)) {}
SkyTracer::~SkyTracer() = default;

int SkyTracer::width() const {
  return static_cast<int>(impl_->state.scene.output.width);
}
int SkyTracer::height() const {
  return static_cast<int>(impl_->state.scene.output.height);
}

SkySample SkyTracer::trace(int x, int y, std::uint64_t index) const {
  const std::uint64_t pixel =
      static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(width()) + static_cast<std::uint64_t>(x);
  Random random(hashOf(impl_->seed, pixel, index));
  glm::vec3 direction(0.0f);
  float pixelRad = 0.0f;
  const glm::vec2 px(static_cast<float>(x + unit(random)), static_cast<float>(y + unit(random)));
  if (!scene::directionAt(impl_->projector, px, direction, pixelRad)) return {};
  return impl_->traceFrom(glm::normalize(glm::dvec3(direction)), random.next(),
                          impl_->state.scene.output.sunDisc, pixelRad);
}

SkySample SkyTracer::traceDirection(const glm::dvec3& direction, std::uint64_t index) const {
  return impl_->traceFrom(glm::normalize(direction), hashOf(impl_->seed, std::uint64_t{0x5d1a}, index),
                          impl_->state.scene.output.sunDisc, 0.0f);
}

}  // namespace welkin::reference
