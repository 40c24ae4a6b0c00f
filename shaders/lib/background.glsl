// SPDX-License-Identifier: Apache-2.0
// What lies behind the clouds: the clear sky with its discs, or the ground.
//
// Needs lib/sky_uniforms.glsl before it, and two functions of the pass, float groundSunlight(vec2 q) and float groundSkylight(vec2 q): the shares of
// the key light that clouds let through to the ground at q, and of the mean light of sky and clouds that it has there. WELKIN_BEYOND: with stars, planets or Milky Way. With lib/air_shadows.glsl before it (WELKIN_AIR_SHADOWS) volumes cast shadows in
// the air too; so they do where the pass has them from pass/live_air in a vec4 airShadows (WELKIN_AIR_SHADOWS_KNOWN).

#include "lib/eclipse.glsl"
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
uniform float uSunHidden;         // share of the light of the sun's disc that the moon keeps from the eye
uniform vec4 uEarthShadow;        // where the moon's middle is in it, and its radius, as lib/eclipse.glsl has them; w = 0: outside
uniform float uEarthOverSun;      // radius of the earth's disc seen from the moon, in the sun's
uniform vec3 uMoonShare;          // of its light that the earth leaves, mean over the disc
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

// What the moon leaves of the share of a pixel that the sun has. Both edges are straight in a pixel: where they face the same way the moon
// hides the same side that the sun has, where they face each other the other one.
float sunLeft(vec3 dir, float sun, float pixelRad) {
  vec3 fromSun = dir - uSunDirection, fromMoon = dir - uMoonDirection;
  float moon = discCover(length(fromMoon), max(uMoonRadius, 0.75 * pixelRad), pixelRad);
  float facing = clamp(2.0 * dot(fromSun, fromMoon) / max(length(fromSun) * length(fromMoon), 1e-12), -1.0, 1.0);
  float across = sun * (1.0 - moon);
  return facing > 0.0 ? mix(across, max(sun - moon, 0.0), facing) : mix(across, min(sun, 1.0 - moon), -facing);
}

// The corona about the eclipsed sun, as far as the moon does not hide it.
vec3 corona(vec3 dir, float pixelRad) {
  float seen = 1.0 - discCover(length(dir - uMoonDirection), max(uMoonRadius, 0.75 * pixelRad), pixelRad);
  float r = max(length(dir - uSunDirection) / uSunRadius, 1.0);
  return uSunLuminance * (uSunHidden * seen * coronaLuminance(r));
}

// The sun's disc with its limb darkening (lib/eclipse.glsl), mean 1 over it.
vec3 sunDisc(vec3 dir, float pixelRad) {
  // Where pixels are as large as the disc there is no limb to see, and darkening the widened edge would lose light.
  float pixels = uSunRadius / pixelRad;
  float exponent = kSunLimb * smoothstep(1.0, 6.0, pixels);
  Disc disc = discAt(dir, uSunDirection, uSunRadius, pixelRad);
  float limb = pow(max(1.0 - disc.x * disc.x, 0.02), 0.5 * exponent) * (0.5 * exponent + 1.0);
  if (uSunHidden <= 0.0) return uSunLuminance * (disc.share * limb);
  float edge = discCover(length(dir - uSunDirection), max(uSunRadius, 0.75 * pixelRad), pixelRad);
  float left = edge > 0.0 ? sunLeft(dir, edge, pixelRad) / edge : 0.0;
  vec3 seen = uSunLuminance * (disc.share * limb * left) + corona(dir, pixelRad);
  // In pixels too large for a crescent all of the disc has its light, and the corona's.
  vec3 even = uSunLuminance * (disc.share * (1.0 - uSunHidden + uSunHidden * kCoronaShare));
  return mix(even, seen, smoothstep(0.75, 1.5, pixels));
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
  vec3 luminance = uMoonLuminance * (lit + disc.share * kEarthshine);
  if (uEarthShadow.w <= 0.0) return luminance;
  return luminance * mix(uMoonShare, sunOnMoon(length(vec3(uEarthShadow) + uEarthShadow.w * across), uEarthOverSun), fine);
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

// What the air over all clouds adds to the clear sky of their light.
vec3 overCloudsInSky(vec3 dir) {
  if (uOverClouds.x + uOverClouds.y + uOverClouds.z <= 0.0) return vec3(0.0);
  vec3 inscatter, through = vec3(1.0);
  if (uEyeM < uOverClouds.w) aerialLit(dir, sphereCrossings(uOverClouds.w, dir.z).y, inscatter, through);
  vec3 beyond = atmosphereTransmittance(uAtmosphere, uTransmittance, uEyeM + uGroundAltitudeM, dir.z);
  return vec3(uOverClouds) * max(through - beyond, 0.0);
}

vec3 skyLuminance(vec3 dir) {
  vec3 sky = atmosphereSkyLuminance(uAtmosphere, uSkyView, uEyeM + uGroundAltitudeM, dir, uKeyDirection);
#if defined(WELKIN_AIR_SHADOWS_KNOWN)
  sky = max(sky - vec3(airShadows), 0.0);
#elif defined(WELKIN_AIR_SHADOWS)
  sky = max(sky - shadowsInSky(dir), 0.0);
#endif
  return sky + overCloudsInSky(dir);
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
