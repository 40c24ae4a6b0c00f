// SPDX-License-Identifier: Apache-2.0
// The clear sky in absolute luminance: Rayleigh, aerosol and ozone after S. Hillaire 2020, "A Scalable and
// Production Ready Sky and Atmosphere Rendering Technique". The formulas stand once, in
// shaders/lib/atmosphere.glsl, for CPU and GPU.
//
// Frame: east-north-up at the place, z up. Altitudes in metres above mean sea level; the ground is a sphere
// at groundAltitudeM. Luminance in cd/m2 and illuminance in lux, each as linear Rec. 709 triples whose
// weighted sum (0.2126, 0.7152, 0.0722) is the photometric value.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "welkin/core/image.h"
#include "welkin/sky/atmosphere_params.h"
#include "welkin/sky/light.h"

namespace welkin::sky {

// The fields of `struct Atmosphere` in shaders/lib/atmosphere.glsl, with the same names and meanings.
struct AtmosphereUniforms {
  float seaRadiusM = 0.0f;
  float groundAltitudeM = 0.0f;
  float topAltitudeM = 0.0f;
  glm::vec3 rayleighScattering{0};
  float rayleighScaleHeightM = 0.0f;
  glm::vec3 aerosolExtinction{0};
  glm::vec3 aerosolScattering{0};
  float aerosolScaleHeightM = 0.0f;
  float aerosolG = 0.0f;
  glm::vec3 ozoneAbsorption{0};
  float ozoneAltitudeM = 0.0f;
  float ozoneHalfWidthM = 0.0f;
  glm::vec3 groundAlbedo{0};
  glm::vec3 airglow{0};
  float airglowAltitudeM = 0.0f;
};

// Calls f(name, value) for each field: how a GPU's uniforms are filled by name.
template <class F>
void visitFields(const AtmosphereUniforms& u, F&& f) {
  f("seaRadiusM", u.seaRadiusM);
  f("groundAltitudeM", u.groundAltitudeM);
  f("topAltitudeM", u.topAltitudeM);
  f("rayleighScattering", u.rayleighScattering);
  f("rayleighScaleHeightM", u.rayleighScaleHeightM);
  f("aerosolExtinction", u.aerosolExtinction);
  f("aerosolScattering", u.aerosolScattering);
  f("aerosolScaleHeightM", u.aerosolScaleHeightM);
  f("aerosolG", u.aerosolG);
  f("ozoneAbsorption", u.ozoneAbsorption);
  f("ozoneAltitudeM", u.ozoneAltitudeM);
  f("ozoneHalfWidthM", u.ozoneHalfWidthM);
  f("groundAlbedo", u.groundAlbedo);
  f("airglow", u.airglow);
  f("airglowAltitudeM", u.airglowAltitudeM);
}

// The coefficients for a visibility (m, at the ground, by a contrast of 2 %). Pure.
AtmosphereUniforms atmosphereUniforms(const AtmosphereParams& params, double visibilityM,
                                      double groundAltitudeM, glm::vec3 groundAlbedo);

// Light from many directions by its moments over them.
struct LightMoments {
  glm::vec3 total{0};                // integral of the luminance, lm/m2 for all sides of a small ball
  std::array<glm::vec3, 3> along{};  // integrals of it times the direction's components east, north, up

  void add(const glm::vec3& luminance, const glm::vec3& direction, float steradians);
  bool operator==(const LightMoments&) const = default;
};
LightMoments operator+(const LightMoments& a, const LightMoments& b);
LightMoments operator*(float share, const LightMoments& m);

// The atmosphere and the two tables that depend on nothing else. Immutable; safe to share between threads.
// The tables are computed in the constructor by parallelFor, the same with any number of threads.
class Atmosphere {
 public:
  // visibilityM: at the ground, by a contrast of 2 %, Koschmieder: total extinction there is 3.912 /
  // visibility.
  Atmosphere(const AtmosphereParams& params, double visibilityM, double groundAltitudeM,
             glm::vec3 groundAlbedo);
  // For media that no visibility describes (other planets, tests).
  explicit Atmosphere(const AtmosphereUniforms& uniforms);

  const AtmosphereUniforms& uniforms() const { return uniforms_; }
  const Image<float>& transmittance() const { return transmittance_; }            // 256 x 64 RGBA
  const Image<float>& multipleScattering() const { return multipleScattering_; }  // 32 x 96 RGB

  double groundAltitudeM() const { return uniforms_.groundAltitudeM; }
  double topAltitudeM() const { return uniforms_.topAltitudeM; }

  // Transmittance from a point to space in the direction with zenith cosine mu; 0 where the earth is in the
  // way (half a light's disc at the horizon itself).
  glm::vec3 transmittanceToSpace(double altitudeM, double mu) const;
  // Of light from all directions below, the share that the air above a point sends back down.
  glm::vec3 sphericalAlbedo(double altitudeM) const;
  // Luminance of the clear sky seen from a point, ray-marched, all lights and airglow (no discs). Airglow is
  // seen from below its shell at 90 km, and nothing of it from higher up. Towards the ground: of the air in
  // front of it alone.
  glm::vec3 skyLuminance(double altitudeM, glm::vec3 direction, std::span<const Light> lights) const;
  // Illuminance of a horizontal plane facing up by the clear sky alone.
  glm::vec3 skyIlluminance(double altitudeM, std::span<const Light> lights) const;
  // Light of the clear sky from one of kSkyRings rings above the horizon; their sum, from the first on, is
  // that of the upper hemisphere.
  static constexpr int kSkyRings = 24;
  LightMoments skyLightOfRing(double altitudeM, std::span<const Light> lights, int ring) const;
  // The same of the air below the horizon, down to the ground, without the ground's own.
  static constexpr int kAirRings = 10;
  LightMoments airLightOfRing(double altitudeM, std::span<const Light> lights, int ring) const;

 private:
  AtmosphereUniforms uniforms_;
  Image<float> transmittance_, multipleScattering_;
};

// Tables seen from one eye for one set of lights (sun, moon), everything summed, airglow included, discs left
// out. Their parametrisation is in shaders/lib/atmosphere.glsl: azimuth relative to lights[0], denser near it
// and near the horizon. Sample with linear filtering and clamping, through atmosphereSkyLuminance() and
// atmosphereAerial().
struct SkyTables {
  Image<float> skyView;  // RGB luminance of the clear sky by direction (down to the ground, which is drawn by
                         // the caller)
  Volume<float> aerialInscatter;      // RGB luminance scattered in between the eye and a distance (azimuth,
                                      // elevation, distance)
  Volume<float> aerialTransmittance;  // RGB
};
SkyTables makeSkyTables(const Atmosphere& atmosphere, double eyeAltitudeM, std::span<const Light> lights);

// The same tables a few rows at a time, for those who have frames to draw in between.
class SkyTablesInProgress {
 public:
  // Starts anew, in the memory that is there. The atmosphere must live until the last row.
  void start(const Atmosphere& atmosphere, double eyeAltitudeM, std::span<const Light> lights);
  int rows() const;                        // all there are; after start()
  void computeTo(int row);                 // the first `row` of them
  SkyTables& tables() { return tables_; }  // complete after computeTo(rows())

 private:
  const Atmosphere* atmosphere_ = nullptr;
  double eyeAltitudeM_ = 0.0;
  glm::vec3 zeroAzimuth_{1, 0, 0};
  std::vector<Light> lights_;
  int done_ = 0;
  SkyTables tables_;
};

}  // namespace welkin::sky
