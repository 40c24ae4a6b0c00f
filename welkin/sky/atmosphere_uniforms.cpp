// SPDX-License-Identifier: Apache-2.0
// Coefficients of the air in linear Rec. 709.
//
// How a spectrum becomes three numbers: the coefficient of a primary is the spectral coefficient weighted by
// sunlight times that primary's colour-matching function (negative lobes included), so that a thin layer has
// exactly the colour of the spectral answer, both in what it scatters and in what it takes away.
// exp(-coefficient x path) then follows the spectral transmittance of red and green within 4 % down to air
// mass 6, and the luminance of direct sunlight within 8 % down to air mass 20. Inputs: solar spectrum ASTM
// G173-03 (extraterrestrial), CIE 1931 functions as fitted by C. Wyman, P.-P. Sloan and P. Shirley 2013.
#include <algorithm>
#include <cmath>

#include "welkin/core/units.h"
#include "welkin/sky/atmosphere.h"

namespace welkin::sky {
namespace {

constexpr double kTopAltitudeM = 100e3;

// Vertical optical depth of the air above sea level: B. A. Bodhaine et al. 1999, "On Rayleigh optical depth
// calculations", eq. 30 (0.0971 at 550 nm).
constexpr glm::vec3 kRayleighOpticalDepth{0.05077f, 0.09823f, 0.23600f};
constexpr double kRayleighScaleHeightM = 8400.0;  // column over density at sea level

// Vertical optical depth of 300 Dobson units; cross-sections by A. Serdyuchenko et al. 2014 at 223 K. The
// blue primary's is nothing within its accuracy (-0.0005).
constexpr glm::vec3 kOzoneOpticalDepth300{0.03723f, 0.02688f, 0.0f};
constexpr double kOzoneAltitudeM = 25e3;
constexpr double kOzoneHalfWidthM = 15e3;

// Wavelengths at which an Angstrom power law has the primaries' coefficients, within 0.5 % for exponents 0
// to 2.
constexpr glm::dvec3 kAngstromWavelengthNm{640.4, 545.6, 441.6};

constexpr double kAirglowAltitudeM = 90e3;

// Haze is coloured where its particles are small and grey where they are fog: exponent 1.8 (dry continental
// haze) at 20 km of visibility and beyond, 0 at 1 km.
double hazeExponent(double visibilityM) {
  return 1.8 * std::clamp(std::log(std::max(visibilityM, 1.0) / 1e3) / std::log(20.0), 0.0, 1.0);
}

// The thicker the haze, the shallower: a 100 m fog is not 2 km deep. Under 20 km the height goes with a power
// of the visibility that keeps the optical depth of the column to plausible values: 0.4 at 20 km, 0.7 at 5
// km, 1.5 at 1 km, 4 at 100 m. What the wind has raised is deeper: 0.9 at 5 km, 3 at 800 m.
double scaleHeightM(double fullM, double visibilityM, bool raised) {
  return raised ? fullM * std::clamp(std::pow(visibilityM / 20e3, 0.4), 0.3, 1.0)
                : fullM * std::clamp(std::pow(visibilityM / 20e3, 0.55), 0.05, 1.0);
}

// What small particles do to light: single-scattering albedo by primary, exponent of Angstrom's law, mean
// cosine.
struct AerosolOptics {
  glm::dvec3 albedo;
  double exponent, g;
  bool raised;  // by the wind, or thrown up
};
// Dust as in Saudi Arabia and on Cape Verde, smoke as over burning savanna in Brazil: O. Dubovik et al. 2002,
// "Variability of Absorption and Optical Properties of Key Aerosol Types Observed in Worldwide Locations",
// table 1. Ash is taken to be as coarse as dust, darker and greyer.
AerosolOptics opticsOf(const AtmosphereParams& params, double visibilityM) {
  switch (params.aerosol) {
    case Aerosol::kDust:
      return {{0.96, 0.945, 0.92}, 0.15, 0.70, true};
    case Aerosol::kSmoke:
      return {{0.875, 0.89, 0.91}, 1.7, 0.60, false};
    case Aerosol::kAsh:
      return {{0.915, 0.905, 0.89}, 0.1, 0.70, true};
    case Aerosol::kAuto:
    case Aerosol::kHaze:
      break;
  }
  return {glm::dvec3(params.aerosolAlbedo), hazeExponent(visibilityM), params.aerosolG, false};
}

}  // namespace

AtmosphereUniforms atmosphereUniforms(const AtmosphereParams& params, double visibilityM,
                                      double groundAltitudeM, glm::vec3 groundAlbedo) {
  AtmosphereUniforms u;
  u.seaRadiusM = static_cast<float>(kEarthRadiusM);
  u.groundAltitudeM = static_cast<float>(groundAltitudeM);
  u.topAltitudeM = static_cast<float>(kTopAltitudeM);
  u.rayleighScattering = kRayleighOpticalDepth / static_cast<float>(kRayleighScaleHeightM);
  u.rayleighScaleHeightM = static_cast<float>(kRayleighScaleHeightM);

  // What the air itself takes at 550 nm is not the haze's; a visibility beyond that of pure air leaves no
  // haze.
  const double total = kVisibilityDepth / std::max(visibilityM, 1.0);
  const double air =
      kRayleighOpticalDepth.y / kRayleighScaleHeightM * std::exp(-groundAltitudeM / kRayleighScaleHeightM);
  const double aerosol = std::max(total - air, 0.0);
  const AerosolOptics optics = opticsOf(params, visibilityM);
  for (int c = 0; c < 3; ++c) {
    u.aerosolExtinction[c] =
        static_cast<float>(aerosol * std::pow(kAngstromWavelengthNm[c] / 550.0, -optics.exponent));
  }
  u.aerosolScattering = u.aerosolExtinction * glm::vec3(optics.albedo);
  u.aerosolScaleHeightM =
      static_cast<float>(scaleHeightM(params.aerosolScaleHeightM, visibilityM, optics.raised));
  u.aerosolG = static_cast<float>(optics.g);

  u.ozoneAbsorption = kOzoneOpticalDepth300 * static_cast<float>(params.ozoneDu / 300.0 / kOzoneHalfWidthM);
  u.ozoneAltitudeM = static_cast<float>(kOzoneAltitudeM);
  u.ozoneHalfWidthM = static_cast<float>(kOzoneHalfWidthM);
  u.groundAlbedo = groundAlbedo;
  // The natural night sky without moon has about the colour of sunlight (C. Leinert et al. 1998, "The 1997
  // reference of diffuse night sky brightness": airglow, zodiacal light and starlight together are little
  // redder than the sun).
  u.airglow = sunlightColour() * static_cast<float>(params.airglowCdPerM2);
  u.airglowAltitudeM = static_cast<float>(kAirglowAltitudeM);
  return u;
}

}  // namespace welkin::sky
