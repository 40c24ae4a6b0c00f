// SPDX-License-Identifier: Apache-2.0
// Light of a ball along one ray: at the place in it that is seen most, as it arrives at the eye, with what the air in front adds.

#include "lib/phase.glsl"
#include "lib/eclipse.glsl"
#include "lib/atmosphere.glsl"
#include "lib/sky_uniforms.glsl"
#include "lib/cloud_light.glsl"
#include "lib/light_around.glsl"
#include "lib/splat.glsl"
#include "lib/splat_ray.glsl"
#include "lib/splat_stack.glsl"
#include "lib/splat_shading.glsl"

flat in vec4 vBall;
flat in vec4 vMatter;
flat in vec4 vCloud;
flat in vec4 vHalves;
flat in vec4 vOthers;
flat in vec2 vGlow;
flat in vec4 vBlock;
in vec2 vCorner;

uniform mat3 uSunStack;                   // across, upward, away
uniform mat3 uSkyStack;
uniform mat3 uGlowStack;                  // away from the bright side of the sky
uniform mat3 uSecondStack;
uniform sampler2D uDepths;
uniform DropletPhase uDroplets;

layout(location = 0) out vec4 outLight;

const float kRim = 0.95;                  // rays beyond that many radii see what those see
const int kHalvings = 6;
const float kGlowTexels = 16.0;           // on a slice's side of that stack
const float kEyeStackPart = 0.4;          // of the number of the phase function: how much the stack from the eye counts
const float kFront = 0.7;                 // optical depth of the surface of a cloud

float phaseOf(float cosine) {
  return vMatter.y < 0.5 ? phaseDroplet(cosine, uDroplets) : (vMatter.y < 1.5 ? phaseRayleigh(cosine) : phaseIsotropic());
}

// Of a light with its stack; sky: the depths above and below.
vec3 fromLight(SplatStack stack, vec3 lux, vec3 toLight, vec2 sky, SplatPlace place) {
  vec3 p = place.dir * place.distanceM;
  vec2 along = splatBodyDepths(stack, uDepths, p);
  float shade = splatAhead(stack, uDepths, p);
  CloudDepths depths = CloudDepths(max(along.x - shade, 0.0), along.y, sky.x, sky.y);
  vec3 q = p - stack.centreM;
  float facing = splatFacing(vec3(dot(q, stack.across), dot(q, stack.upward), dot(q, stack.away)),
                             vec3(stack.halfM, stack.halfM, stack.halfDepthM), vec3(0.0, 0.0, -1.0));
  return splatFromLight(lux, toLight, depths, facing, shade, phaseOf(dot(place.dir, toLight)), place);
}

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
  SplatPlace place = splatPlace(dir, distanceM);
  vec3 p = dir * distanceM;
  SplatStack keyStack = SplatStack(vec3(vCloud), uSunStack[0], uSunStack[1], uSunStack[2], vHalves.x, vHalves.y, block);
  SplatStack skyStack = SplatStack(vec3(vCloud), uSkyStack[0], uSkyStack[1], uSkyStack[2], vHalves.z, vHalves.w, block + beside);
  SplatStack glowStack = SplatStack(vec3(vCloud), uGlowStack[0], uGlowStack[1], uGlowStack[2], vOthers.x, vOthers.y, vec3(vGlow, kGlowTexels));
  vec2 sky = splatDepths(skyStack, uDepths, p), glow = splatDepths(glowStack, uDepths, p);
  vec3 light = fromLight(keyStack, keyLightAt(place.heightM, place.fromGround), uKeyDirection, sky, place) +
               splatFromSky(CloudDepths(0.0, 0.0, sky.x, sky.y), glow, -uGlowStack[2], place);
#ifdef WELKIN_SECOND_LIGHT
  SplatStack second = SplatStack(vec3(vCloud), uSecondStack[0], uSecondStack[1], uSecondStack[2], vOthers.z, vOthers.w, block + 3.0 * beside);
  light += fromLight(second, lightAt(uSecondLight, uSecondDirection, place.heightM, place.fromGround), uSecondDirection, sky, place);
#endif
  outLight = vec4(splatThroughAir(vMatter.z * light, place), 0.0);
}
