// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/living_pattern.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "welkin/core/glsl.h"
#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/noise/gradient.h"
#include "welkin/weather/wind.h"

namespace welkin::scene {
namespace {

using namespace welkin::glsl;
#include "shaders/lib/octaves.glsl"

constexpr int kMaxSide = 32;

// A point's share of the place u cells from it, one axis. Of gradients: of its component along the other axis
// (even), and of its component along this one (odd).
double tent(double u) {
  return std::max(1.0 - std::abs(u), 0.0);
}
double gaussian(double u) {
  const auto g = [](double d) { return std::exp(-2.0 * d * d); };
  const double f = u - std::floor(u);  // the points' distances are f + 1, f, f - 1 and f - 2
  return std::abs(u) < 2.0 ? g(u) / (g(f + 1.0) + g(f) + g(f - 1.0) + g(f - 2.0)) : 0.0;
}
double even(double u) {
  return std::abs(u) < 1.0 ? 1.0 - noise::fade(std::abs(u)) : 0.0;
}
double odd(double u) {
  return u * even(u);
}

// Integral of a(u) b(u - d), by the midpoint rule.
template <class A, class B>
double overlap(A a, B b, int d) {
  constexpr int kSteps = 256;  // a cell
  double sum = 0.0;
  for (int i = -2 * kSteps; i < 2 * kSteps; ++i) {
    const double u = (i + 0.5) / kSteps;
    sum += a(u) * b(u - d);
  }
  return sum / kSteps;
}

}  // namespace

// The numbers of a lattice with as many rows and columns about it, repeated, as kernels reach.
struct LivingPattern::Numbers {
  static constexpr int kAround = 3, kStride = kMaxSide + 2 * kAround;
  std::array<float, kStride * kStride> x{}, y{};

  static std::size_t index(int i, int j) {
    return static_cast<std::size_t>((j + kAround) * kStride + i + kAround);
  }
  void repeat(int side) {
    const auto wrapped = [side](int i) { return ((i % side) + side) % side; };
    for (int j = -kAround; j < side + kAround; ++j)
      for (int i = -kAround; i < side + kAround; ++i) {
        const std::size_t from = index(wrapped(i), wrapped(j));
        x[index(i, j)] = x[from];
        y[index(i, j)] = y[from];
      }
  }
};

LivingPattern::LivingPattern(const Sheet& sheet, std::uint64_t seed) : living_(sheet.living), seed_(seed) {
  const bool gradient = living_.kernel == OctaveKernel::kGradient;
  scroll_ = weather::windTowards(sheet.windFromDeg) * (living_.scrollMps / sheet.tileM);

  auto cells = static_cast<int>(cellsOf(sheet));
  double amplitude = sheet.amplitude, intervalS = living_.intervalS;
  for (std::int64_t k = 0; k < sheet.octaves && k < kMaxLivingOctaves; ++k) {
    if (k > 0 && cells > sheet.texels) break;
    int side = cells;
    while (side > kMaxSide && side % 2 == 0) side /= 2;
    assert(side <= kMaxSide);
    octaves_.push_back({cells, side, amplitude, intervalS});
    cells *= 2;
    amplitude *= sheet.persistence;
    intervalS *= living_.intervalRatio;
  }

  double variance = 0.0;
  const auto term = [&](int dx, int dy, double xx, double xy, double yy) {
    if (std::abs(xx) + std::abs(xy) + std::abs(yy) > 1e-7)
      covariance_.push_back({dx, dy, static_cast<float>(xx), static_cast<float>(xy), static_cast<float>(yy)});
  };
  constexpr int kReach = Numbers::kAround;
  for (int dy = -kReach; dy <= kReach; ++dy)
    for (int dx = -kReach; dx <= kReach; ++dx)
      if (gradient)
        term(dx, dy, overlap(odd, odd, dx) * overlap(even, even, dy),
             overlap(odd, even, dx) * overlap(even, odd, dy),
             overlap(even, even, dx) * overlap(odd, odd, dy));
      else if (living_.kernel == OctaveKernel::kPallister)
        term(dx, dy, overlap(tent, tent, dx) * overlap(tent, tent, dy), 0.0, 0.0);
      else
        term(dx, dy, overlap(gaussian, gaussian, dx) * overlap(gaussian, gaussian, dy), 0.0, 0.0);
  // Of the numbers themselves: eight directions of the same length, or uniform in [-1, 1].
  const auto g = noise::gradientOf(2, 0);
  const double power = gradient ? 0.5 * (g[0] * g[0] + g[1] * g[1]) : 1.0 / 3.0;
  for (const Term& t : covariance_)
    if (t.dx == 0 && t.dy == 0) variance = power * (t.xx + t.yy);
  deviation_ = std::sqrt(variance);
}

double LivingPattern::shown(double secondsAfter) const {
  if (living_.updatesPerS <= 0.0) return secondsAfter;
  return std::floor(secondsAfter * living_.updatesPerS) / living_.updatesPerS;
}

// Times `weight`, onto what is there.
void LivingPattern::add(int octave, double j, double weight, Numbers& numbers) const {
  // Keyframes far beyond the integers of 64 bits have numbers, too: j is hashed by its bits, 0 as +0.
  Random random(hashOf(seed_, static_cast<std::uint64_t>(octave), std::bit_cast<std::uint64_t>(j + 0.0)));
  const bool gradient = living_.kernel == OctaveKernel::kGradient;
  const float w = static_cast<float>(weight);
  const int side = octaves_[static_cast<std::size_t>(octave)].side;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const std::size_t i = Numbers::index(x, y);
      if (gradient) {
        const auto g = noise::gradientOf(2, static_cast<std::uint32_t>(random.next() >> 32));
        numbers.x[i] += w * g[0];
        numbers.y[i] += w * g[1];
      } else {
        numbers.x[i] += w * (2.0f * random.uniform() - 1.0f);
      }
    }
}

std::vector<glm::vec2> LivingPattern::keyframe(int octave, double j) const {
  Numbers numbers;
  add(octave, j, 1.0, numbers);
  std::vector<glm::vec2> out;
  for (int y = 0; y < side(octave); ++y)
    for (int x = 0; x < side(octave); ++x)
      out.emplace_back(numbers.x[Numbers::index(x, y)], numbers.y[Numbers::index(x, y)]);
  return out;
}

// Takes the mean off and returns the factor that gives the octave its usual deviation again.
double LivingPattern::preserve(const Octave& octave, Numbers& numbers) const {
  const int side = octave.side;
  const double count = static_cast<double>(side) * side;
  if (living_.kernel != OctaveKernel::kGradient) {  // that of gradients is 0, as each point's share is odd
    double sum = 0.0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) sum += numbers.x[Numbers::index(x, y)];
    const float mean = static_cast<float>(sum / count);
    for (float& x : numbers.x) x -= mean;
  }
  double variance = 0.0;
  for (int y = 0; y < side; ++y) {
    std::array<float, kMaxSide> sum{};
    const float* x = &numbers.x[Numbers::index(0, y)];
    const float* yy = &numbers.y[Numbers::index(0, y)];
    for (const Term& t : covariance_) {
      const std::ptrdiff_t d = t.dy * Numbers::kStride + t.dx;
      for (int i = 0; i < side; ++i)
        sum[static_cast<std::size_t>(i)] +=
            x[i] * (t.xx * x[i + d] + 2.0f * t.xy * yy[i + d]) + t.yy * yy[i] * yy[i + d];
    }
    for (int i = 0; i < side; ++i) variance += sum[static_cast<std::size_t>(i)];
  }
  // Few points may all but cancel; then there is nothing to preserve.
  return deviation_ / std::max(std::sqrt(std::max(variance / count, 0.0)), 0.1 * deviation_);
}

void LivingPattern::at(double secondsAfter, LivingInstant& out) const {
  out.count = count();
  out.base = 0.0f;
  for (int k = 0; k < out.count; ++k) {
    const Octave& octave = octaves_[static_cast<std::size_t>(k)];
    OctaveNow& now = out.octaves[static_cast<std::size_t>(k)];
    const double t = secondsAfter / octave.intervalS, j = std::floor(t), w = t - j;
    Numbers numbers;
    add(k, j, 1.0 - w, numbers);
    if (w > 0.0) add(k, j + 1.0, w, numbers);
    numbers.repeat(octave.side);
    const double gain = living_.blend == OctaveBlend::kVariancePreserving ? preserve(octave, numbers) : 1.0;
    const float scale = static_cast<float>(0.5 * octave.amplitude * gain);

    if (now.lattice.width != octave.side) now.lattice = Image<float>(octave.side, octave.side, 4);
    float* texel = now.lattice.data.data();
    for (int y = 0; y < octave.side; ++y)
      for (int x = 0; x < octave.side; ++x, texel += 4) {
        const float* here = &numbers.x[Numbers::index(x, y)];
        const float* other = &numbers.y[Numbers::index(x, y)];
        switch (living_.kernel) {
          case OctaveKernel::kGradient:
            texel[0] = scale * here[0], texel[1] = scale * other[0];
            texel[2] = scale * here[1], texel[3] = scale * other[1];
            break;
          case OctaveKernel::kPallister:
            texel[0] = scale * here[0], texel[1] = scale * here[1];
            texel[2] = scale * here[Numbers::kStride], texel[3] = scale * here[Numbers::kStride + 1];
            break;
          case OctaveKernel::kCourse:
            for (int i = 0; i < 4; ++i) texel[i] = scale * here[i - 1];
            break;
        }
      }
    now.cells = static_cast<float>(octave.cells);
    const glm::dvec2 tiles = -scroll_ * (static_cast<double>(k) * secondsAfter);
    now.shift = glm::vec2(glm::mod((tiles - glm::floor(tiles)) * static_cast<double>(octave.cells),
                                   static_cast<double>(octave.side)));
    out.base += static_cast<float>(0.5 * octave.amplitude);
  }
}

Image<float> LivingPattern::image(double secondsAfter, int texels) const {
  LivingInstant now;
  at(secondsAfter, now);
  Image<float> out(texels, texels, 1);
  parallelFor(static_cast<std::size_t>(texels), 8, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < texels; ++x) {
        const vec2 uv = (vec2(x, y) + 0.5f) / static_cast<float>(texels);
        float sum = now.base;
        for (int k = 0; k < now.count; ++k) {
          const OctaveNow& o = now.octaves[static_cast<std::size_t>(k)];
          const sampler2D lattice{&o.lattice, glsl::Wrap::kRepeat, glsl::Wrap::kRepeat};
          const float side = static_cast<float>(o.lattice.width);
          const vec2 place = uv * o.cells + o.shift;
          sum += living_.kernel == OctaveKernel::kGradient    ? octaveGradient(lattice, side, place)
                 : living_.kernel == OctaveKernel::kPallister ? octavePallister(lattice, side, place)
                                                              : octaveCourse(lattice, side, place);
        }
        out.at(x, y) = std::clamp(sum, 0.0f, 1.0f);
      }
  });
  return out;
}

std::vector<float> LivingPattern::samples() const {
  constexpr int kInstants = 8, kTexels = 128;
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(kInstants) * kTexels * kTexels);
  for (int i = 0; i < kInstants; ++i) {
    // Intervals apart, so that keyframes are others each time, at all stages of the blend.
    const Image<float> one = image(octaves_[0].intervalS * (1.0 + 1.0 / kInstants) * i, kTexels);
    values.insert(values.end(), one.data.begin(), one.data.end());
  }
  return values;
}

}  // namespace welkin::scene
