// SPDX-License-Identifier: Apache-2.0
// One octave of a living pattern at a place x, counted in its cells: a lattice of `side` points a side that repeats, and what becomes of it
// between the points. A texel holds all that a row of points has to say about the cell to its right, so that one fetch a row is enough;
// welkin/scene/living_pattern.h says what. Shared by C++ and GLSL, see welkin/core/glsl.h.

// Improved gradient noise (K. Perlin 2002, "Improving Noise"). Points at whole x; a texel holds the gradients of its point and of the next.
WELKIN_FN float octaveGradient(sampler2D lattice, float side, vec2 x) {
  vec2 cell = floor(x);
  vec2 f = x - cell;
  vec2 at = (cell + 0.5f) / side;
  vec4 low = textureLod(lattice, at, 0.0f);
  vec4 high = textureLod(lattice, vec2(at.x, at.y + 1.0f / side), 0.0f);
  vec2 u = f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
  float a = low.x * f.x + low.y * f.y;
  float b = low.z * (f.x - 1.0f) + low.w * f.y;
  float c = high.x * f.x + high.y * (f.y - 1.0f);
  float d = high.z * (f.x - 1.0f) + high.w * (f.y - 1.0f);
  return mix(mix(a, b, u.x), mix(c, d, u.x), u.y);
}

// Bilinear between values (Pallister). Points at the centres of cells, as texels are; a texel holds its value, the next, and the two of the
// row above.
WELKIN_FN float octavePallister(sampler2D lattice, float side, vec2 x) {
  vec2 cell = floor(x - 0.5f);
  vec2 f = x - 0.5f - cell;
  vec4 corners = textureLod(lattice, (cell + 0.5f) / side, 0.0f);
  return mix(mix(corners.x, corners.y, f.x), mix(corners.z, corners.w, f.x), f.y);
}

// Weights of the points at -1, 0, 1 and 2 for a place f past 0: a Gaussian of half a cell, of sum 1.
WELKIN_FN vec4 octaveGaussian(float f) {
  vec4 d = vec4(f + 1.0f, f, f - 1.0f, f - 2.0f);
  vec4 g = exp(-2.0f * d * d);
  return g / (g.x + g.y + g.z + g.w);
}

// Values upsampled by a Gaussian (Guthikonda et al.). Points at the centres of cells; a texel holds the values from the one before to the
// second after.
WELKIN_FN float octaveCourse(sampler2D lattice, float side, vec2 x) {
  vec2 cell = floor(x - 0.5f);
  vec2 f = x - 0.5f - cell;
  vec4 across = octaveGaussian(f.x);
  vec4 up = octaveGaussian(f.y);
  vec2 at = (cell + 0.5f) / side;
  float row = 1.0f / side;
  return up.x * dot(across, textureLod(lattice, vec2(at.x, at.y - row), 0.0f)) + up.y * dot(across, textureLod(lattice, at, 0.0f)) +
         up.z * dot(across, textureLod(lattice, vec2(at.x, at.y + row), 0.0f)) +
         up.w * dot(across, textureLod(lattice, vec2(at.x, at.y + 2.0f * row), 0.0f));
}
