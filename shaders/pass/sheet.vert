// SPDX-License-Identifier: Apache-2.0
// A thin layer's mesh about the eye. What changes slowly over the sky is computed here, at the vertices: air between, and the light
// of the sheet where it is thin and thick, from its sunny and its shady side.

#include "lib/phase.glsl"
#include "lib/eclipse.glsl"
#include "lib/atmosphere.glsl"
#include "lib/sky_uniforms.glsl"
#include "lib/cloud_light.glsl"
#include "lib/sheet.glsl"
#include "lib/sheet_light.glsl"

layout(location = 0) in vec3 iPositionM;  // from the ground under the eye, z up
layout(location = 1) in float iAlpha;     // 0 at the rim

uniform mat4 uClipFromEnu;                // directions east-north-up from the eye to clip space
uniform Sheet uSheet;
uniform float uScale;                     // written value for each cd/m2
uniform DropletPhase uDroplets;
uniform float uSunOnSheet;                // share of the key light that sheets above let through
uniform vec3 uSkyOnSheet;                 // mean luminance of the sky over it, cd/m2

uniform float uTexelsPerPixel;            // of the pattern, seen square on at a distance of 1 m

out vec4 vCoordinate;                     // of the pattern; w: the most that is hidden here
#if WELKIN_TIER == 0
out vec3 vLight;                          // luminance of cloud as it arrives, with what the air in front adds, cd/m2
#elif WELKIN_TIER == 1
out vec3 vShade;                          // the same of the shady side
out vec3 vGain;                           // sunny over shady
#else
out vec3 vInscatter;                      // by the air in front, cd/m2
out vec3 vKey;                            // illuminance of the sheet that arrives at the eye's side of the air, lux
out vec3 vAround;                         // radiance from all other directions, as it arrives
out vec4 vDirection;                      // from the eye; not normalised; w: level of the pattern's mipmaps
#endif

void main() {
  vec3 p = iPositionM - vec3(0.0, 0.0, uEyeM);
  float distanceM = length(p);
  vec3 dir = p / distanceM;
  vec4 clip = uClipFromEnu * vec4(p, 1.0);
  gl_Position = vec4(clip.xy, clip.w, clip.w);  // as far as can be: behind all that an engine draws

  vCoordinate = vec4(sheetCoordinate(uSheet, iPositionM), uSheet.bias * iAlpha);
  vec3 inscatter, through;
  aerial(dir, distanceM, inscatter, through);
  inscatter *= uScale;
  through *= uScale;

  vec3 around = sheetAround(uSheet, uSkyOnSheet, uGroundLight) * through;
  vec3 key = uSunOnSheet * sheetKey(uSheet, keyLightAt(uSheet.heightM, iPositionM)) * through;
#if WELKIN_TIER == 2
  vInscatter = inscatter;
  vKey = key;
  vAround = around;
  vDirection = vec4(p, sheetWayLevel(uTexelsPerPixel, distanceM));
#else
  float cosSun = dot(dir, uKeyDirection);
  float phase = phaseDroplet(cosSun, uDroplets);
  vec3 sunny = sheetSide(uSheet, true, key, around, phase, cosSun, dir.z, uKeyDirection.z) + inscatter;
  vec3 shade = sheetSide(uSheet, false, key, around, phase, cosSun, dir.z, uKeyDirection.z) + inscatter;
#if WELKIN_TIER == 0
  vLight = 0.5 * (sunny + shade);
#else
  vShade = shade;
  vGain = sunny - shade;
#endif
#endif
}
