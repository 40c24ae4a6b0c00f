// SPDX-License-Identifier: Apache-2.0
// The marched sky of a frame from that of the last and what has been marched since, one pixel of each block.
//
// While neither eye nor time moves, pixels are means of their samples, whose weights grow from round to round (uStillWeight), so that what
// was there before they stood still is soon forgotten. In motion each pixel looks where its cloud was in the last frame, as eye and wind have
// moved, and what it finds is brought within what the new samples around it span (variance clipping: M. Salvi 2016, "An Excursion in
// Temporal Supersampling"), so that nothing stays where it no longer belongs.

#include "lib/cloud_layer.glsl"
#include "lib/clouds.glsl"

uniform sampler2D uFresh;         // pass/live_march
uniform sampler2D uMean;          // pass/live_spread
uniform sampler2D uSpread;
uniform sampler2D uNearest;
uniform sampler2D uHistory;       // luminance and transmittance
uniform sampler2D uCount;         // samples that a pixel of it is the mean of
uniform int uBlock;
uniform ivec2 uCell;              // of the fresh samples in their blocks
uniform int uHasHistory;
uniform int uStill;               // neither eye nor time has moved
uniform float uStillWeight;       // then of a fresh sample
uniform float uMostCount;         // samples that a pixel in motion remembers

uniform mat3 uEnuFromCamera;
uniform vec4 uRayScale;
uniform mat4 uLastClipFromEnu;    // positions from the last eye to the last picture
uniform vec3 uEyeMoveM;           // since then
uniform float uEyeM;
uniform float uEarthRadiusM;
const int kMaxBands = kMaxLayers;
WELKIN_FIXED uniform vec4 uBands[kMaxBands];      // base, top: as in lib/light_volume.glsl
WELKIN_FIXED uniform vec4 uBandMoveM[kMaxBands];  // xy: with the wind since then

layout(location = 0) out vec4 outHistory;
layout(location = 1) out vec4 outCount;

// Catmull and Rom's cubic without its corners (J. Jimenez 2016, "Filmic SMAA"), as bilinear filtering frame after frame would blur. Between
// the four texels around, or edges would ring more and more.
vec4 sharpHistory(vec2 uv) {
  vec2 size = vec2(textureSize(uHistory, 0));
  vec2 at = uv * size - 0.5;
  vec2 f = fract(at);
  ivec2 low = ivec2(floor(at)), high = min(low + 1, ivec2(size) - 1);
  low = max(low, ivec2(0));
  vec4 a = texelFetch(uHistory, low, 0), b = texelFetch(uHistory, ivec2(high.x, low.y), 0), c = texelFetch(uHistory, ivec2(low.x, high.y), 0),
       d = texelFetch(uHistory, high, 0);
  vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f));
  vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f));
  vec2 w3 = f * f * (-0.5 + 0.5 * f);
  vec2 w12 = 1.0 - w0 - w3, between = w2 / w12;
  vec2 centre = (floor(at) + 0.5) / size;
  vec2 p0 = centre - 1.0 / size, p3 = centre + 2.0 / size, p12 = centre + between / size;
  vec4 sum = mix(mix(a, b, between.x), mix(c, d, between.x), between.y) * (w12.x * w12.y) +
             w12.x * (textureLod(uHistory, vec2(p12.x, p0.y), 0.0) * w0.y + textureLod(uHistory, vec2(p12.x, p3.y), 0.0) * w3.y) +
             w12.y * (textureLod(uHistory, vec2(p0.x, p12.y), 0.0) * w0.x + textureLod(uHistory, vec2(p3.x, p12.y), 0.0) * w3.x);
  sum /= w12.x * w12.y + w12.x * (w0.y + w3.y) + w12.y * (w0.x + w3.x);
  return clamp(sum, min(min(a, b), min(c, d)), max(max(a, b), max(c, d)));
}

// Towards the mean until it is within the spread, light and transmittance together: each for itself, gaps between clouds that close would
// turn into black cloud.
vec4 clipped(vec4 history, vec4 mean, vec4 spread) {
  vec4 offset = history - mean;
  vec4 share = abs(offset) / (spread + vec4(1e-3 * vec3(mean), 1e-3) + 1e-12);
  return mean + offset / max(max(max(share.x, share.y), max(share.z, share.w)), 1.0);
}

void main() {
  ivec2 px = ivec2(gl_FragCoord.xy);
  ivec2 block = px / uBlock;
  bool isFresh = px - block * uBlock == uCell;
  vec4 fresh = texelFetch(uFresh, block, 0);
  vec4 history;
  float count;
  if (uStill != 0) {
    history = texelFetch(uHistory, px, 0);
    count = texelFetch(uCount, px, 0).x;
    if (isFresh) {
      history = count < 0.5 ? fresh : mix(history, fresh, uStillWeight);
      count += 1.0;
    }
  } else {
    vec4 mean = texelFetch(uMean, block, 0), spread = texelFetch(uSpread, block, 0);
    float depthM = texelFetch(uNearest, block, 0).x;
    vec2 uvFresh = ((vec2(px) - vec2(uCell)) / float(uBlock) + 0.5) / vec2(textureSize(uFresh, 0));
    vec4 around = textureLod(uFresh, uvFresh, 0.0);
    count = 0.0;
    history = around;
    if (uHasHistory != 0) {
      vec2 size = vec2(textureSize(uHistory, 0));
      vec2 clip = (vec2(px) + 0.5) / size * 2.0 - 1.0;
      vec3 dir = normalize(uEnuFromCamera * vec3(uRayScale.xy * clip + uRayScale.zw, -1.0));
      vec3 moved = vec3(0.0);
      if (depthM < 1e8) {
        float height = heightAboveGround(vec3(0.0, 0.0, uEyeM) + dir * depthM, uEarthRadiusM);
        for (int i = 0; i < kMaxBands; ++i)
          if (i == 0 || height >= uBands[i].x) moved = vec3(vec2(uBandMoveM[i]), 0.0);
      }
      vec4 was = uLastClipFromEnu * vec4(dir * min(depthM, 1e6) - moved + uEyeMoveM, 1.0);
      vec2 uv = was.w > 0.0 ? was.xy / was.w * 0.5 + 0.5 : vec2(-1.0);
      if (all(greaterThanEqual(uv, vec2(0.0))) && all(lessThan(uv, vec2(1.0)))) {
        count = texelFetch(uCount, ivec2(uv * size), 0).x;
        // Where all around is the same, as clear sky is, so is what was there: a loop, as a rasteriser on the processor runs both sides of
        // a branch.
        int different = count > 0.5 && dot(spread, vec4(1.0)) > 0.0 ? 1 : 0;
        for (int i = 0; i < different; ++i) history = clipped(sharpHistory(uv), mean, spread);
        count = min(count, uMostCount);
      }
    }
    if (isFresh) {
      history = count < 0.5 ? fresh : mix(history, fresh, 1.0 / (count + 1.0));
      count += 1.0;
    }
    history = vec4(max(vec3(history), 0.0), clamp(history.w, 0.0, 1.0));
  }
  outHistory = history;
  outCount = vec4(count, 0.0, 0.0, 1.0);
}
