// SPDX-License-Identifier: Apache-2.0
// One triangle that covers the viewport, from no vertex data at all. Fragment entry points place themselves by gl_FragCoord.

void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0f : -1.0f, gl_VertexID == 2 ? 3.0f : -1.0f);
  gl_Position = vec4(corner, 0.0f, 1.0f);
}
