// SPDX-License-Identifier: Apache-2.0
// Benchmarks of noise fills for Google Benchmark:
//   W1  tileable Perlin fBm in space, 6 octaves from frequency 6, 128^3, 8 bit
//   W2  tileable Perlin fBm in the plane, 10 octaves from frequency 3, 1024^2, 8 bit
//   W3  one octave of Perlin noise, 0.02 cells a sample, 256^3, float
//   W4  Perlin fBm, 5 octaves from 0.05 cells a sample, 256^3, float
//   W5  cellular F1, 8 cells across 128^3, float
//   W6  Perlin-Worley, cells from frequency 4 and gradient noise of 3 octaves from 8, 128^3, 8-bit RGBA
// in nanoseconds a sample, into a buffer that has been written before; and what writing memory costs.
#pragma once

namespace welkin::bench {

// Registers them: each workload on each instruction set of this processor with one thread; on the best also
// with two threads; W1 and W4 on the best from 64^3 to 512^3. Names are <workload>/<set>/<threads>/<size>.
void registerNoiseBenchmarks();

}  // namespace welkin::bench
