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
uniform vec3 uSunStep;    // towards the sun in the pattern: to the embossing's neighbour, or to the far end of the way through the sheet
uniform float uEmboss;    // how steep a slope is wholly sunny or shady, per unit of pattern
uniform float uScale;     // written value for each cd/m2
#if WELKIN_PATTERN_3D
uniform sampler3D uPattern;
#define WELKIN_COORDINATE(v) (v)
#else
uniform sampler2D uPattern;
#define WELKIN_COORDINATE(v) vec2(v)
#endif

in vec3 vCoordinate;
in vec4 vInscatter;
#if WELKIN_TIER == 2
in vec3 vKey;
in vec3 vAround;
in vec3 vDirection;
#else
in vec3 vShade;
in vec3 vSunny;
#endif

layout(location = 0) out vec4 outColor;

void main() {
  float pattern = texture(uPattern, WELKIN_COORDINATE(vCoordinate)).x;
  float depth = sheetDepth(uSheet, pattern);
  float alpha = sheetOpacity(uSheet, depth) * vInscatter.w;
#if WELKIN_TIER == 0
  vec3 light = mix(vSunny, vShade, 0.5);
#elif WELKIN_TIER == 1
  // The sheet's side that falls off towards the sun is its sunny side.
  float slope = pattern - texture(uPattern, WELKIN_COORDINATE(vCoordinate + uSunStep)).x;
  vec3 light = mix(vShade, vSunny, clamp(0.5 + uEmboss * slope, 0.0, 1.0));
#else
  // Depth on the way to the sun, which rises through the sheet while it crosses the pattern.
  const int kSteps = 4;
  float toSun = 0.0;
  float weights = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    float x = (float(i) + 0.5) / float(kSteps);
    float above = 1.0 - x * x;  // share of the sheet's thickness still above the way
    toSun += above * sheetDepth(uSheet, texture(uPattern, WELKIN_COORDINATE(vCoordinate + uSunStep * (x * x))).x);
    weights += above;
  }
  float sine = max(abs(uKeyDirection.z), 0.05);
  toSun *= 0.5 / (weights * sine);
  vec3 dir = normalize(vDirection);
  float cosSun = dot(dir, uKeyDirection);
  CloudDepths d = CloudDepths(toSun, 0.5 * depth / sine, 0.5 * depth, 0.5 * depth);
  vec3 light = vKey * cloudSunSource(d, phaseDroplet(cosSun, uDroplets), cosSun, dir.z, max(uKeyDirection.z, 0.0)) + vAround;
#endif
  outColor = vec4((light + vInscatter.xyz) * (alpha * uScale), alpha);
}
