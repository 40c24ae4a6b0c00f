// SPDX-License-Identifier: Apache-2.0
// Light of a place in a cloud of metaballs as it arrives at the eye, with what the air in front adds.
// Needs lib/sky_uniforms.glsl and lib/cloud_light.glsl before it.

// Of light through another cloud, as much as slabs let through that absorb nothing (Eddington's solution, scaled by similarity).
float splatThrough(float depth) { return 4.0 / (4.0 + 3.0 * kSimilarity * depth); }

// dir: from the eye. depths: in the cloud itself. shade: optical depth of other clouds before the sun. phase: of the first scattering, 1/sr; cosSun: of the angle between dir and the light.
vec3 splatLight(CloudDepths depths, float shade, vec3 dir, float distanceM, float phase, float cosSun, float albedo) {
  vec3 p = dir * distanceM;
  vec3 fromGround = vec3(p.xy, p.z + uEyeM);
  float heightM = max(fromGround.z + 0.5 * dot(p.xy, p.xy) / uEarthRadiusM, 0.0);
  vec2 shares = cloudSkyShares(depths);
  vec3 light = keyLightAt(heightM, fromGround) * splatThrough(shade) * cloudSunSource(depths, phase, cosSun, dir.z, uKeyDirection.z) +
               skyAbove(heightM) * shares.x + uGroundLight * shares.y;
  vec3 inscatter, through;
  aerial(dir, distanceM, inscatter, through);
  return albedo * light * through + inscatter;
}
