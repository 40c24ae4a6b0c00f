// SPDX-License-Identifier: Apache-2.0
// Light that volumes scatter: the closed forms of lib/cloud_light.glsl, corrected by a small network that was fitted to the reference
// renderer (tools/fit_cloud_light.py). A slab is what the closed forms take a cloud for; how much more or less light comes out of its
// sides, from between clouds and towards the eye, the network has learnt from points in the clouds of random skies. It sees what the
// march knows anyhow, the optical depths some way behind the point, whence most of the light comes that goes on towards the eye, and the
// light that diffusion through the clouds around brings there. Needs lib/cloud_light.glsl and lib/cloud_light_fit.glsl before it.

// The sun's light that has gone in all directions (lib/fluence.glsl): at the point, and kAheadM farther along the view.
struct CloudFluence {
  float here;
  float ahead;
};

// How a point is seen.
struct CloudView {
  float cosSun;     // of the angle between the direction of view and the sun
  float height;     // sine of the elevation of the direction of view
  float toEye;      // optical depth
  float distanceM;
  CloudDepths behind;  // kBehindM farther along the view
  CloudFluence fluence;
};

WELKIN_CONST float kAheadM = 100.0f;
WELKIN_CONST float kBehindM = 300.0f;

// What kind of cloud it is in.
struct CloudPlace {
  float ice;         // the share of it
  float cover;       // of the sky by the layer, [0, 1]
  float surface;     // cloudSurface, sd
  float height;      // in the layer, [0, 1]
  float depthM;      // of the layer
  float extinction;  // of the layer, 1/m
};

// How it turns light.
struct CloudPhase {
  float first;       // the first scattering's phase function in the direction of view, 1/sr
  PhasePeak peak;
};

// What it does with light: of the sun, scattered radiance per unit extinction and unit illuminance, 1/sr; and the shares of light from
// above (x) and from below (y), which sum to 1, as clouds absorb nothing.
struct CloudScattering {
  float sun;
  vec2 shares;
};

WELKIN_CONST float kMostCorrection = 3.0f;  // of logarithms

// sunHeight: sine of the sun's elevation.
WELKIN_FN CloudScattering cloudScattering(CloudDepths d, CloudView view, CloudPlace place, CloudPhase phase, float sunHeight) {
  vec2 shares = cloudSkyShares(d);
  float sun = cloudSunSource(d, phase.first, view.cosSun, view.height, sunHeight);
#if defined(WELKIN_SINGLE_SCATTERING) || defined(WELKIN_OCTAVES_OF_SCATTERING)
  return CloudScattering(sun, shares);
#else
  float direct = phase.first * exp(-d.toSun);
  float others = max(sun - direct, 0.0f) + 1e-5f;
  const float few = 1e-3f;
  CloudFluence fluence = view.fluence;
  float forward = exp(-kSimilarity * d.toSun);  // light that has gone on much as it came
  vec2 logs = cloudLightFit(
      log(1.0f + vec4(d.toSun, d.fromSun, d.up, d.down)) / 3.0f,
      vec4(log(1.0f + view.toEye) / 3.0f, view.cosSun, view.height, sunHeight),
      vec4(sqrt(max(0.5f - 0.5f * view.cosSun, 0.0f)), place.ice, log(1.0f + 0.001f * view.distanceM) / 3.0f, place.cover),
      log(1.0f + vec4(view.behind.toSun, view.behind.fromSun, view.behind.up, view.behind.down)) / 3.0f,
      vec4(0.5f * clamp(place.surface, -2.0f, 4.0f), place.height, 0.25f * log(1.0f + 0.01f * place.depthM),
           0.5f * log(1.0f + 300.0f * place.extinction)),
      vec4(1.5f + 0.5f * log(kInvFourPi * fluence.here + few), 1.5f + 0.5f * log(kInvFourPi * fluence.ahead + few),
           2.0f + log(kInvFourPi * (fluence.here + forward) + few),
           4.0f * (fluence.ahead - fluence.here) / (fluence.ahead + fluence.here + 0.01f)));
  float above = shares.x / (shares.x + shares.y * exp(clamp(-logs.y, -kMostCorrection, kMostCorrection)));
  return CloudScattering(direct + cloudPeakSource(d.toSun, view.cosSun, phase.peak) + others * exp(clamp(logs.x, -kMostCorrection, kMostCorrection)), vec2(above, 1.0f - above));
#endif
}
