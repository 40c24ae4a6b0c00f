// SPDX-License-Identifier: Apache-2.0
// A marched sky over what lies behind it, premultiplied. Of neighbours that differ no more than grain does the mean is taken, as the
// still's resolve does (welkin/render/accumulation.h).

uniform sampler2D uHistory;
uniform ivec2 uOffsetPx;          // of the picture in the target
uniform float uReach;             // 1 / the relative difference at which neighbours count no more
uniform float uScale;             // written value for each cd/m2

layout(location = 0) out vec4 outColor;


float luminanceOf(vec4 c) { return dot(vec3(c), vec3(0.2126, 0.7152, 0.0722)); }

void main() {
  ivec2 px = ivec2(gl_FragCoord.xy) - uOffsetPx;
  ivec2 last = textureSize(uHistory, 0) - 1;
  vec4 own = texelFetch(uHistory, px, 0);
  float ownLuminance = luminanceOf(own);
  int radius = own.w < 1.0 ? 2 : 0;  // clear sky stays so
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x) {
      vec4 other = texelFetch(uHistory, clamp(px + ivec2(x, y), ivec2(0), last), 0);
      float luminance = luminanceOf(other);
      float d = (abs(luminance - ownLuminance) / max(luminance + ownLuminance, 1e-12) + abs(other.w - own.w)) * uReach;
      float near = max(1.0 - d * d, 0.0);
      sum += near * near * other;
      weights += near * near;
    }
  sum /= weights;
  outColor = vec4(uScale * vec3(sum), 1.0 - sum.w);
}
