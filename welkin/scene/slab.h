// SPDX-License-Identifier: Apache-2.0
// A plane-parallel layer to prove light transport with: homogeneous, or of periodic columns, without an
// atmosphere. It is no sky: a scene that has one is traced by reference/ alone.
//
// Columns stand side by side along x (east), each as wide as the next, repeat for ever, and are endless along
// y. All light is relative to the flux that falls on the slab's top.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "welkin/core/params.h"

namespace welkin::scene {

enum class SlabPhase { kHenyeyGreenstein, kRayleigh, kDroplets, kMie };
enum class SlabLight { kSun, kDiffuse };

struct SlabColumns {
  double opticalDepth = 1.0;  // vertical
  std::int64_t count = 1;     // how many such columns stand side by side
  bool operator==(const SlabColumns&) const = default;
};
void describe(SlabColumns& c, ParamVisitor& v);

struct Slab {
  std::optional<double> opticalDepth;  // of a homogeneous slab
  std::vector<SlabColumns> columns;    // or of columns, from the west; neither: no slab
  double thicknessM = 250.0;
  double periodM = 500.0;  // width of all columns together
  SlabPhase phase = SlabPhase::kHenyeyGreenstein;
  double asymmetry = 0.85;  // mean cosine of Henyey and Greenstein's function
  double dropletDiameterUm = 20.0;
  double albedo = 1.0;  // of a single scattering
  SlabLight light = SlabLight::kSun;
  double sunZenithDeg = 0.0;
  double sunAzimuthDeg = 90.0;  // where it stands, clockwise from north
  double groundAlbedo = 0.0;    // Lambert's

  bool empty() const { return !opticalDepth && columns.empty(); }
  // The vertical optical depth of each column, from the west; one for a homogeneous slab.
  std::vector<double> depths() const;
  bool operator==(const Slab&) const = default;
};
void describe(Slab& s,
              ParamVisitor& v);  // but for the columns, which are a list of their own: [[slab_column]]
// Throws ParameterError: a depth and columns, too many columns, or droplets too large for Mie's table.
void validate(const Slab& s);

}  // namespace welkin::scene

namespace welkin {
template <>
inline constexpr auto kEnumNames<scene::SlabPhase> =
    std::array<std::string_view, 4>{"henyey_greenstein", "rayleigh", "droplets", "mie"};
template <>
inline constexpr auto kEnumNames<scene::SlabLight> = std::array<std::string_view, 2>{"sun", "diffuse"};
}  // namespace welkin
