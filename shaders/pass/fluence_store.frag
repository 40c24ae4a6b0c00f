// SPDX-License-Identifier: Apache-2.0
// One cell of all columns, where lib/fluence.glsl looks it up: from four cells to a texel.

uniform sampler3D uPacked;
uniform int uCell;

out float outFluence;

void main() { outFluence = texelFetch(uPacked, ivec3(ivec2(gl_FragCoord.xy), uCell / 4), 0)[uCell % 4]; }
