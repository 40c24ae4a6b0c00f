// SPDX-License-Identifier: Apache-2.0
#include "bench/phase_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <glm/common.hpp>
#include <memory>

#include "welkin/core/colour.h"
#include "welkin/core/error.h"
#include "welkin/core/units.h"

namespace welkin::bench {
namespace {

constexpr double kSunRadiusDeg = 0.2665;
constexpr double kLeastOfLuminance = 0.1;  // a colour's

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

// Of what is linear between rows: the integral over the sphere of the function, and of it times the cosine.
std::array<glm::dvec3, 2> integralsOf(const std::vector<PhaseRow>& rows) {
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

}  // namespace

// Eyes: C. Wyman, P.-P. Sloan and P. Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color
// Matching Functions".
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

std::vector<PhaseRow> rowsOf(const std::vector<glm::dvec3>& phase, const std::vector<RowRange>& ranges) {
  std::vector<PhaseRow> rows;
  for (std::size_t r = 0; r < ranges.size(); ++r) {
    const auto [fromDeg, stepDeg] = ranges[r];
    const double toDeg = r + 1 < ranges.size() ? ranges[r + 1].fromDeg - 1e-6 : 180.0 + 1e-6;
    for (int k = 0; fromDeg + k * stepDeg < toDeg; ++k) {
      const double deg = fromDeg + k * stepDeg;
      glm::dvec3 p = seenAt(phase, deg, stepDeg);
      const double y = luminanceOf(&p.x), least = std::min({p.x, p.y, p.z});
      if (least < kLeastOfLuminance * y)
        p = glm::mix(glm::dvec3(y), p, (1.0 - kLeastOfLuminance) * y / (y - least));
      rows.push_back({deg, p});
    }
  }
  return rows;
}

void writePhaseTable(const char* path, const std::string& matter, const std::string& by,
                     std::vector<PhaseRow> rows) {
  const auto [whole, forward] = integralsOf(rows);
  fmt::print("integrals {:.4f} {:.4f} {:.4f}, mean cosines {:.4f} {:.4f} {:.4f}\n", whole.x, whole.y, whole.z,
             forward.x / whole.x, forward.y / whole.y, forward.z / whole.z);
  for (PhaseRow& row : rows) row.phase /= whole;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path, "w"), std::fclose);
  if (!file)
    throw IoError(fmt::format("{} cannot be written; expected a path in a folder that is there", path));
  fmt::print(file.get(),
             "// SPDX-License-Identifier: Apache-2.0\n// {}\n#pragma once\n\n"
             "#include \"welkin/optics/phase_rows.h\"\n\nnamespace welkin::optics::detail {{\n\n"
             "// clang-format off\ninline constexpr PhaseRow k{}Rows[] = {{\n",
             by, matter);
  for (const PhaseRow& r : rows)
    fmt::print(file.get(), "    {{{:#.4g}f, {{{:#.5g}f, {:#.5g}f, {:#.5g}f}}}},\n", r.deg, r.phase.x,
               r.phase.y, r.phase.z);
  fmt::print(file.get(), "}};\n// clang-format on\n\n}}  // namespace welkin::optics::detail\n");
}

}  // namespace welkin::bench
