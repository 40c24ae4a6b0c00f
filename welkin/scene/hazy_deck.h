// SPDX-License-Identifier: Apache-2.0
// What haze takes from the light under a deck of cloud.
#pragma once

#include <glm/vec3.hpp>

#include "welkin/sky/atmosphere.h"

namespace welkin::scene {

// A layer of cloud as one slab over the place.
struct Deck {
  double baseM = 0.0, topM = 0.0;  // above the ground
  double depth = 0.0;              // optical, times 1 - g
};

// What the haze in and under a deck leaves of the diffuse light that the deck lets through: the illuminance
// from above in what it would be without that haze. By two streams (Eddington's approximation), slab on slab.
// Haze under a deck sends light back to it; haze in a deck, where light goes far from droplet to droplet,
// takes more than its own depth would. Linear Rec. 709.
struct HazyLight {
  glm::vec3 onGround{1.0f}, underDeck{1.0f};
};
HazyLight lightThroughHaze(const Deck& deck, const sky::AtmosphereUniforms& air);

}  // namespace welkin::scene
