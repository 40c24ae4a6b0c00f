// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/atmosphere_params.h"

namespace welkin::sky {

void describe(AtmosphereParams& p, ParamVisitor& v) {
  v.choice({"aerosol", "",
            "what makes the air hazy: haze, dust (sand), smoke or ash, or auto: as the weather report says"},
           p.aerosol);
  v.value({"aerosol_scale_height_m", "m", "e-folding height of the haze in good visibility", 50, 10000},
          p.aerosolScaleHeightM);
  v.value({"aerosol_albedo", "", "single-scattering albedo of the haze", 0, 1}, p.aerosolAlbedo);
  v.value({"aerosol_g", "", "mean cosine of the haze's phase function", 0.3, 0.9}, p.aerosolG);
  v.value({"ozone_du", "DU", "ozone column", 0, 1000}, p.ozoneDu);
  v.value({"airglow", "cd/m2", "zenith luminance of the moonless night sky", 0, 1}, p.airglowCdPerM2);
}

}  // namespace welkin::sky
