// SPDX-License-Identifier: Apache-2.0
// A thin layer of cloud, premultiplied with its opacity. WELKIN_TIER: 0 flat, 1 embossed, 2 lit. WELKIN_PATTERN_3D: the pattern is a
// volume.

#if WELKIN_TIER == 2
#include "lib/phase.glsl"
#include "lib/cloud_light.glsl"
uniform DropletPhase uDroplets;
uniform vec3 uKeyDirection;
#endif
#include "lib/sheet.glsl"

uniform Sheet uSheet;
uniform vec3 uSunStep;    // towards the sun in the pattern: embossed, so long that a slope of 1/2 is wholly sunny; lit, to where light leaves the sheet
#if WELKIN_PATTERN_3D
uniform sampler3D uPattern;
#define WELKIN_COORDINATE(v) vec3(v)
#else
uniform sampler2D uPattern;
#define WELKIN_COORDINATE(v) vec2(v)
#endif

in vec4 vCoordinate;      // of the pattern; w: the most that is hidden here
#if WELKIN_TIER == 0
in vec3 vLight;
#elif WELKIN_TIER == 1
in vec3 vShade;
in vec3 vGain;
#else
in vec3 vInscatter;
in vec3 vKey;
in vec3 vAround;
in vec4 vDirection;       // w: level of the pattern's mipmaps for the way to the sun
#endif

layout(location = 0) out vec4 outColor;

void main() {
  vec4 texel = texture(uPattern, WELKIN_COORDINATE(vCoordinate));
  float depth = sheetDepth(uSheet, texel.x);
  float alpha = vCoordinate.w - vCoordinate.w * exp(-depth);
#if WELKIN_TIER == 0
  vec3 light = vLight;
#elif WELKIN_TIER == 1
  // The sheet's side that falls off towards the sun is its sunny side. The texels hold the slopes.
  float sunny = clamp(0.5 - dot(WELKIN_COORDINATE(texel.yzw), WELKIN_COORDINATE(uSunStep)), 0.0, 1.0);
  vec3 light = vShade + sunny * vGain;
#else
  // Depth on the way to the sun, which rises through the sheet while it crosses the pattern: at 1/6, 1/2 and 5/6 of it, squared, weighted
  // by what of the sheet's thickness is still above.
  float level = floor(vDirection.w);
  float toSun = 0.45 * sheetDepth(uSheet, textureLod(uPattern, WELKIN_COORDINATE(vCoordinate.xyz + 0.028 * uSunStep), level).x) +
                0.36 * sheetDepth(uSheet, textureLod(uPattern, WELKIN_COORDINATE(vCoordinate.xyz + 0.25 * uSunStep), level).x) +
                0.19 * sheetDepth(uSheet, textureLod(uPattern, WELKIN_COORDINATE(vCoordinate.xyz + 0.694 * uSunStep), level).x);
  float sine = max(abs(uKeyDirection.z), 0.05);
  toSun *= 0.5 / sine;
  vec3 dir = normalize(vDirection.xyz);
  float cosSun = dot(dir, uKeyDirection);
  CloudDepths d = CloudDepths(toSun, 0.5 * depth / sine, 0.5 * depth, 0.5 * depth);
  vec3 light = vKey * cloudSunSource(d, phaseDroplet(cosSun, uDroplets), cosSun, dir.z, max(uKeyDirection.z, 0.0)) + vAround +
               vInscatter;
#endif
  outColor = vec4(light, 1.0) * alpha;
}
