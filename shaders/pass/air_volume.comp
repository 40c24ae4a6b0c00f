// SPDX-License-Identifier: Apache-2.0
// All slices of an air volume (lib/air_volume.glsl) in one dispatch: each invocation marches a column of them, front to back.

#define WELKIN_SEGMENTS
#include "lib/air_column.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) uniform writeonly image3D uColourImage;
layout(rgba16f, binding = 1) uniform writeonly image3D uTransmittanceImage;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= uSize.x || at.y >= uSize.y) return;
  AirRay ray = airRay(at);
  AirColumn column = AirColumn(vec3(0.0), 1.0);
  float fromM = 0.0;
  for (int slice = 0; slice < uSize.z; ++slice) {
    float toM = airSliceDistance(uNearFarM, slice, uSize.z);
    AirSlice there = airSegment(ray, fromM, toM, column);
    imageStore(uColourImage, ivec3(at, slice), vec4(there.colour, 1.0));
    imageStore(uTransmittanceImage, ivec3(at, slice), vec4(there.transmittance, 1.0));
    fromM = toM;
  }
}
