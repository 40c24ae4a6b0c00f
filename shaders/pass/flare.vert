// SPDX-License-Identifier: Apache-2.0
// Sprites of the lens flare, two triangles each. How much of the sun's light arrives is found here, once a vertex and with nothing read
// back: past the horizon, past what an engine has drawn, through the sheets or what has been marched, at points of the sun's disc.

#include "lib/sheet.glsl"
#include "lib/sheet_surface.glsl"

const int kMaxSprites = 6;
const int kMaxFlat = 6;
const int kMaxVolumes = 2;

layout(location = 0) in vec3 iCorner;      // x, y in [-1.1, 1.1], room for fringes; z: the sprite

uniform vec4 uSprites[kMaxSprites];        // centre and half size in clip space
uniform vec4 uSpriteLight[kMaxSprites];    // mean luminance, cd/m2; w: hollowness, below 0 the glow
uniform vec2 uSunAt;                       // in clip space
uniform vec2 uSunHalfSize;

uniform mat3 uEnuFromCamera;
uniform vec4 uRayScale;                    // from clip x, y: xy * clip + zw is the camera ray at depth 1
uniform float uEyeM;
uniform float uEarthRadiusM;

uniform int uFlatCount;
uniform Sheet uFlat[kMaxFlat];
uniform vec4 uFlatSurface[kMaxFlat];       // shapes of lib/sheet_surface.glsl
uniform vec4 uFlatRim[kMaxFlat];           // where the rim begins, m; kind of surface
uniform sampler2D uFlatPattern0;
uniform sampler2D uFlatPattern1;
uniform sampler2D uFlatPattern2;
uniform sampler2D uFlatPattern3;
uniform sampler2D uFlatPattern4;
uniform sampler2D uFlatPattern5;
uniform int uVolumeCount;
uniform Sheet uVolume[kMaxVolumes];
uniform vec4 uVolumeSurface[kMaxVolumes];
uniform vec4 uVolumeRim[kMaxVolumes];
uniform sampler3D uVolumePattern0;
uniform sampler3D uVolumePattern1;

uniform sampler2D uDepth;                  // of the picture, where an engine gives it
uniform float uHasDepth;
uniform float uFarDepth;                   // what it holds where there is nothing: 1, or 0 for reversed depth

uniform sampler2D uInFront;                // of the picture, w: what marched clouds and the sheets among them let through
uniform float uHasInFront;

out vec2 vCorner;
out vec4 vLight;

// To a sheet from beneath it; less than 0: it is beneath the eye.
float surfaceDistance(vec4 shape, vec3 dir) {
  return shape.x * uEyeM > shape.z ? -1.0 : sheetCrossings(shape, uEyeM, dir).y;
}

// Of what stands behind a sheet, as the sheet is drawn. rim: where it begins, and the kind of surface.
float through(Sheet sheet, sampler2D pattern, vec4 surface, vec4 rim, vec3 dir) {
  float t = surfaceDistance(surface, dir);
  if (t <= 0.0) return 1.0;
  vec3 p = vec3(0.0, 0.0, uEyeM) + dir * t;
  return 1.0 - sheetRim(int(rim.y + 0.5), surface, rim.x, p) *
                   sheetOpacity(sheet, sheetDepth(sheet, textureLod(pattern, vec2(sheetCoordinate(sheet, p)), 0.0).x));
}

float throughVolume(Sheet sheet, sampler3D pattern, vec4 surface, vec4 rim, vec3 dir) {
  float t = surfaceDistance(surface, dir);
  if (t <= 0.0) return 1.0;
  vec3 p = vec3(0.0, 0.0, uEyeM) + dir * t;
  return 1.0 - sheetRim(int(rim.y + 0.5), surface, rim.x, p) *
                   sheetOpacity(sheet, sheetDepth(sheet, textureLod(pattern, sheetCoordinate(sheet, p), 0.0).x));
}

float throughSheets(vec3 dir) {
  float t = 1.0;
  if (uFlatCount > 0) t *= through(uFlat[0], uFlatPattern0, uFlatSurface[0], uFlatRim[0], dir);
  if (uFlatCount > 1) t *= through(uFlat[1], uFlatPattern1, uFlatSurface[1], uFlatRim[1], dir);
  if (uFlatCount > 2) t *= through(uFlat[2], uFlatPattern2, uFlatSurface[2], uFlatRim[2], dir);
  if (uFlatCount > 3) t *= through(uFlat[3], uFlatPattern3, uFlatSurface[3], uFlatRim[3], dir);
  if (uFlatCount > 4) t *= through(uFlat[4], uFlatPattern4, uFlatSurface[4], uFlatRim[4], dir);
  if (uFlatCount > 5) t *= through(uFlat[5], uFlatPattern5, uFlatSurface[5], uFlatRim[5], dir);
  if (uVolumeCount > 0) t *= throughVolume(uVolume[0], uVolumePattern0, uVolumeSurface[0], uVolumeRim[0], dir);
  if (uVolumeCount > 1) t *= throughVolume(uVolume[1], uVolumePattern1, uVolumeSurface[1], uVolumeRim[1], dir);
  return t;
}

bool meetsEarth(vec3 dir) {
  float b = (uEarthRadiusM + uEyeM) * dir.z;
  return b < 0.0 && b * b > uEyeM * (2.0 * uEarthRadiusM + uEyeM);
}

float arriving() {
  float sum = 0.0;
  for (int i = 0; i < 16; ++i) {
    // Evenly over the disc: H. Vogel 1979, "A better way to construct the sunflower head".
    float r = sqrt((float(i) + 0.5) / 16.0);
    float a = 2.39996323 * float(i);
    vec2 at = uSunAt + r * vec2(cos(a), sin(a)) * uSunHalfSize;
    vec3 dir = normalize(uEnuFromCamera * vec3(uRayScale.xy * at + uRayScale.zw, -1.0));
    if (meetsEarth(dir)) continue;
    if (uHasDepth > 0.5 && textureLod(uDepth, 0.5 + 0.5 * at, 0.0).x != uFarDepth) continue;
    sum += uHasInFront > 0.5 ? textureLod(uInFront, 0.5 + 0.5 * at, 0.0).w : throughSheets(dir);
  }
  return sum / 16.0;
}

void main() {
  int sprite = int(iCorner.z + 0.5);
  vec4 place = uSprites[sprite];
  vCorner = iCorner.xy;
  float share = arriving();
  vLight = vec4(uSpriteLight[sprite].xyz * share, uSpriteLight[sprite].w);
  // Of no light there is nothing to draw: outside.
  gl_Position = share > 0.0 ? vec4(place.xy + iCorner.xy * place.zw, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
