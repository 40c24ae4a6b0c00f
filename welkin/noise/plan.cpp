// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "welkin/core/random.h"

namespace welkin::noise {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What a lattice is for, so that no two share a hash.
enum Stream : std::uint32_t { kNoise, kPotential, kDistortion, kFeature };

struct Builder {
  const NoiseParams& p;
  int dimensions() const { return static_cast<int>(p.dimensions); }

  std::uint32_t key(Stream stream, int which, int octave, int axis) const {
    return static_cast<std::uint32_t>(
        hashOf(static_cast<std::uint64_t>(p.seed), stream, which, octave, axis));
  }

  Axis axis(std::uint32_t key, int i, double factor, double shiftCells) const {
    const double f = p.frequency[i] * factor;
    return {key, f, p.offset[i] + shiftCells / p.frequency[i], p.tile ? 1.0 : 0.0};
  }

  // Octave `octave` of a stream. With `stretch` other than 1 its cells are so much smaller, as nearly as
  // tiling allows.
  GradientLattice lattice(Stream stream, int which, int octave, double stretch = 1.0,
                          double shiftCells = 0.0) const {
    const double factor = std::pow(p.lacunarity, octave);
    std::array<Axis, 4> axes;
    for (int i = 0; i < dimensions(); ++i) {
      double f = factor * stretch;
      if (p.tile) f = std::max(std::round(p.frequency[i] * f), 1.0) / p.frequency[i];
      axes[i] = axis(key(stream, which, octave, i), i, f, shiftCells / factor);
    }
    int count = dimensions();
    if (p.time) {
      const double pace = std::pow(p.timeLacunarity, octave);
      axes[count] = Axis(key(stream, which, octave, 3), pace, 0.0, p.timePeriod);
      ++count;
    }
    const bool published = p.table == Table::kPublished;
    return {published ? 3 : count, axes, published};
  }

  CellLattice cells(int which, int octave, double factor) const {
    std::array<Axis, 3> axes;
    for (int i = 0; i < dimensions(); ++i) axes[i] = axis(key(kFeature, which, octave, i), i, factor, 0.0);
    std::optional<double> time = p.time;
    const double pace = std::pow(p.timeLacunarity, octave);
    if (time) *time *= pace;
    return {dimensions(), axes, time, p.timePeriod * pace};
  }

  ValueTerm value(int octave) const {
    const double factor = std::pow(p.lacunarity, octave);
    ValueTerm term{Value(valueSettings(octave)), {}, weight(octave)};
    for (int i = 0; i < dimensions(); ++i) term.axes[i] = axis(0, i, factor, 0.0);
    return term;
  }

  ValueSettings valueSettings(int octave) const {
    ValueSettings s;
    // Any seed but 0, which is the source's hash.
    if (p.table == Table::kSeeded) s.seed = hashOf(static_cast<std::uint64_t>(p.seed), kNoise, octave) | 1u;
    s.interpolation = p.interpolation;
    s.smooth = p.smooth;
    if (p.tile)
      for (int i = 0; i < dimensions(); ++i)
        s.period[i] = static_cast<int>(std::lround(p.frequency[i] * std::pow(p.lacunarity, octave)));
    return s;
  }

  double weight(int octave) const { return p.amplitude * std::pow(p.persistence, octave); }
};

// Of the noise of one octave: mean and deviation over the infinite lattice, and least and greatest value.
struct Spread {
  double mean, deviation, low, high;
};

Spread spreadOf(const NoiseParams& p) {
  const int axes = p.table == Table::kPublished ? 3 : static_cast<int>(p.dimensions) + (p.time ? 1 : 0);
  const double bound = GradientLattice::bound(axes), deviation = GradientLattice::deviation(axes);
  switch (p.kind) {
    case Kind::kPerlin:
      return {0.0, deviation, -bound, bound};
    case Kind::kValue: {
      const Value noise(Builder{p}.valueSettings(0));
      const int dimensions = static_cast<int>(p.dimensions);
      return {0.0, noise.deviation(dimensions), -noise.bound(dimensions), noise.bound(dimensions)};
    }
    default:
      return {0.0, 1.0, -1.0, 1.0};
  }
}

Affine normalisation(const NoiseParams& p, const Spread& s) {
  double sum = 0.0, squares = 0.0;
  for (int o = 0; o < p.octaves; ++o) {
    const double a = p.amplitude * std::pow(p.persistence, o);
    sum += a;
    squares += a * a;
  }
  const bool distances = p.kind == Kind::kCellular;
  switch (p.normalisation) {
    case Normalisation::kRaw:
      break;
    case Normalisation::kThesis:
      if (distances) return {1.0, 0.0, 0.0, 1.0};
      return {0.5, 0.5 * sum, 0.0, 1.0};
    case Normalisation::kUnitRange: {
      const double range = std::max((s.high - s.low) * sum, 1e-300);
      return {1.0 / range, -s.low * sum / range, 0.0, 1.0};
    }
    case Normalisation::kUnitVariance: {
      const double deviation = std::max(s.deviation * std::sqrt(squares), 1e-300);
      return {1.0 / deviation, -s.mean * sum / deviation, -kInfinity, kInfinity};
    }
  }
  return {1.0, 0.0, -kInfinity, kInfinity};
}

Affine quantisation(const NoiseParams& p) {
  if (p.normalisation == Normalisation::kUnitVariance) return {0.125, 0.5, 0.0, 1.0};
  const bool positive =
      p.normalisation != Normalisation::kRaw || p.kind == Kind::kCellular || p.kind == Kind::kPerlinWorley;
  return positive ? Affine{1.0, 0.0, 0.0, 1.0} : Affine{0.5, 0.5, 0.0, 1.0};
}

// Perlin-Worley's gradient noise starts an octave above its coarsest cells.
constexpr int kPerlinWorleyOctave = 1;

}  // namespace

Plan makePlan(const NoiseParams& p) {
  const Builder b{p};
  const int dimensions = b.dimensions();
  Plan plan;
  plan.normalise = normalisation(p, spreadOf(p));
  plan.quantise = quantisation(p);
  switch (p.kind) {
    case Kind::kPerlin:
      plan.gradients.resize(1);
      for (int o = 0; o < p.octaves; ++o) plan.gradients[0].push_back({b.lattice(kNoise, 0, o), b.weight(o)});
      break;
    case Kind::kValue:
      for (int o = 0; o < p.octaves; ++o) plan.values.push_back(b.value(o));
      break;
    case Kind::kCellular:
      for (int o = 0; o < p.octaves; ++o)
        plan.cells.push_back({b.cells(0, o, std::pow(p.lacunarity, o)), b.weight(o)});
      break;
    case Kind::kPerlinWorley: {
      double sum = 0.0;
      for (int o = 0; o < p.octaves; ++o) sum += b.weight(o);
      plan.gradients.resize(1);
      for (int o = 0; o < p.octaves; ++o)
        plan.gradients[0].push_back({b.lattice(kNoise, 0, o, std::pow(2.0, kPerlinWorleyOctave)),
                                     b.weight(o) / std::max(sum, 1e-300)});
      for (int i = 0; i < 4; ++i) plan.cells.push_back({b.cells(1, i, std::pow(2.0, i)), 1.0});
      plan.normalise = {1.0, 0.0, 0.0, 1.0};
      break;
    }
    case Kind::kCurl:
      plan.gradients.resize(static_cast<std::size_t>(dimensions));
      for (int o = 0; o < p.octaves; ++o) {
        // By a unit of the domain, over the cells along x.
        auto term = [&](int potential, int by, double sign) {
          const double scale = std::pow(p.lacunarity, o) * p.frequency[by] / p.frequency.x;
          return GradientTerm{b.lattice(kPotential, potential, o), sign * b.weight(o) * scale, by};
        };
        if (dimensions == 2) {
          plan.gradients[0].push_back(term(0, 1, 1.0));
          plan.gradients[1].push_back(term(0, 0, -1.0));
        } else {
          for (int c = 0; c < 3; ++c) {
            const int next = (c + 1) % 3, last = (c + 2) % 3;
            plan.gradients[static_cast<std::size_t>(c)].push_back(term(last, next, 1.0));
            plan.gradients[static_cast<std::size_t>(c)].push_back(term(next, last, -1.0));
          }
        }
      }
      break;
    case Kind::kDistorted:
      for (int o = 0; o < p.octaves; ++o) {
        DistortedTerm t{b.lattice(kNoise, 0, o), {}, b.weight(o)};
        constexpr double kStretch[] = {1.0, 3.33, 7.77};
        for (int i = 0; i < dimensions; ++i)
          t.fields.push_back({b.lattice(kDistortion, i, o, kStretch[i], 0.5), 1.0});
        plan.distorted.push_back(std::move(t));
      }
      break;
  }
  return plan;
}

}  // namespace welkin::noise
