// SPDX-License-Identifier: Apache-2.0
// Stars and planets as spots a few pixels wide. Plain mathematics.
//
// Every one is a round spot 3.5 pixels wide, of which half stands out. Those brighter than V = 4.5 send a share of their light into a
// wider one, as lenses and eyes do: where a pixel cannot become whiter, bright stars are larger.
//
// Stars are found by direction. The texture (welkin/sky/star_cells.h) begins with the cells of a cube around the eye, n x n on each face +x -x +y -y +z -z: where the
// list of a cell begins, and how many spots touch it. A spot is two texels: its direction and its radius in pixels; its illuminance.

WELKIN_CONST int kStarRowBits = 10;        // texels in a row, as a power of two
WELKIN_CONST float kWidestPixelRad = 0.128f;  // rad; pixels that are larger are taken for it

WELKIN_CONST float kSpotPx = 1.75f;      // radius; its sum over pixels is within 2 % wherever their centres lie
WELKIN_CONST float kHaloShare = 0.1f;    // of the light of those 1 magnitude brighter than V = 4.5, and more
WELKIN_CONST float kHaloGrowth = 0.33f;  // of the radius a magnitude; chosen by eye

// Share of a spot's illuminance for each sr, away from its middle.
WELKIN_FN float spotShare(vec3 away, float radius) {
  float inside = max(1.0f - dot(away, away) / (radius * radius), 0.0f);
  // The cube of it over the spot is a quarter of the spot's area.
  return inside * inside * inside * 4.0f / (3.14159265f * radius * radius);
}

// Luminance, for each lux, away from a planet that is so many magnitudes brighter than V = 4.5. leastRad: twice its radius, which leaves
// the middle no brighter than its disc is.
WELKIN_FN float planetShare(vec3 away, float brighter, float leastRad, float pixelRad) {
  float pixel = min(pixelRad, kWidestPixelRad), halo = kHaloShare * clamp(brighter, 0.0f, 1.0f);
  float wide = kSpotPx * (1.0f + kHaloGrowth * max(brighter, 0.0f)) * pixel;
  return (1.0f - halo) * spotShare(away, max(kSpotPx * pixel, leastRad)) + halo * spotShare(away, max(wide, leastRad));
}

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
    float share = spotShare(dir - vec3(place), place.w * pixel);
    if (share > 0.0f) sum += share * vec3(starTexel(stars, first + 2 * i + 1));
  }
  return sum;
}
