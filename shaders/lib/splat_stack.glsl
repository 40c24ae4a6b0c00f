// SPDX-License-Identifier: Apache-2.0
// A stack of slices across a direction of light: the optical depth from the light to the end of each slice. The slices lie side by
// side in one texture, a margin of a texel around each.

const int kSplatSlices = 32;      // 8 columns, 4 rows
const vec2 kSplatTiles = vec2(8.0, 4.0);
const float kSplatTilePx = 64.0;

struct SplatStack {
  vec3 centreM;                   // from the eye
  vec3 across;                    // unit; with `upward` it spans the slices
  vec3 upward;
  vec3 away;                      // the way the light goes
  float halfM;                    // half the side of a slice
  float halfDepthM;
};

// Texture coordinate of a place in a slice; at: from -1 to 1.
vec2 splatTile(int slice, vec2 at) {
  vec2 tile = vec2(float(slice % 8), float(slice / 8));
  vec2 px = kSplatTilePx * 0.5 + clamp(at, -1.0, 1.0) * (kSplatTilePx * 0.5 - 1.0);
  return (tile + px / kSplatTilePx) / kSplatTiles;
}

// Optical depths of a point: from the light, and on to the other side.
vec2 splatDepths(SplatStack stack, sampler2D depths, vec3 p) {
  vec3 q = p - stack.centreM;
  vec2 at = vec2(dot(q, stack.across), dot(q, stack.upward)) / stack.halfM;
  float z = clamp((dot(q, stack.away) / stack.halfDepthM * 0.5 + 0.5) * float(kSplatSlices), 0.0, float(kSplatSlices) - 0.001);
  int slice = int(z);
  float before = slice > 0 ? textureLod(depths, splatTile(slice - 1, at), 0.0).x : 0.0;
  float here = mix(before, textureLod(depths, splatTile(slice, at), 0.0).x, z - float(slice));
  float all = textureLod(depths, splatTile(kSplatSlices - 1, at), 0.0).x;
  return max(vec2(here, all - here), 0.0);
}
