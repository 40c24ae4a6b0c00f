// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/sheet_ambient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>

#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"
#include "welkin/optics/phase.h"

namespace welkin::shading {
namespace {

constexpr float kPiF = static_cast<float>(kPi);

glm::vec3 horizontalIlluminance(const scene::SkyState& s, const sky::Light& light, double heightM) {
  if (light.direction.z <= 0.0f) return glm::vec3(0.0f);
  return light.illuminance * light.direction.z *
         s.atmosphere->transmittanceToSpace(s.scene.place.altitudeM + heightM, light.direction.z);
}

// Mean luminance of the clear sky above a height, on a straight line from the ground to 10 km. Volumes take
// finer heights and directions (lib/light_around.glsl).
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

namespace {

// Light on its way down through layers of cloud: what is left of the sky's and of each light's, and what
// clouds have diffused.
class Descent {
 public:
  explicit Descent(const scene::SkyState& state) : state_(state) { direct_.fill(1.0); }

  // through(sine): what the layer lets down of light of this sine of elevation.
  template <class Through>
  void pass(double heightM, const Through& through) {
    glm::vec3 fresh(0.0f);
    for (std::size_t l = 0; l < state_.lights.size(); ++l) {
      const SheetTransmittance t = through(state_.lights[l].direction.z);
      fresh += horizontalIlluminance(state_, state_.lights[l], heightM) *
               static_cast<float>(direct_[l] * t.diffused);
      direct_[l] *= t.direct;
    }
    const double sky = through(1.0).sky;
    diffused_ = diffused_ * static_cast<float>(sky) + fresh;
    sky_ *= sky;
  }
  void pass(const SheetInSky& sheet) {
    pass(sheet.heightM, [&](double sine) { return transmittanceOf(*sheet.matter, sine); });
  }
  void pass(const VolumeInSky& volume) {
    pass(volume.heightM, [&](double sine) { return transmittanceOf(volume.depth, sine, volume.cover); });
  }

  double direct() const { return direct_[0]; }  // of the key light
  glm::vec3 skyAt(double heightM) const {
    return clearSky(state_.ambient, heightM) * static_cast<float>(sky_) + diffused_ / kPiF;
  }

  struct AtGround {
    glm::vec3 sky, light;  // illuminance by the sky, lux; luminance of the ground
  };
  AtGround atGround() const {
    const glm::vec3 albedo(scene::groundAlbedo(state_.scene, state_.weather));
    glm::vec3 lit(0.0f);
    for (std::size_t l = 0; l < state_.lights.size(); ++l)
      lit += horizontalIlluminance(state_, state_.lights[l], 0.0) * static_cast<float>(direct_[l]);
    const glm::vec3 down = clearSky(state_.ambient, 0.0) * kPiF * static_cast<float>(sky_) + diffused_;
    // To the clouds and back: all that they do not let through returns.
    const glm::vec3 again = albedo * static_cast<float>(1.0 - sky_);
    const glm::vec3 sky = (down + again * lit) / (1.0f - again);
    return {sky, albedo / kPiF * (sky + lit)};
  }

 private:
  const scene::SkyState& state_;
  std::array<double, 2> direct_;  // of the state's lights
  double sky_ = 1.0;
  glm::vec3 diffused_{0.0f};  // illuminance, lux
};

}  // namespace

std::vector<VolumeInSky> volumesIn(const scene::SkyState& state) {
  std::vector<VolumeInSky> volumes;
  const auto layers = state.clouds->layers().first(state.weather.layers.size());  // without rain
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (scene::isSheet(state.scene, state.weather.layers[i])) continue;
    const field::CloudLayer& layer = layers[i];
    volumes.push_back({0.5 * (layer.baseM + layer.topM),
                       0.4 * static_cast<double>(layer.extinction * (layer.topM - layer.baseM)),
                       state.weather.layers[i].oktas / kOktas});
  }
  std::ranges::sort(volumes, {}, &VolumeInSky::heightM);
  return volumes;
}

LightUnderSheets lightUnder(const scene::SkyState& state, std::span<const SheetInSky> sheets,
                            std::span<const VolumeInSky> volumes) {
  LightUnderSheets out;
  lightUnder(state, sheets, volumes, out);
  return out;
}

void lightUnder(const scene::SkyState& state, std::span<const SheetInSky> sheets,
                std::span<const VolumeInSky> volumes, LightUnderSheets& out) {
  out.ambient = state.ambient;
  out.sheets.resize(sheets.size());
  out.sunThrough.resize(sheets.size());
  Descent all(state), sheetsAlone(state), volumesAlone(state);
  std::size_t volume = volumes.size();
  const auto passVolumesAbove = [&](double heightM) {
    for (; volume > 0 && volumes[volume - 1].heightM > heightM; --volume) {
      all.pass(volumes[volume - 1]);
      volumesAlone.pass(volumes[volume - 1]);
    }
  };
  for (std::size_t i = sheets.size(); i-- > 0;) {
    const SheetInSky& sheet = sheets[i];
    passVolumesAbove(sheet.heightM);
    out.sheets[i].sun = static_cast<float>(sheetsAlone.direct());
    out.sheets[i].sky = all.skyAt(sheet.heightM);
    all.pass(sheet);
    sheetsAlone.pass(sheet);
    out.sunThrough[i] =
        static_cast<float>(transmittanceOf(*sheet.matter, state.lights[0].direction.z).direct);
  }
  passVolumesAbove(-1.0);

  scene::AmbientLight& a = out.ambient;
  const Descent::AtGround ground = all.atGround();
  a.skyOnGround = ground.sky;
  a.ground = ground.light;
  out.onHaze = out.onGlow = glm::vec3(1.0f);
  out.amongVolumes = !volumes.empty();
  if (out.amongVolumes) {
    const Descent::AtGround before = volumesAlone.atGround();
    const glm::vec3 least(1e-30f);
    a.skyOnGround = state.ambient.skyOnGround * (ground.sky / glm::max(before.sky, least));
    const glm::vec3 share = ground.light / glm::max(before.light, least);
    a.ground = state.ambient.ground * share;
    a.below = share.y * state.ambient.below;
    a.belowHigh = share.y * state.ambient.belowHigh;
    out.onGlow = share;
  }
  // Of what there was without them, as much as there is of light from above and from below.
  const auto around = [](const scene::AmbientLight& light) {
    return light.skyOnGround / kPiF + light.ground;
  };
  out.onHaze = around(a) / glm::max(around(state.ambient), glm::vec3(1e-30f));
  a.air = airUnder(state, sheets, out, state.scene.camera.eyeM);
}

scene::EyeAir airUnder(const scene::SkyState& state, std::span<const SheetInSky> sheets,
                       const LightUnderSheets& light, double eyeM) {
  scene::EyeAir air = scene::airAbout(state, eyeM);
  for (std::size_t i = 0; i < sheets.size(); ++i)
    if (sheets[i].heightM > eyeM) air.airUnderSheets *= light.sunThrough[i];
  air.clearAir = (light.amongVolumes ? air.clearAir : 1.0f) * air.airUnderSheets;
  air.haze = light.onHaze * air.haze;
  air.cloudGlow = light.onGlow * air.cloudGlow;
  air.overClouds *= light.onGlow;
  return air;
}

glm::vec4 lightShareUnder(const scene::SkyState& state, std::span<const SheetInSky> sheets, double heightM) {
  Descent descent(state);
  for (std::size_t i = sheets.size(); i > 0 && sheets[i - 1].heightM > heightM; --i)
    descent.pass(sheets[i - 1]);
  return {descent.skyAt(heightM) / glm::max(clearSky(state.ambient, heightM), glm::vec3(1e-30f)),
          static_cast<float>(descent.direct())};
}

}  // namespace welkin::shading
