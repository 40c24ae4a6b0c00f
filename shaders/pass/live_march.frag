// SPDX-License-Identifier: Apache-2.0
// A frame's share of a marched sky: one pixel of each block of uBlock x uBlock, drawn to a target so much smaller. Clouds alone, volumes
// and the thin layers among them, for any OpenGL camera; what lies behind is drawn elsewhere and shines through.

#include "lib/phase.glsl"
#include "lib/eclipse.glsl"
#include "lib/atmosphere.glsl"
#include "lib/sky_uniforms.glsl"
#include "lib/cloud_uniforms.glsl"
#include "lib/cloud_light.glsl"
#include "lib/light_around.glsl"
#include "lib/cloud_light_fit.glsl"
#include "lib/cloud_scattering.glsl"
#define WELKIN_CASCADES_DITHERED
#include "lib/light_volume.glsl"
#include "lib/fluence.glsl"
#include "lib/ground_light.glsl"
#ifdef WELKIN_SHEETS
#include "lib/sheet.glsl"
#include "lib/sheet_surface.glsl"
#include "lib/sheet_light.glsl"
#include "lib/sheet_ray.glsl"
#include "lib/sheet_shadows.glsl"
#endif
#include "lib/dither.glsl"
#include "lib/march.glsl"
#define WELKIN_AIR_SAMPLES 8
#include "lib/air_shadows.glsl"

float groundSunlight(vec2 q) { return 1.0; }  // of no ground
float groundSkylight(vec2 q) { return 1.0; }

#include "lib/background.glsl"

uniform mat3 uEnuFromCamera;      // OpenGL's camera: x right, y up, z backwards
uniform vec4 uRayScale;           // from clip x, y: xy * clip + zw is the camera ray at depth 1
uniform vec2 uSizePx;             // of the whole picture
uniform float uPixelRad;
uniform float uBlock;
uniform vec2 uCellPx;             // of this frame within the blocks, with the jitter within the pixel
uniform vec2 uJitterStep;         // along the ray and towards the sun, [0, 1)

layout(location = 0) out vec4 outCloud;   // luminance that arrives, air and all; w: the share of what is behind that arrives too
layout(location = 1) out vec4 outDepth;   // x: distance of what is seen, m; 0: nothing is

void main() {
  vec2 block = floor(gl_FragCoord.xy);
  vec2 px = uBlock * block + uCellPx;
  vec2 clip = px / uSizePx * 2.0 - 1.0;
  vec3 dir = normalize(uEnuFromCamera * vec3(uRayScale.xy * clip + uRayScale.zw, -1.0));
  Dithers dithers = dithersOf(floor(px), uJitterStep);
  airDither = dithers.steps.x;
  cascadeDither = dithers.cascade;
  CloudRay ray = marchClouds(dir, groundDistance(dir), uPixelRad, dithers.steps);
  vec3 color = vec3(0.0);
  float depthM = ray.depthM;
#ifdef WELKIN_SHEETS
  color += ray.sheets;
  float hidden = ray.hidden;
  if (hidden <= 0.0001 && ray.transmittance < 1.0) depthM = max(sphereCrossings(uSheets[0].heightM, dir.z).y, 0.0);
#else
  float hidden = 1.0 - ray.transmittance;
#endif
  if (hidden > 0.0001) {
    vec3 inscatter, through;
    aerialShaded(dir, ray.depthM, inscatter, through);
    color += cloudsThroughAir(dir, ray.luminance, hidden, through) + inscatter * hidden;
  }
  outCloud = vec4(color, ray.transmittance);
  outDepth = vec4(depthM, 0.0, 0.0, 1.0);
}
