// SPDX-License-Identifier: Apache-2.0
// A thin layer's mesh about the eye. What changes slowly over the sky is computed here, at the vertices: air between, and the light
// of the sheet where it is thin and thick, from its sunny and its shady side.

#include "lib/phase.glsl"
#include "lib/atmosphere.glsl"
#include "lib/sky_uniforms.glsl"
#include "lib/cloud_light.glsl"
#include "lib/sheet.glsl"

layout(location = 0) in vec3 iPositionM;  // from the ground under the eye, z up
layout(location = 1) in float iAlpha;     // 0 at the rim

uniform mat4 uClipFromEnu;                // directions east-north-up from the eye to clip space
uniform Sheet uSheet;
uniform DropletPhase uDroplets;

out vec3 vCoordinate;                     // of the pattern
out vec4 vInscatter;                      // by the air in front, cd/m2; w: the mesh's alpha
#if WELKIN_TIER == 2
out vec3 vKey;                            // illuminance of the sheet that arrives at the eye's side of the air, lux
out vec3 vAround;                         // radiance from all other directions, as it arrives
out vec3 vDirection;                      // from the eye; not normalised
#else
out vec3 vShade;                          // luminance of the shady and of the sunny side as they arrive, cd/m2
out vec3 vSunny;
#endif

// Luminance of cloud at an optical depth towards the sun.
vec3 sheetLight(float toSun, vec3 key, vec3 around, float phase, float cosSun, float viewHeight) {
  CloudDepths d = CloudDepths(toSun, uSheet.typicalDepth, 0.5 * uSheet.typicalDepth, 0.5 * uSheet.typicalDepth);
  return key * cloudSunSource(d, phase, cosSun, viewHeight, max(uKeyDirection.z, 0.0)) + around;
}

void main() {
  vec3 p = iPositionM - vec3(0.0, 0.0, uEyeM);
  float distanceM = length(p);
  vec3 dir = p / distanceM;
  vec4 clip = uClipFromEnu * vec4(p, 1.0);
  gl_Position = vec4(clip.xy, clip.w, clip.w);  // as far as can be: behind all that an engine draws

  vCoordinate = sheetCoordinate(uSheet, iPositionM);
  vec3 inscatter, through;
  aerial(dir, distanceM, inscatter, through);
  vInscatter = vec4(inscatter, iAlpha);

  CloudDepths d = CloudDepths(0.0, 0.0, 0.5 * uSheet.typicalDepth, 0.5 * uSheet.typicalDepth);
  vec2 shares = cloudSkyShares(d);
  vec3 around = (skyAbove(uSheet.heightM) * shares.x + uGroundLight * shares.y) * through;
  vec3 key = keyLightAt(uSheet.heightM, iPositionM) * through;
#if WELKIN_TIER == 2
  vKey = key;
  vAround = around;
  vDirection = p;
#else
  float cosSun = dot(dir, uKeyDirection);
  float phase = phaseDroplet(cosSun, uDroplets);
  vSunny = sheetLight(0.1 * uSheet.typicalDepth, key, around, phase, cosSun, dir.z);
  vShade = sheetLight(uSheet.typicalDepth, key, around, phase, cosSun, dir.z);
#endif
}
