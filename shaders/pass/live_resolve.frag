// SPDX-License-Identifier: Apache-2.0
// The marched sky of a frame from that of the last and what has been marched since, one pixel of each block.
//
// While neither eye nor time moves, pixels are means of their samples, whose weights grow from round to round (uStillWeight), so that what
// was there before they stood still is soon forgotten. In motion each pixel looks where its cloud was in the last frame, as eye and wind have
// moved, and what it finds is held within what the new samples around it span (variance clipping: M. Salvi 2016, "An Excursion in
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
const int kMaxBands = 8;
WELKIN_FIXED uniform vec4 uBands[kMaxBands];      // base, top: as in lib/light_volume.glsl
WELKIN_FIXED uniform vec4 uBandMoveM[kMaxBands];  // xy: with the wind since then

layout(location = 0) out vec4 outHistory;
layout(location = 1) out vec4 outCount;

// Catmull and Rom's cubic in five fetches, without its corners (J. Jimenez 2016, "Filmic SMAA"): bilinear filtering frame after frame would
// blur. With none it is 0: a loop, as a rasteriser on the processor runs both sides of a branch.
vec4 sharpHistory(vec2 uv, int fetches) {
  vec2 size = vec2(textureSize(uHistory, 0));
  vec2 at = uv * size - 0.5;
  vec2 f = fract(at);
  vec2 centre = (floor(at) + 0.5) / size;
  vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f));
  vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f));
  vec2 w3 = f * f * (-0.5 + 0.5 * f);
  vec2 w12 = 1.0 - w0 - w3;
  vec2 p0 = centre - 1.0 / size, p3 = centre + 2.0 / size, p12 = centre + w2 / w12 / size;
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int i = 0; i < fetches; ++i) {
    vec2 x = i == 1 ? vec2(p0.x, w0.x) : (i == 2 ? vec2(p3.x, w3.x) : vec2(p12.x, w12.x));
    vec2 y = i == 3 ? vec2(p0.y, w0.y) : (i == 4 ? vec2(p3.y, w3.y) : vec2(p12.y, w12.y));
    sum += x.y * y.y * textureLod(uHistory, vec2(x.x, y.x), 0.0);
    weights += x.y * y.y;
  }
  return sum / max(weights, 1e-6);
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
        // Where all around is the same, in clear sky, so is what it was.
        int fetches = dot(spread, vec4(1.0)) > 0.0 ? 5 : 0;
        if (count > 0.5) history = clamp(sharpHistory(uv, fetches), mean - spread, mean + spread);
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
