// SPDX-License-Identifier: Apache-2.0
// The pattern of living octaves at one instant: the sum of WELKIN_OCTAVES (1 to 8) lattices. WELKIN_KERNEL: 0 gradient, 1 Pallister's,
// 2 the course's.

#include "lib/octaves.glsl"

#if WELKIN_KERNEL == 0
#define WELKIN_OCTAVE octaveGradient
#elif WELKIN_KERNEL == 1
#define WELKIN_OCTAVE octavePallister
#else
#define WELKIN_OCTAVE octaveCourse
#endif

uniform sampler2D uLattice0;
uniform sampler2D uLattice1;
uniform sampler2D uLattice2;
uniform sampler2D uLattice3;
uniform sampler2D uLattice4;
uniform sampler2D uLattice5;
uniform sampler2D uLattice6;
uniform sampler2D uLattice7;
uniform vec4 uOctaves[8];  // x, y: shift in cells; z: cells a texel of the pattern; w: points of the lattice, a side
uniform float uBase;

layout(location = 0) out float outPattern;

float octave(sampler2D lattice, vec4 o) { return WELKIN_OCTAVE(lattice, o.w, gl_FragCoord.xy * o.z + o.xy); }

void main() {
  float sum = uBase + octave(uLattice0, uOctaves[0]);
#if WELKIN_OCTAVES > 1
  sum += octave(uLattice1, uOctaves[1]);
#endif
#if WELKIN_OCTAVES > 2
  sum += octave(uLattice2, uOctaves[2]);
#endif
#if WELKIN_OCTAVES > 3
  sum += octave(uLattice3, uOctaves[3]);
#endif
#if WELKIN_OCTAVES > 4
  sum += octave(uLattice4, uOctaves[4]);
#endif
#if WELKIN_OCTAVES > 5
  sum += octave(uLattice5, uOctaves[5]);
#endif
#if WELKIN_OCTAVES > 6
  sum += octave(uLattice6, uOctaves[6]);
#endif
#if WELKIN_OCTAVES > 7
  sum += octave(uLattice7, uOctaves[7]);
#endif
  outPattern = clamp(sum, 0.0, 1.0);
}
