// SPDX-License-Identifier: Apache-2.0
// Noise of pixels, to begin steps of neighbours at different places.

// Interleaved gradient noise (J. Jimenez 2014, "Next Generation Post Processing in Call of Duty: Advanced Warfare"): neighbours differ as
// much as they can.
float interleavedNoise(vec2 px) { return fract(52.9829189 * fract(dot(px, vec2(0.06711056, 0.00583715)))); }

// Along the ray, towards the sun, and among the light volume's cascades: they know nothing of each other, as related ones would draw contour
// lines. A shifted copy is related; one turned over is not.
struct Dithers {
  vec2 steps;      // along the ray and towards the sun, [0, 1)
  float cascade;
};
Dithers dithersOf(vec2 px, vec2 stepJitter) {
  return Dithers(fract(vec2(interleavedNoise(px), interleavedNoise(px.yx + 71.0)) + stepJitter),
                 fract(interleavedNoise(vec2(px.x, -px.y)) + stepJitter.y));
}
