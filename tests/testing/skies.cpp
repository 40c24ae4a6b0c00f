// SPDX-License-Identifier: Apache-2.0
#include "tests/testing/skies.h"

#include <cmath>
#include <memory>

#include "welkin/sky/ephemeris.h"

namespace welkin::testing {
namespace {

scene::Scene smallScene(const UtcTime& time) {
  scene::Scene s;
  s.place = {kTestLatitudeDeg, 0.0, 0.0};
  s.time = time;
  s.camera.headingDeg = 0.0;
  s.output.width = 32;
  s.output.height = 18;
  s.output.quality = scene::Quality::kLow;
  return s;
}

}  // namespace

scene::Scene clearScene(double sunElevationDeg) {
  // From noon to midnight the sun only sinks.
  const UtcTime noon = parseUtcTime("2026-06-21T12:05:00Z");
  double early = 0.0, late = 12.0 * 3600.0;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (early + late);
    const sky::Ephemeris e = sky::ephemeris(addSeconds(noon, middle), {kTestLatitudeDeg, 0.0, 0.0});
    (e.sun.elevationDeg > sunElevationDeg ? early : late) = middle;
  }
  return smallScene(addSeconds(noon, early));
}

scene::Scene cloudyScene(double sunElevationDeg, std::initializer_list<weather::Genus> genera, double oktas) {
  scene::Scene s = clearScene(sunElevationDeg);
  for (const weather::Genus genus : genera) {
    s.layers.push_back(weather::typicalLayer(genus, kTestLatitudeDeg));
    s.layers.back().oktas = oktas;
  }
  return s;
}

scene::Scene moonlitScene() {
  return smallScene(parseUtcTime("2026-12-24T00:30:00Z"));
}
scene::Scene moonlessScene() {
  return smallScene(parseUtcTime("2026-12-09T00:30:00Z"));
}

scene::Scene sized(scene::Scene s, int width, int height) {
  s.output.width = width;
  s.output.height = height;
  return s;
}

scene::Scene looking(scene::Scene s, double headingDeg, double pitchDeg, double fovDeg) {
  s.camera.headingDeg = std::fmod(headingDeg, 360.0);
  s.camera.pitchDeg = pitchDeg;
  s.camera.fovDeg = fovDeg;
  return s;
}

scene::Scene projected(scene::Scene s, scene::Projection projection, int width, int height) {
  s.camera.projection = projection;
  return sized(s, width, height);
}

scene::Scene fromHeight(scene::Scene s, double eyeM) {
  s.camera.eyeM = eyeM;
  return s;
}

void changeLayers(scene::SkyState& state,
                  const std::function<void(std::vector<field::CloudLayer>&)>& change) {
  std::vector<field::CloudLayer> layers(state.clouds->layers().begin(), state.clouds->layers().end());
  change(layers);
  const auto noise = state.clouds->sharedNoise();  // a copy, which outlives the field
  state.clouds.emplace(noise, layers, state.scene.place.altitudeM);
}

scene::SkyState airlessSky(scene::Scene s, double sunLux) {
  s.ground.albedo = {0.0, 0.0, 0.0};
  s.output.sunDisc = false;
  scene::SkyState state = scene::buildSky(s, 0.0);
  sky::AtmosphereUniforms u = state.atmosphere->uniforms();
  u.rayleighScattering = u.aerosolExtinction = u.aerosolScattering = u.ozoneAbsorption = u.airglow =
      glm::vec3(0.0f);
  state.atmosphere = std::make_shared<sky::Atmosphere>(u);
  state.lights[0].illuminance = glm::vec3(static_cast<float>(sunLux));
  state.lights[1].illuminance = glm::vec3(0.0f);
  return state;
}

}  // namespace welkin::testing
