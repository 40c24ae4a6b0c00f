// SPDX-License-Identifier: Apache-2.0
// Eye pass: a ball as a quad that holds it just so. Its light is computed here, at four places within the ball, and so is the air
// between: fragments have next to nothing to do.

#include "lib/phase.glsl"
#include "lib/atmosphere.glsl"
#include "lib/sky_uniforms.glsl"
#include "lib/cloud_light.glsl"
#include "lib/splat_stack.glsl"

layout(location = 0) in vec4 iBall;       // centre from the eye, radius, m
layout(location = 1) in vec4 iMatter;     // extinction at the centre, 1/m

uniform mat4 uClipFromEnu;                // directions east-north-up from the eye to clip space
uniform mat3 uEnuFromCamera;
uniform vec4 uRayScale;
uniform float uScale;                     // written value for each cd/m2
uniform DropletPhase uDroplets;
uniform SplatStack uSunStack;
uniform SplatStack uSkyStack;
uniform sampler2D uSunDepths;
uniform sampler2D uSkyDepths;
uniform int uPhase;                       // 0 droplets, 1 Rayleigh, 2 isotropic
uniform float uAlbedo;

out vec3 vRay;                            // direction of view: x, y across, z towards the centre
out vec3 vLight;                          // luminance of the ball as it arrives, with what the air in front adds
flat out vec3 vBall;                      // radii from the eye to the centre, optical depth of a radius, radius

void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  float radius = iBall.w;
  float centreM = max(length(iBall.xyz), 1e-3 * radius);
  vec3 forward = iBall.xyz / centreM;
  vec3 right = normalize(cross(forward, abs(forward.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
  vec3 up = cross(right, forward);
  float q = radius / centreM;
  vec3 p = iBall.xyz;
  if (q < 0.8) {
    // The tangent cone meets the plane through the centre a little outside the ball.
    vec2 offset = corner * (q / sqrt(1.0 - q * q));
    vRay = vec3(offset, 1.0);
    gl_Position = uClipFromEnu * vec4(iBall.xyz + centreM * (right * offset.x + up * offset.y), 1.0);
    // What is seen of a thick ball is its skin, of a thin one all of it: the corners' places move out to the rim and to the eye.
    float skin = 1.0 - exp(-0.5 * max(iMatter.x, 0.0) * radius);
    p += radius * ((0.5 + 0.2 * skin) * (right * corner.x + up * corner.y) - 0.7 * skin * forward);
  } else {
    // The eye is in it or close by: all of the picture.
    vec3 ray = uEnuFromCamera * vec3(uRayScale.xy * corner + uRayScale.zw, -1.0);
    vRay = vec3(dot(ray, right), dot(ray, up), dot(ray, forward));
    gl_Position = vec4(corner, 0.0, 1.0);
  }
  vBall = vec3(1.0 / q, iMatter.x * radius, radius);

  vec2 sun = splatDepths(uSunStack, uSunDepths, p);
  vec2 sky = splatDepths(uSkyStack, uSkyDepths, p);
  CloudDepths depths = CloudDepths(sun.x, sun.y, sky.x, sky.y);
  float cosSun = dot(forward, uKeyDirection);
  float phase = uPhase == 0 ? phaseDroplet(cosSun, uDroplets) : (uPhase == 1 ? phaseRayleigh(cosSun) : phaseIsotropic());
  vec3 fromGround = vec3(p.xy, p.z + uEyeM);
  vec2 shares = cloudSkyShares(depths);
  vec3 light = keyLightAt(max(fromGround.z, 0.0), fromGround) * cloudSunSource(depths, phase, cosSun, forward.z, uKeyDirection.z) +
               skyAbove(fromGround.z) * shares.x + uGroundLight * shares.y;
  vec3 inscatter, through;
  aerial(forward, centreM, inscatter, through);
  vLight = uScale * (uAlbedo * light * through + inscatter);
}
