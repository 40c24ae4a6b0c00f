// SPDX-License-Identifier: Apache-2.0
// The sun's light that has been scattered and gone on in all directions, around the eye: its fluence (radiance over all directions,
// 1 is what the sun sends) for each unit of the sun's illuminance, by diffusion through the clouds of the light volume. So light that
// leaves a cloud through its sides, or goes from one cloud to the next, is known. Cells are half as fine as the columns of the light
// volume, one above another in the order of its slices; between bands there is one cell of air.
//
// Diffusion of light that does not get lost, scaled by similarity: the flux is -D grad(fluence), D = 1 / (3 (1 - g) extinction);
// what is scattered for the first time are the sources; through top and bottom half of the fluence leaves (A. Ishimaru 1978, "Wave
// Propagation and Scattering in Random Media", chapter 9). As light crosses clear air at once and diffusion does not end there, clear air has a
// free path, kAirPathM (after C. D. Levermore and G. C. Pomraning 1981, "A flux-limited diffusion theory", a limit of the flux).
// Needs lib/light_volume.glsl before it.

uniform sampler3D uFluence;
uniform float uFluenceCells;             // of one cascade
WELKIN_FIXED uniform vec4 uFluenceBands[kMaxBands];   // of each band: its first cell, what follows its last one, and between what cells it may be looked up

float fluenceCell(float heightM) {
  float cell = uFluenceBands[0].z;
  for (int i = 0; i < WELKIN_BANDS; ++i) {
    vec4 band = uBands[i], cells = uFluenceBands[i];
    if (heightM >= band.x) cell = clamp(mix(cells.x, cells.y, (heightM - band.x) / (band.y - band.x)), cells.z, cells.w);
  }
  return cell;
}

float fluenceTexel(vec2 q, float cell, int cascade) {
  vec2 uv = clamp(q / cascadeHalfM(cascade) * 0.5 + 0.5, 0.0, 1.0);
  return textureLod(uFluence, vec3(uv, (float(cascade) * uFluenceCells + cell) / (uFluenceCells * float(kCascades))), 0.0).x;
}

float fluenceAt(vec3 q) {
  q += vec3(uLightShiftM, 0.0);
  float cell = fluenceCell(q.z);
  LightCascade cascade = lightCascade(vec2(q));
  float own = fluenceTexel(vec2(q), cell, cascade.own);
  if (cascade.next <= 0.0) return own;
  return mix(own, fluenceTexel(vec2(q), cell, cascade.own + 1), cascade.next);
}
