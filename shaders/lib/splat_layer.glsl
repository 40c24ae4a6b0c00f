// SPDX-License-Identifier: Apache-2.0
// Clouds of metaballs as rays of a still meet them: drawn before (pass/splat.frag) on the faces of a cube or on the picture's own plane,
// light and opacity, and how far away.

uniform sampler2D uSplatLight;        // premultiplied, the air in front and all; three faces beside one another, two rows
uniform sampler2D uSplatDistance;     // km, premultiplied
uniform int uSplatFaces;              // 1 or 6, in the order +x -x +y -y +z -z
uniform vec4 uSplatAxes[18];          // of each face: right, up, ahead; w: tangent of half its width, of half its height, share of the texture
uniform sampler2D uSplatShadow;       // optical depth through all of them across the key light
uniform vec4 uSplatShadowAxes[2];     // across, upward; w: the middle along them, from the ground under the eye
uniform float uSplatShadowHalfM;      // of its side; 0: there is none

struct SplatSeen {
  vec4 light;
  float distanceM;
};

SplatSeen splatsAlong(vec3 dir) {
  vec3 a = abs(dir);
  int face = 0;
  if (uSplatFaces > 1)
    face = a.x >= a.y && a.x >= a.z ? (dir.x > 0.0 ? 0 : 1) : (a.y >= a.z ? (dir.y > 0.0 ? 2 : 3) : (dir.z > 0.0 ? 4 : 5));
  vec4 right = uSplatAxes[3 * face], up = uSplatAxes[3 * face + 1], ahead = uSplatAxes[3 * face + 2];
  vec2 at = vec2(dot(vec3(right), dir) / right.w, dot(vec3(up), dir) / up.w) / dot(vec3(ahead), dir);
  vec2 cells = uSplatFaces > 1 ? vec2(3.0, 2.0) : vec2(1.0);
  vec2 uv = (vec2(float(face % 3), float(face / 3)) + 0.5 + 0.5 * at) / cells;
  vec4 light = textureLod(uSplatLight, uv, 0.0);
  vec4 distance = textureLod(uSplatDistance, uv, 0.0);
  return SplatSeen(light, distance.w > 1e-4 ? 1000.0 * distance.x / distance.w : 0.0);
}

// Share of the key light that reaches a place on the ground or in front of all of them.
float splatSunlight(vec3 q) {
  if (uSplatShadowHalfM <= 0.0) return 1.0;
  vec2 at = vec2(dot(vec3(uSplatShadowAxes[0]), q) - uSplatShadowAxes[0].w, dot(vec3(uSplatShadowAxes[1]), q) - uSplatShadowAxes[1].w);
  at /= uSplatShadowHalfM;
  if (max(abs(at.x), abs(at.y)) >= 1.0) return 1.0;
  return exp(-max(textureLod(uSplatShadow, 0.5 + 0.5 * at, 0.0).x, 0.0));
}
