// SPDX-License-Identifier: Apache-2.0
// Sun and moon as lights. Frame: east-north-up, z up. Illuminance in lux as linear Rec. 709 triples whose
// weighted sum (0.2126, 0.7152, 0.0722) is the photometric value.
#pragma once

#include <glm/vec3.hpp>

#include "welkin/sky/ephemeris.h"

namespace welkin::sky {

// A distant light: sun or moon.
struct Light {
  glm::vec3 direction{0, 0, 1};    // towards the light, unit, east-north-up
  glm::vec3 illuminance{0, 0, 0};  // on a plane facing it at the top of the atmosphere, lux; eclipsed
  MoonShadow shadow{};             // of the moon on the air about the place, where it is the sun

  // Where no moon is before it.
  glm::vec3 fullIlluminance() const { return shadow.any() ? illuminance / shadow.share : illuminance; }
};

// Colours of photometric weight 1: the sun's spectrum outside the atmosphere relative to D65 white, and the
// moon's, whose reflectance grows with wavelength.
glm::vec3 sunlightColour();
glm::vec3 moonlightColour();

// Mean luminance of the moon's disc at a phase angle, of which the full moon's is 1: as shaders/lib/moon.glsl
// draws it, with its earthshine.
double moonDiscMean(double phaseAngleRad);

Light sunLight(const Ephemeris& e);
Light moonLight(const Ephemeris& e);
// The moon's light where the earth is not before the sun, lux.
glm::vec3 fullMoonlight(const Ephemeris& e);

}  // namespace welkin::sky
