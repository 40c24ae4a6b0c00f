// SPDX-License-Identifier: Apache-2.0
// Stars as spots a few pixels wide, found by direction. Plain mathematics.
//
// The texture (welkin/sky/star_cells.h) begins with the cells of a cube around the eye, n x n on each face +x -x +y -y +z -z: where the
// list of a cell begins, and how many spots touch it. A spot is two texels: its direction and its radius in pixels; its illuminance.

WELKIN_CONST int kStarRowBits = 10;        // texels in a row, as a power of two
WELKIN_CONST float kWidestPixelRad = 0.128f;  // rad; pixels that are larger are taken for it

WELKIN_FN vec4 starTexel(sampler2D stars, int i) {
  return texelFetch(stars, ivec2(i & ((1 << kStarRowBits) - 1), i >> kStarRowBits), 0);
}

// Luminance by a unit direction in the stars' frame. Over the solid angle it sums up to the illuminance, whatever the pixels' size.
WELKIN_FN vec3 starLuminance(sampler2D stars, int cells, vec3 dir, float pixelRad) {
  vec3 a = abs(dir);
  bool alongX = a.x >= a.y && a.x >= a.z, alongY = !alongX && a.y >= a.z;
  float along = alongX ? dir.x : alongY ? dir.y : dir.z;
  vec2 across = alongX ? vec2(dir.y, dir.z) : alongY ? vec2(dir.x, dir.z) : vec2(dir.x, dir.y);
  float n = float(cells);
  vec2 at = clamp(floor((across / abs(along) * 0.5f + 0.5f) * n), vec2(0.0f), vec2(n - 1.0f));
  int face = (alongX ? 0 : alongY ? 2 : 4) + (along < 0.0f ? 1 : 0);
  vec4 cell = starTexel(stars, (face * cells + int(at.y)) * cells + int(at.x));
  int first = int(cell.x), count = int(cell.y);
  float pixel = min(pixelRad, kWidestPixelRad);
  vec3 sum = vec3(0.0f);
  for (int i = 0; i < count; ++i) {
    vec4 place = starTexel(stars, first + 2 * i);
    vec3 away = dir - vec3(place);
    float radius = place.w * pixel;
    float inside = max(1.0f - dot(away, away) / (radius * radius), 0.0f);
    // The cube of it over the spot is a quarter of the spot's area.
    if (inside > 0.0f) {
      float share = inside * inside * inside * 4.0f / (3.14159265f * radius * radius);
      sum += share * vec3(starTexel(stars, first + 2 * i + 1));
    }
  }
  return sum;
}
