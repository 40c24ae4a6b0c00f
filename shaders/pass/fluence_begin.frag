// SPDX-License-Identifier: Apache-2.0
// The fluence of a cascade's cells to begin with: that of the next wider one.

uniform sampler3D uFluence;   // all cascades, one cell a slice
uniform float uCells, uWider, uCascades;
uniform float uShare;         // half the side of this cascade, in those of the wider one

layout(location = 0) out vec4 outFluence[4];

vec4 cellsFrom(vec2 uv, float first) {
  vec4 cells;
  for (int j = 0; j < 4; ++j) {
    float cell = min(first + float(j), uCells - 1.0);
    cells[j] = textureLod(uFluence, vec3(uv, (uWider * uCells + cell + 0.5) / (uCells * uCascades)), 0.0).x;
  }
  return cells;
}

void main() {
  vec2 uv = 0.5 + uShare * (gl_FragCoord.xy / vec2(textureSize(uFluence, 0)) - 0.5);
  outFluence[0] = cellsFrom(uv, 0.0);
  outFluence[1] = cellsFrom(uv, 4.0);
  outFluence[2] = cellsFrom(uv, 8.0);
  outFluence[3] = cellsFrom(uv, 12.0);
}
