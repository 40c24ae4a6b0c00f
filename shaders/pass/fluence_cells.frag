// SPDX-License-Identifier: Apache-2.0
// What the cells of a column do with the sun's light, from the light volume (lib/fluence.glsl says what for): their scaled optical
// depths upwards, or with WELKIN_SOURCES the light that is scattered in them for the first time, for each unit of illuminance.
// Compiled for a number of cells (WELKIN_CELLS). Four cells to a texel, four textures.

#include "lib/phase.glsl"
#include "lib/cloud_light.glsl"

uniform sampler3D uLightVolume;
uniform vec4 uCells[WELKIN_CELLS];  // slices at the lower and the upper edge, depth m
uniform float uSliceCount;          // of one cascade
uniform float uCascade, uCascades;
uniform float uLineTowardsSun;

layout(location = 0) out vec4 outCells[4];

vec4 depthsAt(vec2 uv, float slice) {
  return textureLod(uLightVolume, vec3(uv, (uCascade * uSliceCount + slice + 0.5) / (uSliceCount * uCascades)), 0.0);
}

void main() {
  float cells[16];
  for (int k = 0; k < 16; ++k) cells[k] = 0.0;
#ifdef WELKIN_SOURCES
  // Of four columns of the light volume the mean: dense ones shade themselves.
  for (int column = 0; column < 4; ++column) {
    vec2 uv = (2.0 * floor(gl_FragCoord.xy) + vec2(column & 1, column >> 1) + 0.5) / vec2(textureSize(uLightVolume, 0));
    vec4 above = vec4(0.0);
    for (int k = 0; k < WELKIN_CELLS; ++k) {
      bool adjoins = k > 0 && uCells[k].x == uCells[max(k - 1, 0)].y;
      vec4 below = adjoins ? above : depthsAt(uv, uCells[k].x);
      above = depthsAt(uv, uCells[k].y);
      // The mean between the two edges.
      vec2 toSun = kSimilarity * (uLineTowardsSun > 0.5 ? vec2(below.x, above.x) : vec2(below.z, above.z));
      float between = toSun.x - toSun.y;
      float lit = abs(between) > 0.01 ? (exp(-toSun.y) - exp(-toSun.x)) / between : exp(-toSun.y);
      cells[k] += 0.25 * kSimilarity * max(below.y - above.y, 0.0) * lit;
    }
  }
#else
  // Between four columns: their mean.
  vec2 uv = 2.0 * gl_FragCoord.xy / vec2(textureSize(uLightVolume, 0));
  for (int k = 0; k < WELKIN_CELLS; ++k)
    cells[k] = kSimilarity * max(depthsAt(uv, uCells[k].x).y - depthsAt(uv, uCells[k].y).y, 0.0);
#endif
  outCells[0] = vec4(cells[0], cells[1], cells[2], cells[3]);
  outCells[1] = vec4(cells[4], cells[5], cells[6], cells[7]);
  outCells[2] = vec4(cells[8], cells[9], cells[10], cells[11]);
  outCells[3] = vec4(cells[12], cells[13], cells[14], cells[15]);
}
