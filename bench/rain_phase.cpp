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
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "welkin/core/colour.h"
#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/core/units.h"
#include "welkin/optics/mie_sphere.h"

namespace welkin {
namespace {

constexpr int kFine = 9001;                       // angles of the sums
constexpr double kFineDeg = 180.0 / (kFine - 1);  // between them
constexpr int kSizes = 48, kWavelengths = 31;     // strata, a sphere each of both
constexpr double kLeastUm = 200.0, kMostUm = 4000.0;
constexpr double kFirstUm = 0.395, kStepUm = 0.01;
constexpr double kDiffractionToDeg = 4.0;  // up to where it hides the rest, which is level there
constexpr double kSunRadiusDeg = 0.2665;
constexpr double kLeastOfLuminance = 0.1;  // a colour's

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

// What a wavelength of sunlight counts for in each colour, up to a factor of the colour. Eyes: C. Wyman,
// P.-P. Sloan and P. Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions".
glm::dvec3 colourOf(double wavelengthUm) {
  const double nm = 1000.0 * wavelengthUm;
  const auto lobe = [nm](double a, double middle, double below, double above) {
    const double t = (nm - middle) * (nm < middle ? below : above);
    return a * std::exp(-0.5 * t * t);
  };
  const glm::dvec3 xyz(lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) +
                           lobe(-0.065, 501.1, 0.0490, 0.0382),
                       lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
                       lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725));
  constexpr double kSunK = 5778.0;
  return rgbFromXyz(xyz) / (std::pow(wavelengthUm, 5.0) * (std::exp(14387.8 / (wavelengthUm * kSunK)) - 1.0));
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

// Over the sun's disc and over the angles that the table's row stands for.
glm::dvec3 seenAt(const std::vector<glm::dvec3>& phase, double deg, double widthDeg) {
  constexpr int kRings = 12, kAround = 48, kAcross = 20;
  glm::dvec3 sum(0.0);
  double count = 0.0;
  for (int k = 0; k < kAcross; ++k) {
    const double at = deg + widthDeg * ((k + 0.5) / kAcross - 0.5);
    if (at < 0.0 || at > 180.0) continue;
    for (int r = 0; r < kRings; ++r) {
      const double out = radians(kSunRadiusDeg * std::sqrt((r + 0.5) / kRings));
      for (int a = 0; a < kAround; ++a) {
        const double c = std::cos(radians(at)) * std::cos(out) +
                         std::sin(radians(at)) * std::sin(out) * std::cos(2.0 * kPi * (a + 0.5) / kAround);
        const double x = std::min(degrees(std::acos(std::clamp(c, -1.0, 1.0))) / kFineDeg, kFine - 1.001);
        const auto i = static_cast<std::size_t>(x);
        const double share = x - static_cast<double>(i);
        sum += (1.0 - share) * phase[i] + share * phase[i + 1];
        ++count;
      }
    }
  }
  return sum / count;
}

struct Row {
  double deg;
  glm::dvec3 phase;
};

// Of what is linear between rows: the integral over the sphere of the function, and of it times the cosine.
std::array<glm::dvec3, 2> integralsOf(const std::vector<Row>& rows) {
  std::array<glm::dvec3, 2> sums{glm::dvec3(0.0), glm::dvec3(0.0)};
  constexpr int kSteps = 64;
  for (std::size_t i = 0; i + 1 < rows.size(); ++i)
    for (int k = 0; k < kSteps; ++k) {
      const double share = (k + 0.5) / kSteps, step = radians(rows[i + 1].deg - rows[i].deg),
                   angle = radians(rows[i].deg) + share * step;
      const glm::dvec3 p = ((1.0 - share) * rows[i].phase + share * rows[i + 1].phase) * (2.0 * kPi) *
                           std::sin(angle) * (step / kSteps);
      sums[0] += p;
      sums[1] += p * std::cos(angle);
    }
  return sums;
}

std::vector<Row> rowsOf(const std::vector<glm::dvec3>& phase) {
  std::vector<Row> rows;
  const auto add = [&](double from, double to, double step) {
    for (int k = 0; from + k * step < to - 1e-6; ++k) {
      const double deg = from + k * step;
      rows.push_back({deg, seenAt(phase, deg, step)});
    }
  };
  add(0.0, 120.0, 2.0);
  add(120.0, 146.0, 0.1);
  add(146.0, 179.0, 1.0);
  add(179.0, 180.1, 0.25);
  for (Row& row : rows) {
    // The red rim of the primary bow has a colour that screens have not: towards grey until they have.
    const double y = luminanceOf(&row.phase.x), least = std::min({row.phase.x, row.phase.y, row.phase.z});
    if (least < kLeastOfLuminance * y)
      row.phase = glm::mix(glm::dvec3(y), row.phase, (1.0 - kLeastOfLuminance) * y / (y - least));
  }
  return rows;
}

void write(const char* path, double mmPerH, const std::vector<Row>& rows) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path, "w"), std::fclose);
  if (!file)
    throw IoError(fmt::format("{} cannot be written; expected a path in a folder that is there", path));
  fmt::print(file.get(),
             "// SPDX-License-Identifier: Apache-2.0\n"
             "// Written by bench/rain_phase.cpp, which says what it is; drops of {} mm/h.\n"
             "#pragma once\n\n#include <array>\n\nnamespace welkin::optics::detail {{\n\n"
             "struct RainRow {{\n  float angleDeg;\n  std::array<float, 3> phase;  // 1/sr: red, green, "
             "blue\n}};\n\n"
             "// clang-format off\ninline constexpr RainRow kRainRows[] = {{\n",
             mmPerH);
  for (const Row& r : rows)
    fmt::print(file.get(), "    {{{:#.4g}f, {{{:#.5g}f, {:#.5g}f, {:#.5g}f}}}},\n", r.deg, r.phase.x,
               r.phase.y, r.phase.z);
  fmt::print(file.get(), "}};\n// clang-format on\n\n}}  // namespace welkin::optics::detail\n");
}

}  // namespace
}  // namespace welkin

int main(int argc, char** argv) {
  using namespace welkin;
  if (argc < 2 || argc > 3) {
    fmt::print(stderr, "usage: rain_phase OUT [MM_PER_H]\n");
    return 2;
  }
  try {
    const double mmPerH = argc > 2 ? std::atof(argv[2]) : 10.0;
    std::vector<Row> rows = rowsOf(withoutDiffraction(sumsOf(mmPerH)));
    const auto [whole, forward] = integralsOf(rows);
    fmt::print("integrals {:.4f} {:.4f} {:.4f}, mean cosines {:.4f} {:.4f} {:.4f}\n", whole.x, whole.y,
               whole.z, forward.x / whole.x, forward.y / whole.y, forward.z / whole.z);
    for (Row& row : rows) row.phase /= whole;
    write(argv[1], mmPerH, rows);
  } catch (const std::exception& e) {
    fmt::print(stderr, "rain_phase: {}\n", e.what());
    return 1;
  }
  return 0;
}
