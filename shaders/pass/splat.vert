// SPDX-License-Identifier: Apache-2.0
// Eye pass: a ball as a quad that holds it just so.

#include "lib/splat.glsl"
#include "lib/splat_ray.glsl"

layout(location = 0) in vec4 iBall;       // centre from the eye, radius, m
layout(location = 1) in vec4 iMatter;     // extinction at the centre, 1/m; the tile of its light: texel at its corner, x, y; texels on its side

uniform mat4 uClipFromEnu;                // directions east-north-up from the eye to clip space
uniform vec2 uPerTexel;

out vec3 vRay;                            // direction of view: x, y across, z towards the centre
out vec2 vLight;                          // texture coordinate
flat out vec3 vBall;                      // radii from the eye to the centre, optical depth of a radius, radius
flat out mat3 vFrame;                     // right, up, forward

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  SplatFrame f = splatFrame(iBall);
  vRay = splatRay(f, corner);
  gl_Position = f.share < kSplatClose
                    ? uClipFromEnu * vec4(f.centreM * (f.right * vRay.x + f.up * vRay.y + f.forward), 1.0)
                    : vec4(corner, 0.0, 1.0);
  vLight = (iMatter.yz + 0.5 * iMatter.w + 0.5 * corner * (iMatter.w - 1.0)) * uPerTexel;
  vBall = vec3(1.0 / f.share, iMatter.x * iBall.w, iBall.w);
  vFrame = mat3(f.right, f.up, f.forward);
}
