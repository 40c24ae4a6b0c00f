// SPDX-License-Identifier: Apache-2.0
// How the shares of lib/ground_light.glsl are found.
//
// All in units of the illuminance of the ground by the clear sky. Clouds overhead hide the sky, and send down what they let through of sun and
// sky by the Eddington solution for diffuse light, as lib/cloud_light.glsl has it. Most of the sky's light comes from the low air and from about the
// sun, and goes with the sun's. Where there are clouds in the sun, their sides send down light too. Both constants follow the ground
// under thunderclouds, in the sun and in their shade, of the reference renderer.

uniform float uSpreadM;           // deviation of what is averaged: light comes from clouds about as far away as they are high
uniform float uSunOverSky;        // illuminance of level ground by sun or moon

const float kNearM = 1200.0;      // the same of the low air
const float kWithSun = 0.65;
const float kOfSides = 1.3;

// what: x what comes down overhead, y the sun's share that comes straight, z the sky's, w as y of what is near. Of the result x: by sky and clouds, y: by all.
vec2 lightOf(vec4 what) {
  float light = what.x * (1.0 - kWithSun + kWithSun * what.w) + kOfSides * (1.0 - what.z) * what.y * uSunOverSky;
  return vec2(light, light + what.w * uSunOverSky);
}

// Of a place so many deviations away: for x, y and z; for w.
vec2 weightsAt(float away) {
  float near = away * max(uSpreadM / kNearM, 1.0);
  return exp(-0.5 * vec2(away * away, near * near));
}
