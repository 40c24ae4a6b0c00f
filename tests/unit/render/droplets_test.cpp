// SPDX-License-Identifier: Apache-2.0
// The first scattering by Mie's theory in pictures of marched volumes.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "tests/testing/skies.h"
#include "welkin/core/units.h"
#include "welkin/optics/mie_droplets.h"
#include "welkin/optics/phase.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

scene::Scene deck(weather::Genus genus) {
  scene::Scene s;
  s.time = parseUtcTime("2026-06-21T06:45:00Z");
  s.visibilityM = 300000.0;
  s.camera.eyeM = 1100.0;
  s.camera.fovDeg = 3.0;
  s.output.width = s.output.height = 16;
  weather::Layer layer = weather::typicalLayer(genus, 47.0);
  layer.baseM = 200.0;
  layer.topM = 900.0;
  layer.oktas = 8;
  layer.effectiveRadiusUm = 6.0;
  s.layers = {layer};
  return s;
}

glm::dvec3 meanLuminance(SkyRenderer& renderer, const scene::SkyState& state) {
  const Image<float> picture = renderer.draw(state).luminance;
  glm::dvec3 sum(0.0);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int c = 0; c < 3; ++c) sum[c] += picture.at(x, y, c);
  return sum / static_cast<double>(picture.width * picture.height);
}

glm::dvec3 phaseAt(const Image<float>& table, double cosine) {
  const double x = std::acos(glm::clamp(cosine, -1.0, 1.0)) / kPi * (optics::kMieAngles - 1);
  const int i = static_cast<int>(std::min(x, optics::kMieAngles - 2.0));
  glm::dvec3 p;
  for (int c = 0; c < 3; ++c)
    p[c] = table.at(i, 0, c) + (x - i) * (table.at(i + 1, 0, c) - table.at(i, 0, c));
  return p;
}

// What Mie's theory adds to the picture of a deck is single scattering in a half space: its phase function,
// less the fit's, times the illuminance over 1 + mu / mu0 (S. Chandrasekhar 1960, "Radiative Transfer"), at
// the glory, on its rings and on the fogbow.
TEST(Droplets, MieAddsItsSingleScattering) {
  SkyRenderer renderer({.debug = true});
  scene::Scene s = deck(weather::Genus::kStratus);
  scene::SkyState state = scene::buildSky(s, 0.0);
  // Without gaps, and flat above.
  testing::changeLayers(state, [](auto& layers) { layers.at(0).threshold = -50.0f; });
  const double diameterUm = scene::dropletDiameterUm(state.weather);
  const Image<float> table = optics::mieDroplets(diameterUm);
  const auto fit = optics::dropletPhase(static_cast<float>(diameterUm));
  const glm::dvec3 toSun(state.lights[0].direction);
  for (const double fromAntisolarDeg : {0.0, 2.0, 20.0, 38.0}) {
    state.headingDeg = state.ephemeris.sun.azimuthDeg + 180.0;
    state.scene.camera.pitchDeg = -state.ephemeris.sun.elevationDeg - fromAntisolarDeg;
    state.scene.droplets = optics::DropletModel::kFit;
    const glm::dvec3 without = meanLuminance(renderer, state);
    state.scene.droplets = optics::DropletModel::kMie;
    const glm::dvec3 added = meanLuminance(renderer, state) - without;

    glm::dvec3 expected(0.0);
    constexpr int kSide = 16;
    const double half = std::tan(0.5 * radians(s.camera.fovDeg)), a = radians(state.headingDeg),
                 e = radians(state.scene.camera.pitchDeg);
    const glm::dvec3 forward(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)),
        right(std::cos(a), -std::sin(a), 0.0), up = glm::cross(right, forward);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const glm::dvec3 dir = glm::normalize(forward + half * ((2.0 * (x + 0.5) / kSide - 1.0) * right +
                                                                (2.0 * (y + 0.5) / kSide - 1.0) * up));
        const double c = glm::dot(dir, toSun);
        expected +=
            (phaseAt(table, c) - static_cast<double>(optics::phaseDroplet(static_cast<float>(c), fit))) /
            (1.0 - dir.z / toSun.z) / static_cast<double>(kSide * kSide);
      }
    const glm::dvec3 light(state.lights[0].illuminance *
                           state.atmosphere->transmittanceToSpace(900.0, state.lights[0].direction.z));
    expected *= light;
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(added[c], expected[c], 0.12 * std::abs(expected[c]) + 0.01 * without[c])
          << fromAntisolarDeg << " degrees, colour " << c << ", without " << without[c];
  }
}

TEST(Droplets, IceHasNoGlory) {
  SkyRenderer renderer({.debug = true});
  scene::SkyState state = scene::buildSky(deck(weather::Genus::kCirrostratus), 0.0);
  state.headingDeg = state.ephemeris.sun.azimuthDeg + 180.0;
  state.scene.camera.pitchDeg = -state.ephemeris.sun.elevationDeg;
  const glm::dvec3 fit = meanLuminance(renderer, state);
  state.scene.droplets = optics::DropletModel::kMie;
  const glm::dvec3 mie = meanLuminance(renderer, state);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mie[c], fit[c], 1e-4 * fit[c]);
}

}  // namespace
}  // namespace welkin::render
