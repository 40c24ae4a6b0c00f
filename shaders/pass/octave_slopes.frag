// SPDX-License-Identifier: Apache-2.0
// A pattern with its slopes beside it, for embossing: its value, and the differences of the neighbours along x and y.

uniform sampler2D uPattern;  // not filtered; repeats
uniform vec2 uTexel;         // 1 / size

layout(location = 0) out vec4 outPattern;

void main() {
  vec2 at = gl_FragCoord.xy * uTexel;
  vec2 x = vec2(uTexel.x, 0.0);
  vec2 y = vec2(0.0, uTexel.y);
  outPattern = vec4(textureLod(uPattern, at, 0.0).x, textureLod(uPattern, at + x, 0.0).x - textureLod(uPattern, at - x, 0.0).x,
                    textureLod(uPattern, at + y, 0.0).x - textureLod(uPattern, at - y, 0.0).x, 0.0);
}
