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
uniform vec3 uSkyLow;             // mean luminance of the upper hemisphere of the clear sky at the ground
uniform vec3 uSkyHigh;            // the same at 10 km
uniform vec3 uGroundLight;        // luminance of the ground as clouds see it
uniform sampler2D uSkyView;
uniform sampler3D uAerialInscatter;
uniform sampler3D uAerialTransmittance;
uniform float uClearAir;          // share of the lower air that the sun reaches
uniform vec3 uHazeLuminance;      // mean luminance about the eye where it does not: what hazy air there tends to

// The light that reaches p through the air, tabulated over height and over how high the light stands there: the earth's curve makes it
// day over some clouds and dusk over others.
vec3 keyLightAt(float heightM, vec3 p) {
  float sine = uKeyDirection.z + dot(vec2(p), vec2(uKeyDirection)) / uEarthRadiusM;
  return vec3(textureLod(uKeyLight, vec2(heightM / uKeyLightTopM, 0.5 + 0.5 * (sine - uKeyDirection.z) / uKeyLightReach), 0.0));
}

// What the air between the eye and a distance adds, and what it lets through.
void aerial(vec3 dir, float distanceM, out vec3 inscatter, out vec3 through) {
  atmosphereAerial(uAtmosphere, uAerialInscatter, uAerialTransmittance, uEyeM + uGroundAltitudeM, dir, uKeyDirection,
                   distanceM, inscatter, through);
  // Air in the shade of clouds is lit from all sides alike.
  inscatter = mix((1.0 - through) * uHazeLuminance, inscatter, uClearAir);
}

// Mean radiance of what is not the key light, from above (sky) and below (ground) at a height.
vec3 skyAbove(float heightM) { return mix(uSkyLow, uSkyHigh, clamp(heightM / 10000.0, 0.0, 1.0)); }
