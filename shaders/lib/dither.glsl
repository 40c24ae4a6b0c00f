// SPDX-License-Identifier: Apache-2.0
// Noise of pixels, to begin steps of neighbours at different places.

// Interleaved gradient noise (J. Jimenez 2014, "Next Generation Post Processing in Call of Duty: Advanced Warfare"): neighbours differ as
// much as they can.
float interleavedNoise(vec2 px) { return fract(52.9829189 * fract(dot(px, vec2(0.06711056, 0.00583715)))); }
