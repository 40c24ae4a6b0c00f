// SPDX-License-Identifier: Apache-2.0
// One slice of the light volume completed from the slice below: depth down the line and straight down. No density is evaluated:
// what lies between two slices is the difference of their depths upwards.

uniform sampler2D uBelow;         // xy: depths down the line and straight down at the slice below; zero at the lowest
uniform sampler3D uUpward;        // what light_volume_up stored, all cascades
uniform float uHalfM;
uniform float uHeightM;
uniform float uHeightBelowM;
uniform float uSliceW;            // texture coordinate of this slice
uniform float uSliceBelowW;
uniform vec3 uLine;

layout(location = 0) out vec4 outNext;
layout(location = 1) out vec4 outStored;

void main() {
  vec2 uv = gl_FragCoord.xy / vec2(textureSize(uBelow, 0));
  float lengthM = (uHeightM - uHeightBelowM) / uLine.z;
  vec2 shifted = uv - vec2(uLine) * lengthM / uHalfM * 0.5;
  vec2 here = textureLod(uUpward, vec3(uv, uSliceW), 0.0).xy;
  float lineBelow = textureLod(uBelow, shifted, 0.0).x +
                    max(textureLod(uUpward, vec3(shifted, uSliceBelowW), 0.0).x - here.x, 0.0);
  float down = textureLod(uBelow, uv, 0.0).y + max(textureLod(uUpward, vec3(uv, uSliceBelowW), 0.0).y - here.y, 0.0);
  outNext = vec4(lineBelow, down, 0.0, 0.0);
  outStored = vec4(here, lineBelow, down);
}
