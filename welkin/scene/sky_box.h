// SPDX-License-Identifier: Apache-2.0
// A sky of the user's own behind thin clouds: six pictures all around the eye, as sky boxes are
// (Guthikonda, Meena, Linder and Yi, "Realistic Real-Time Skies", draw their clouds over one).
//
// The faces are in OpenGL's order and orientation (+x -x +y -y +z -z, OpenGL 4.6 specification, 8.13), either
// a file each or one picture with the six side by side, as `welkin render --projection cubemap` writes.
// PNG and DDS of integers hold sRGB, 1 being `whiteCdM2`; EXR, HDR and DDS of floats luminance in cd/m2.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "welkin/core/image.h"
#include "welkin/core/params.h"

namespace welkin::scene {

// Which of its axes stands upright.
enum class BoxAxes {
  kZUp,  // x east, y north, z up: as Welkin writes cube maps
  kYUp,  // x east, y up, -z north: as most engines have it
};

struct SkyBox {
  std::optional<std::string> strip;                   // a file with all six, or
  std::optional<std::string> px, nx, py, ny, pz, nz;  // all six files
  BoxAxes axes = BoxAxes::kZUp;
  double turnDeg = 0.0;  // clockwise as seen from above
  double whiteCdM2 = 8000.0;
  bool ground = false;  // Welkin's ground below the horizon, else the box all around

  std::array<const std::optional<std::string>*, 6> faces() const { return {&px, &nx, &py, &ny, &pz, &nz}; }
  bool empty() const;  // no file: the clear sky
  bool operator==(const SkyBox&) const = default;
};
void describe(SkyBox& b, ParamVisitor& v);
// Throws ParameterError: a strip and faces, not all faces, or other keys alone.
void validate(const SkyBox& b);

// The six faces, square and of one size, three channels of linear Rec. 709 in cd/m2. The box is not empty.
// Throws IoError that names the file.
std::array<Image<float>, 6> skyBoxFaces(const SkyBox& b);

}  // namespace welkin::scene

namespace welkin {
template <>
inline constexpr auto kEnumNames<scene::BoxAxes> = std::array<std::string_view, 2>{"z_up", "y_up"};
}  // namespace welkin
