// SPDX-License-Identifier: Apache-2.0
// Light of a ball along one ray: at the place in it that is seen most, as it arrives at the eye, with what the air in front adds.

#include "lib/phase.glsl"
#include "lib/atmosphere.glsl"
#include "lib/sky_uniforms.glsl"
#include "lib/cloud_light.glsl"
#include "lib/splat.glsl"
#include "lib/splat_ray.glsl"
#include "lib/splat_stack.glsl"
#include "lib/splat_shading.glsl"

flat in vec4 vBall;
flat in vec4 vMatter;
flat in vec4 vCloud;
flat in vec4 vHalves;
flat in vec4 vBlock;
in vec2 vCorner;

uniform mat3 uSunStack;                   // across, upward, away
uniform mat3 uSkyStack;
uniform sampler2D uDepths;
uniform DropletPhase uDroplets;

layout(location = 0) out vec4 outLight;

const float kRim = 0.95;                  // rays beyond that many radii see what those see
const int kHalvings = 6;
const float kEyeStackPart = 0.4;          // of the number of the phase function: how much the stack from the eye counts
const float kFront = 0.7;                 // optical depth of the surface of a cloud

void main() {
  SplatFrame f = splatFrame(vBall);
  vec2 corner = f.share < kSplatClose ? vCorner * min(1.0, kRim / max(length(vCorner), 1e-3)) : vCorner;
  vec3 ray = normalize(splatRay(f, corner));
  // Where half of what is seen of it lies in front: of a thick ball in its skin, of a thin one half-way.
  float across = dot(ray.xy, ray.xy), nearest = ray.z / f.share;
  float w = max(1.0 - across / (f.share * f.share), 0.02);
  float rim = sqrt(w), begin = clamp(-nearest, -rim, rim), end = rim;
  float before = splatColumnTo(w, begin), all = vMatter.x * vBall.w * (splatColumnTo(w, end) - before);
  float seen = -log(0.5 + 0.5 * exp(-max(all, 0.001))) / max(all, 0.001);
  float sought = before + seen * (splatColumnTo(w, end) - before);
  for (int i = 0; i < kHalvings; ++i) {
    float middle = 0.5 * (begin + end);
    bool beyond = splatColumnTo(w, middle) > sought;
    begin = beyond ? begin : middle;
    end = beyond ? middle : end;
  }
  vec3 dir = f.right * ray.x + f.up * ray.y + f.forward * ray.z;
  float distanceM = max((nearest + 0.5 * (begin + end)) * vBall.w, 0.0);
  vec3 block = vec3(vBlock), beside = vec3(float(splatColumns(vBlock.z)) * vBlock.z, 0.0, 0.0);
  if (vCloud.w > 0.0) {
    // Balls that run into one another have one surface: where other balls hide that place, what is seen is in front of it.
    vec3 away = normalize(vec3(vCloud)), across = normalize(cross(away, abs(away.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
    SplatStack eyeStack = SplatStack(vec3(vCloud), across, cross(across, away), away, vCloud.w, vBlock.w, block + 2.0 * beside);
    distanceM = mix(distanceM, min(distanceM, splatReach(eyeStack, uDepths, dir, kFront)), fract(vMatter.y) / kEyeStackPart);
  }
  vec3 p = dir * distanceM;

  SplatStack sunStack = SplatStack(vec3(vCloud), uSunStack[0], uSunStack[1], uSunStack[2], vHalves.x, vHalves.y, block);
  SplatStack skyStack = SplatStack(vec3(vCloud), uSkyStack[0], uSkyStack[1], uSkyStack[2], vHalves.z, vHalves.w, block + beside);
  vec2 sun = splatBodyDepths(sunStack, uDepths, p);
  float shade = splatAhead(sunStack, uDepths, p);
  vec2 sky = splatDepths(skyStack, uDepths, p);
  CloudDepths depths = CloudDepths(max(sun.x - shade, 0.0), sun.y, sky.x, sky.y);
  float cosSun = dot(dir, uKeyDirection);
  float phase = vMatter.y < 0.5 ? phaseDroplet(cosSun, uDroplets) : (vMatter.y < 1.5 ? phaseRayleigh(cosSun) : phaseIsotropic());
  outLight = vec4(splatLight(depths, shade, dir, distanceM, phase, cosSun, vMatter.z), 0.0);
}
