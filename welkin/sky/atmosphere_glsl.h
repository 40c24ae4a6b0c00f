// SPDX-License-Identifier: Apache-2.0
// shaders/lib/atmosphere.glsl compiled as C++, for this folder's sources and for tests.
#pragma once

#include "welkin/core/glsl.h"
#include "welkin/sky/atmosphere.h"

namespace welkin::sky::shared {

using namespace welkin::glsl;
#include "shaders/lib/phase.glsl"
// Keeps the order: the last file uses the others.
#include "shaders/lib/eclipse.glsl"
//
#include "shaders/lib/atmosphere.glsl"

// Into a texel of a table.
inline void store(float* p, const vec3& v) {
  p[0] = v.x;
  p[1] = v.y;
  p[2] = v.z;
}

inline Atmosphere fromUniforms(const AtmosphereUniforms& u) {
  Atmosphere a;
  a.seaRadiusM = u.seaRadiusM;
  a.groundAltitudeM = u.groundAltitudeM;
  a.topAltitudeM = u.topAltitudeM;
  a.rayleighScattering = u.rayleighScattering;
  a.rayleighScaleHeightM = u.rayleighScaleHeightM;
  a.aerosolExtinction = u.aerosolExtinction;
  a.aerosolScattering = u.aerosolScattering;
  a.aerosolScaleHeightM = u.aerosolScaleHeightM;
  a.aerosolG = u.aerosolG;
  a.ozoneAbsorption = u.ozoneAbsorption;
  a.ozoneAltitudeM = u.ozoneAltitudeM;
  a.ozoneHalfWidthM = u.ozoneHalfWidthM;
  a.groundAlbedo = u.groundAlbedo;
  a.airglow = u.airglow;
  a.airglowAltitudeM = u.airglowAltitudeM;
  return a;
}

inline MoonShadow fromUniforms(const sky::MoonShadow& s) {
  return {s.toMoon, s.moonRadius, s.perMetre, s.share};
}

// Lights 2 i and 2 i + 1 of a list; a missing second one is dark.
inline AtmosphereLights lightPair(std::span<const Light> lights, std::size_t i) {
  AtmosphereLights p{vec3(0, 0, 1), vec3(0), fromUniforms(sky::MoonShadow{}),
                     vec3(0, 0, 1), vec3(0), fromUniforms(sky::MoonShadow{})};
  if (2 * i < lights.size()) {
    p.direction0 = lights[2 * i].direction;
    p.illuminance0 = lights[2 * i].fullIlluminance();
    p.shadow0 = fromUniforms(lights[2 * i].shadow);
  }
  if (2 * i + 1 < lights.size()) {
    p.direction1 = lights[2 * i + 1].direction;
    p.illuminance1 = lights[2 * i + 1].fullIlluminance();
    p.shadow1 = fromUniforms(lights[2 * i + 1].shadow);
  }
  return p;
}

}  // namespace welkin::sky::shared
