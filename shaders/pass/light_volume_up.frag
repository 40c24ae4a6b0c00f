// SPDX-License-Identifier: Apache-2.0
// One slice of the light volume from the slice above it: optical depth up the line and straight up.

// Compiled for each band (WELKIN_BAND), with that band's layers alone. The topmost slice of a band takes over what lies above the gap.

#include "lib/cloud_uniforms.glsl"

uniform sampler2D uAbove;         // the slice above; zero above the highest
uniform sampler3D uWider;         // the volume with the next wider cascade: a line that leaves this one goes on there
uniform float uWiderShare;        // half the side of this cascade in that one's; 0: there is none
uniform float uWiderW;            // texture coordinate of its slice above
uniform float uHalfM;             // half the side of this cascade
uniform float uHeightM;           // of this slice
uniform float uHeightAboveM;      // of the slice above
uniform vec3 uLine;               // unit, z > 0
uniform int uSamples;             // along the line between the slices

layout(location = 0) out vec4 outNext;
layout(location = 1) out vec4 outStored;

void main() {
  vec2 uv = gl_FragCoord.xy / vec2(textureSize(uAbove, 0));
  vec2 q = (uv * 2.0 - 1.0) * uHalfM;
  float rise = uHeightAboveM - uHeightM;
  float lengthM = rise / uLine.z;
  float line = 0.0;
  for (int i = 0; i < uSamples; ++i) {
    float t = (float(i) + 0.5) / float(uSamples) * lengthM;
    line += cloudExtinctionInBand(WELKIN_BAND, vec3(q, uHeightM) + uLine * t, 0.0);
  }
  line *= lengthM / float(uSamples);
  float up = 0.5 * rise * (cloudExtinctionInBand(WELKIN_BAND, vec3(q, uHeightM + 0.25 * rise), 0.0) +
                           cloudExtinctionInBand(WELKIN_BAND, vec3(q, uHeightM + 0.75 * rise), 0.0));
  vec2 shifted = uv + vec2(uLine) * lengthM / uHalfM * 0.5;
  vec2 above = vec2(textureLod(uAbove, shifted, 0.0).x, textureLod(uAbove, uv, 0.0).y), beyond = abs(shifted - 0.5);
  if (max(beyond.x, beyond.y) > 0.5 && uWiderShare > 0.0)
    above.x = textureLod(uWider, vec3(0.5 + (shifted - 0.5) * uWiderShare, uWiderW), 0.0).x;
  outNext = vec4(above + vec2(line, up), 0.0, 0.0);
  outStored = outNext;
}
