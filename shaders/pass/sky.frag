// SPDX-License-Identifier: Apache-2.0
// One sub-frame of the whole picture: sky, discs, ground, and one march through all layers of cloud, with the thin ones among them
// (WELKIN_SHEETS). WELKIN_TRANSMITTANCE: not a picture, but what arrives through them all. Sub-frames differ in their
// place within the pixel and along the ray; their mean converges to the still. Alpha counts them. Beside it: the share of what is
// behind all clouds that they hide.

#include "lib/projection.glsl"
#include "lib/phase.glsl"
#include "lib/eclipse.glsl"
#include "lib/atmosphere.glsl"
#include "lib/sky_uniforms.glsl"
#include "lib/cloud_uniforms.glsl"
#include "lib/cloud_light.glsl"
#include "lib/light_around.glsl"
#include "lib/cloud_light_fit.glsl"
#include "lib/cloud_scattering.glsl"
#ifndef WELKIN_CASCADES_BLENDED
#define WELKIN_CASCADES_DITHERED
#endif
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
#ifdef WELKIN_SPLATS
#include "lib/splat_layer.glsl"
#endif
#include "lib/dither.glsl"
#include "lib/march.glsl"
#include "lib/air_shadows.glsl"

float groundSkylight(vec2 q) { return groundSharesAt(q).x; }
float groundSunlight(vec2 q) {
  float sun = exp(-cloudDepthToSun(uLightVolume, vec3(q, 0.0)));
#ifdef WELKIN_SHEETS
  sun *= sheetsSunlight(vec3(q, 0.0));
#endif
#ifdef WELKIN_SPLATS
  sun *= splatSunlight(vec3(q, 0.0));
#endif
  return sun;
}

#include "lib/background.glsl"

uniform Projector uProjector;
uniform vec2 uJitterPx;           // of this sub-frame within the pixel
uniform vec2 uJitterStep;         // of this sub-frame along the ray and towards the sun, [0, 1)

layout(location = 0) out vec4 outColor;
layout(location = 1) out float outHidden;

void main() {
  outHidden = 0.0;
  vec2 px = vec2(gl_FragCoord.x, uProjector.sizePx.y - gl_FragCoord.y);
  vec3 dir;
  float pixelRad;
  if (!projectorDirection(uProjector, px + uJitterPx, dir, pixelRad)) {
    outColor = vec4(0.0, 0.0, 0.0, 1.0);
    return;
  }
  Dithers dithers = dithersOf(floor(px), uJitterStep);
  airDither = dithers.steps.x;
#ifdef WELKIN_CASCADES_DITHERED
  cascadeDither = dithers.cascade;
#endif
  float groundM = groundDistance(dir);
  CloudRay ray = marchClouds(dir, groundM, pixelRad, dithers.steps);
#ifdef WELKIN_TRANSMITTANCE
  outColor = vec4(vec3(groundM < 1e8 ? 0.0 : ray.transmittance), 1.0);
  return;
#endif
  outHidden = 1.0 - ray.transmittance;
  vec3 color = vec3(0.0);
  if (ray.transmittance > 0.0005) color = ray.transmittance * backgroundLuminance(dir, groundM, pixelRad);
#ifdef WELKIN_SURFACES
  color += ray.sheets;
  if (ray.hidden > 0.0001) {
    vec3 inscatter, through;
    aerialShaded(dir, ray.depthM, inscatter, through);
    color += cloudsThroughAir(dir, ray.luminance, ray.hidden, through) + inscatter * ray.hidden;
  }
#else
  if (ray.transmittance < 0.9999) {
    vec3 inscatter, through;
    aerialShaded(dir, ray.depthM, inscatter, through);
    float hidden = 1.0 - ray.transmittance;
    color += cloudsThroughAir(dir, ray.luminance, hidden, through) + inscatter * hidden;
  }
#endif
  outColor = vec4(color, 1.0);
}
