// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/slab.h"

#include <string>

#include "welkin/core/error.h"
#include "welkin/core/param_range.h"
#include "welkin/optics/mie_phase.h"

namespace welkin::scene {
namespace {

constexpr double kMaxDepth = 1000.0;
constexpr std::int64_t kMaxColumns = 1024;

}  // namespace

void describe(SlabColumns& c, ParamVisitor& v) {
  v.value({"optical_depth", "", "vertical optical depth of the column", 0, kMaxDepth}, c.opticalDepth);
  v.value({"count", "", "how many such columns stand side by side", 1, static_cast<double>(kMaxColumns)},
          c.count);
}

void describe(Slab& s, ParamVisitor& v) {
  v.value(
      {"optical_depth", "",
       "vertical optical depth of a homogeneous slab; absent: that of its columns, or no slab", 0, kMaxDepth},
      s.opticalDepth);
  v.value({"thickness_m", "m", "height of the slab", 1, 100000}, s.thicknessM);
  v.value({"period_m", "m", "width of all columns together, after which they repeat", 1, 1000000}, s.periodM);
  v.choice({"phase", "",
            "phase function; droplets: the fit that clouds are drawn with; mie: droplets by Mie's theory"},
           s.phase);
  v.value({"asymmetry", "", "mean cosine, of henyey_greenstein", -0.99, 0.99}, s.asymmetry);
  v.value({"droplet_diameter_um", "um", "diameter, of droplets and mie (there at most 40)", 5, 50},
          s.dropletDiameterUm);
  v.value({"albedo", "", "share of the light that a scattering leaves", 0, 1}, s.albedo);
  v.choice({"light", "", "a sun without width, or the same radiance from all directions above"}, s.light);
  v.value({"sun_zenith_deg", "deg", "angle of the sun from the zenith", 0, 89.9}, s.sunZenithDeg);
  v.value({"sun_azimuth_deg", "deg", "where the sun stands, clockwise from north", -360, 360},
          s.sunAzimuthDeg);
  v.value({"ground_albedo", "", "reflectance of the ground right below, the same in all directions", 0, 1},
          s.groundAlbedo);
}

std::vector<double> Slab::depths() const {
  if (opticalDepth) return {*opticalDepth};
  std::vector<double> all;
  for (const SlabColumns& c : columns)
    all.insert(all.end(), static_cast<std::size_t>(c.count), c.opticalDepth);
  return all;
}

void validate(const Slab& s) {
  if (s.opticalDepth && !s.columns.empty())
    throw ParameterError("slab has an optical_depth and columns; expected one or the other");
  if (s.phase == SlabPhase::kMie && s.dropletDiameterUm > optics::kLargestMieDropletUm)
    throw ParameterError("droplet_diameter_um is " + numberText(s.dropletDiameterUm) + "; expected at most " +
                         numberText(optics::kLargestMieDropletUm) + " um with phase mie");
  std::int64_t count = 0;
  for (const SlabColumns& c : s.columns) count += c.count;
  if (count > kMaxColumns)
    throw ParameterError("slab has " + std::to_string(count) + " columns; expected at most " +
                         std::to_string(kMaxColumns));
}

}  // namespace welkin::scene
