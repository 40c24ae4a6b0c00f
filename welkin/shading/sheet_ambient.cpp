// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/sheet_ambient.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>

#include "welkin/core/units.h"
#include "welkin/optics/phase.h"

namespace welkin::shading {
namespace {

constexpr float kPiF = static_cast<float>(kPi);

glm::vec3 horizontalIlluminance(const scene::SkyState& s, const sky::Light& light, double heightM) {
  if (light.direction.z <= 0.0f) return glm::vec3(0.0f);
  return light.illuminance * light.direction.z *
         s.atmosphere->transmittanceToSpace(s.scene.place.altitudeM + heightM, light.direction.z);
}

// The clear sky's, as lib/sky_uniforms.glsl has it.
glm::vec3 clearSky(const scene::AmbientLight& a, double heightM) {
  return glm::mix(a.skyLow, a.skyHigh, static_cast<float>(std::clamp(heightM / 10000.0, 0.0, 1.0)));
}

}  // namespace

SheetTransmittance transmittanceOf(double depth, double sine, double bias) {
  const double mu = std::clamp(sine, 0.1, 1.0), t = (1.0 - optics::dropletAsymmetry()) * depth;
  const double direct = std::exp(-depth / mu);
  const double all = (2.0 / 3.0 + mu + (2.0 / 3.0 - mu) * std::exp(-t / mu)) / (4.0 / 3.0 + t);
  const double sky = 1.0 / (1.0 + 0.75 * t);
  return {1.0 - bias * (1.0 - direct), bias * std::max(all - direct, 0.0), 1.0 - bias * (1.0 - sky)};
}

SheetTransmittance transmittanceOf(const SheetMatter& matter, double sine) {
  constexpr int kColumns = 64;
  const double k = std::min(matter.law.k, 1e4);  // as lookOf
  SheetTransmittance mean{0.0, 0.0, 0.0};
  for (int i = 0; i < kColumns; ++i) {
    const double excess = matter.quantiles.above((i + 0.5) / kColumns) - matter.law.threshold;
    const SheetTransmittance t = transmittanceOf(k * std::max(excess, 0.0), sine, matter.law.bias);
    mean.direct += t.direct / kColumns;
    mean.diffused += t.diffused / kColumns;
    mean.sky += t.sky / kColumns;
  }
  return mean;
}

LightUnderSheets lightUnder(const scene::SkyState& state, std::span<const SheetInSky> sheets) {
  LightUnderSheets out;
  out.ambient = state.ambient;
  out.sheets.resize(sheets.size());
  out.sunThrough.resize(sheets.size());
  // From the top down: what is left of the sky's light and of each light's, and what clouds have diffused.
  std::vector<double> direct(state.lights.size(), 1.0);
  double sky = 1.0;
  glm::vec3 diffused(0.0f);  // illuminance, lux
  for (std::size_t i = sheets.size(); i-- > 0;) {
    const SheetInSky& sheet = sheets[i];
    out.sheets[i].sun = static_cast<float>(direct[0]);
    out.sheets[i].sky = clearSky(state.ambient, sheet.heightM) * static_cast<float>(sky) + diffused / kPiF;
    glm::vec3 fresh(0.0f);
    for (std::size_t l = 0; l < state.lights.size(); ++l) {
      const SheetTransmittance t = transmittanceOf(*sheet.matter, state.lights[l].direction.z);
      fresh += horizontalIlluminance(state, state.lights[l], sheet.heightM) *
               static_cast<float>(direct[l] * t.diffused);
      direct[l] *= t.direct;
      if (l == 0) out.sunThrough[i] = static_cast<float>(t.direct);
    }
    const double through = transmittanceOf(*sheet.matter, 1.0).sky;
    diffused = diffused * static_cast<float>(through) + fresh;
    sky *= through;
  }

  scene::AmbientLight& a = out.ambient;
  const glm::vec3 albedo(state.scene.ground.albedo);
  glm::vec3 lit(0.0f);
  for (std::size_t l = 0; l < state.lights.size(); ++l)
    lit += horizontalIlluminance(state, state.lights[l], 0.0) * static_cast<float>(direct[l]);
  const glm::vec3 down = clearSky(a, 0.0) * kPiF * static_cast<float>(sky) + diffused;
  // To the clouds and back: all that they do not let through returns.
  const glm::vec3 again = albedo * static_cast<float>(1.0 - sky);
  a.skyOnGround = (down + again * lit) / (1.0f - again);
  a.ground = albedo / kPiF * (a.skyOnGround + lit);
  a.clearAir = 1.0f;
  for (std::size_t i = 0; i < sheets.size(); ++i)
    if (sheets[i].heightM > state.scene.camera.eyeM) a.clearAir *= out.sunThrough[i];
  a.haze = 0.75f * a.skyOnGround / kPiF + 0.25f * a.ground;
  return out;
}

}  // namespace welkin::shading
