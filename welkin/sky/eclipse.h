// SPDX-License-Identifier: Apache-2.0
// Eclipses of the sun at a place, and of the moon: what is hidden, and what light is left. Pure functions of
// where the bodies stand; the formulas are in shaders/lib/eclipse.glsl.
//
// Limbs are smooth: the moon's mountains, which shift contacts by a second or two and make Baily's beads, are
// not there.
#pragma once

#include <glm/vec3.hpp>

namespace welkin::sky {

constexpr double kSunRadiusM = 695.7e6;    // IAU 2015 resolution B3
constexpr double kMoonRadiusM = 1737.4e3;  // IAU mean radius

// The moon before the sun, seen from a point: the fields of `struct MoonShadow` in shaders/lib/eclipse.glsl.
struct MoonShadow {
  glm::vec3 toMoon{0.0f};   // in radii of the sun's disc
  float moonRadius = 0.0f;  // 0: no eclipse within 1000 km
  float perMetre = 0.0f;
  float share = 1.0f;

  bool any() const { return moonRadius > 0.0f; }
};

struct SolarEclipse {
  double obscuration = 0.0;  // share of the area of the sun's disc that the moon hides
  MoonShadow shadow;
};

// sunM, moonM: from the observer to their centres, in any system; the shadow is in that system.
SolarEclipse solarEclipse(const glm::dvec3& sunM, const glm::dvec3& moonM);

// Share of the sun's light that arrives at a place, metres from the point that the shadow is for. Away from
// eclipses 1.
float sunShareAt(const MoonShadow& shadow, const glm::vec3& sunDirection, const glm::vec3& fromPointM);

struct LunarEclipse {
  double umbralMagnitude = 0.0;     // share of the moon's diameter in the umbra; 1 and more: total
  double penumbralMagnitude = 0.0;  // 0: no eclipse
  glm::vec3 share{1.0f};            // of the moon's light, mean over the disc, linear Rec. 709
  // The moon's centre from the axis of the shadow, in radii of the sun's disc seen from there, its own radius
  // and that of the earth's disc in these.
  glm::vec3 at{0.0f};
  float moonRadius = 0.0f, earthRadius = 0.0f;

  bool any() const { return penumbralMagnitude > 0.0; }
  // Share of the sunlight on the disc, `across` (radii of the disc, across the line of sight) from its
  // middle.
  glm::vec3 shareAt(const glm::vec3& across) const;
};

// sunM, moonM: from the earth's centre. The air makes the earth's shadow larger: its radius counts a
// hundredth more (A. Danjon 1951, "Les eclipses de Lune par la penombre en 1951"), 71 km above the mean one.
LunarEclipse lunarEclipse(const glm::dvec3& sunM, const glm::dvec3& moonM);

}  // namespace welkin::sky
