// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/noise.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include "welkin/core/error.h"
#include "welkin/noise/fill.h"
#include "welkin/noise/plan.h"
#include "welkin/noise/value_sum.h"

namespace welkin::noise {
namespace {

double sumOf(const std::vector<GradientTerm>& terms, Fractal fractal, const std::array<double, 4>& place) {
  double sum = 0.0;
  for (const GradientTerm& t : terms) {
    const ValueAndGradient n = t.lattice.at(place);
    sum += t.weight * shaped(fractal, t.derivative < 0 ? n.value : n.gradient[t.derivative]);
  }
  return sum;
}

double sumOf(const std::vector<DistortedTerm>& terms, Fractal fractal, double distortion,
             const std::array<double, 4>& place) {
  double sum = 0.0;
  for (const DistortedTerm& t : terms) {
    std::array<double, 4> shift{};
    for (std::size_t i = 0; i < t.fields.size(); ++i)
      shift[i] = distortion * t.fields[i].lattice.at(place).value;
    sum += t.weight * shaped(fractal, t.main.at(place, shift).value);
  }
  return sum;
}

double sumOf(const std::vector<CellTerm>& terms, Feature feature, const std::array<double, 3>& place) {
  double sum = 0.0;
  for (const CellTerm& t : terms) {
    const Distances d = t.lattice.at(place);
    sum += t.weight * (feature == Feature::kF1 ? d.f1 : feature == Feature::kF2 ? d.f2 : d.f2 - d.f1);
  }
  return sum;
}

double apply(const Affine& a, double v) {
  return std::clamp(a.scale * v + a.bias, a.low, a.high);
}

bool isFinite(const glm::dvec3& p, int dimensions) {
  for (int i = 0; i < dimensions; ++i)
    if (!std::isfinite(p[i])) return false;
  return true;
}

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

}  // namespace

struct Noise::Impl {
  Plan plan;
};

Noise::Noise(const NoiseParams& params) : params_(params) {
  validate(params);
  impl_ = std::make_unique<const Impl>(Impl{makePlan(params)});
}
Noise::~Noise() = default;
Noise::Noise(Noise&&) noexcept = default;
Noise& Noise::operator=(Noise&&) noexcept = default;

int Noise::channels() const {
  if (params_.kind == Kind::kCurl) return static_cast<int>(params_.dimensions);
  return params_.kind == Kind::kPerlinWorley ? 4 : 1;
}

double Noise::sample(const glm::dvec3& p, int channel) const {
  assert(channel >= 0 && channel < channels());
  const Plan& plan = impl_->plan;
  if (!isFinite(p, static_cast<int>(params_.dimensions))) return kNoNumber;
  std::array<double, 4> place{p.x, p.y, p.z, 0.0};
  const std::array<double, 3> inSpace{p.x, p.y, p.z};
  place[static_cast<std::size_t>(params_.dimensions)] = params_.time.value_or(0.0);
  double raw = 0.0;
  switch (params_.kind) {
    case Kind::kPerlin:
    case Kind::kCurl:
      raw = sumOf(plan.gradients[static_cast<std::size_t>(channel)], params_.fractal, place);
      break;
    case Kind::kDistorted:
      raw = sumOf(plan.distorted, params_.fractal, params_.distortion, place);
      break;
    case Kind::kCellular:
      raw = sumOf(plan.cells, params_.feature, inSpace);
      break;
    case Kind::kValue:
      raw = valueSum(plan.values, params_, p);
      break;
    case Kind::kPerlinWorley: {
      std::array<double, 4> cells;
      for (std::size_t i = 0; i < 4; ++i)
        cells[i] = std::clamp(1.0 - plan.cells[i].lattice.at(inSpace).f1, 0.0, 1.0);
      const double n = sumOf(plan.gradients[0], Fractal::kFbm, place);
      raw = perlinWorley(std::clamp(0.5 + 0.5 * n, 0.0, 1.0), cells)[static_cast<std::size_t>(channel)];
      break;
    }
  }
  return apply(plan.normalise, raw);
}

Noise::Slope Noise::sampleSlope(const glm::dvec3& p) const {
  const bool value = params_.kind == Kind::kValue;
  if ((params_.kind != Kind::kPerlin && !value) || params_.fractal != Fractal::kFbm)
    throw ParameterError("only sums (fbm) of Perlin and value noise have slopes");
  if (!isFinite(p, static_cast<int>(params_.dimensions))) return {kNoNumber, glm::dvec3(kNoNumber)};
  if (value) {
    const ValueAndSlope s = valueSlope(impl_->plan.values, params_, p);
    return {s.value, s.slope};
  }
  std::array<double, 4> place{p.x, p.y, p.z, 0.0};
  place[static_cast<std::size_t>(params_.dimensions)] = params_.time.value_or(0.0);
  Slope s{0.0, glm::dvec3(0.0)};
  for (const GradientTerm& t : impl_->plan.gradients[0]) {
    const ValueAndGradient n = t.lattice.at(place);
    s.value += t.weight * n.value;
    for (int i = 0; i < params_.dimensions; ++i)
      s.gradient[i] += t.weight * n.gradient[i] * t.lattice.axis(i).frequency();
  }
  return s;
}

namespace {

Half halfOf(float v) {
  // Scaled so that the float's own rounding to nearest even falls on the last bit of the half.
  const float magnitude = std::abs(v);
  const std::uint16_t sign = std::signbit(v) ? 0x8000 : 0;
  if (!(magnitude < 65520.0f)) return {static_cast<std::uint16_t>(sign | (std::isnan(v) ? 0x7e00 : 0x7c00))};
  if (magnitude == 0.0f) return {sign};
  int exponent = 0;
  std::frexp(magnitude, &exponent);
  const int ulp = std::max(exponent - 11, -24);
  const int steps = static_cast<int>(std::nearbyint(std::ldexp(magnitude, -ulp)));  // up to 2048
  const int bits = steps + ((ulp + 24) << 10);
  return {static_cast<std::uint16_t>(sign | bits)};
}

// A normalised value.
template <class T>
T storedAs(const Plan& plan, double v) {
  if constexpr (std::is_same_v<T, float>)
    return static_cast<float>(v);
  else if constexpr (std::is_same_v<T, Half>)
    return halfOf(static_cast<float>(v));
  else
    return static_cast<T>(std::lround(std::numeric_limits<T>::max() * apply(plan.quantise, v)));
}

template <class T>
void fillPointwiseAs(const FillJob& job, const Block& b) {
  const glm::ivec3& size = job.box.size;
  for (int z = b.z; z < b.z + b.slices; ++z)
    for (int y = b.y; y < b.y + b.rows; ++y) {
      T* out = static_cast<T*>(job.out) + ((static_cast<std::size_t>(z) * size.y + y) * size.x + b.x) *
                                              static_cast<std::size_t>(job.channels);
      for (int x = b.x; x < b.x + b.width; ++x) {
        const glm::dvec3 p = (glm::dvec3(job.box.first + glm::ivec3(x, y, z)) + 0.5) * job.grid.spacing;
        for (int c = 0; c < job.channels; ++c, ++out) *out = storedAs<T>(*job.plan, job.noise->sample(p, c));
      }
    }
}

template <class T>
constexpr Format kFormatOf = Format::kFloat;
template <>
constexpr Format kFormatOf<std::uint8_t> = Format::kUint8;
template <>
constexpr Format kFormatOf<std::uint16_t> = Format::kUint16;
template <>
constexpr Format kFormatOf<Half> = Format::kHalf;

}  // namespace

void fillPointwise(const FillJob& job, const Block& block) {
  switch (job.format) {
    case Format::kUint8:
      return fillPointwiseAs<std::uint8_t>(job, block);
    case Format::kUint16:
      return fillPointwiseAs<std::uint16_t>(job, block);
    case Format::kHalf:
      return fillPointwiseAs<Half>(job, block);
    case Format::kFloat:
      return fillPointwiseAs<float>(job, block);
  }
}

template <class T>
void Noise::fill(const Grid& grid, const Box& box, std::span<T> out) const {
  auto text = [](const glm::ivec3& v) {
    return std::to_string(v.x) + " x " + std::to_string(v.y) + " x " + std::to_string(v.z);
  };
  for (int i = 0; i < 3; ++i) {
    if (grid.size[i] < 1 || !(grid.spacing[i] > 0.0) || !std::isfinite(grid.spacing[i]))
      throw ParameterError("the grid of " + text(grid.size) + " samples is empty or has no spacing");
    if (box.size[i] < 1 || box.first[i] < 0 || box.size[i] > grid.size[i] - box.first[i])
      throw ParameterError("the box of " + text(box.size) + " samples is not part of the grid of " +
                           text(grid.size));
  }
  if (params_.dimensions == 2 && grid.size.z != 1)
    throw ParameterError("noise in a plane fills grids of one slice, not " + text(grid.size));
  const std::size_t samples = static_cast<std::size_t>(box.size.x) * box.size.y * box.size.z;
  if (out.size() != samples * static_cast<std::size_t>(channels()))
    throw ParameterError("a buffer of " + std::to_string(out.size()) + " values is not what " +
                         text(box.size) + " samples of " + std::to_string(channels()) + " need");

  FillJob job{};
  job.noise = this;
  job.plan = &impl_->plan;
  job.params = &params_;
  job.grid = grid;
  job.box = box;
  job.format = kFormatOf<T>;
  job.out = out.data();
  job.channels = channels();
  fillGrid(job);
}

template void Noise::fill(const Grid&, const Box&, std::span<std::uint8_t>) const;
template void Noise::fill(const Grid&, const Box&, std::span<std::uint16_t>) const;
template void Noise::fill(const Grid&, const Box&, std::span<Half>) const;
template void Noise::fill(const Grid&, const Box&, std::span<float>) const;

}  // namespace welkin::noise
