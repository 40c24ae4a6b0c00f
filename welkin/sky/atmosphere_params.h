// SPDX-License-Identifier: Apache-2.0
// What the clear atmosphere is made of.
#pragma once

#include <optional>

#include "welkin/core/params.h"

namespace welkin::sky {

struct AtmosphereParams {
  double aerosolScaleHeightM = 1200.0;  // e-folding height of the haze
  double aerosolAlbedo = 0.95;          // single-scattering albedo of the haze
  double aerosolG = 0.76;               // mean cosine of its phase function
  double ozoneDu = 300.0;               // ozone column, Dobson units
  double airglowCdPerM2 = 2.0e-4;  // zenith luminance of the moonless night sky: airglow and unresolved stars
};
void describe(AtmosphereParams& p, ParamVisitor& v);

}  // namespace welkin::sky
