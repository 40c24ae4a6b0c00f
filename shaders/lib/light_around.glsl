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
  // How much cloud the view has before it: between what lies along the sun's line and along the vertical, as slabs have it.
  vec2 along = vec2(cosSun * cosSun, abs(viewHeight)) + 0.005;
  float beyond = (along.x + along.y) / (along.x / max(cosSun > 0.0 ? depths.toSun : depths.fromSun, 0.01) +
                                        along.y / max(viewHeight > 0.0 ? depths.up : depths.down, 0.01));
  return LightWeights(2.7 * exp(-beyond / 14.0) - 0.3, 3.5 - 4.5 * exp(-beyond / 6.0));
}

vec3 weighedLight(LightMoments light, LightWeights weights, vec3 dir, float side) {
  vec3 w = weights.forward * dir;
  w.z = side * max(side * w.z + weights.upright, -1.0);
  return max(vec3(dot(light.red, vec4(1.0, w)), dot(light.green, vec4(1.0, w)), dot(light.blue, vec4(1.0, w))), 0.0) / (1.0 + 0.5 * side * w.z);
}

LightMoments mixMoments(LightMoments a, LightMoments b, float share) {
  return LightMoments(mix(a.red, b.red, share), mix(a.green, b.green, share), mix(a.blue, b.blue, share));
}

// Most of the air is low.
float airBelow2Km(float heightM) { return (1.0 - exp(-heightM / 1500.0)) / (1.0 - exp(-2000.0 / 1500.0)); }
float heightTo10Km(float heightM) { return clamp((heightM - 2000.0) / 8000.0, 0.0, 1.0); }

vec3 lightFromAbove(LightWeights weights, vec3 dir, float heightM) {
  LightMoments light = heightM < 2000.0 ? mixMoments(uAboveLight[0], uAboveLight[1], airBelow2Km(heightM))
                                        : mixMoments(uAboveLight[1], uAboveLight[2], heightTo10Km(heightM));
  return weighedLight(light, weights, dir, 1.0);
}
vec3 lightFromBelow(LightWeights weights, vec3 dir, float heightM) {
  if (heightM < 2000.0) return mix(uGroundLight, weighedLight(uBelowLight[0], weights, dir, -1.0), airBelow2Km(heightM));
  return weighedLight(mixMoments(uBelowLight[0], uBelowLight[1], heightTo10Km(heightM)), weights, dir, -1.0);
}
