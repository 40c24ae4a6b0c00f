// SPDX-License-Identifier: Apache-2.0
// The light of a sky that comes from all sides at once, on clouds, ground and air. Pure.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "welkin/sky/atmosphere.h"

namespace welkin::scene {

struct SkyState;

// Luminance that hazy air tends to, cd/m2, by the direction in which one looks.
struct AirLight {
  glm::vec3 mean{0};                 // over all directions
  std::array<glm::vec3, 3> along{};  // more of it for each unit of the direction's east, north and up
};
AirLight operator*(const glm::vec3& share, const AirLight& light);

// The air about an eye.
struct EyeAir {
  float clearAir = 1.0f;        // share of the air beneath the clouds that the sun reaches
  float airUnderSheets = 1.0f;  // the part of it that thin sheets decide
  AirLight haze;                // about the eye where it does not
  AirLight cloudGlow;           // by how much volumes make that brighter than it is under the clear sky
  glm::vec3 overClouds{0};      // by how much they make the air over them all brighter than over bare ground
  float overCloudsM = 0.0f;     // and from which height on
};

// What the air about eyes at all heights is lit by: airAbout().
struct AirSources {
  // Of the clear sky alone, above the horizon: at the ground, at ClearSkyKey::kLowM and at kHighM.
  sky::LightMoments ground, low, high;
  // Under the clouds: light from them and from the ground, and what comes between them from overhead and
  // level.
  sky::LightMoments underClouds;
  float gapsOverhead = 1.0f, gapsLevel = 1.0f;
  // Luminance of clouds and ground from above, and of the ground without clouds, cd/m2.
  glm::vec3 upward{0}, bare{0};
  float lowM = 0.0f, highM = 0.0f;  // the lowest base and the highest top of volumes
  bool anyVolumes = false;
};

// Light that reaches clouds and ground from all directions at once, past the layers that are drawn as
// volumes; what thin sheets make of it: shading/sheet_ambient.h. Linear Rec. 709.
struct AmbientLight {
  glm::vec3 skyLow{0};       // mean luminance of the upper hemisphere of the clear sky at the ground, cd/m2
  glm::vec3 skyHigh{0};      // the same at 10 km
  glm::vec3 skyOnGround{0};  // illuminance of the ground by sky and clouds, lux
  glm::vec3 ground{0};       // mean luminance of the ground, cd/m2
  float cover = 0.0f;        // of the sky by volumes, [0, 1]
  float cloudsM = 0.0f;      // height in which light falls on thick clouds; 0: there are none
  float sunOverSky = 0.0f;   // illuminance of level ground by sun and moon in that by the sky, both clear
  // What comes from above the horizon at the ground, at 2 km and at 10 km, and from below it at 2 km and at
  // 10 km, air and ground.
  sky::LightMoments above, aboveLow, aboveHigh, below, belowHigh;
  AirSources airSources;
  EyeAir air;  // of the scene's eye
};

// Of a sky of which all else is known.
AmbientLight ambientLight(const SkyState& state);

// Of eyes at a height above the ground, m, by the sources of the state's ambient light.
EyeAir airAbout(const SkyState& state, double eyeM);

}  // namespace welkin::scene
