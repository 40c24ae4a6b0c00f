// SPDX-License-Identifier: Apache-2.0
// What the programs share that write tables of phase functions, welkin/optics/*_table.h: colours of
// wavelengths of sunlight, the mean over the sun's disc, and the file. Angles are of scattering, in degrees;
// colours linear Rec. 709.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace welkin::bench {

inline constexpr int kFine = 9001;                       // angles of the sums, from 0 to 180 degrees
inline constexpr double kFineDeg = 180.0 / (kFine - 1);  // between them

// What a wavelength of sunlight counts for in each colour, up to a factor of the colour.
glm::dvec3 colourOf(double wavelengthUm);

struct PhaseRow {
  double deg;
  glm::dvec3 phase;  // 1/sr
};

// From an angle to before the next range's, the last one to 180.
struct RowRange {
  double fromDeg, stepDeg;
};
// Of a phase function at the angles of the sums: rows, each the mean over the sun's disc and over the angles
// that the row stands for. A colour that screens have not is moved towards grey of its luminance until they
// have.
std::vector<PhaseRow> rowsOf(const std::vector<glm::dvec3>& phase, const std::vector<RowRange>& ranges);

// Writes the header, of rows whose integral over the sphere is made 1 in each colour, and prints what it was,
// and mean cosines. matter: "Rain" makes kRainRows; by: what its second line says. Throws IoError.
void writePhaseTable(const char* path, const std::string& matter, const std::string& by,
                     std::vector<PhaseRow> rows);

}  // namespace welkin::bench
