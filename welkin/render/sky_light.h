// SPDX-License-Identifier: Apache-2.0
// The light of the sky at a place, for what an engine draws itself: sun and moon as distant lights, and all
// the rest of what is seen from there as nine coefficients. LiveSky::light() finds it from what LiveSky
// draws.
//
//   SkyLight light = sky.light(eyeM);
//   colour = albedo / pi * (light.illuminance(normal) +
//                           light.sun.illuminance * max(dot(normal, light.sun.direction), 0) + moon's);
//
// East-north-up, z up; linear Rec. 709, whose weighted sum (0.2126, 0.7152, 0.0722) is the photometric value.
#pragma once

#include <array>
#include <glm/vec3.hpp>

namespace welkin::render {

// Sun or moon.
struct DirectLight {
  glm::vec3 direction{0.0f, 0.0f, 1.0f};  // towards it, unit
  glm::vec3 illuminance{0.0f};  // on a plane facing it, through air and clouds, lux; 0 below the horizon
  glm::vec3 overClouds{0.0f};   // the same through the air alone
  float throughClouds = 1.0f;   // share that clouds let straight through, mean over the disc
};

struct SkyLight {
  DirectLight sun, moon;
  // Luminance of all but the two discs, cd/m2, by direction: clouds, air and ground, the glow about the sun.
  // Real spherical harmonics up to second order, orthonormal, in the order 1, y, z, x, xy, yz, 3z2 - 1, xz,
  // x2 - y2 with x east, y north, z up.
  std::array<glm::vec3, 9> luminance{};

  // Illuminance by these of a plane with that unit normal, lux: after R. Ramamoorthi and P. Hanrahan 2001,
  // "An Efficient Representation for Irradiance Environment Maps", within some hundredths of what the plane
  // faces; never negative.
  glm::vec3 illuminance(const glm::vec3& normal) const;
};

// The nine functions in a direction, in that order.
std::array<float, 9> skyHarmonics(const glm::vec3& direction);

}  // namespace welkin::render
