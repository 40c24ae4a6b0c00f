// SPDX-License-Identifier: Apache-2.0
// The look of the ground. Shared by C++ and GLSL, see welkin/core/glsl.h.

WELKIN_CONST float kGroundSharesHalfM = 48e3f;  // half the side of the square around the eye whose light is known (lib/ground_light.glsl)

// Fields and woods: the albedo wanders by a third about its mean over some hundred metres to kilometres. q: metres east and north
// along the ground.
WELKIN_FN vec3 groundAlbedoAt(vec3 albedo, sampler2D placement, vec2 q) {
  vec4 a = textureLod(placement, q / 9000.0f, 0.0f);
  vec4 b = textureLod(placement, vec2(q.y, -q.x) / 31000.0f, 0.0f);
  return albedo * clamp(vec3(1.0f + 0.12f * a.y + 0.12f * b.y) + vec3(0.05f, 0.0f, -0.05f) * a.x, 0.4f, 1.6f);
}
