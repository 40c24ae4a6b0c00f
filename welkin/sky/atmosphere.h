// SPDX-License-Identifier: Apache-2.0
// The clear sky in absolute luminance: Rayleigh, aerosol and ozone after S. Hillaire 2020, "A Scalable and Production Ready Sky and
// Atmosphere Rendering Technique". The formulas stand once, in shaders/lib/atmosphere.glsl, for CPU and GPU.
//
// Frame: east-north-up at the place, z up. Altitudes in metres above mean sea level; the ground is a sphere at groundAltitudeM.
// Luminance in cd/m2 and illuminance in lux, each as linear Rec. 709 triples whose weighted sum (0.2126, 0.7152, 0.0722) is the
// photometric value.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "welkin/core/image.h"
#include "welkin/sky/atmosphere_params.h"
#include "welkin/sky/light.h"

namespace welkin::sky {

// The atmosphere and the two tables that depend on nothing else. Immutable; safe to share between threads.
class Atmosphere {
 public:
  // visibilityM: meteorological optical range at the ground, Koschmieder: total extinction there is 3.912 / visibility.
  Atmosphere(const AtmosphereParams& params, double visibilityM, double groundAltitudeM, glm::vec3 groundAlbedo);

  const Image<float>& transmittance() const { return transmittance_; }             // 256 x 64 RGB
  const Image<float>& multipleScattering() const { return multipleScattering_; }   // 32 x 32 RGB

  double groundAltitudeM() const { return groundAltitudeM_; }
  double topAltitudeM() const;
  float aerosolGroundExtinction() const;   // 1/m

  // Transmittance from a point to space in the direction with zenith cosine mu; 0 where the earth is in the way.
  glm::vec3 transmittanceToSpace(double altitudeM, double mu) const;
  // Luminance of the clear sky seen from a point, ray-marched, all lights and airglow (no discs).
  glm::vec3 skyLuminance(double altitudeM, glm::vec3 direction, const std::vector<Light>& lights) const;
  // Illuminance of a horizontal plane facing up by the clear sky alone.
  glm::vec3 skyIlluminance(double altitudeM, const std::vector<Light>& lights) const;

 private:
  Image<float> transmittance_, multipleScattering_;
  double groundAltitudeM_;
};

// Tables seen from one eye for one set of lights (sun, moon), everything summed, airglow included, discs left out.
// Their parametrisation is in shaders/lib/atmosphere.glsl: azimuth relative to lights[0], denser near it and near the horizon.
struct SkyTables {
  Image<float> skyView;              // RGB luminance of the clear sky by direction (down to the ground, which is drawn by the caller)
  Volume<float> aerialInscatter;     // RGB luminance scattered in between the eye and a distance (azimuth, elevation, distance)
  Volume<float> aerialTransmittance; // RGB
};
SkyTables makeSkyTables(const Atmosphere& atmosphere, double eyeAltitudeM, const std::vector<Light>& lights);

}  // namespace welkin::sky
