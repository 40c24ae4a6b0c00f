// SPDX-License-Identifier: Apache-2.0
// The air and the clouds between the eye and what an engine draws at a distance, from the two textures of render::AirVolume
// (welkin/render/air_volume.h). For engines to include or to copy; needs nothing else:
//
//   AirBefore air = airBefore(uAirColour, uAirTransmittance, vec2(nearM, farM), gl_FragCoord.xy / viewportSize, length(positionInView));
//   outColor = vec4(air.transmittance * glass + air.colour, ...);
//
// The textures filter linearly and clamp at their edges. The slices lie at distances of a constant ratio, the first at near, the last at
// far.

struct AirBefore {
  vec3 colour;        // that arrives from in front, linear Rec. 709, as scaled
  vec3 transmittance; // share of what is behind that arrives too
};

// Metres from the eye to a slice.
float airSliceDistance(vec2 nearFarM, int slice, int slices) {
  return nearFarM.x * pow(nearFarM.y / nearFarM.x, float(slice) / float(slices - 1));
}

// uv: of the picture, the origin at the bottom left. distanceM: along the ray, no depth.
AirBefore airBefore(sampler3D colour, sampler3D transmittance, vec2 nearFarM, vec2 uv, float distanceM) {
  float slices = float(textureSize(colour, 0).z);
  float slice = log(max(distanceM, nearFarM.x) / nearFarM.x) / log(nearFarM.y / nearFarM.x) * (slices - 1.0);
  vec3 at = vec3(uv, (min(slice, slices - 1.0) + 0.5) / slices);
  // Before the first slice there is as much less as the way is shorter.
  float share = clamp(distanceM / nearFarM.x, 0.0, 1.0);
  return AirBefore(share * textureLod(colour, at, 0.0).xyz, mix(vec3(1.0), textureLod(transmittance, at, 0.0).xyz, share));
}
