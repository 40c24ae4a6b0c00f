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
uniform float uDropletDiameterUm;
uniform float uStepNearM;         // smallest step
uniform float uStepShare;         // step as a share of the distance
uniform int uMaxSteps;
uniform int uSunSamples;          // density samples towards the sun before the light volume takes over
uniform float uSunReachM;         // how far they reach

struct CloudRay {
  vec3 luminance;       // scattered towards the eye, cd/m2
  float transmittance;
  float depthM;         // mean distance of what is seen
};

// Distance to the next crossing of any layer's base or top beyond t; -1: none.
float nextBoundary(vec3 dir, float t) {
  float r0 = uEarthRadiusM + uEyeM;
  float b = r0 * dir.z;
  float next = 1e9;
  for (int i = 0; i < uLayerCount; ++i) {
    for (int side = 0; side < 2; ++side) {
      float h = side == 0 ? uLayers[i].baseM : uLayers[i].topM;
      // r0^2 - r^2 without cancellation.
      float c = (uEyeM - h) * (2.0 * uEarthRadiusM + uEyeM + h);
      float disc = b * b - c;
      if (disc <= 0.0) continue;
      float root = sqrt(disc);
      // The stable form of both roots.
      float q = b > 0.0 ? -b - root : -b + root;
      float t0 = min(q, c / q), t1 = max(q, c / q);
      if (t0 > t) next = min(next, t0);
      if (t1 > t) next = min(next, t1);
    }
  }
  return next > 1e8 ? -1.0 : next;
}

vec3 keyLightAt(float heightM, vec3 p) {
  vec3 up = normalize(vec3(p.x, p.y, p.z + uEarthRadiusM));
  return uKeyIlluminance *
         atmosphereTransmittance(uAtmosphere, uTransmittance, heightM + uGroundAltitudeM, dot(up, uKeyDirection));
}

// Source function at q: scattered radiance per unit extinction, cd/m2.
vec3 cloudSource(vec3 p, vec3 q, vec2 phases, float ice, float cosSun, float detail, float dither) {
  float near = 0.0;
  float done = 0.0;
  // Distances grow cubically: fine where shadows are sharp.
  for (int i = 0; i < uSunSamples; ++i) {
    float x = (float(i) + 1.0) / float(uSunSamples);
    float end = uSunReachM * x * x * x;
    float at = mix(done, end, 0.5);
    vec3 s = cloudPosition(p + uKeyDirection * at, uEarthRadiusM);
    near += (end - done) * cloudsExtinction(s, i < 2 ? detail : 0.0);
    done = end;
    if (near > 40.0) break;
  }
  CloudDepths depths = cloudDepthsAt(uLightVolume, q, dither);
  vec3 beyond = cloudPosition(p + uKeyDirection * done, uEarthRadiusM);
  CloudDepths far = cloudDepthsAt(uLightVolume, beyond, dither);
  depths.toSun = near + far.toSun;
  float phase = mix(phases.x, phases.y, ice);
  vec3 source = keyLightAt(q.z, p) * cloudSunSource(depths, phase, cosSun, uKeyDirection.z);
  vec2 shares = cloudSkyShares(depths);
  return source + mix(uSkyLow, uSkyHigh, clamp(q.z / 10000.0, 0.0, 1.0)) * shares.x + uGroundLight * shares.y;
}

CloudRay marchClouds(vec3 dir, float endM, float pixelRad, float dither) {
  CloudRay ray = CloudRay(vec3(0.0), 1.0, 0.0);
  float weightedDepth = 0.0, weight = 0.0;
  float cosSun = dot(dir, uKeyDirection);
  vec2 phases = vec2(phaseDroplet(cosSun, dropletPhase(uDropletDiameterUm)),
                     mix(phaseHenyeyGreenstein(cosSun, 0.92), phaseHenyeyGreenstein(cosSun, 0.55), 0.45));
  float t = 0.0;
  float step = 0.0;
  for (int n = 0; n < uMaxSteps; ++n) {
    vec3 p = vec3(0.0, 0.0, uEyeM) + dir * t;
    vec3 q = cloudPosition(p, uEarthRadiusM);
    float shortest = max(uStepNearM, uStepShare * t);
    float detail = clamp(2.0 - 12.0 * t * pixelRad / 40.0, 0.0, 1.0);
    float extinction = 0.0, ice = 0.0, clear = 1e9;
    bool inside = false;
    for (int i = 0; i < uLayerCount; ++i) {
      if (q.z < uLayers[i].baseM || q.z > uLayers[i].topM) continue;
      inside = true;
      float clearM;
      float e = cloudExtinction(uLayers[i], uPlacement, uShapeNoise, uDetailNoise, q, detail, clearM);
      extinction += e;
      ice += e * uLayerIce[i];
      clear = min(clear, clearM);
    }
    if (!inside) {
      float next = nextBoundary(dir, t);
      if (next < 0.0 || next >= endM) break;
      t = next + max(uStepNearM, uStepShare * next) * (0.02 + dither);
      continue;
    }
    step = shortest;
    if (extinction > 0.0) {
      float through = exp(-extinction * step);
      float share = ray.transmittance * (1.0 - through);
      vec3 source = cloudSource(p, q, phases, ice / extinction, cosSun, detail, dither);
      ray.luminance += share * source;
      weightedDepth += share * t;
      weight += share;
      ray.transmittance *= through;
      if (ray.transmittance < 0.005) {
        ray.transmittance = 0.0;
        break;
      }
    } else {
      step = clamp(clear, shortest, max(6.0 * shortest, 400.0));
    }
    t += step;
    if (t >= endM) break;
  }
  if (weight > 0.0) ray.depthM = weightedDepth / weight;
  return ray;
}
