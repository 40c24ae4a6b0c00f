// SPDX-License-Identifier: Apache-2.0
// Shadows of clouds in the air before the sky and before the ground, for a backdrop (pass/backdrop): a texel for each block of pixels, as
// they are soft.

#define WELKIN_AIR_SAMPLES 8
#include "lib/phase.glsl"
#include "lib/eclipse.glsl"
#include "lib/atmosphere.glsl"
#include "lib/sky_uniforms.glsl"
#include "lib/cloud_uniforms.glsl"
#include "lib/cloud_light.glsl"
uniform sampler3D uLightVolume;
#include "lib/light_volume.glsl"
#include "lib/ground_light.glsl"
#include "lib/air_shadows.glsl"

uniform mat3 uEnuFromCamera;      // OpenGL's camera: x right, y up, z backwards
uniform vec4 uRayScale;           // from clip x, y: xy * clip + zw is the camera ray at depth 1
uniform vec2 uSizePx;             // of the whole picture
uniform float uBlock;             // pixels a side of a texel
uniform float uPixelRad;

layout(location = 0) out vec4 outAir;  // xyz: what they take from the sky, cd/m2; w: the share of the air before the ground that is lit

void main() {
  vec2 clip = uBlock * gl_FragCoord.xy / uSizePx * 2.0 - 1.0;
  vec3 dir = normalize(uEnuFromCamera * vec3(uRayScale.xy * clip + uRayScale.zw, -1.0));
  // Texels at the horizon are read from both of its sides, and hold what is there on either.
  float aboveM = max(uEyeM, 0.0);  // an engine's ground may lie lower
  float horizon = -sqrt(aboveM * (2.0 * uEarthRadiusM + aboveM)) / (uEarthRadiusM + aboveM), margin = 2.0 * uBlock * uPixelRad;
  int first = uEyeM < uCloudTopM && dir.z > horizon - margin ? 0 : 1, last = dir.z < horizon + margin ? 2 : 1;
  outAir = vec4(0.0, 0.0, 0.0, 1.0);
  for (int side = first; side < last; ++side) {  // a loop, as a rasteriser on the processor runs both sides of a branch
    bool sky = side == 0;
    vec3 there = normalize(vec3(vec2(dir), sky ? max(dir.z, horizon) : min(dir.z, horizon - 1e-6)));
    vec2 crossings = sphereCrossings(sky ? uCloudTopM : 0.0, there.z);
    float distanceM = max(sky ? crossings.y : crossings.x, 0.0);
    vec3 inscatter, through;
    aerialLit(there, distanceM, inscatter, through);
    float lit = litAir(there, distanceM, through);
    if (sky) outAir = vec4(inscatter - shadedAir(there, inscatter, through, lit, lightAboutAir(there, distanceM)), outAir.w);
    else outAir.w = lit;
  }
}
