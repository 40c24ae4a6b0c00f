// SPDX-License-Identifier: Apache-2.0
// The eye, the air and the lights of a frame as uniforms, for all that is drawn in a sky.
//
// Frame: east-north-up, metres; p from the ground under the eye. Needs lib/atmosphere.glsl before it.

uniform float uEyeM;              // height of the eye above the ground
uniform float uEarthRadiusM;      // to the ground
uniform vec3 uSunDirection;
uniform vec3 uMoonDirection;
uniform vec3 uKeyDirection;       // towards the light that lights the clouds, sun or moon
uniform float uKeyCounts;         // by how much it counts from where that comes: less while sun and moon change places
uniform float uKeyShown;          // how much of its light volumes get
uniform sampler2D uKeyLight;      // its illuminance through the air, lux, by height and by the sine of its elevation
uniform float uKeyLightTopM;      // height of the table's end
uniform float uKeyLightReach;     // sines are those at the eye +- this
uniform Atmosphere uAtmosphere;
uniform float uGroundAltitudeM;   // of the ground above mean sea level
uniform sampler2D uTransmittance;
uniform vec3 uGroundLight;        // luminance of the ground as clouds see it
// Moments of light from many directions over 2 pi. x: of the luminance, yzw: of it times the direction.
struct LightMoments {
  vec4 red, green, blue;
};
WELKIN_FIXED uniform LightMoments uAboveLight[3];  // from above the horizon at the ground, at 2 km, at 10 km
WELKIN_FIXED uniform LightMoments uBelowLight[2];  // from below it, air and ground, at 2 km, at 10 km
uniform sampler2D uSkyView;
uniform sampler3D uAerialInscatter;
uniform sampler3D uAerialTransmittance;
uniform float uClearAir;          // share of the lower air that the sun reaches
uniform float uAirUnderSheets;    // of what thin sheets alone leave, the share of it
uniform LightMoments uHaze;       // luminance that hazy air about the eye tends to where it does not: lightTowards()
uniform LightMoments uCloudGlow;  // by how much clouds make it brighter than it is without them
uniform vec4 uOverClouds;         // and the air over them all: luminance that it tends to, w: from which height on

// The light that reaches p through the air, tabulated over height and over how high the light stands there: the earth's curve makes it
// day over some clouds and dusk over others.
vec3 lightAt(sampler2D table, vec3 direction, float heightM, vec3 p) {
  float more = dot(vec2(p), vec2(direction)) / uEarthRadiusM;  // of the sine
  return vec3(textureLod(table, vec2(heightM / uKeyLightTopM, 0.5 + 0.5 * more / uKeyLightReach), 0.0));
}
vec3 keyLightAt(float heightM, vec3 p) { return lightAt(uKeyLight, uKeyDirection, heightM, p); }

#ifdef WELKIN_SECOND_LIGHT
uniform vec3 uSecondDirection;    // towards the other one of sun and moon, where it is seen on clouds
uniform sampler2D uSecondLight;   // as uKeyLight
#endif

// What the air between the eye and a distance adds in the sun, and what it lets through.
void aerialLit(vec3 dir, float distanceM, out vec3 inscatter, out vec3 through) {
  atmosphereAerial(uAtmosphere, uAerialInscatter, uAerialTransmittance, uEyeM + uGroundAltitudeM, dir, uKeyDirection,
                   distanceM, inscatter, through);
}

// What air that scatters forward adds in a direction. x: the mean over all directions, yzw: what is linear in them.
vec3 lightTowards(LightMoments light, vec3 dir) {
  vec4 w = vec4(1.0, dir);
  vec3 mean = vec3(light.red.x, light.green.x, light.blue.x);
  return max(vec3(dot(light.red, w), dot(light.green, w), dot(light.blue, w)), 0.2 * mean);
}

// What it adds between two distances where the sun reaches a share of it: air in the shade of clouds has the light about it alone, `about` in that
// on average; in the sun, a share of it (glow) has the light of the clouds about it too, and the rest, over them all, has theirs from below.
vec3 airBetween(vec3 dir, vec3 nearLit, vec3 nearThrough, vec3 farLit, vec3 farThrough, float lit, float glow, float about) {
  vec3 scattered = nearThrough - farThrough;
  return mix(about * scattered * lightTowards(uHaze, dir), farLit - nearLit + scattered * mix(vec3(uOverClouds), lightTowards(uCloudGlow, dir), glow), lit);
}
vec3 shadedAir(vec3 dir, vec3 inscatter, vec3 through, float lit, float about) {
  return airBetween(dir, vec3(0.0), vec3(1.0), inscatter, through, lit, 1.0, about);
}

// The same by the mean share.
void aerial(vec3 dir, float distanceM, out vec3 inscatter, out vec3 through) {
  aerialLit(dir, distanceM, inscatter, through);
  inscatter = shadedAir(dir, inscatter, through, uClearAir, 1.0);
}

// Where a ray crosses the sphere at height h: x before, y behind its lowest point; x > y: not at all. Without cancellation.
vec2 sphereCrossings(float h, float dirZ) {
  float b = (uEarthRadiusM + uEyeM) * dirZ;
  float c = (uEyeM - h) * (2.0 * uEarthRadiusM + uEyeM + h);  // r0^2 - r^2
  float disc = b * b - c;
  if (disc <= 0.0) return vec2(1.0, -1.0);
  float root = sqrt(disc);
  float q = b > 0.0 ? -b - root : -b + root;
  float other = abs(q) > 1e-6 ? c / q : 0.0;
  return vec2(min(q, other), max(q, other));
}
