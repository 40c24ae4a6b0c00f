// SPDX-License-Identifier: Apache-2.0
// What the clear atmosphere is made of.
#pragma once

#include <optional>

#include "welkin/core/params.h"

namespace welkin::sky {

// The defaults, with a visibility of 40 km, are the clear sky of the illuminance tables (aerosol optical
// depth 0.18 at 550 nm).
struct AtmosphereParams {
  double aerosolScaleHeightM = 2100.0;  // e-folding height of the haze in good visibility
  double aerosolAlbedo = 0.90;          // single-scattering albedo of the haze
  double aerosolG = 0.56;               // mean cosine of its phase function
  double ozoneDu = 344.0;               // ozone column, Dobson units; 344: mid-latitudes (ASTM G173)
  double airglowCdPerM2 = 1.7e-4;       // zenith luminance of the moonless night sky (22.0 mag/arcsec2)

  bool operator==(const AtmosphereParams&) const = default;
};
void describe(AtmosphereParams& p, ParamVisitor& v);

}  // namespace welkin::sky
