// SPDX-License-Identifier: Apache-2.0
// One step towards the fluence that lib/fluence.glsl describes: every column solved as a whole (L. H. Thomas 1949), with the columns beside
// it as they were. Compiled for a number of cells (WELKIN_CELLS); four cells to a texel, four textures one above another.

uniform sampler3D uDepths, uSources;  // of the cells: pass/fluence_cells.frag
uniform sampler3D uFluence, uBefore;  // as it is, and a step ago
uniform vec4 uCells[WELKIN_CELLS];    // z: depth, m
uniform float uColumnM;               // side of a column
uniform float uWeight;                // of what this step finds; the rest is as it was a step ago

layout(location = 0) out vec4 outFluence[4];

const float kAirPathM = 1000.0;       // scaled free path in clear air
const float kEdge = 2.0;              // fluence for each unit of flux that leaves through top or bottom
const int kTexels = (WELKIN_CELLS + 3) / 4;

// Diffusivity, m.
float diffusivity(float depth, float heightM) { return 1.0 / (3.0 * (depth / heightM + 1.0 / kAirPathM)); }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(uFluence, 0).xy - 1;
  vec4 depths[kTexels], sources[kTexels];
  for (int i = 0; i < kTexels; ++i) {
    depths[i] = texelFetch(uDepths, ivec3(at, i), 0);
    sources[i] = texelFetch(uSources, ivec3(at, i), 0);
  }
  // Through the sides, for each unit of area: what leaves for each unit of fluence, and what comes.
  float leaving[16], coming[16], d[16];
  for (int k = 0; k < WELKIN_CELLS; ++k) {
    d[k] = diffusivity(depths[k / 4][k % 4], uCells[k].z);
    leaving[k] = 0.0;
    coming[k] = sources[k / 4][k % 4];
  }
  for (int side = 0; side < 4; ++side) {
    ivec2 step = side < 2 ? ivec2(2 * side - 1, 0) : ivec2(0, 2 * side - 5);
    ivec2 beside = clamp(at + step, ivec2(0), last);
    for (int i = 0; i < kTexels; ++i) {
      vec4 depth = texelFetch(uDepths, ivec3(beside, i), 0), fluence = texelFetch(uFluence, ivec3(beside, i), 0);
      for (int j = 0; j < 4; ++j) {
        int k = 4 * i + j;
        if (k >= WELKIN_CELLS) break;
        float other = diffusivity(depth[j], uCells[k].z);
        float through = 2.0 * d[k] * other / (d[k] + other) * uCells[k].z / (uColumnM * uColumnM);
        leaving[k] += through;
        coming[k] += through * fluence[j];
      }
    }
  }
  // Up and down; from the bottom up, then back.
  float upward[16];
  float below = 1.0 / (0.5 * uCells[0].z / d[0] + kEdge);
  float belowShare = 0.0, belowComing = 0.0;
  for (int k = 0; k < WELKIN_CELLS; ++k) {
    float resistance = 0.5 * uCells[k].z / d[k];
    float above = k + 1 < WELKIN_CELLS ? 1.0 / (resistance + 0.5 * uCells[min(k + 1, WELKIN_CELLS - 1)].z / d[min(k + 1, WELKIN_CELLS - 1)])
                                       : 1.0 / (resistance + kEdge);
    float all = leaving[k] + below * (1.0 - belowShare) + above;
    coming[k] = (coming[k] + below * belowComing) / all;
    belowShare = k + 1 < WELKIN_CELLS ? above / all : 0.0;
    upward[k] = belowShare;
    belowComing = coming[k];
    below = above;
  }
  for (int k = WELKIN_CELLS - 2; k >= 0; --k) coming[k] += upward[k] * coming[k + 1];
  for (int k = WELKIN_CELLS; k < 16; ++k) coming[k] = 0.0;
  for (int i = 0; i < 4; ++i) {
    vec4 found = vec4(coming[4 * i], coming[4 * i + 1], coming[4 * i + 2], coming[4 * i + 3]);
    outFluence[i] = max(mix(texelFetch(uBefore, ivec3(at, i), 0), found, uWeight), vec4(0.0f));
  }
}
