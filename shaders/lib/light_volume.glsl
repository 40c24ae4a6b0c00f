// SPDX-License-Identifier: Apache-2.0
// The light volume: optical depths around the eye, from every point along the line to the sun, up and down.
//
// Three nested squares of columns centred on the eye (cascades), each a stack of slices. Slices lie only where there are layers: a
// band is a range of heights with cloud, and bands lie on one another in the stack. The texture holds the cascades above one
// another along z. Channels: depth up the line, straight up, down the line, straight down. The line points to the sun or
// away from it, so that it always goes up: welkin/shading/far_decks.h.

const int kMaxBands = kMaxLayers;
const int kCascades = 3;

// Of each band base m, top m, first slice, last slice; those that there are not lie above everything. Where the order of the march is compiled
// in, their number is too (WELKIN_BANDS).
WELKIN_FIXED uniform vec4 uBands[kMaxBands];
uniform int uBandCount;
uniform float uCloudTopM;          // top of the highest band
#ifndef WELKIN_BANDS
#define WELKIN_BANDS kMaxBands
#endif
uniform float uSliceCount;         // of one cascade
WELKIN_FIXED uniform float uCascadeHalfM[kCascades];
uniform vec3 uLine;                // unit, z > 0
uniform float uLineTowardsSun;     // 1: towards the sun, 0: away from it
uniform vec2 uLightShiftM;         // from the eye's frame to the volume's: where the eye and the wind have moved since it was swept

// Slice at a height, fractional. Between bands: the first slice of the band above (from below) has all that lies above.
float lightVolumeSlice(float heightM) {
  float slice = uBands[0].z;
  for (int i = 0; i < WELKIN_BANDS; ++i) {
    vec4 band = uBands[i];
    if (heightM >= band.x) slice = mix(band.z, band.w, clamp((heightM - band.x) / (band.y - band.x), 0.0, 1.0));
  }
  return slice;
}

float cascadeHalfM(int cascade) { return cascade == 0 ? uCascadeHalfM[0] : (cascade == 1 ? uCascadeHalfM[1] : uCascadeHalfM[2]); }

vec4 lightVolumeTexel(sampler3D volume, vec2 q, float slice, int cascade) {
  vec2 uv = clamp(q / cascadeHalfM(cascade) * 0.5 + 0.5, 0.0, 1.0);
  float w = (float(cascade) * uSliceCount + slice + 0.5) / (uSliceCount * float(kCascades));
  return textureLod(volume, vec3(uv, w), 0.0);
}

// Towards the border of a cascade it is blended with the next; in a pass whose pixels are seen together (WELKIN_CASCADES_DITHERED), by
// taking one or the other: half the look-ups.
struct LightCascade {
  int own;
  float next;  // the next one's share
};
#ifdef WELKIN_CASCADES_DITHERED
float cascadeDither = 0.5;  // a pass's, in [0, 1)
#endif

LightCascade lightCascade(vec2 q) {
  float reach = max(abs(q.x), abs(q.y));
  int own = reach < uCascadeHalfM[0] * 0.96 ? 0 : (reach < uCascadeHalfM[1] * 0.96 ? 1 : 2);
  float next = own == kCascades - 1 ? 0.0 : max((reach / cascadeHalfM(own) - 0.77) / 0.19, 0.0);
#ifdef WELKIN_CASCADES_DITHERED
  return LightCascade(next > cascadeDither ? own + 1 : own, 0.0);
#else
  return LightCascade(own, next);
#endif
}

vec4 lightVolumeAt(sampler3D volume, vec3 q) {
  q += vec3(uLightShiftM, 0.0);
  float slice = lightVolumeSlice(q.z);
  LightCascade cascade = lightCascade(vec2(q));
  vec4 own = lightVolumeTexel(volume, vec2(q), slice, cascade.own);
  if (cascade.next <= 0.0) return own;
  return mix(own, lightVolumeTexel(volume, vec2(q), slice, cascade.own + 1), cascade.next);
}

// How far apart its columns are at a place, m: nothing smaller is known there.
float lightVolumeCellM(sampler3D volume, vec3 q) {
  LightCascade cascade = lightCascade(vec2(q) + uLightShiftM);
  float halfM = cascadeHalfM(cascade.own);
  if (cascade.next > 0.0) halfM = mix(halfM, cascadeHalfM(cascade.own + 1), cascade.next);
  return 2.0 * halfM / float(textureSize(volume, 0).x);
}

CloudDepths cloudDepthsAt(sampler3D volume, vec3 q) {
  vec4 v = lightVolumeAt(volume, q);
  bool towards = uLineTowardsSun > 0.5;
  return CloudDepths(towards ? v.x : v.z, towards ? v.z : v.x, v.y, v.w);
}

// Depth towards the sun from anywhere outside the bands too, as for the ground: along the line to the next band, then as stored.
float cloudDepthToSun(sampler3D volume, vec3 q) {
  if (uBandCount == 0) return 0.0;
  vec3 p = q;
  bool inside = false;
  float nextBase = 1e9;
  for (int i = 0; i < WELKIN_BANDS; ++i) {
    if (q.z >= uBands[i].x && q.z <= uBands[i].y) inside = true;
    if (uBands[i].x > q.z) nextBase = min(nextBase, uBands[i].x);
  }
  if (!inside) {
    if (nextBase > 1e8) return 0.0;
    p = q + uLine * ((nextBase - q.z) / uLine.z);
  }
  return lightVolumeAt(volume, p).x;
}
