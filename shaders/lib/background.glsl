// SPDX-License-Identifier: Apache-2.0
// What lies behind the clouds: the clear sky with its discs, or the ground.
//
// Needs lib/sky_uniforms.glsl before it, and two functions of the pass, float groundSunlight(vec2 q) and float groundSkylight(vec2 q): the shares of
// the key light that clouds let through to the ground at q, and of the mean light of sky and clouds that it has there. WELKIN_BEYOND: with stars, planets or Milky Way. With lib/air_shadows.glsl before it (WELKIN_AIR_SHADOWS) volumes cast shadows in
// the air too; so they do where the pass has them from pass/live_air in a vec4 airShadows (WELKIN_AIR_SHADOWS_KNOWN).

#include "lib/ground.glsl"
#include "lib/milky_way.glsl"
#include "lib/moon.glsl"
#include "lib/stars.glsl"

uniform vec3 uGroundAlbedo;
uniform vec3 uSkyOnGround;        // illuminance of the ground by the sky, clouds included, lux
uniform float uDiscs;             // 1: draw the discs
uniform vec3 uSunLuminance;       // mean over the disc, above the atmosphere, cd/m2
uniform float uSunRadius;         // rad
uniform vec3 uMoonLuminance;      // of what lib/moon.glsl has shares of
uniform float uMoonRadius;
#ifdef WELKIN_BEYOND
uniform mat3 uCelestialFromEnu;
uniform sampler2D uMilkyWay;      // lib/milky_way.glsl
// Shares of the stars' and of the Milky Way's light that are drawn, number of planets; of each planet its direction and least radius,
// rad, then its illuminance above the atmosphere, lux, and how many magnitudes it is brighter than V = 4.5.
uniform sampler2D uPlanets;
uniform sampler2D uStars;         // lib/stars.glsl
uniform int uStarCells;
#endif
#ifdef WELKIN_SKY_BOX
uniform samplerCube uSkyBox;      // in the place of the clear sky
uniform mat3 uBoxFromEnu;
uniform float uBoxScale;          // cd/m2 for each unit of it
uniform float uBoxTexelsPerRad;   // in the middle of a face
uniform float uBoxGround;         // 1: the ground below the horizon, else the box
#endif

float groundDistance(vec3 dir) {
  float b = (uEarthRadiusM + uEyeM) * dir.z;
  float c = uEyeM * (2.0 * uEarthRadiusM + uEyeM);
  float disc = b * b - c;
  if (b >= 0.0 || disc <= 0.0) return 1e9;
  return c / (-b + sqrt(disc));
}

// A disc as pixels see it: at least a pixel and a half across and with an edge a pixel wide, as bright as keeps its light. So the
// sum over a picture, an environment map above all, is the disc's illuminance whatever the pixels' size.
struct Disc {
  float x;      // distance from the centre in radii
  float share;  // of luminance that is left
};

float discCover(float angle, float seen, float pixelRad) { return clamp((seen - angle) / pixelRad + 0.5, 0.0, 1.0); }

Disc discAt(vec3 dir, vec3 centre, float radius, float pixelRad) {
  float seen = max(radius, 0.75 * pixelRad);
  float angle = length(dir - centre);
  float edge = discCover(angle, seen, pixelRad);
  // A linear edge of width w about radius r holds r^2 + w^2 / 12 times pi.
  float area = (seen * seen + pixelRad * pixelRad / 12.0) / (radius * radius);
  return Disc(min(angle / seen, 1.0), edge / area);
}

// Limb darkening of the sun in the visible, D. Hestroffer and C. Magnan 1998 (exponent for 550 nm), mean 1 over the disc.
vec3 sunDisc(vec3 dir, float pixelRad) {
  // Where pixels are as large as the disc there is no limb to see, and darkening the widened edge would lose light.
  float exponent = 0.41 * smoothstep(1.0, 6.0, uSunRadius / pixelRad);
  Disc disc = discAt(dir, uSunDirection, uSunRadius, pixelRad);
  float limb = pow(max(1.0 - disc.x * disc.x, 0.02), 0.5 * exponent) * (0.5 * exponent + 1.0);
  return uSunLuminance * (disc.share * limb);
}

// The moon's disc: even where pixels are as large as it, so that it keeps its light, with its phase where they are smaller.
vec3 moonDisc(vec3 dir, float pixelRad) {
  if (length(dir - uMoonDirection) > uMoonRadius + 1.5 * pixelRad) return vec3(0.0);
  Disc disc = discAt(dir, uMoonDirection, uMoonRadius, pixelRad);
  float cosSun = dot(uSunDirection, uMoonDirection), pixels = uMoonRadius / pixelRad;
  vec2 phase = moonPhase(-cosSun);
  vec3 sunwards = normalize(uSunDirection - cosSun * uMoonDirection + 1e-9);
  vec3 across = (dir - uMoonDirection) / uMoonRadius;
  vec2 at = vec2(dot(across, sunwards), dot(across, cross(uMoonDirection, sunwards)));
  float fine = smoothstep(1.0, 2.0, pixels), lit = (1.0 - fine) * disc.share * moonMean(phase);
  if (fine > 0.0) lit += fine * moonSquare(at, 1.0 / pixels, phase);
  return uMoonLuminance * (lit + disc.share * kEarthshine);
}

// Stars, planets and the Milky Way above the atmosphere, behind the moon.
vec3 starsBeyond(vec3 dir, float pixelRad) {
#ifdef WELKIN_BEYOND
  vec4 shares = texelFetch(uPlanets, ivec2(0, 0), 0);
  vec3 celestial = uCelestialFromEnu * dir;
  vec3 sum = shares.x * starLuminance(uStars, uStarCells, celestial, pixelRad);
  sum += shares.y * vec3(textureLod(uMilkyWay, milkyWayAt(celestial), 0.0));
  int planets = int(shares.z);
  for (int p = 0; p < planets; ++p) {
    vec4 place = texelFetch(uPlanets, ivec2(2 * p + 1, 0), 0), light = texelFetch(uPlanets, ivec2(2 * p + 2, 0), 0);
    sum += vec3(light) * planetShare(dir - vec3(place), light.w, place.w, pixelRad);
  }
  return sum * (1.0 - uDiscs * discCover(length(dir - uMoonDirection), max(uMoonRadius, 0.75 * pixelRad), pixelRad));
#else
  return vec3(0.0);
#endif
}

vec3 groundLuminance(vec3 dir, float distanceM) {
  vec3 p = vec3(0.0, 0.0, uEyeM) + dir * distanceM;
  vec3 q = cloudPosition(p, uEarthRadiusM);
  vec3 up = normalize(vec3(p.x, p.y, p.z + uEarthRadiusM));
  float incidence = max(dot(up, uKeyDirection), 0.0);
  vec3 light = keyLightAt(0.0, p) * (incidence * groundSunlight(vec2(q))) + uSkyOnGround * groundSkylight(vec2(q));
  vec3 albedo = groundAlbedoAt(uGroundAlbedo, uPlacement, vec2(q));
  return albedo * light / 3.14159265;
}

vec3 groundThroughAir(vec3 dir, float groundM) {
  vec3 inscatter, through;
#if defined(WELKIN_AIR_SHADOWS_KNOWN)
  aerialLit(dir, groundM, inscatter, through);
  inscatter = shadedAir(dir, inscatter, through, airShadows.w, lightAboutAir(dir, groundM));
#elif defined(WELKIN_AIR_SHADOWS)
  aerialShaded(dir, groundM, inscatter, through);
#else
  aerial(dir, groundM, inscatter, through);
#endif
  return groundLuminance(dir, groundM) * through + inscatter;
}

vec3 skyLuminance(vec3 dir) {
  vec3 sky = atmosphereSkyLuminance(uAtmosphere, uSkyView, uEyeM + uGroundAltitudeM, dir, uKeyDirection);
#if defined(WELKIN_AIR_SHADOWS_KNOWN)
  sky = max(sky - vec3(airShadows), 0.0);
#elif defined(WELKIN_AIR_SHADOWS)
  sky = max(sky - shadowsInSky(dir), 0.0);
#endif
  return sky;
}

vec3 throughAtmosphere(vec3 dir, vec3 sky, vec3 beyond) {
  if (beyond.x + beyond.y <= 0.0) return sky;
  return sky + beyond * atmosphereTransmittance(uAtmosphere, uTransmittance, uEyeM + uGroundAltitudeM, dir.z);
}

vec3 backgroundLuminance(vec3 dir, float groundM, float pixelRad) {
#ifdef WELKIN_SKY_BOX
  if (groundM >= 1e8 || uBoxGround < 0.5)
    return uBoxScale * textureLod(uSkyBox, uBoxFromEnu * dir, log2(max(uBoxTexelsPerRad * pixelRad, 1.0))).xyz;
#endif
  if (groundM < 1e8) return groundThroughAir(dir, groundM);
  vec3 sky = skyLuminance(dir), beyond = starsBeyond(dir, pixelRad);
  if (uDiscs > 0.5) beyond += sunDisc(dir, pixelRad) + moonDisc(dir, pixelRad);
  return throughAtmosphere(dir, sky, beyond);
}
