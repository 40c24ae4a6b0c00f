// SPDX-License-Identifier: Apache-2.0
// A stack of slices across a direction of light, of one cloud: the optical depth from the light to the end of each slice. The slices lie
// side by side in a block of one texture, four of them to a texel, a margin of texels around each four. A cloud has three or four blocks beside one another: from the
// key light, from the zenith, from the eye, and from the second light where it is seen; a coarse one stands by itself, from the side that
// the sky is bright on. The eye's is in perspective: across, lengths are as seen at the cloud's centre.

struct SplatStack {
  vec3 centreM;                   // from the eye
  vec3 across;                    // unit; with `upward` it spans the slices
  vec3 upward;
  vec3 away;                      // the way the light goes
  float halfM;                    // half the side of a slice
  float halfDepthM;
  vec3 block;                     // texel at its corner, x, y; texels on a slice's side, twice the slices
};

// Fours of slices beside one another in a block.
int splatColumns(float side) { return side > 32.0 ? 4 : 2; }

// To the ends of four slices; at: from -1 to 1.
vec4 splatFour(SplatStack stack, sampler2D depths, int four, vec2 at) {
  int columns = splatColumns(stack.block.z);
  vec2 tile = vec2(float(four % columns), float(four / columns));
  vec2 texel = stack.block.xy + stack.block.z * (tile + 0.5) + clamp(at, -1.0, 1.0) * (stack.block.z * 0.5 - 1.0);
  return textureLod(depths, texel / vec2(textureSize(depths, 0)), 0.0);
}

// Optical depths of a point: from the light, and on to the other side.
vec2 splatDepths(SplatStack stack, sampler2D depths, vec3 p) {
  vec3 q = p - stack.centreM;
  vec2 at = vec2(dot(q, stack.across), dot(q, stack.upward)) / stack.halfM;
  float slices = 0.5 * stack.block.z;
  float z = clamp((dot(q, stack.away) / stack.halfDepthM * 0.5 + 0.5) * slices, 0.0, slices - 0.001);
  int slice = int(z), last = int(slices) - 1;
  vec4 own = splatFour(stack, depths, slice / 4, at);
  float before = slice % 4 > 0 ? own[max(slice % 4 - 1, 0)] : (slice > 0 ? splatFour(stack, depths, slice / 4 - 1, at).w : 0.0);
  float here = mix(before, own[slice % 4], z - float(slice));
  float all = splatFour(stack, depths, last / 4, at)[last % 4];
  return max(vec2(here, all - here), 0.0);
}

// The same with more on the other side where the line misses most of the cloud: what bulges from it is lit back by its body, of which the
// line knows nothing. Half of what a line nearer to the cloud's centre has.
const float kSplatInward = 0.4;

vec2 splatBodyDepths(SplatStack stack, sampler2D depths, vec3 p) {
  vec2 here = splatDepths(stack, depths, p), inward = splatDepths(stack, depths, mix(p, stack.centreM, kSplatInward));
  return vec2(here.x, max(here.y, 0.5 * (here.y + inward.x + inward.y - here.x)));
}

// In front of the first slice's end, where none of the cloud itself is.
float splatAhead(SplatStack stack, sampler2D depths, vec3 p) {
  vec3 q = p - stack.centreM;
  return splatFour(stack, depths, 0, vec2(dot(q, stack.across), dot(q, stack.upward)) / stack.halfM).x;
}

// Distance along a ray from the eye at which a cloud has that optical depth in front; past the cloud where it has less. The stack is the
// eye's.
float splatReach(SplatStack stack, sampler2D depths, vec3 dir, float depth) {
  float centreM = length(stack.centreM), cosine = dot(dir, stack.away);
  vec2 at = vec2(dot(dir, stack.across), dot(dir, stack.upward)) * (centreM / (cosine * stack.halfM));
  int slices = int(0.5 * stack.block.z), first = 0, end = (slices + 3) / 4;
  vec4 own = splatFour(stack, depths, end - 1, at);
  if (own[(slices - 1) % 4] <= depth) return 1e9;
  // The first four at whose end it is exceeded is in [first, end).
  float before = 0.0;
  for (int i = 0; i < 4; ++i) {
    if (end - first <= 1) break;
    int middle = (first + end) / 2;
    vec4 d = splatFour(stack, depths, middle - 1, at);
    if (d.w > depth) {
      end = middle;
      own = d;
    } else {
      first = middle;
      before = d.w;
    }
  }
  int within = own.x > depth ? 0 : (own.y > depth ? 1 : (own.z > depth ? 2 : 3));
  before = within > 0 ? own[max(within - 1, 0)] : before;
  float slice = float(4 * first + within) + clamp((depth - before) / max(own[within] - before, 1e-6), 0.0, 1.0);
  return (centreM + (2.0 * slice / float(slices) - 1.0) * stack.halfDepthM) / cosine;
}
