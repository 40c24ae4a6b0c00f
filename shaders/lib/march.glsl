// SPDX-License-Identifier: Apache-2.0
// The march: from the eye through the shells of all layers at once, over the curved earth.

uniform float uEyeM;              // height of the eye above the ground
uniform vec3 uKeyDirection;       // towards the light that lights the clouds, sun or moon
uniform vec3 uKeyIlluminance;     // at the top of the atmosphere, lux
uniform Atmosphere uAtmosphere;
uniform float uGroundAltitudeM;   // of the ground above mean sea level
uniform sampler2D uTransmittance;
uniform sampler3D uLightVolume;
uniform vec3 uSkyLow;             // mean luminance of the upper hemisphere of the clear sky at the ground
uniform vec3 uSkyHigh;            // the same at 10 km
uniform vec3 uGroundLight;        // luminance of the ground as clouds see it
uniform DropletPhase uDroplets;
uniform float uStepNearM;         // smallest step
uniform float uStepShare;         // step as a share of the distance
uniform float uStepLong;          // the longest step through clear air, in those of the above
uniform int uMaxSteps;
uniform int uSunSamples;          // density samples towards the sun before the light volume takes over
uniform float uSunReachM;         // how far they reach

struct CloudRay {
  vec3 luminance;       // scattered towards the eye, cd/m2
  float transmittance;
  float depthM;         // mean distance of what is seen
};

// The nearest crossing of the sphere at height h beyond t, if nearer than `next`.
void boundaryAt(float h, float b, float t, inout float next) {
  // r0^2 - r^2 without cancellation, and the stable form of both roots.
  float c = (uEyeM - h) * (2.0 * uEarthRadiusM + uEyeM + h);
  float disc = b * b - c;
  if (disc <= 0.0) return;
  float root = sqrt(disc);
  float q = b > 0.0 ? -b - root : -b + root;
  float other = abs(q) > 1e-6 ? c / q : 0.0;
  float t0 = min(q, other), t1 = max(q, other);
  if (t0 > t) next = min(next, t0);
  if (t1 > t) next = min(next, t1);
}

// Distance to the next crossing of any layer's base or top beyond t; -1: none.
float nextBoundary(vec3 dir, float t) {
  float b = (uEarthRadiusM + uEyeM) * dir.z;
  float next = 1e9;
#define WELKIN_LAYER_BOUNDARIES(i) boundaryAt(uLayers[i].baseM, b, t, next); boundaryAt(uLayers[i].topM, b, t, next);
  WELKIN_EACH_LAYER(WELKIN_LAYER_BOUNDARIES)
  return next > 1e8 ? -1.0 : next;
}

vec3 keyLightAt(float heightM, vec3 p) {
  vec3 up = normalize(vec3(p.x, p.y, p.z + uEarthRadiusM));
  return uKeyIlluminance *
         atmosphereTransmittance(uAtmosphere, uTransmittance, heightM + uGroundAltitudeM, dot(up, uKeyDirection));
}

// Source function at q: scattered radiance per unit extinction, cd/m2.
vec3 cloudSource(vec3 p, vec3 q, CloudPoint point, vec2 phases, float cosSun, float detail, float dither) {
  float near = 0.0;
  float done = 0.0;
  // Distances grow cubically: fine where shadows are sharp. Thin cloud has none that the light volume would miss.
  int samples = point.extinction * uSunReachM > 0.5 ? uSunSamples : 0;
  for (int i = 0; i < samples; ++i) {
    float x = (float(i) + 1.0) / float(uSunSamples);
    float end = uSunReachM * x * x * x;
    float at = mix(done, end, fract(dither + 0.382 * float(i)));
    vec3 s = cloudPosition(p + uKeyDirection * at, uEarthRadiusM);
    near += (end - done) * cloudsAt(s, i < 2 ? detail : 0.0).extinction;
    done = end;
    if (near > 15.0) break;
  }
  CloudDepths depths = cloudDepthsAt(uLightVolume, q, dither);
  vec3 beyond = cloudPosition(p + uKeyDirection * done, uEarthRadiusM);
  if (samples > 0) depths.toSun = near + cloudDepthsAt(uLightVolume, beyond, dither).toSun;
  float phase = mix(phases.x, phases.y, point.ice / point.extinction);
  vec3 source = keyLightAt(q.z, p) * cloudSunSource(depths, phase, cosSun, uKeyDirection.z);
  vec2 shares = cloudSkyShares(depths);
  return source + mix(uSkyLow, uSkyHigh, clamp(q.z / 10000.0, 0.0, 1.0)) * shares.x + uGroundLight * shares.y;
}

CloudRay marchClouds(vec3 dir, float endM, float pixelRad, float dither) {
  CloudRay ray = CloudRay(vec3(0.0), 1.0, 0.0);
  float weightedDepth = 0.0, weight = 0.0;
  float cosSun = dot(dir, uKeyDirection);
  vec2 phases = vec2(phaseDroplet(cosSun, uDroplets),
                     mix(phaseHenyeyGreenstein(cosSun, 0.92), phaseHenyeyGreenstein(cosSun, 0.55), 0.45));
  // Two loops, one in the other: the inner one finds the next sample in cloud, the outer one lights it. Pixels that are drawn
  // together then light together, however far apart their clouds are.
  float t = 0.0;
  float lastClear = 0.0;  // a place in front of the surface
  float entered = -1.0;   // where a long step last ended in a cloud
  int steps = 0;
  while (steps < uMaxSteps && t < endM) {
    vec3 p, q;
    CloudPoint point;
    float shortStep, detail;
    bool hit = false;
    while (steps < uMaxSteps && t < endM) {
      ++steps;
      p = vec3(0.0, 0.0, uEyeM) + dir * t;
      q = cloudPosition(p, uEarthRadiusM);
      detail = clamp(2.0 - 12.0 * t * pixelRad / 40.0, 0.0, 1.0);
      point = cloudsAt(q, detail);
      shortStep = max(uStepNearM, uStepShare * t);
      if (point.inside) shortStep = max(shortStep, point.stepM);
      float longStep = uStepLong * shortStep;
      if (!point.inside) {
        float next = nextBoundary(dir, t);
        if (next < 0.0) {
          t = endM;
          break;
        }
        lastClear = next;
        t = next + shortStep * (0.02 + dither);
      } else if (point.extinction <= 0.0) {
        lastClear = t;
        t += clamp(2.2 * point.clearM, shortStep, longStep);
      } else if (t - lastClear > 1.6 * shortStep && lastClear >= entered) {
        // A long step ended in a cloud: back to find its surface with short ones.
        entered = t;
        t = lastClear + shortStep * (0.3 + dither);
      } else {
        hit = true;
        break;
      }
    }
    if (!hit) break;
    float through = exp(-point.extinction * shortStep);
    float share = ray.transmittance * (1.0 - through);
    vec3 source = cloudSource(p, q, point, phases, cosSun, detail, dither);
    ray.luminance += share * source;
    weightedDepth += share * t;
    weight += share;
    ray.transmittance *= through;
    if (ray.transmittance < 0.01) {
      // What is left would look like what was seen.
      ray.luminance /= 1.0 - ray.transmittance;
      ray.transmittance = 0.0;
      break;
    }
    t += shortStep;
  }
  if (weight > 0.0) ray.depthM = weightedDepth / weight;
  return ray;
}
