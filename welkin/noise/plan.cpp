// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

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

  Axis axis(std::uint32_t key, int i, double factor, double cells = 0.0) const {
    return {key, p.frequency[i] * factor, p.offset[i], p.tile ? 1.0 : 0.0, cells};
  }

  // Octave `octave` of a stream. With `stretch` other than 1 its cells are so much smaller, as nearly as
  // tiling allows; the shift is in cells that are not.
  GradientLattice lattice(Stream stream, int which, int octave, double stretch = 1.0,
                          double shiftCells = 0.0) const {
    const double factor = std::pow(p.lacunarity, octave);
    std::array<Axis, 4> axes;
    for (int i = 0; i < dimensions(); ++i) {
      double f = factor * stretch;
      if (p.tile) f = std::max(std::round(p.frequency[i] * f), 1.0) / p.frequency[i];
      axes[i] = axis(key(stream, which, octave, i), i, f, shiftCells * f / factor);
    }
    int count = dimensions();
    if (p.time) {
      axes[count] = timeAxis(key(stream, which, octave, 3), octave);
      ++count;
    }
    const bool published = p.table == Table::kPublished;
    return {published ? 3 : count, axes, published};
  }

  CellLattice cells(int which, int octave, double factor) const {
    std::array<Axis, 3> axes;
    for (int i = 0; i < dimensions(); ++i) axes[i] = axis(key(kFeature, which, octave, i), i, factor);
    std::optional<double> time = p.time;
    const double pace = std::pow(p.timeLacunarity, octave);
    if (time) *time *= pace;
    return {dimensions(), axes, time, p.timePeriod * pace};
  }

  ValueTerm value(int octave) const {
    const double factor = std::pow(p.lacunarity, octave);
    ValueTerm term{Value(valueSettings(octave)), {}, weight(octave)};
    for (int i = 0; i < dimensions(); ++i) term.axes[i] = axis(0, i, factor);
    if (p.time && p.table == Table::kPublished) term.beyond = timeOf(octave);
    return term;
  }

  Axis timeAxis(std::uint32_t key, int octave) const {
    return {key, std::pow(p.timeLacunarity, octave), 0.0, p.timePeriod};
  }
  CellPlace timeOf(int octave) const {
    const Span span = timeAxis(0, octave).at(*p.time);
    return {span.low, span.inside};
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
    if (!p.time) return s;
    const auto period = static_cast<int>(timeAxis(0, octave).period());
    if (p.table == Table::kPublished) {
      s.period.z = period;  // its third axis
    } else {
      s.time = timeOf(octave);
      s.timePeriod = period;
    }
    return s;
  }

  double weight(int octave) const { return p.amplitude * std::pow(p.persistence, octave); }
};

// Of what a sum takes of one octave: mean and deviation over the infinite lattice, and the range, outside of
// which it is less than once in ten million samples, if at all.
struct Spread {
  double mean, deviation, low, high;
};

// Measured over 6e7 samples of the fills, two and three dimensions: F1, F2, F2 - F1.
constexpr Spread kCells[2][3] = {
    {{0.4296, 0.1897, 0.0, 1.25}, {0.6989, 0.1762, 0.0, 1.5}, {0.2694, 0.2009, 0.0, 1.4142}},
    {{0.5203, 0.1723, 0.0, 1.25}, {0.7169, 0.1429, 0.0, 1.4}, {0.1966, 0.1581, 0.0, 1.25}}};
// The same of gradient noise of two to four axes: billow, ridged.
constexpr Spread kBent[3][2] = {{{-0.5021, 0.3518, -1.0, 0.87}, {0.1900, 0.4901, -1.0, 1.0}},
                                {{-0.5597, 0.3125, -1.0, 1.073}, {0.2652, 0.4570, -1.0, 1.0}},
                                {{-0.5257, 0.3426, -1.0, 1.93}, {0.2225, 0.4838, -1.0, 1.0}}};
// The same of Perlin's own noise in a plane, which is one of the lattice's planes of his three axes, without
// what corners above and below it would give. Over all 256^2 cells of his permutation, whose neighbours are
// not independent: as hashes are, the sum's deviation would be 0.2529. The range is that of three axes.
constexpr Spread kPublishedPlane[3] = {
    {0.0, 0.2556, -1.0364, 1.0364}, {-0.5852, 0.2987, -1.0, 1.073}, {0.3010, 0.4428, -1.0, 1.0}};

// Of value noise that a fractal bends, which its interpolation decides: by looking.
Spread spreadOfBent(const Value& noise, Fractal fractal, bool plane, double bound) {
  constexpr int kSamples = 1 << 14;
  double sum = 0.0, squares = 0.0;
  Random random(1);
  for (int i = 0; i < kSamples; ++i) {
    const double x = 4096.0 * random.uniform(), y = 4096.0 * random.uniform(), z = 4096.0 * random.uniform();
    const double n = shaped(fractal, noise(x, y, plane ? 0.0 : z));
    sum += n;
    squares += n * n;
  }
  const double mean = sum / kSamples;
  const double high = fractal == Fractal::kBillow ? 2.0 * bound - 1.0 : 1.0;
  return {mean, std::sqrt(squares / kSamples - mean * mean), -1.0, high};
}

Spread spreadOf(const NoiseParams& p) {
  const int dimensions = static_cast<int>(p.dimensions);
  const int axes = p.table == Table::kPublished ? 3 : dimensions + (p.time ? 1 : 0);
  const bool bent = p.fractal != Fractal::kFbm;
  switch (p.kind) {
    case Kind::kPerlin:
    case Kind::kDistorted: {  // distortion moves values about and keeps how frequent they are
      if (p.table == Table::kPublished && dimensions == 2 && !p.time)
        return kPublishedPlane[static_cast<std::size_t>(p.fractal)];
      if (bent) return kBent[axes - 2][p.fractal == Fractal::kBillow ? 0 : 1];
      const double bound = GradientLattice::bound(axes);
      return {0.0, GradientLattice::deviation(axes), -bound, bound};
    }
    case Kind::kValue: {
      ValueSettings settings = Builder{p}.valueSettings(0);
      settings.period = glm::ivec3(0);                 // over the infinite lattice
      if (settings.time) settings.time = CellPlace{};  // one measure for all times, which it fits
      settings.timePeriod = 0;
      const Value noise(settings);
      const int used = p.time && p.table == Table::kPublished ? 3 : dimensions;
      const double bound = noise.bound(used);
      if (bent) return spreadOfBent(noise, p.fractal, used == 2, bound);
      return {0.0, noise.deviation(used), -bound, bound};
    }
    case Kind::kCellular:
      return kCells[dimensions - 2][static_cast<int>(p.feature)];
    case Kind::kPerlinWorley:
    case Kind::kCurl:
      break;
  }
  return {0.0, 1.0, -1.0, 1.0};
}

// Variances of the channels of curl noise.
std::vector<double> curlVariances(const Plan& plan) {
  std::vector<double> variances;
  for (const auto& channel : plan.gradients) {
    double squares = 0.0;
    for (const GradientTerm& t : channel) {
      const double d = t.weight * GradientLattice::slopeDeviation(t.lattice.axes(), t.derivative);
      squares += d * d;
    }
    variances.push_back(squares);
  }
  return variances;
}

// Four deviations of the channel that has the greatest, either way: derivatives have no bound that is of use,
// and grow with frequencies, weights and octaves. 1/2 + v/2 where there is no noise to speak of.
Affine curlLift(const std::vector<double>& variances) {
  const double deviation = std::sqrt(*std::max_element(variances.begin(), variances.end()));
  return {deviation > 1e-30 ? 1.0 / (8.0 * deviation) : 0.5, 0.5, 0.0, 1.0};
}

// Six deviations to either side are the range of curl noise.
Affine curlNormalisation(const NoiseParams& p, double deviation) {
  deviation = std::max(deviation, 1e-300);
  switch (p.normalisation) {
    case Normalisation::kRaw:
      break;
    case Normalisation::kThesis:
      return {0.5, 0.5, 0.0, 1.0};
    case Normalisation::kUnitRange:
      return {1.0 / (12.0 * deviation), 0.5, 0.0, 1.0};
    case Normalisation::kUnitVariance:
      return {1.0 / deviation, 0.0, -kInfinity, kInfinity};
  }
  return {1.0, 0.0, -kInfinity, kInfinity};
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

void finishCurl(const NoiseParams& p, Plan& plan) {
  const std::vector<double> variances = curlVariances(plan);
  const double sum = std::accumulate(variances.begin(), variances.end(), 0.0);
  plan.normalise = curlNormalisation(p, std::sqrt(sum / static_cast<double>(variances.size())));
  if (p.normalisation == Normalisation::kRaw) plan.quantise = curlLift(variances);
}

// Where a kind's range is known beforehand.
Affine fixedLift(const NoiseParams& p) {
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
  const bool measured =
      p.normalisation == Normalisation::kUnitRange || p.normalisation == Normalisation::kUnitVariance;
  plan.normalise = normalisation(p, measured ? spreadOf(p) : Spread{0.0, 1.0, -1.0, 1.0});
  plan.quantise = fixedLift(p);
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
      finishCurl(p, plan);
      break;
    case Kind::kDistorted:
      for (int o = 0; o < p.octaves; ++o) {
        DistortedTerm t{b.lattice(kNoise, 0, o), {}, b.weight(o)};
        for (int i = 0; i < dimensions; ++i)
          t.fields.push_back(
              {b.lattice(kDistortion, i, o, kDistortionStretch[static_cast<std::size_t>(i)], 0.5), 1.0});
        plan.distorted.push_back(std::move(t));
      }
      break;
  }
  return plan;
}

Lift liftOf(const NoiseParams& p) {
  const bool curl = p.kind == Kind::kCurl && p.normalisation == Normalisation::kRaw;
  const Affine lift = curl ? makePlan(p).quantise : fixedLift(p);
  return {static_cast<float>(lift.scale), static_cast<float>(lift.bias)};
}

}  // namespace welkin::noise
