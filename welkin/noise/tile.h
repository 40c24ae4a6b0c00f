// SPDX-License-Identifier: Apache-2.0
// Tileable noise pictures and volumes of the renderer's clouds, by the fills of noise.h.
// All are normalised to mean 0 and standard deviation 1 over the tile.
#pragma once

#include <cstdint>

#include "welkin/core/image.h"

namespace welkin::noise {

// A fractal sum: octave o has frequency * lacunarity^o cells across the tile and weight persistence^o.
struct Octaves {
  int octaves = 4;
  int frequency = 4;   // cells across the tile in the first octave, >= 1
  int lacunarity = 2;  // integer, so that every octave tiles
  float persistence = 0.5f;
};

// n x n x n, one channel: mix of gradient noise (weight 1 - billow) and inverted cellular noise (weight
// billow), which makes round bumps with sharp creases between them: the cauliflower of cumulus.
Volume<float> billowVolume(std::uint64_t seed, int n, const Octaves& sum, float billow);

// n x n, one channel: gradient-noise fractal sum made exactly Gaussian by rank, so that a threshold is a
// cover.
Image<float> gaussianMap(std::uint64_t seed, int n, const Octaves& sum);

// n x n, one channel: round cells (inverted cellular noise with a little gradient noise), Gaussian by rank.
Image<float> gaussianCellMap(std::uint64_t seed, int n, const Octaves& sum);

}  // namespace welkin::noise
