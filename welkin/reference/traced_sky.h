// SPDX-License-Identifier: Apache-2.0
// What light meets on its way through a sky: clouds, air, ground and lights, made once for all paths.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "welkin/reference/air.h"
#include "welkin/reference/cloud_medium.h"
#include "welkin/reference/cloud_phases.h"
#include "welkin/reference/metaball_medium.h"
#include "welkin/reference/phase_sampler.h"
#include "welkin/reference/sky_lights.h"
#include "welkin/reference/sky_tracer.h"
#include "welkin/scene/projector.h"
#include "welkin/scene/sky_state.h"
#include "welkin/sky/planets.h"
#include "welkin/sky/star_cells.h"

namespace welkin::reference {

struct TracedSky {
  // Throws ParameterError for what is not traced.
  TracedSky(const scene::SkyState& s, const SkySettings& settings);

  const scene::SkyState state;
  std::uint64_t seed;
  scene::Projector projector;
  Sphere earth;
  CloudMedium clouds;
  MetaballMedium balls;
  Air air;
  SkyLights lights;
  PhaseSampler droplets, snow, molecules, isotropic;
  ColourPhase rain, ice;
  PhaseSampler peak;  // of the droplets: sky_paths.cpp
  glm::dvec3 airglow;
  double airglowHeight;
  float starlight, galaxyShare;  // shares that are drawn
  glm::dmat3 celestialFromEnu;
  sky::StarCells stars;
  sky::PlanetSpots planets;

  bool mayHaveCloud() const { return clouds.grid() || !balls.empty(); }
  const PhaseSampler& phaseOf(scene::CloudMatter matter) const;
  const PhaseSampler& phaseOf(scene::MetaballPhase phase) const;

  double end(const Ray& ray) const;  // of a ray's way through air and clouds
  bool meetsGround(const Ray& ray) const { return earth.toGround(ray, -1.0) >= 0.0; }
  glm::dvec3 throughAir(const Ray& ray, double t) const {
    return air.empty() ? glm::dvec3(1.0) : air.transmittance(earth, ray, t);
  }
  glm::dvec3 groundAlbedo(const glm::dvec3& p) const;

  // The night sky above the air, cd/m2: shaders/lib/atmosphere.glsl.
  glm::dvec3 above(const Ray& ray) const;
  // Stars, planets and the Milky Way above the air, behind the moon's disc where discs are seen.
  glm::dvec3 starsBeyond(const glm::dvec3& way, bool discs, float pixelRad) const;
};

}  // namespace welkin::reference
