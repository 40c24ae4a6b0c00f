// SPDX-License-Identifier: Apache-2.0
// How light lies in the sprites of a lens flare: over the unit disc, each with the mean 1, so that a sprite's light is what it is
// given. Shared by C++ and GLSL, see welkin/core/glsl.h.

// A ghost, the image of the diaphragm far out of focus: a disc with a soft edge, the darker in the middle the more hollow it is, [0, 1].
// With u = r^2 the edge is (1 - u^6)^2, of which the unit disc has 1 - 2/7 + 1/13, and times 2 u, 2 (1/2 - 2/8 + 1/14).
WELKIN_FN float flareGhost(float r, float hollow) {
  float u = min(r * r, 1.0f);
  float edge = 1.0f - u * u * u * u * u * u;
  return edge * edge * (1.0f + hollow * (2.0f * u - 1.0f)) / (0.7912088f - 0.1483517f * hollow);
}

// The glow about the sun: light that the eye or the lens scatters falls off with the square of the angle (G. Spencer, P. Shirley,
// K. Zimmerman and D. Greenberg 1995, "Physically-Based Glare Effects for Digital Images"), here from a core of 1/50 of the disc, and to
// nothing at its rim. The divisor is the mean of (1 - u)^2 / (u + c), c = 1/2500.
WELKIN_FN float flareGlow(float r) {
  float u = min(r * r, 1.0f);
  return (1.0f - u) * (1.0f - u) / ((u + 0.0004f) * 6.3301f);
}
