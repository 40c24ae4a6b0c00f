// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/drift.h"

#include <algorithm>
#include <cmath>

#include "welkin/core/random.h"
#include "welkin/core/units.h"
#include "welkin/weather/wind.h"

namespace welkin::scene {
namespace {

constexpr double kHourS = 3600.0;
constexpr int kFiner = 2;  // cells of the second octave in one of the first
constexpr int kSteps = 4;  // of the fixed partition, a period; both octaves have their knots between them

// Gradient noise on a line that returns after `period` cells, within [-1/2, 1/2]. Neighbouring cells share
// their gradients and each cell's mean is a difference of its two: over a loop they cancel.
double gradientNoise(std::uint64_t seed, std::int64_t period, double x) {
  const double cell = std::floor(x), f = x - cell;
  const auto gradient = [&](std::int64_t i) {
    const std::uint64_t h = hashOf(seed, static_cast<std::uint64_t>((i % period + period) % period));
    return static_cast<double>(h >> 11) * 0x1p-52 - 1.0;
  };
  const auto i = static_cast<std::int64_t>(cell);
  const double fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  const double a = gradient(i) * f, b = gradient(i + 1) * (f - 1.0);
  return a + fade * (b - a);
}

glm::dvec2 velocity(const Drift& d, std::uint64_t seed, double windFromDeg, double x) {
  return weather::windTowards(windFromDeg + d.windDeg * driftNoise(seed, x));
}

// Gauss and Legendre, five points: exact for polynomials of degree nine.
glm::dvec2 integral(const Drift& d, std::uint64_t seed, double windFromDeg, double from, double to) {
  constexpr double kAt[] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                            0.9061798459386640};
  constexpr double kWeight[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                0.4786286704993665, 0.2369268850561891};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  glm::dvec2 sum(0.0);
  for (int i = 0; i < 5; ++i) sum += kWeight[i] * velocity(d, seed, windFromDeg, middle + half * kAt[i]);
  return half * sum;
}

// Over [0, x] of a loop.
glm::dvec2 pathInLoop(const Drift& d, std::uint64_t seed, double windFromDeg, double x) {
  glm::dvec2 path(0.0);
  const int whole = static_cast<int>(std::floor(x * kSteps));
  for (int i = 0; i < whole; ++i)
    path +=
        integral(d, seed, windFromDeg, static_cast<double>(i) / kSteps, static_cast<double>(i + 1) / kSteps);
  return path + integral(d, seed, windFromDeg, static_cast<double>(whole) / kSteps, x);
}

}  // namespace

void describe(Drift& d, ParamVisitor& v) {
  v.value({"wind_deg", "deg", "the most by which the wind turns to either side; 0: it does not", 0, 180},
          d.windDeg);
  v.value(
      {"cover_oktas", "okta", "the most by which each sheet's cover rises and falls; 0: it does not", 0, 8},
      d.coverOktas);
  v.value({"period_h", "h", "how long a swing to and fro takes, about", 0.05, 1000}, d.periodH);
}

double driftNoise(std::uint64_t seed, double x) {
  // Gradient noise swings to and fro once in two cells or so.
  return 2.0 * (0.7 * gradientNoise(hashOf(seed, 1), kDriftLoop, x) +
                0.3 * gradientNoise(hashOf(seed, 2), kFiner * kDriftLoop, kFiner * x));
}

glm::dvec2 windPath(const Drift& d, std::uint64_t seed, double windFromDeg, double seconds) {
  if (d.windDeg == 0.0) return seconds * weather::windTowards(windFromDeg);
  const double periodS = d.periodH * kHourS, x = seconds / periodS;
  const double loops = std::floor(x / kDriftLoop);
  glm::dvec2 path = pathInLoop(d, seed, windFromDeg, x - loops * kDriftLoop);
  if (loops != 0.0) path += loops * pathInLoop(d, seed, windFromDeg, kDriftLoop);
  return periodS * path;
}

double windFromDegAt(const Drift& d, std::uint64_t seed, double windFromDeg, double seconds) {
  if (d.windDeg == 0.0) return windFromDeg;
  return windFromDeg + d.windDeg * driftNoise(seed, seconds / (d.periodH * kHourS));
}

double oktasAt(const Drift& d, std::uint64_t seed, double oktas, double seconds) {
  if (d.coverOktas == 0.0) return oktas;
  return std::clamp(oktas + d.coverOktas * driftNoise(seed, seconds / (d.periodH * kHourS)), 0.0, kOktas);
}

}  // namespace welkin::scene
