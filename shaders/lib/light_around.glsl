// SPDX-License-Identifier: Apache-2.0
// Light from above and from below the horizon that a point in a cloud scatters towards an eye that looks along a direction: where cloud is thin
// beyond the point it goes on much as it came, and what lies behind the cloud counts most, above all near the horizon; in thick cloud what
// lies overhead counts, as it finds its way in more easily than what comes slanting. Weights linear in the direction, which follow where
// paths of the reference renderer end, in clouds of random skies. Needs lib/sky_uniforms.glsl and lib/cloud_light.glsl before it.
struct LightWeights {
  float forward;  // of the direction of view,
  float upright;  // and of the vertical
};

// depths: around the point. cosSun: of the angle between the view and the sun.
LightWeights lightWeights(CloudDepths depths, float cosSun, float viewHeight) {
  float beyond = cloudDepthAhead(depths, cosSun, viewHeight, uKeyCounts);
  return LightWeights(2.7 * exp(-beyond / 14.0) - 0.3, 3.5 - 4.5 * exp(-beyond / 6.0));
}

vec3 weighedLight(LightMoments light, LightWeights weights, vec3 dir, float side) {
  vec3 w = weights.forward * dir;
  w.z = side * max(side * w.z + weights.upright, -1.0);
  vec3 mean = vec3(light.red.x, light.green.x, light.blue.x);
  vec3 weighed = vec3(dot(light.red, vec4(1.0, w)), dot(light.green, vec4(1.0, w)), dot(light.blue, vec4(1.0, w))) / (1.0 + 0.5 * side * w.z);
  // Away from a bright side light gets less and less, but never none, as what is linear would have it.
  return mix(weighed, 0.25 * mean * mean / max(mean - weighed, 0.25 * mean + 1e-20), step(weighed, 0.5 * mean));
}

LightMoments mixMoments(LightMoments a, LightMoments b, float share) {
  return LightMoments(mix(a.red, b.red, share), mix(a.green, b.green, share), mix(a.blue, b.blue, share));
}

// Most of the air is low.
float airBelow2Km(float heightM) { return (1.0 - exp(-heightM / 1500.0)) / (1.0 - exp(-2000.0 / 1500.0)); }
float heightTo10Km(float heightM) { return clamp((heightM - 2000.0) / 8000.0, 0.0, 1.0); }

LightMoments momentsAbove(float heightM) {
  if (heightM < 2000.0) return mixMoments(uAboveLight[0], uAboveLight[1], airBelow2Km(heightM));
  return mixMoments(uAboveLight[1], uAboveLight[2], heightTo10Km(heightM));
}
LightMoments momentsBelow(float heightM) { return mixMoments(uBelowLight[0], uBelowLight[1], heightTo10Km(heightM)); }
float airShareBelow(float heightM) { return heightM < 2000.0 ? airBelow2Km(heightM) : 1.0; }  // the rest is the ground

vec3 lightFromAbove(LightWeights weights, vec3 dir, float heightM) { return weighedLight(momentsAbove(heightM), weights, dir, 1.0); }
vec3 lightFromBelow(LightWeights weights, vec3 dir, float heightM) {
  return mix(uGroundLight, weighedLight(momentsBelow(heightM), weights, dir, -1.0), airShareBelow(heightM));
}

// Half of the difference between what comes from one side, level, and what comes from the opposite side: as mean luminances of planes that
// face them.
vec3 sideOf(LightMoments light, vec3 side) {
  vec4 w = vec4(0.0, side);
  return vec3(dot(light.red, w), dot(light.green, w), dot(light.blue, w));
}
vec3 sideFromAbove(vec3 side, float heightM) { return sideOf(momentsAbove(heightM), side); }
vec3 sideFromBelow(vec3 side, float heightM) { return airShareBelow(heightM) * sideOf(momentsBelow(heightM), side); }
