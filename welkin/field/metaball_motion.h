// SPDX-License-Identifier: Apache-2.0
// A cloud of metaballs in time, as a pure function of it: any instant needs no other.
//
// Every ball drifts with the wind of the cloud. With a life time it also grows, lives and decays again and
// again, each at moments of its own (hashes of its number): its volume follows a trapezoid with smooth flanks
// whose mean over a life is 1, so that the cloud expected at any time is the one that was given. Over its
// life a ball is carried by the difference of its own height's wind to the cloud's, from before its place to
// beyond it: shear turns the cloud over without ever tearing it apart.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "welkin/field/metaballs.h"

namespace welkin::field {

struct MetaballMotion {
  glm::dvec3 windMps{0.0};    // of the cloud
  glm::dvec3 shearPerS{0.0};  // m/s of wind more for each metre above referenceM
  double referenceM = 0.0;    // height of windMps, in the balls' frame
  double lifeS = 0.0;         // of a ball, each within 30 % of it; 0: they stay
  double fade = 0.3;          // share of a life in which it grows, and again in which it decays, to 0.5
  std::int64_t seed = 0;
};

// The balls at that time, as many and in the same order; one that is not alive has density 0 and a radius of
// a thousandth. Densities of the others stay, radii grow with the cube root of the volume.
std::vector<Metaball> ballsAt(std::span<const Metaball> balls, const MetaballMotion& motion, double timeS);
// The same in place.
void move(std::span<Metaball> balls, const MetaballMotion& motion, double timeS);

}  // namespace welkin::field
