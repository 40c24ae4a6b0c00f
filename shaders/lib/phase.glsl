// SPDX-License-Identifier: Apache-2.0
// Phase functions: the density, in 1/sr, with which a scatterer turns light by an angle. Each integrates to 1 over the sphere.
// c is the cosine of the angle between the way the light travels before and after: 1 is straight on. The mean of c is called g.
// Shared by C++ and GLSL, see welkin/core/glsl.h; C++ programs use welkin/optics/phase.h.

WELKIN_CONST float kInvFourPi = 0.0795774715f;  // 1 / (4 pi)
WELKIN_CONST float kDropletAsymmetry = 0.86f;      // mean cosine of scattering by cloud droplets, for closed forms
WELKIN_CONST float kRainAsymmetry = 0.765f;        // of scattering by drops of rain, diffraction apart (welkin/optics/rain_phase.h)
WELKIN_CONST float kDropletAside = 0.33f;          // share that droplets turn by more than some degrees: what shades the air behind them

WELKIN_FN float phaseIsotropic() { return kInvFourPi; }

// Molecules much smaller than the wavelength (Rayleigh 1871), depolarisation left out.
WELKIN_FN float phaseRayleigh(float c) { return 0.75f * kInvFourPi * (1.0f + c * c); }

// L. G. Henyey and J. L. Greenstein 1941, "Diffuse radiation in the galaxy". g in (-1, 1) is the mean cosine.
WELKIN_FN float phaseHenyeyGreenstein(float c, float g) {
  float d = max(1.0f + g * g - 2.0f * g * c, 1e-7f);
  return kInvFourPi * (1.0f - g * g) / (d * sqrt(d));
}

// B. T. Draine 2003, "Scattering by interstellar dust grains. I", eq. 4: Henyey-Greenstein (alpha 0) to what W. M. Cornette and
// J. G. Shanks 1992 have (alpha 1), which becomes Rayleigh at g = 0.
WELKIN_FN float phaseDraine(float c, float g, float alpha) {
  return phaseHenyeyGreenstein(c, g) * (1.0f + alpha * c * c) / (1.0f + alpha * (1.0f + 2.0f * g * g) / 3.0f);
}

// Mean cosine of the above.
WELKIN_FN float draineMeanCosine(float g, float alpha) {
  return g * (1.0f + alpha * (3.0f + 2.0f * g * g) / 5.0f) / (1.0f + alpha * (1.0f + 2.0f * g * g) / 3.0f);
}

// Haze with mean cosine g, up to 0.9: not quite half of the light goes into the narrow peak of coarse particles, which makes the sun's
// aureole; the rest, by fine ones, sidewards. Two Henyey-Greenstein lobes as G. W. Kattawar 1975, "A three-parameter analytic phase function
// for multiple scattering calculations".
WELKIN_CONST float kHazePeakG = 0.85f;
WELKIN_CONST float kHazePeakWeight = 0.45f;
WELKIN_FN float hazeFineG(float g) { return (g - kHazePeakWeight * kHazePeakG) / (1.0f - kHazePeakWeight); }
WELKIN_FN float phaseHaze(float c, float g) {
  return mix(phaseHenyeyGreenstein(c, hazeFineG(g)), phaseHenyeyGreenstein(c, kHazePeakG), kHazePeakWeight);
}

// The parameters of the droplet phase function below.
struct DropletPhase {
  float gHg;      // Henyey-Greenstein lobe: the narrow forward peak
  float gDraine;  // Draine lobe
  float alpha;
  float wDraine;  // weight of the Draine lobe
};

// J. Jendersie and E. d'Eon 2023, "An Approximate Mie Scattering Function for Fog and Cloud Rendering": fit to Mie theory for water
// droplets of 5 to 50 micrometres diameter, clamped outside. Good from 5 to 60 degrees; about half of Mie sidewards and a quarter
// at the glory.
WELKIN_FN DropletPhase dropletPhase(float diameterUm) {
  float d = clamp(diameterUm, 5.0f, 50.0f);
  DropletPhase p;
  p.gHg = exp(-0.0990567f / (d - 1.67154f));
  p.gDraine = exp(-2.20679f / (d + 3.91029f) - 0.428934f);
  p.alpha = exp(3.62489f - 8.29288f / (d + 5.52825f));
  p.wDraine = exp(-0.599085f / (d - 0.641583f) - 0.665888f);
  return p;
}

WELKIN_FN float phaseDroplet(float c, DropletPhase p) {
  return mix(phaseHenyeyGreenstein(c, p.gHg), phaseDraine(c, p.gDraine, p.alpha), p.wDraine);
}

// The narrow forward peak of a phase function, a Henyey-Greenstein lobe: its share of the scattered light, and its mean cosine.
struct PhasePeak {
  float share;
  float g;
};
WELKIN_FN PhasePeak dropletPeak(DropletPhase p) { return PhasePeak(1.0f - p.wDraine, p.gHg); }

// Ice crystals of many shapes and sizes: two lobes, without halos, for snow and for light scattered more than once (welkin/optics/ice_phase.h).
WELKIN_CONST float kIcePeakG = 0.92f;
WELKIN_CONST float kIcePeakShare = 0.55f;
WELKIN_CONST float kIceWideG = 0.55f;
WELKIN_FN float phaseIce(float c) {
  return mix(phaseHenyeyGreenstein(c, kIceWideG), phaseHenyeyGreenstein(c, kIcePeakG), kIcePeakShare);
}

WELKIN_FN float dropletMeanCosine(DropletPhase p) {
  return mix(p.gHg, draineMeanCosine(p.gDraine, p.alpha), p.wDraine);
}
