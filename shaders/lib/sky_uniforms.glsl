// SPDX-License-Identifier: Apache-2.0
// The eye, the air and the lights of a frame as uniforms, for all that is drawn in a sky.
//
// Frame: east-north-up, metres; p from the ground under the eye. Needs lib/atmosphere.glsl before it.

uniform float uEyeM;              // height of the eye above the ground
uniform float uEarthRadiusM;      // to the ground
uniform vec3 uKeyDirection;       // towards the light that lights the clouds, sun or moon
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
uniform LightMoments uAboveLight[3];  // from above the horizon at the ground, at 2 km, at 10 km
uniform LightMoments uBelowLight[2];  // from below it, air and ground, at 2 km, at 10 km
uniform sampler2D uSkyView;
uniform sampler3D uAerialInscatter;
uniform sampler3D uAerialTransmittance;
uniform float uClearAir;          // share of the lower air that the sun reaches
uniform float uAirUnderSheets;    // of what thin sheets alone leave, the share of it
uniform vec3 uHazeLuminance;      // mean luminance about the eye where it does not: what hazy air there tends to
uniform vec3 uCloudGlow;          // by how much clouds make it brighter than it is without them

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

// What it adds between two distances where the sun reaches a share of it: air in the shade of clouds is lit from all sides alike; in the sun,
// a share of it (glow) has the light of the clouds too.
vec3 airBetween(vec3 nearLit, vec3 nearThrough, vec3 farLit, vec3 farThrough, float lit, float glow) {
  vec3 scattered = nearThrough - farThrough;
  return mix(scattered * uHazeLuminance, farLit - nearLit + scattered * (glow * uCloudGlow), lit);
}
vec3 shadedAir(vec3 inscatter, vec3 through, float lit) { return airBetween(vec3(0.0), vec3(1.0), inscatter, through, lit, 1.0); }

// The same by the mean share.
void aerial(vec3 dir, float distanceM, out vec3 inscatter, out vec3 through) {
  aerialLit(dir, distanceM, inscatter, through);
  inscatter = shadedAir(inscatter, through, uClearAir);
}

// Light of clouds as it arrives through air, of what they hide. Haze scatters mostly forward: a part of what it takes from a ray is as if it had
// not been turned, for there is cloud about the ray too. In the place of that is the mean light about the eye that the air has been given.
const float kHazeForward = 0.3;
vec3 cloudsThroughAir(vec3 luminance, float hidden, vec3 through) {
  float red = max(through.x, 1e-4);  // haze takes as much of all colours, molecules little of red
  return luminance * through + (pow(red, -kHazeForward) - 1.0) * through * (luminance - hidden * uHazeLuminance);
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
