// SPDX-License-Identifier: Apache-2.0
// A thin layer of cloud, premultiplied with its opacity. WELKIN_TIER: 0 flat, 1 embossed, 2 lit. WELKIN_PATTERN_3D: the pattern is a
// volume.

#include "lib/phase.glsl"
#include "lib/cloud_light.glsl"
#include "lib/sheet.glsl"
#include "lib/sheet_light.glsl"

#if WELKIN_TIER == 2
uniform DropletPhase uDroplets;
uniform vec3 uKeyDirection;
#endif

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
  float sunny = sheetSunny(dot(WELKIN_COORDINATE(texel.yzw), WELKIN_COORDINATE(uSunStep)));
  vec3 light = vShade + sunny * vGain;
#else
  float level = floor(vDirection.w);
  vec3 way = vec3(textureLod(uPattern, WELKIN_COORDINATE(vCoordinate.xyz + kSheetWay.x * uSunStep), level).x,
                  textureLod(uPattern, WELKIN_COORDINATE(vCoordinate.xyz + kSheetWay.y * uSunStep), level).x,
                  textureLod(uPattern, WELKIN_COORDINATE(vCoordinate.xyz + kSheetWay.z * uSunStep), level).x);
  vec3 dir = normalize(vDirection.xyz);
  float cosSun = dot(dir, uKeyDirection);
  float toSun = sheetDepthToSun(uSheet, way, uKeyDirection.z);
  vec3 light = sheetLit(depth, toSun, vKey, vAround, phaseDroplet(cosSun, uDroplets), cosSun, dir.z, uKeyDirection.z) + vInscatter;
#endif
  outColor = vec4(light, 1.0) * alpha;
}
