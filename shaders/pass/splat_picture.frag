// SPDX-License-Identifier: Apache-2.0
// Picture of a far cloud, premultiplied: one ray through its shape on a grid, and the light of the place in it that is seen.
// In the shape's own frame lengths are in widths of the cloud.

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

flat in vec4 vPlace;
flat in vec4 vShape;
flat in vec4 vMatter;
flat in vec4 vShade;
flat in vec4 vTexel;
in vec2 vAcross;

uniform mat3 uSunStack;                   // across, upward, away
uniform mat3 uGlowStack;                  // away from the bright side of the sky
uniform mat3 uSecondStack;
uniform sampler2D uDepths;
uniform sampler3D uShapes;                // beside one another: density, columns of it above and below, distance to the nearest ball
uniform vec2 uShapePoints;                // on the side of each grid; shapes
uniform DropletPhase uDroplets;

layout(location = 0) out vec4 outLight;

const int kMostSteps = 64;
const float kStepDepth = 0.6, kFinestStep = 0.03, kCoarsestStep = 0.08;
const float kOpaque = 7.0;                // optical depth
const int kSunSteps = 5;
const int kBodySteps = 3;
const int kGlowSteps = 4;

vec4 shapeAt(vec3 q) {
  vec3 at = clamp(0.5 * q / vec3(vShape) + 0.5, 0.0, 1.0);
  vec3 texel = 0.5 + at * (uShapePoints.x - 1.0);
  texel.x = floor(texel.x * 256.0 + 0.5) / 256.0 + vShape.w * uShapePoints.x;  // without rounding, whichever shape it is
  return textureLod(uShapes, texel / vec3(uShapePoints.x * uShapePoints.y, uShapePoints.x, uShapePoints.x), 0.0);
}

// Where a ray crosses the box: x before y, or else it does not.
vec2 boxCrossings(vec3 from, vec3 dir) {
  vec3 per = 1.0 / (abs(dir) + 1e-6) * vec3(dir.x < 0.0 ? -1.0 : 1.0, dir.y < 0.0 ? -1.0 : 1.0, dir.z < 0.0 ? -1.0 : 1.0);
  vec3 a = (-vec3(vShape) - from) * per, b = (vec3(vShape) - from) * per;
  vec3 low = min(a, b), high = max(a, b);
  return vec2(max(max(low.x, low.y), low.z), min(min(high.x, high.y), high.z));
}

// Column of density from a place on to the box's end, in steps that grow.
float columnFrom(vec3 q, vec3 dir, int steps) {
  float end = max(boxCrossings(q, dir).y, 0.0), per = 1.0 / float(steps), sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    float middle = (float(i) + 0.5) * per;
    sum += shapeAt(q + dir * (middle * middle * end)).x * (2.0 * middle * per);
  }
  return sum * end;
}

vec3 turned(vec3 v) { return vec3(vMatter.x * v.x - vMatter.y * v.y, vMatter.y * v.x + vMatter.x * v.y, v.z); }

// Of a light at a place in the shape's frame and in the world, with the stack of what shades the cloud; sky: the depths above and below.
vec3 fromLight(mat3 axes, float stackNumber, vec3 lux, vec3 toLight, vec3 q, vec2 sky, SplatPlace place) {
  vec3 along = turned(toLight), inward = (1.0 - kSplatInward) * q;
  float towards = columnFrom(q, along, kSunSteps), away = columnFrom(q, -along, kSunSteps);
  float body = columnFrom(inward, along, kBodySteps) + columnFrom(inward, -along, kBodySteps);
  away = max(away, 0.5 * (away + body - towards));
  SplatStack stack = SplatStack(vec3(vPlace), axes[0], axes[1], axes[2], vShade.x, vShade.y, vec3(vShade.z + stackNumber * vTexel.y, vShade.w, vTexel.y));
  float shade = splatDepths(stack, uDepths, place.dir * place.distanceM).x;
  CloudDepths depths = CloudDepths(vMatter.z * towards, vMatter.z * away, sky.x, sky.y);
  return splatFromLight(lux, toLight, depths, splatFacing(q, vec3(vShape), along), shade, phaseDroplet(dot(place.dir, toLight), uDroplets), place);
}

void main() {
  SplatFrame f = splatFrame(vPlace);
  vec3 dir = normalize(f.forward * f.centreM + f.right * vAcross.x + f.up * vAcross.y);
  vec3 eye = turned(-vPlace.xyz / vPlace.w), ray = turned(dir);
  vec2 ends = boxCrossings(eye, ray);
  ends.x = max(ends.x, 0.0);
  outLight = vec4(0.0);
  if (ends.x >= ends.y) return;
  // In the clear from ball to ball, then in steps to the surface, which is where it is seen on the average.
  float step = clamp(kStepDepth / vMatter.z, kFinestStep, kCoarsestStep);
  float through = 1.0, all = 0.0, seenAt = 0.0, t = ends.x, before = 0.0;
  for (int i = 0; i < kMostSteps; ++i) {
    if (t >= ends.y || all > kOpaque) break;
    vec4 there = shapeAt(eye + ray * t);
    if (there.w > step) {
      t += there.w;
      before = 0.0;
      continue;
    }
    float own = vMatter.z * 0.5 * (before + there.x) * step, left = exp(-own);
    float within = own > 1e-2 ? 1.0 / own - left / (1.0 - left) : 0.5 - own / 12.0;
    seenAt += through * (1.0 - left) * (t + step * (within - 1.0));
    through *= left;
    all += own;
    before = there.x;
    t += step;
  }
  if (all < 1e-4) return;
  float at = seenAt / (1.0 - through);
  vec3 q = eye + ray * at;
  vec4 here = shapeAt(q);
  SplatPlace place = splatPlace(dir, at * vPlace.w);
  vec3 toGlow = -uGlowStack[2], side = turned(toGlow);
  vec2 sky = vMatter.z * here.yz, glow = vMatter.z * vec2(columnFrom(q, side, kGlowSteps), columnFrom(q, -side, kGlowSteps));
  vec3 light = fromLight(uSunStack, 0.0, keyLightAt(place.heightM, place.fromGround), uKeyDirection, q, sky, place) +
               splatFromSky(CloudDepths(0.0, 0.0, sky.x, sky.y), glow, toGlow, place);
#ifdef WELKIN_SECOND_LIGHT
  light += fromLight(uSecondStack, 1.0, lightAt(uSecondLight, uSecondDirection, place.heightM, place.fromGround), uSecondDirection, q, sky, place);
#endif
  outLight = vec4(splatThroughAir(light, place), 1.0) * (1.0 - exp(-vMatter.w * all));
}
