// SPDX-License-Identifier: Apache-2.0
// Benchmarks of noise fills:
//   W1  tileable Perlin fBm in space, 6 octaves from frequency 6, 128^3, 8 bit
//   W2  tileable Perlin fBm in the plane, 10 octaves from frequency 3, 1024^2, 8 bit
//   W3  one octave of Perlin noise, 0.02 cells a sample, 256^3, float
//   W4  Perlin fBm, 5 octaves from 0.05 cells a sample, 256^3, float
//   W5  cellular F1, 8 cells across 128^3, float
//   W6  Perlin-Worley, cells from frequency 4 and gradient noise of 3 octaves from 8, 128^3, 8-bit RGBA
//   V1  bare value noise with the octaves of W2, 1024^2, float
//   V2  the same smoothed over 27 lattice points
//   V3  bare value noise with the octaves of W1, 128^3, float
//   V4  the same smoothed
//   V5, V6  V3 and V4 at a time
// into a buffer that has been written before; and what writing memory costs.
#pragma once

#include <string>
#include <vector>

namespace welkin::bench {

struct NoiseTime {
  std::string name;  // of the workload; "write" and "write past caches": 64 MiB of floats, none computed
  std::string set;   // instruction set; of writing: the C library's own choice, ""
  int threads = 1;
  int size = 0;              // samples across
  double nsPerSample = 0.0;  // median; of one thread processor time, of two wall clock
};

// Measures each workload on each instruction set of this processor with one thread; on the best also with two
// threads; W1, W3 and W4 on the best from 64^3 to 512^3, W3 with two threads too. By Google Benchmark,
// `repetitions` times each; takes about a minute for nine.
std::vector<NoiseTime> measureNoise(int repetitions);

}  // namespace welkin::bench
