// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/params.h"

#include <cmath>
#include <string>

#include "welkin/core/error.h"
#include "welkin/core/param_range.h"
#include "welkin/noise/plan.h"

namespace welkin::noise {
namespace {

void require(bool fine, const char* sentence) {
  if (!fine) throw ParameterError(sentence);
}

bool isWhole(double x) {
  return std::floor(x) == x;
}

}  // namespace

void describe(NoiseParams& p, ParamVisitor& v) {
  constexpr double kFar = 1e15;
  v.choice({"kind", "", "what the noise is made of"}, p.kind);
  v.value({"dimensions", "", "2: a plane, z is ignored; 3: space", 2, 3}, p.dimensions);
  v.value({"tile", "", "repeat without a seam after one unit of the domain; needs whole frequencies"},
          p.tile);
  v.value({"frequency", "cells", "cells across one unit of the domain in the first octave", 1e-9, 1e6},
          p.frequency);
  v.value({"octaves", "", "octaves summed", 1, 24}, p.octaves);
  v.value({"lacunarity", "", "frequency of an octave over that of the one before", 1, 16}, p.lacunarity);
  v.value({"amplitude", "", "weight of the first octave", 0, 1e6}, p.amplitude);
  v.value({"persistence", "", "weight of an octave over that of the one before", 0, 16}, p.persistence);
  v.choice({"fractal", "", "how octaves are summed"}, p.fractal);
  v.choice({"feature", "", "distance that cellular noise shows"}, p.feature);
  v.value({"distortion", "cells", "shift for a distorting noise of 1, in distorted noise", 0, 16},
          p.distortion);
  v.choice({"interpolation", "", "between the lattice points of value noise"}, p.interpolation);
  v.value({"smooth", "", "average value noise over the 27 lattice points around each"}, p.smooth);
  v.choice({"normalisation", "", "what becomes of the sum"}, p.normalisation);
  v.value({"seed", "", "another seed, another noise"}, p.seed);
  v.choice({"table", "", "where the lattice's hash comes from"}, p.table);
  v.value({"offset", "", "added to positions, in units of the domain", -kFar, kFar}, p.offset);
  v.value(
      {"time", "cells", "place on one more axis, for noise that evolves; absent: no such axis", -kFar, kFar},
      p.time);
  v.value({"time_period", "cells", "time after which the evolution repeats, whole; 0: never", 0, 1e6},
          p.timePeriod);
  v.value({"time_lacunarity", "", "pace of an octave over that of the one before", 0, 16}, p.timeLacunarity);
}

void validate(const NoiseParams& p) {
  if (const std::string problem = rangeProblemIn(p); !problem.empty())
    throw ParameterError("the noise's " + problem);
  if (p.tile) {
    for (int axis = 0; axis < p.dimensions; ++axis)
      require(isWhole(p.frequency[axis]) && p.frequency[axis] >= 1.0,
              "noise that tiles needs whole frequencies of at least 1 on every axis");
    require(isWhole(p.lacunarity) || p.octaves == 1, "noise that tiles needs a whole lacunarity");
  }
  const double last = std::pow(p.lacunarity, static_cast<double>(p.octaves - 1));
  // Cells are counted where they repeat: integers hold 2^32.
  const double narrowest = p.tile && p.kind == Kind::kDistorted
                               ? kDistortionStretch[static_cast<std::size_t>(p.dimensions - 1)]
                               : 1.0;
  for (int axis = 0; axis < p.dimensions; ++axis) {
    require(p.frequency[axis] * last <= 1e9, "the noise's last octave has more than 1e9 cells a unit");
    require(
        p.frequency[axis] * last * narrowest <= 4e9,
        "the last octave of what distorts noise that tiles has more than 4e9 cells a unit; it has 7.77 times "
        "as many as the noise, in a plane 3.33");
  }
  require(p.timePeriod == 0.0 || p.time,
          "the noise has a time_period and no time: without a time it does not evolve");
  const double pace = std::pow(p.timeLacunarity, static_cast<double>(p.octaves - 1));
  require(!p.time || pace <= 1e9, "the noise's last octave evolves more than 1e9 times as fast as the first");
  if (p.timePeriod > 0.0) {
    require(isWhole(p.timePeriod), "the noise's time_period is not a whole number of cells");
    require(isWhole(p.timeLacunarity) && p.timeLacunarity >= 1.0,
            "evolution that repeats needs a whole time_lacunarity of at least 1");
    require(p.timePeriod * pace <= 1e9, "the noise's last octave repeats after more than 1e9 cells of time");
  }
  const bool signs = p.kind == Kind::kPerlin || p.kind == Kind::kValue || p.kind == Kind::kDistorted;
  require(signs || p.fractal == Fractal::kFbm,
          "billow and ridged sums need noise of both signs: perlin, value or distorted");
  require(p.table == Table::kSeeded || p.kind == Kind::kPerlin || p.kind == Kind::kValue,
          "the published table belongs to Perlin and value noise alone");
  require(p.table == Table::kSeeded || p.dimensions == 2 || !p.time,
          "the published table has three axes: in space none is left for time");
  require(p.kind != Kind::kPerlinWorley || p.normalisation != Normalisation::kUnitVariance,
          "Perlin-Worley noise fills [0, 1] by itself and has no unit variance");
}

}  // namespace welkin::noise
