// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/atmosphere.h"

#include <algorithm>
#include <cmath>

#include "welkin/core/parallel.h"
#include "welkin/core/units.h"
#include "welkin/sky/atmosphere_glsl.h"

namespace welkin::sky {
namespace {

using shared::store;
using shared::vec2;
using shared::vec3;

Image<float> makeTransmittance(const shared::Atmosphere& a) {
  const int w = static_cast<int>(shared::kTransmittanceWidth),
            h = static_cast<int>(shared::kTransmittanceHeight);
  Image<float> table(w, h, 4);
  parallelFor(static_cast<std::size_t>(h), 4, [&](std::size_t begin, std::size_t end) {
    for (int j = static_cast<int>(begin); j < static_cast<int>(end); ++j) {
      for (int i = 0; i < w; ++i) {
        const vec2 p = shared::atmosphereTransmittanceParameters(
            a, static_cast<float>(i) / (shared::kTransmittanceWidth - 1),
            static_cast<float>(j) / (shared::kTransmittanceHeight - 1));
        const shared::vec4 depth = shared::atmosphereOpticalDepth(a, p.x, p.y);
        store(&table.at(i, j), glm::exp(-vec3(depth)));
        table.at(i, j, 3) = depth.w / a.aerosolScaleHeightM;
      }
    }
  });
  return table;
}

// Moments of the light around a point (shaders/lib/atmosphere.glsl). Of the mean, after Hillaire 2020, eq. 5
// to 10, all orders from the second on as a geometric series of isotropic exchanges with a neighbourhood that
// is lit like the point itself; of the others the second order alone, which has most of them.
Image<float> makeMultipleScattering(const shared::Atmosphere& a, const Image<float>& transmittance) {
  const int size = static_cast<int>(shared::kMultipleScatteringSize);
  constexpr int kElevations = 8, kAzimuths = 4;  // azimuths over half a turn: the light's plane is a mirror
  // A light so far down (20 degrees) reaches no air that is seen from air that is seen: the table stays 0.
  constexpr float kDarkMu = -0.35f;
  const shared::sampler2D lut{&transmittance};
  Image<float> table(size, size * static_cast<int>(shared::kMultipleScatteringMoments), 3);
  parallelFor(static_cast<std::size_t>(size), 1, [&](std::size_t begin, std::size_t end) {
    for (int j = static_cast<int>(begin); j < static_cast<int>(end); ++j) {
      for (int i = 0; i < size; ++i) {
        const vec2 p = shared::atmosphereMultipleScatteringParameters(
            a, static_cast<float>(i) / static_cast<float>(size - 1),
            static_cast<float>(j) / static_cast<float>(size - 1));
        if (p.y < kDarkMu) continue;
        const vec3 light(std::sqrt(std::max(1.0f - p.y * p.y, 0.0f)), 0.0f, p.y);
        vec3 mean(0.0f), first(0.0f), second(0.0f), gathered(0.0f);
        for (int e = 0; e < kElevations; ++e) {
          const float mu = -1.0f + (static_cast<float>(e) + 0.5f) * 2.0f / kElevations;
          for (int f = 0; f < kAzimuths; ++f) {
            const float azimuth = (static_cast<float>(f) + 0.5f) * static_cast<float>(kPi) / kAzimuths;
            const vec3 direction = shared::atmosphereDirection(mu, azimuth, vec3(1, 0, 0));
            vec3 s, g;
            shared::atmosphereSecondOrder(a, lut, p.x, direction, light, s, g);
            const float c = glm::dot(direction, light);
            mean += s;
            first += 3.0f * c * s;
            second += 5.0f * (1.5f * c * c - 0.5f) * s;
            gathered += g;
          }
        }
        constexpr float kWeight = 1.0f / (kElevations * kAzimuths);
        store(&table.at(i, j), mean * kWeight / (vec3(1.0f) - glm::min(gathered * kWeight, vec3(0.999f))));
        store(&table.at(i, size + j), first * kWeight);
        store(&table.at(i, 2 * size + j), second * kWeight);
      }
    }
  });
  return table;
}

}  // namespace

Atmosphere::Atmosphere(const AtmosphereParams& params, double visibilityM, double groundAltitudeM,
                       glm::vec3 groundAlbedo)
    : Atmosphere(atmosphereUniforms(params, visibilityM, groundAltitudeM, groundAlbedo)) {}

Atmosphere::Atmosphere(const AtmosphereUniforms& uniforms) : uniforms_(uniforms) {
  const shared::Atmosphere a = shared::fromUniforms(uniforms_);
  transmittance_ = makeTransmittance(a);
  multipleScattering_ = makeMultipleScattering(a, transmittance_);
}

glm::vec3 Atmosphere::transmittanceToSpace(double altitudeM, double mu) const {
  return shared::atmosphereTransmittance(shared::fromUniforms(uniforms_), {&transmittance_},
                                         static_cast<float>(altitudeM), static_cast<float>(mu));
}

glm::vec3 Atmosphere::sphericalAlbedo(double altitudeM) const {
  // Of a layer that scatters alike to both sides and absorbs nothing: E. F. Vermote et al. 1997, "Second
  // Simulation of the Satellite Signal in the Solar Spectrum, 6S: An Overview". Aerosol counts by similarity.
  const AtmosphereUniforms& u = uniforms_;
  const double rayleighM =
      u.rayleighScaleHeightM * std::exp(-altitudeM / static_cast<double>(u.rayleighScaleHeightM));
  const double aerosolM = u.aerosolScaleHeightM * std::exp((u.groundAltitudeM - altitudeM) /
                                                           static_cast<double>(u.aerosolScaleHeightM));
  glm::vec3 albedo(0.0f);
  for (int c = 0; c < 3; ++c) {
    const double depth = u.rayleighScattering[c] * rayleighM +
                         (1.0 - static_cast<double>(u.aerosolG)) * u.aerosolScattering[c] * aerosolM;
    if (depth < 1e-6) continue;
    // Exponential integrals.
    const double e1 = -std::expint(-depth), e2 = std::exp(-depth) - depth * e1,
                 e3 = (std::exp(-depth) - depth * e2) / 2.0, e4 = (std::exp(-depth) - depth * e3) / 3.0;
    albedo[c] = static_cast<float>((3.0 * depth - 4.0 * e3 + 6.0 * e4) / (4.0 + 3.0 * depth));
  }
  return albedo;
}

glm::vec3 Atmosphere::skyLuminance(double altitudeM, glm::vec3 direction,
                                   std::span<const Light> lights) const {
  shared::Atmosphere a = shared::fromUniforms(uniforms_);
  vec3 sum(0.0f);
  for (std::size_t i = 0; i == 0 || 2 * i < lights.size(); ++i) {
    sum +=
        shared::atmosphereSkyRay(a, {&transmittance_}, {&multipleScattering_}, static_cast<float>(altitudeM),
                                 direction, shared::lightPair(lights, i), 1.0f);
    a.airglow = vec3(0.0f);  // once
  }
  return sum;
}

void LightMoments::add(const glm::vec3& luminance, const glm::vec3& direction, float steradians) {
  const glm::vec3 light = steradians * luminance;
  total += light;
  for (int k = 0; k < 3; ++k) along[static_cast<std::size_t>(k)] += direction[k] * light;
}

LightMoments operator+(const LightMoments& a, const LightMoments& b) {
  LightMoments sum{a.total + b.total, {}};
  for (std::size_t k = 0; k < 3; ++k) sum.along[k] = a.along[k] + b.along[k];
  return sum;
}

LightMoments operator*(float share, const LightMoments& m) {
  return {share * m.total, {share * m.along[0], share * m.along[1], share * m.along[2]}};
}

namespace {

// One of so many rings of a hemisphere. Midpoints in elevation, squeezed towards the horizon where luminance
// changes fast, and in azimuth.
template <class Luminance>
LightMoments lightOfRing(int ring, int rings, int azimuths, float side, std::span<const Light> lights,
                         Luminance&& luminance) {
  const float x = (static_cast<float>(ring) + 0.5f) / static_cast<float>(rings);
  const float angle = static_cast<float>(0.5 * kPi) * x * x;
  const float width = static_cast<float>(kPi) * x / static_cast<float>(rings);
  const float steradians =
      std::cos(angle) * width * static_cast<float>(2.0 * kPi) / static_cast<float>(azimuths);
  const vec3 zero = lights.empty() ? vec3(1, 0, 0) : vec3(lights[0].direction);
  LightMoments sum;
  for (int f = 0; f < azimuths; ++f) {
    const float azimuth =
        (static_cast<float>(f) + 0.5f) * static_cast<float>(2.0 * kPi) / static_cast<float>(azimuths);
    const vec3 direction = shared::atmosphereDirection(side * std::sin(angle), azimuth, zero);
    sum.add(luminance(direction), direction, steradians);
  }
  return sum;
}

}  // namespace

glm::vec3 Atmosphere::skyIlluminance(double altitudeM, std::span<const Light> lights) const {
  LightMoments sum;
  for (int ring = 0; ring < kSkyRings; ++ring) sum = sum + skyLightOfRing(altitudeM, lights, ring);
  return sum.along[2];
}

LightMoments Atmosphere::skyLightOfRing(double altitudeM, std::span<const Light> lights, int ring) const {
  return lightOfRing(ring, kSkyRings, 24, 1.0f, lights,
                     [&](const vec3& d) { return skyLuminance(altitudeM, d, lights); });
}

LightMoments Atmosphere::airLightOfRing(double altitudeM, std::span<const Light> lights, int ring) const {
  return lightOfRing(ring, kAirRings, 12, -1.0f, lights,
                     [&](const vec3& d) { return skyLuminance(altitudeM, d, lights); });
}

}  // namespace welkin::sky
