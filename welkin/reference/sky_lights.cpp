// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/sky_lights.h"

#include <cmath>

#include "welkin/core/glsl.h"
#include "welkin/reference/directions.h"
#include "welkin/sky/light.h"

namespace welkin::reference {
namespace {

namespace shared {
using namespace welkin::glsl;
#include "shaders/lib/eclipse.glsl"
#include "shaders/lib/moon.glsl"
}  // namespace shared

constexpr double kLimb = static_cast<double>(shared::kSunLimb);
constexpr double kMostSecond = 0.9;  // chance of the second light: the first may be up where light goes next

double sum(const glm::dvec3& v) {
  return v.x + v.y + v.z;
}

}  // namespace

SkyLights::SkyLights(const scene::SkyState& state, const Air& air, const Sphere& earth)
    : earth_(&earth),
      sunDirection_(glm::normalize(state.ephemeris.sun.direction)),
      moonDirection_(glm::normalize(state.ephemeris.moon.direction)),
      eye_(0.0, 0.0, state.scene.camera.eyeM),
      moonRadius_(state.ephemeris.moon.angularRadiusRad),
      lunarEclipse_(state.ephemeris.lunarEclipse) {
  for (std::size_t i = 0; i < state.lights.size(); ++i) {
    const sky::Light& light = state.lights[i];
    const bool isSun = (i == 0) == state.litBySun;
    if (!(light.illuminance.y > 0.0f)) continue;
    const sky::Body& body = isSun ? state.ephemeris.sun : state.ephemeris.moon;
    const glm::dvec3 direction = glm::normalize(glm::dvec3(light.direction));
    const double radius = body.angularRadiusRad;
    const glm::dvec3 full(isSun ? light.fullIlluminance() : sky::fullMoonlight(state.ephemeris));
    const double mean = isSun ? 1.0 : sky::moonDiscMean(state.ephemeris.moonPhaseAngleRad);
    discs_.push_back({isSun, direction, glm::dvec3(light.fullIlluminance()), turned(direction, 0.0, 0.0),
                      turned(direction, 0.0, 0.5 * kPi), radius, full / (kPi * radius * radius * mean),
                      light.shadow, AirToLight(air, earth, direction)});
  }
}

LightSample SkyLights::sample(const glm::dvec3& p, Random& random) const {
  if (discs_.empty()) return {};
  auto aimed = [&](const Disc& disc) {
    // Of a share u of the sun's light the middle x = r / radius: 1 - u = (1 - x^2)^(1 + kLimb / 2).
    const double u = unit(random);
    const double x2 = disc.isSun ? 1.0 - std::pow(1.0 - u, 1.0 / (1.0 + 0.5 * kLimb)) : u;
    // The sine and cosine of so small an angle are those of its series.
    const double angle2 = disc.radius * disc.radius * x2;
    const OnCircle about = onCircle(unit(random));
    const double sine = std::sqrt(angle2) * (1.0 - angle2 / 6.0),
                 cosine = 1.0 - angle2 * (0.5 - angle2 / 24.0);
    return cosine * disc.direction + sine * (about.cosine * disc.east + about.sine * disc.north);
  };
  const Disc& first = discs_.front();
  const glm::dvec3 direction = aimed(first);
  if (discs_.size() == 1) return {direction, 0, 1.0};
  // The second is looked at as often as it may matter beside the first.
  const double some = sum(first.illuminance * first.through.transmittance(p, direction)),
               most = sum(discs_[1].illuminance), chance = std::min(most / (most + some), kMostSecond);
  if (unit(random) >= chance) return {direction, 0, 1.0 / (1.0 - chance)};
  return {aimed(discs_[1]), 1, 1.0 / chance};
}

glm::dvec3 SkyLights::illuminance(const LightSample& light, const glm::dvec3& p) const {
  if (light.disc < 0) return glm::dvec3(0.0);
  const Disc& disc = discs_[static_cast<std::size_t>(light.disc)];
  const double share =
      disc.shadow.any()
          ? static_cast<double>(sky::sunShareAt(disc.shadow, glm::vec3(disc.direction), glm::vec3(p - eye_)))
          : 1.0;
  return light.weight * share * disc.illuminance * disc.through.transmittance(p, light.direction);
}

glm::dvec3 SkyLights::discs(const glm::dvec3& direction) const {
  glm::dvec3 luminance(0.0);
  const bool onMoon = glm::length(direction - moonDirection_) < moonRadius_;
  for (const Disc& disc : discs_) {
    const double x = glm::length(direction - disc.direction) / disc.radius;
    if (disc.isSun && disc.shadow.any()) {
      if (onMoon) continue;
      const double hidden = static_cast<double>(shared::sunHidden(disc.shadow.share));
      luminance +=
          disc.luminance *
          (hidden * static_cast<double>(shared::coronaLuminance(static_cast<float>(std::max(x, 1.0)))));
    }
    if (x >= 1.0) continue;
    const double mu = std::sqrt(1.0 - x * x);
    if (disc.isSun) {
      luminance += disc.luminance * (std::pow(mu, kLimb) * (1.0 + 0.5 * kLimb));
      continue;
    }
    // Lit by the sun as a dusty sphere (Lommel and Seeliger), with a trace of earthshine.
    const glm::dvec3 across = direction - disc.direction * glm::dot(direction, disc.direction);
    const double far = glm::length(across);
    const glm::dvec3 normal = (far > 0.0 ? across / far * x : across) - disc.direction * mu;
    const double mu0 = std::max(glm::dot(normal, sunDirection_), 0.0);
    const glm::dvec3 seen =
        disc.luminance * (2.0 * mu0 / (mu0 + mu + 1e-4) + static_cast<double>(shared::kEarthshine));
    luminance += lunarEclipse_.any()
                     ? seen * glm::dvec3(lunarEclipse_.shareAt(glm::vec3(across / disc.radius)))
                     : seen;
  }
  return luminance;
}

}  // namespace welkin::reference
