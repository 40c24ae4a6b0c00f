// SPDX-License-Identifier: Apache-2.0
// Phase functions for C++: the formulas of shaders/lib/phase.glsl, where the citations stand.
// All are densities in 1/sr that integrate to 1 over the sphere; c is the cosine of the scattering angle, 1
// straight on. Pure functions, safe from any thread.
#pragma once

#include <array>
#include <string_view>

#include "welkin/core/params.h"

namespace welkin::optics {

float phaseRayleigh(float c);
float phaseHenyeyGreenstein(float c, float g);
float phaseDraine(float c, float g, float alpha);
float phaseHaze(float c, float g);  // two lobes; g: mean cosine, up to 0.9
float phaseIce(float c);            // crystals of many shapes, without halos, as snow has them
// Its narrow lobe, Henyey and Greenstein's: share of the light, and mean cosine.
struct IcePeak {
  float share, g;
};
IcePeak icePeak();

// How cloud droplets scatter: by the fit below, or by Mie's theory, with fogbow and glory.
enum class DropletModel { kFit, kMie };

// Mean cosine of phaseDraine().
float draineMeanCosine(float g, float alpha);

// Water droplets by the fit of Jendersie and d'Eon 2023: a Henyey-Greenstein and a Draine lobe.
struct DropletPhase {
  float gHg = 0.0f;
  float gDraine = 0.0f;
  float alpha = 0.0f;
  float wDraine = 0.0f;  // weight of the Draine lobe, 0 to 1
};
// diameterUm: droplet diameter in micrometres, clamped to the fit's 5 to 50.
DropletPhase dropletPhase(float diameterUm);
float phaseDroplet(float c, const DropletPhase& p);
float dropletMeanCosine(const DropletPhase& p);
// The mean cosine that closed forms for the inside of clouds go by, whatever the droplets.
float dropletAsymmetry();
// The share of what droplets scatter that they turn by more than some degrees.
float dropletAside();

}  // namespace welkin::optics

namespace welkin {
template <>
inline constexpr auto kEnumNames<optics::DropletModel> = std::array<std::string_view, 2>{"fit", "mie"};
}  // namespace welkin
