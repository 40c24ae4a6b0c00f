// SPDX-License-Identifier: Apache-2.0
// What the clear atmosphere is made of.
#pragma once

#include <array>
#include <string_view>

#include "welkin/core/params.h"

namespace welkin::sky {

// What makes the air hazy. kAuto: as the weather says.
enum class Aerosol { kAuto, kHaze, kDust, kSmoke, kAsh };

// The defaults, with a visibility of 40 km, are the clear sky of the illuminance tables (aerosol optical
// depth 0.18 at 550 nm).
struct AtmosphereParams {
  Aerosol aerosol = Aerosol::kAuto;     // what follows for haze is known of the others
  double aerosolScaleHeightM = 2100.0;  // e-folding height of the haze in good visibility
  double aerosolAlbedo = 0.90;          // single-scattering albedo of the haze
  double aerosolG = 0.56;               // mean cosine of its phase function
  double ozoneDu = 344.0;               // ozone column, Dobson units; 344: mid-latitudes (ASTM G173)
  double airglowCdPerM2 = 1.7e-4;       // zenith luminance of the moonless night sky (22.0 mag/arcsec2)

  bool operator==(const AtmosphereParams&) const = default;
};
void describe(AtmosphereParams& p, ParamVisitor& v);

}  // namespace welkin::sky

template <>
inline constexpr auto welkin::kEnumNames<welkin::sky::Aerosol> =
    std::to_array<std::string_view>({"auto", "haze", "dust", "smoke", "ash"});
