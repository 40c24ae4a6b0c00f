// SPDX-License-Identifier: Apache-2.0
// One slice of an air volume (lib/air_volume.glsl), from what its columns have come to at the slice before: where there is no compute.

#define WELKIN_SEGMENTS
#include "lib/air_column.glsl"

uniform sampler2D uColumns;       // luminance, and what clouds let through
uniform int uSlice;

layout(location = 0) out vec4 outColumn;
layout(location = 1) out vec4 outColour;
layout(location = 2) out vec4 outTransmittance;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  AirRay ray = airRay(at);
  AirColumn column = AirColumn(vec3(0.0), 1.0);
  float fromM = 0.0;
  if (uSlice > 0) {
    vec4 was = texelFetch(uColumns, at, 0);
    column = AirColumn(vec3(was), was.w);
    fromM = airSliceDistance(uNearFarM, uSlice - 1, uSize.z);
  }
  AirSlice there = airSegment(ray, fromM, airSliceDistance(uNearFarM, uSlice, uSize.z), column);
  outColumn = vec4(column.luminance, column.clouds);
  outColour = vec4(there.colour, 1.0);
  outTransmittance = vec4(there.transmittance, 1.0);
}
