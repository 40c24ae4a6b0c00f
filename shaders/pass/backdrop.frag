// SPDX-License-Identifier: Apache-2.0
// What lies behind thin clouds, for any OpenGL camera: the clear sky, the discs, the ground with the shadows of the sheets.
// WELKIN_VOLUMES, WELKIN_SPLATS: and with those of volumes, of metaballs. WELKIN_BEYOND: and stars, planets and Milky Way. WELKIN_BACKDROP: 0 all of it, 1 where there is clear sky alone, 2 where there is ground alone (welkin/shading/backdrop_tiles.h).

#include "lib/phase.glsl"
#include "lib/eclipse.glsl"
#include "lib/atmosphere.glsl"
#include "lib/sky_uniforms.glsl"
#include "lib/cloud_uniforms.glsl"
#include "lib/ground.glsl"
#include "lib/sheet.glsl"
#include "lib/sheet_shadows.glsl"

uniform mat3 uEnuFromCamera;      // OpenGL's camera: x right, y up, z backwards
uniform vec4 uRayScale;           // from clip x, y: xy * clip + zw is the camera ray at depth 1
uniform vec4 uViewportPx;         // x, y, width, height
uniform float uPixelRad;
uniform float uScale;             // written value for each cd/m2
#ifdef WELKIN_VOLUMES
uniform sampler3D uLightVolume;
uniform sampler2D uAirShadows;    // pass/live_air of the same view
uniform float uAirShadowsPx;      // pixels a side of its texels
#endif

#ifdef WELKIN_SPLATS
#include "lib/splat_layer.glsl"
#endif

layout(location = 0) out vec4 outColor;

#ifdef WELKIN_VOLUMES
#include "lib/cloud_light.glsl"
#include "lib/light_volume.glsl"
#include "lib/ground_light.glsl"
#define WELKIN_AIR_SHADOWS_KNOWN
vec4 airShadows;
#endif

float groundSkylight(vec2 q) {
#ifdef WELKIN_VOLUMES
  return groundSharesAt(q).x;
#else
  return 1.0;
#endif
}

float groundSunlight(vec2 q) {
  float sun = sheetsSunlight(vec3(q, 0.0));
#ifdef WELKIN_VOLUMES
  sun *= exp(-cloudDepthToSun(uLightVolume, vec3(q, 0.0)));
#endif
#ifdef WELKIN_SPLATS
  sun *= splatSunlight(vec3(q, 0.0));
#endif
  return sun;
}

#include "lib/background.glsl"

void main() {
  vec2 px = gl_FragCoord.xy - uViewportPx.xy;
  vec2 clip = px / uViewportPx.zw * 2.0 - 1.0;
  vec3 dir = normalize(uEnuFromCamera * vec3(uRayScale.xy * clip + uRayScale.zw, -1.0));
#ifdef WELKIN_VOLUMES
  airShadows = textureLod(uAirShadows, px / (uAirShadowsPx * vec2(textureSize(uAirShadows, 0))), 0.0);
#endif
#if WELKIN_BACKDROP == 1
  vec3 luminance = skyLuminance(dir);
#ifdef WELKIN_BEYOND
  luminance = throughAtmosphere(dir, luminance, starsBeyond(dir, uPixelRad));
#endif
#elif WELKIN_BACKDROP == 2
  vec3 luminance = groundThroughAir(dir, groundDistance(dir));
#else
  vec3 luminance = backgroundLuminance(dir, groundDistance(dir), uPixelRad);
#endif
  outColor = vec4(uScale * luminance, 1.0);
}
