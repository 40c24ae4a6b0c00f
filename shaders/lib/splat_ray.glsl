// SPDX-License-Identifier: Apache-2.0
// Rays to a ball, and what they see of it.
// Needs lib/splat.glsl before it.

uniform mat3 uEnuFromCamera;
uniform vec4 uRayScale;

// Of a ball seen from so close, the whole picture is drawn.
const float kSplatClose = 0.8;        // radius over distance

struct SplatFrame {
  vec3 forward;                       // to the centre
  vec3 right;
  vec3 up;
  float centreM;                      // distance of the centre
  float share;                        // radius over it
};

SplatFrame splatFrame(vec4 ball) {
  SplatFrame f;
  f.centreM = max(length(ball.xyz), 1e-3 * ball.w);
  f.forward = ball.xyz / f.centreM;
  f.right = normalize(cross(f.forward, abs(f.forward.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
  f.up = cross(f.right, f.forward);
  f.share = ball.w / f.centreM;
  return f;
}

// Through a corner, or a place between corners, of what is drawn for a ball. In the ball's frame, z forward; any length.
vec3 splatRay(SplatFrame f, vec2 corner) {
  // The tangent cone meets the plane through the centre a little outside the ball.
  if (f.share < kSplatClose) return vec3(corner * (f.share / sqrt(1.0 - f.share * f.share)), 1.0);
  vec3 ray = uEnuFromCamera * vec3(uRayScale.xy * corner + uRayScale.zw, -1.0);
  return vec3(dot(ray, f.right), dot(ray, f.up), dot(ray, f.forward));
}
