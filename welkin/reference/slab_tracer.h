// SPDX-License-Identifier: Apache-2.0
// Light through a slab by Monte Carlo, without bias: what it reflects, lets through and absorbs, and its
// radiance towards the zenith, each with its standard error.
//
// Fluxes are shares of the flux that falls on the top (of a column: on that column's top). Points of a batch
// are a randomly shifted lattice, so that batches are independent and each is stratified; errors are those of
// the batches' mean. The same numbers on any number of threads. docs/theory.md has the method and its
// sources.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "welkin/scene/slab.h"

namespace welkin::reference {

struct Estimate {
  double value = 0.0;
  double error = 0.0;  // standard error, 0 for what is known
};

struct SlabLightFlow {
  Estimate reflectance;           // up through the top, the ground's light included
  Estimate transmittance;         // down to the ground, all of it: more than 1 over a bright ground
  Estimate directTransmittance;   // of light never scattered nor reflected
  Estimate diffuseTransmittance;  // the rest
  Estimate absorptance;           // in the slab
  Estimate nadirRadiance;  // pi I / F seen from above, looking straight down; F falls on the slab's top
};

struct SlabResult {
  SlabLightFlow total;
  std::vector<SlabLightFlow> columns;   // by where light leaves; from the west
  std::uint64_t paths = 0, events = 0;  // events: scatterings, and reflections of the ground
  bool reachedNoise = false;
};

struct SlabSettings {
  std::uint64_t seed = 1;
  std::uint64_t maxPaths = 0;  // 0: until the noise is reached
  // The largest relative standard error wanted of reflectance, transmittance and nadir radiance; three times
  // as much for a column's fluxes. What is below 1e-4 need not be known so well. 0: trace maxPaths.
  double noise = 1e-3;
};

// Throws ParameterError for an empty slab, and where nothing would end the paths.
// progress: called between rounds with what there is and the share of the work that is done; may throw.
SlabResult traceSlab(const scene::Slab& slab, const SlabSettings& settings,
                     const std::function<void(const SlabResult&, double)>& progress = {});

}  // namespace welkin::reference
