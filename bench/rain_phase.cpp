// SPDX-License-Identifier: Apache-2.0
// Writes welkin/optics/rain_table.h, the phase function of rain: rain_phase OUT [MM_PER_H]
//
// Mie's theory for spheres, over the visible wavelengths and over the drops of J. S. Marshall and W. McK.
// Palmer 1948, "The distribution of raindrops with size", from 0.2 to 4 mm, each counting by its
// cross-section; without diffraction, which turns light by hundredths of a degree and is half of what drops
// so large scatter; seen over the sun's disc. Colours are linear Rec. 709. Takes some minutes. Prints what
// the table does not say: its mean cosines, and its integrals before they are made 1, which would be that for
// rays without Mie's waves.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <glm/vec3.hpp>
#include <vector>

#include "bench/phase_table.h"
#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/core/units.h"
#include "welkin/optics/mie_sphere.h"

namespace welkin::bench {
namespace {

constexpr int kSizes = 48, kWavelengths = 31;  // strata, a sphere each of both
constexpr double kLeastUm = 200.0, kMostUm = 4000.0;
constexpr double kFirstUm = 0.395, kStepUm = 0.01;
constexpr double kDiffractionToDeg = 4.0;  // up to where it hides the rest, which is level there

// A. H. Harvey, J. S. Gallagher and J. M. H. Levelt Sengers 1998, "Revised Formulation for the Refractive
// Index of Water and Steam as a Function of Wavelength, Temperature and Density", at 10 C.
double indexOfWater(double wavelengthUm) {
  constexpr double kT = 283.15 / 273.15, kDensity = 0.9997, kUv = 0.2292020, kIr = 5.432937;
  const double l = wavelengthUm / 0.589, l2 = l * l;
  const double r =
      kDensity * (0.244257733 + 9.74634476e-3 * kDensity - 3.73234996e-3 * kT + 2.68678472e-4 * l2 * kT +
                  1.58920570e-3 / l2 + 2.45934259e-3 / (l2 - kUv * kUv) + 0.900704920 / (l2 - kIr * kIr) -
                  1.66626219e-2 * kDensity * kDensity);
  return std::sqrt((1.0 + 2.0 * r) / (1.0 - r));
}

// Sums over spheres.
struct Sums {
  std::vector<glm::dvec3> phase = std::vector<glm::dvec3>(kFine, glm::dvec3(0.0));
  glm::dvec3 weight{0.0}, overSize{0.0};  // of the spheres, and over their size parameters
};

Sums sumsOf(double mmPerH) {
  const double perUm = 4.1e-3 * std::pow(mmPerH, -0.21);
  std::vector<Sums> parts(kWavelengths);
  parallelFor(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<double> intensity(kFine);
    for (std::size_t l = begin; l < end; ++l) {
      Random random(hashOf(std::uint64_t{0x7261696e}, l));
      const auto chance = [&random] { return static_cast<double>(random.next() >> 11) * 0x1p-53; };
      for (int j = 0; j < kSizes; ++j) {
        const double um = kLeastUm * std::pow(kMostUm / kLeastUm, (j + chance()) / kSizes);
        const double wavelengthUm = kFirstUm + kStepUm * (static_cast<double>(l) + chance());
        const double x = kPi * um / wavelengthUm;
        std::fill(intensity.begin(), intensity.end(), 0.0);
        optics::addMieSphere(x, indexOfWater(wavelengthUm), 1.0 / (4.0 * kPi * x * x), intensity);
        // Cross-sections, and steps that grow with the size.
        const glm::dvec3 weight = colourOf(wavelengthUm) * um * um * um * std::exp(-perUm * um);
        parts[l].weight += weight;
        parts[l].overSize += weight / x;
        for (std::size_t i = 0; i < kFine; ++i) parts[l].phase[i] += weight * intensity[i];
      }
    }
  });
  Sums all;
  for (const Sums& part : parts) {
    all.weight += part.weight;
    all.overSize += part.overSize;
    for (std::size_t i = 0; i < kFine; ++i) all.phase[i] += part.phase[i];
  }
  return all;
}

// Mean over spheres, 1/sr, without the diffraction of J. von Fraunhofer, of which the mean over its rings
// remains.
std::vector<glm::dvec3> withoutDiffraction(const Sums& sums) {
  std::vector<glm::dvec3> phase;
  const auto level = static_cast<std::size_t>(kDiffractionToDeg / kFineDeg);
  for (std::size_t i = 0; i < kFine; ++i) {
    const double angle = radians(kFineDeg * static_cast<double>(i)), sine = std::sin(angle),
                 tilt = 0.5 + 0.5 * std::cos(angle);
    phase.push_back(sums.phase[i] / sums.weight);
    if (i >= level && angle < 0.5 * kPi)
      phase[i] -= sums.overSize / sums.weight * tilt * tilt / (kPi * kPi * sine * sine * sine);
  }
  glm::dvec3 mean(0.0);
  constexpr std::size_t kBeyond = 50;
  for (std::size_t i = level; i < level + kBeyond; ++i) mean += phase[i] / static_cast<double>(kBeyond);
  std::fill_n(phase.begin(), level, mean);
  return phase;
}

}  // namespace
}  // namespace welkin::bench

int main(int argc, char** argv) {
  using namespace welkin;
  using namespace welkin::bench;
  if (argc < 2 || argc > 3) {
    fmt::print(stderr, "usage: rain_phase OUT [MM_PER_H]\n");
    return 2;
  }
  try {
    const double mmPerH = argc > 2 ? std::atof(argv[2]) : 10.0;
    writePhaseTable(
        argv[1], "Rain",
        fmt::format("Written by bench/rain_phase.cpp, which says what it is; drops of {} mm/h.", mmPerH),
        rowsOf(withoutDiffraction(sumsOf(mmPerH)), {{0.0, 2.0}, {120.0, 0.1}, {146.0, 1.0}, {179.0, 0.25}}));
  } catch (const std::exception& e) {
    fmt::print(stderr, "rain_phase: {}\n", e.what());
    return 1;
  }
  return 0;
}
