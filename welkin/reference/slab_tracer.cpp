// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/slab_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/core/units.h"
#include "welkin/optics/mie_phase.h"
#include "welkin/optics/phase.h"
#include "welkin/reference/directions.h"
#include "welkin/reference/phase_sampler.h"

namespace welkin::reference {
namespace {

// A batch has as many paths as its lattice has points: a prime, so that every generator but 0 is of full
// period.
constexpr std::uint64_t kLatticePoints = 4093;
constexpr std::uint64_t kLatticeGenerator = 1516;                 // Korobov's form: powers of it
constexpr int kLatticeDims = 32;                                  // later ones are random
constexpr std::uint64_t kBatchesInRound = 32, kLeastBatches = 8;  // fewer know no error
// Light that is left below this share of the path's goes on with a chance.
constexpr double kRouletteBelow = 0.03, kRouletteTo = 0.1;
constexpr double kThin = 1e-3;    // an optical depth below which 1 - exp(-x) loses digits
constexpr double kOpaque = 80.0;  // an optical depth through which 2e-35 of the light comes

enum Quantity { kUp, kDownDirect, kDownDiffuse, kAbsorbed, kNadir, kQuantities };
using Sums = std::vector<std::array<double, kQuantities>>;  // by column

// The numbers of one path: a point of a shifted lattice, then random ones.
class PathNumbers {
 public:
  PathNumbers(const std::array<double, kLatticeDims>& shifts,
              const std::array<std::uint64_t, kLatticeDims>& z, std::uint64_t point, Random random)
      : shifts_(shifts), z_(z), point_(point), random_(random) {}

  double next() {
    if (dim_ >= kLatticeDims) return unit(random_);
    const auto d = static_cast<std::size_t>(dim_++);
    double x = static_cast<double>(point_ * z_[d] % kLatticePoints) / kLatticePoints + shifts_[d];
    if (x >= 1.0) x -= 1.0;
    return std::min(x, 1.0 - 0x1p-53);
  }
  double nextRandom() { return unit(random_); }  // for choices that jump: roulette

 private:
  const std::array<double, kLatticeDims>& shifts_;
  const std::array<std::uint64_t, kLatticeDims>& z_;
  std::uint64_t point_;
  Random random_;
  int dim_ = 0;
};

PhaseSampler phaseOf(const scene::Slab& slab) {
  switch (slab.phase) {
    case scene::SlabPhase::kRayleigh:
      return PhaseSampler::tabulated([](double c) { return optics::phaseRayleigh(static_cast<float>(c)); });
    case scene::SlabPhase::kDroplets: {
      const auto fit = optics::dropletPhase(static_cast<float>(slab.dropletDiameterUm));
      return PhaseSampler::tabulated(
          [fit](double c) { return optics::phaseDroplet(static_cast<float>(c), fit); });
    }
    case scene::SlabPhase::kMie:
      return PhaseSampler::tabulated(
          [d = slab.dropletDiameterUm](double c) { return optics::phaseMieDroplet(c, d); });
    case scene::SlabPhase::kHenyeyGreenstein:
      break;
  }
  return PhaseSampler::henyeyGreenstein(slab.asymmetry);
}

class SlabTracer {
 public:
  explicit SlabTracer(const scene::Slab& slab)
      : slab_(slab), phase_(phaseOf(slab)), depths_(slab.depths()), count_(depths_.size()) {
    height_ = slab.thicknessM;
    width_ = slab.periodM / static_cast<double>(count_);
    for (const double d : depths_) sigma_.push_back(d / height_);
    const double zenith = slab.sunZenithDeg * kPi / 180.0, azimuth = slab.sunAzimuthDeg * kPi / 180.0;
    sun_ = -glm::dvec3(std::sin(zenith) * std::sin(azimuth), std::sin(zenith) * std::cos(azimuth),
                       std::cos(zenith));
  }

  // Traces a batch, adds to `sums` and returns the number of events.
  std::uint64_t traceBatch(std::uint64_t seed, Sums& sums) const {
    Random random(seed);
    std::array<double, kLatticeDims> shifts{};
    std::array<std::uint64_t, kLatticeDims> z{};
    std::uint64_t power = 1;
    for (std::size_t d = 0; d < kLatticeDims; ++d) {
      shifts[d] = unit(random);
      z[d] = power;
      power = power * kLatticeGenerator % kLatticePoints;
    }
    std::uint64_t events = 0;
    for (std::uint64_t i = 0; i < kLatticePoints; ++i)
      events += tracePath(PathNumbers(shifts, z, i, Random(hashOf(seed, i))), sums);
    return events;
  }

  std::size_t columns() const { return count_; }

 private:
  // A place between two horizontal planes; x within the period.
  struct Place {
    double x = 0.0, z = 0.0;
    std::size_t column = 0;
  };

  // Goes along w until the optical depth is spent or the slab is left; returns the depth that was spent.
  double walk(Place& p, const glm::dvec3& w, double depth) const {
    const double toExit = exitDistance(p, w);
    if (count_ == 1) {
      const double whole = sigma_[0] * toExit;
      if (whole <= depth) return p.z = w.z > 0.0 ? height_ : 0.0, whole;
      p.z = std::clamp(p.z + w.z * depth / sigma_[0], 0.0, height_);
      return depth;
    }
    const double invX = std::abs(w.x) > 1e-12 ? 1.0 / w.x : 0.0;
    double left = toExit, spent = 0.0;
    for (;;) {
      const double edge = width_ * static_cast<double>(p.column + (w.x > 0.0 ? 1 : 0));
      const double toEdge = invX != 0.0 ? std::max(0.0, (edge - p.x) * invX) : left;
      const double d = std::min(toEdge, left), here = sigma_[p.column] * d;
      if (spent + here > depth) {
        const double part = (depth - spent) / sigma_[p.column];
        p.x += w.x * part;
        p.z = std::clamp(p.z + w.z * part, 0.0, height_);
        return depth;
      }
      spent += here;
      left -= d;
      p.z += w.z * d;
      if (left <= 0.0) {
        p.x += w.x * d;
        p.z = w.z > 0.0 ? height_ : 0.0;
        return spent;
      }
      if (w.x > 0.0) {
        p.column = p.column + 1 == count_ ? 0 : p.column + 1;
        p.x = width_ * static_cast<double>(p.column);
      } else {
        p.column = p.column == 0 ? count_ - 1 : p.column - 1;
        p.x = width_ * static_cast<double>(p.column + 1);
      }
    }
  }

  // Along w to the top or to the ground.
  double exitDistance(const Place& p, const glm::dvec3& w) const {
    const double up = w.z > 0.0 ? height_ - p.z : p.z;
    return up / std::max(std::abs(w.z), 1e-9);
  }

  // A homogeneous slab is the same from all sides: only the height of the way counts there.
  glm::dvec3 scattered(glm::dvec3 w, double cosine, double phi) const {
    if (count_ > 1) return turned(w, cosine, phi);
    const double sines = std::sqrt(std::max(0.0, (1.0 - cosine * cosine) * (1.0 - w.z * w.z)));
    w.z = std::clamp(cosine * w.z + sines * std::cos(phi), -1.0, 1.0);
    return w;
  }

  void lambert(PathNumbers& numbers, glm::dvec3& w, double sign) const {
    const double u = numbers.next(), phi = 2.0 * kPi * numbers.next(), r = std::sqrt(1.0 - u);
    w = {r * std::cos(phi), r * std::sin(phi), sign * std::max(std::sqrt(u), 1e-9)};
  }

  void addNadir(Sums& sums, const Place& p, double light) const {
    sums[p.column][kNadir] += light * std::exp(-sigma_[p.column] * (height_ - p.z));
  }

  std::uint64_t tracePath(PathNumbers numbers, Sums& sums) const {
    Place p;
    p.z = height_;
    glm::dvec3 w = sun_;
    if (count_ > 1) {
      const double x = numbers.next() * static_cast<double>(count_);
      p.column = std::min(static_cast<std::size_t>(x), count_ - 1);
      p.x = x * width_;
    }
    if (slab_.light == scene::SlabLight::kDiffuse) lambert(numbers, w, -1.0);
    double weight = 1.0;
    std::uint64_t events = 0;
    bool fresh = true;  // neither scattered nor reflected
    for (;;) {
      // What leaves without another collision is counted in full, and the rest goes on.
      Place exit = p;
      const double depth = walk(exit, w, kOpaque);
      const double through = depth >= kOpaque ? 0.0 : std::exp(-depth);
      double onGround = 0.0;  // share of the light that the ground sends back
      if (w.z > 0.0) {
        sums[exit.column][kUp] += weight * through;
      } else {
        sums[exit.column][fresh ? kDownDirect : kDownDiffuse] += weight * through;
        onGround = through * slab_.groundAlbedo;
      }
      fresh = false;
      if (onGround > 0.0) addNadir(sums, exit, weight * onGround);  // Lambert: I = F / pi
      const double collides = depth < kThin ? -std::expm1(-depth) : 1.0 - through,
                   goesOn = collides + onGround;
      if (goesOn <= 0.0) return events;
      weight *= goesOn;
      ++events;
      if (onGround > 0.0 && numbers.nextRandom() * goesOn < onGround) {
        p = exit;
        p.z = 0.0;
        lambert(numbers, w, 1.0);
      } else {
        const double u = numbers.next() * collides;
        walk(p, w, std::min(depth < kThin ? -std::log1p(-u) : -std::log(1.0 - u), depth));
        sums[p.column][kAbsorbed] += weight * (1.0 - slab_.albedo);
        weight *= slab_.albedo;
        addNadir(sums, p, weight * kPi * phase_.density(w.z));
        const double cosine = phase_.sampleCosine(numbers.next());
        w = scattered(w, cosine, 2.0 * kPi * numbers.next());
        if (std::abs(w.z) < 1e-9) w.z = std::copysign(1e-9, w.z);
      }
      if (weight < kRouletteBelow) {
        if (numbers.nextRandom() * kRouletteTo >= weight) return events;
        weight = kRouletteTo;
      }
    }
  }

  const scene::Slab& slab_;
  PhaseSampler phase_;
  std::vector<double> depths_, sigma_;
  std::size_t count_;
  double height_ = 0.0, width_ = 0.0;
  glm::dvec3 sun_{};  // the way its light goes
};

// Sums over batches of one quantity and of its square.
struct Moments {
  double sum = 0.0, squares = 0.0;
  void add(double x) {
    sum += x;
    squares += x * x;
  }
  Estimate estimate(double batches) const {
    const double mean = sum / batches;
    return {mean, std::sqrt(std::max(0.0, squares / batches - mean * mean) / std::max(batches - 1.0, 1.0))};
  }
};
using FlowMoments =
    std::array<Moments, kQuantities + 2>;  // the last two: all that comes down, and that is diffuse

void addFlow(FlowMoments& m, const std::array<double, kQuantities>& sums, double paths) {
  for (std::size_t q = 0; q < kQuantities; ++q) m[q].add(sums[q] / paths);
  m[kQuantities].add((sums[kDownDirect] + sums[kDownDiffuse]) / paths);
}

SlabLightFlow flowOf(const FlowMoments& m, double batches) {
  return {m[kUp].estimate(batches),         m[kQuantities].estimate(batches),
          m[kDownDirect].estimate(batches), m[kDownDiffuse].estimate(batches),
          m[kAbsorbed].estimate(batches),   m[kNadir].estimate(batches)};
}

double relativeError(const Estimate& e) {
  return e.error / std::max(std::abs(e.value), 1e-4);
}

// The largest error as a multiple of the one wanted.
double excess(const SlabResult& r, double noise) {
  double worst = std::max({relativeError(r.total.reflectance), relativeError(r.total.transmittance),
                           relativeError(r.total.nadirRadiance)});
  if (r.columns.size() > 1)
    for (const SlabLightFlow& c : r.columns)
      worst = std::max({worst, relativeError(c.reflectance) / 3.0, relativeError(c.transmittance) / 3.0});
  return worst / noise;
}

}  // namespace

SlabResult traceSlab(const scene::Slab& slab, const SlabSettings& settings,
                     const std::function<void(const SlabResult&, double)>& progress) {
  if (slab.empty()) throw ParameterError("the slab is empty; expected an optical depth or columns");
  if (settings.maxPaths == 0 && !(settings.noise > 0.0))
    throw ParameterError("nothing ends the paths; expected a noise above 0 or a number of paths");
  const SlabTracer tracer(slab);
  const std::size_t columns = tracer.columns();
  const double pathsOfColumn = static_cast<double>(kLatticePoints) / static_cast<double>(columns);
  FlowMoments total{};
  std::vector<FlowMoments> byColumn(columns);
  SlabResult result;
  result.columns.resize(columns);
  std::uint64_t batch = 0;
  for (;;) {
    std::uint64_t round = kBatchesInRound;
    if (settings.maxPaths > 0) {
      const std::uint64_t wanted = std::max((settings.maxPaths - 1) / kLatticePoints + 1, kLeastBatches);
      round = std::min(round, wanted - batch);
    }
    std::vector<Sums> sums(round, Sums(columns));
    std::vector<std::uint64_t> events(round);
    parallelFor(round, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        events[i] = tracer.traceBatch(hashOf(settings.seed, 0x51ab, batch + i), sums[i]);
    });
    for (std::size_t i = 0; i < round; ++i) {
      std::array<double, kQuantities> all{};
      for (std::size_t c = 0; c < columns; ++c) {
        addFlow(byColumn[c], sums[i][c], pathsOfColumn);
        for (std::size_t q = 0; q < kQuantities; ++q) all[q] += sums[i][c][q];
      }
      addFlow(total, all, static_cast<double>(kLatticePoints));
      result.events += events[i];
    }
    batch += round;
    const auto batches = static_cast<double>(batch);
    result.paths = batch * kLatticePoints;
    result.total = flowOf(total, batches);
    for (std::size_t c = 0; c < columns; ++c) result.columns[c] = flowOf(byColumn[c], batches);
    double done = 0.0;
    if (settings.noise > 0.0) {
      const double times = excess(result, settings.noise);
      result.reachedNoise = times <= 1.0;
      done = std::min(1.0, 1.0 / (times * times + 1e-30));
    }
    if (settings.maxPaths > 0)
      done = std::max(done, static_cast<double>(result.paths) / static_cast<double>(settings.maxPaths));
    if (progress) progress(result, std::min(done, 1.0));
    if (done >= 1.0) return result;
  }
}

}  // namespace welkin::reference
