// SPDX-License-Identifier: Apache-2.0
// What the fresh samples about each block span, for pass/live_resolve, which asks for every pixel of a block alike.

uniform sampler2D uFresh;         // pass/live_march
uniform sampler2D uFreshDepth;
uniform float uDeviations;        // standard deviations to both sides of the mean

layout(location = 0) out vec4 outMean;
layout(location = 1) out vec4 outSpread;
layout(location = 2) out vec4 outNearest;  // x: of the distances, m; 1e9: nothing is there

void main() {
  ivec2 block = ivec2(gl_FragCoord.xy), last = textureSize(uFresh, 0) - 1;
  vec4 mean = vec4(0.0), square = vec4(0.0);
  float depthM = 1e9;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = clamp(block + ivec2(x, y), ivec2(0), last);
      vec4 sampled = texelFetch(uFresh, at, 0);
      mean += sampled;
      square += sampled * sampled;
      float there = texelFetch(uFreshDepth, at, 0).x;
      if (there > 0.0) depthM = min(depthM, there);
    }
  mean /= 9.0;
  outMean = mean;
  outSpread = uDeviations * sqrt(max(square / 9.0 - mean * mean, 0.0));
  outNearest = vec4(depthM, 0.0, 0.0, 1.0);
}
