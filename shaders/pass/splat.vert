// SPDX-License-Identifier: Apache-2.0
// Eye pass: a ball as a quad that holds it just so, or the picture of a far cloud.

#include "lib/splat.glsl"
#include "lib/splat_ray.glsl"

layout(location = 0) in vec4 iBall;       // centre from the eye, radius, m
layout(location = 1) in vec4 iMatter;     // extinction at the centre, 1/m; the tile of its light: texel at its corner, x, y; texels on its side
                                          // Of a picture: side of a texel at its distance, m; its tile; -(1024 * texels across + texels upward)

uniform mat4 uClipFromEnu;                // directions east-north-up from the eye to clip space
uniform vec2 uPerTexel;

out vec3 vRay;                            // direction of view: x, y across, z towards the centre
out vec2 vLight;                          // texture coordinate
flat out vec4 vBall;                      // radii from the eye to the centre, optical depth of a radius, radius; 1: a picture
flat out mat3 vFrame;                     // right, up, forward

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  SplatFrame f = splatFrame(iBall);
  bool picture = iMatter.w < 0.0;
  vec2 texels = picture ? vec2(floor(-iMatter.w / 1024.0), mod(-iMatter.w, 1024.0)) : vec2(iMatter.w);
  vRay = picture ? vec3(0.5 * corner * (texels - 1.0) * (iMatter.x / f.centreM), 1.0) : splatRay(f, corner);
  gl_Position = picture || f.share < kSplatClose
                    ? uClipFromEnu * vec4(f.centreM * (f.right * vRay.x + f.up * vRay.y + f.forward), 1.0)
                    : vec4(corner, 0.0, 1.0);
  gl_Position.z = 0.0;                    // within every engine's near and far plane
  vLight = (iMatter.yz + 0.5 * texels + 0.5 * corner * (texels - 1.0)) * uPerTexel;
  vBall = vec4(1.0 / f.share, picture ? 0.0 : iMatter.x * iBall.w, iBall.w, picture ? 1.0 : 0.0);
  vFrame = mat3(f.right, f.up, f.forward);
}
