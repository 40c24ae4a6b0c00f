// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/lens_flare.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "welkin/core/units.h"
#include "welkin/sky/light.h"

namespace welkin::shading {
namespace {

// Looks, chosen by eye: radius in half heights of the picture, share of the scattered light, hollowness, and
// the tint that coatings give, whatever its luminance.
struct Look {
  float radius, share, hollow;
  glm::vec3 tint;
};
constexpr Look kGlow = {1.6f, 0.86f, -1.0f, {1.0f, 1.0f, 1.0f}};
constexpr std::array<Look, LensFlare::kGhostsAt.size()> kGhosts = {{
    {0.11f, 0.018f, 0.25f, {1.0f, 0.86f, 0.70f}},
    {0.055f, 0.007f, 0.0f, {0.78f, 1.0f, 0.86f}},
    {0.17f, 0.035f, 0.45f, {0.80f, 0.90f, 1.0f}},
    {0.08f, 0.012f, 0.0f, {1.0f, 0.82f, 0.95f}},
    {0.30f, 0.068f, 0.85f, {0.74f, 1.0f, 0.94f}},
}};

FlareSprite spriteOf(const Look& look, glm::vec2 centre, const ViewParts& view,
                     const glm::vec3& illuminance) {
  // Round on the sensor: as wide as high in tangents, whatever the pixels' shape.
  const glm::vec2 tangents = glm::abs(glm::vec2(view.rayScale));
  const float radius = look.radius * tangents.y;
  const float solidAngle = static_cast<float>(kPi) * radius * radius;
  const float luminance = glm::dot(look.tint, glm::vec3(0.2126f, 0.7152f, 0.0722f));
  return {centre, radius / tangents, illuminance * look.tint * (look.share / (luminance * solidAngle)),
          look.hollow};
}

// The share of a disc, taken for a square, on this side of the rims at -1 and 1.
float within(float at, float radius) {
  return std::clamp((1.0f + radius - std::abs(at)) / (2.0f * radius), 0.0f, 1.0f);
}

}  // namespace

glm::vec3 sunlightAt(const scene::SkyState& state, double eyeM) {
  const sky::Light sun = sky::sunLight(state.ephemeris);
  return sun.illuminance *
         state.atmosphere->transmittanceToSpace(state.scene.place.altitudeM + eyeM, sun.direction.z);
}

LensFlare lensFlareOf(const ViewParts& view, const glm::vec3& toSun, float sunRadiusRad,
                      const glm::vec3& illuminance) {
  LensFlare flare;
  const glm::vec3 camera = glm::transpose(view.enuFromCamera) * toSun;
  const float ahead = -camera.z;  // cosine of the sun's angle to the optical axis
  if (ahead < 0.01f || illuminance.x + illuminance.y + illuminance.z <= 0.0f) return flare;
  const glm::vec2 scale(view.rayScale), shift(view.rayScale.z, view.rayScale.w);
  const glm::vec2 axis =
      -shift / scale;  // where the optical axis is in the picture: its centre, if symmetric
  flare.sunAt = (glm::vec2(camera) / ahead - shift) / scale;
  // Off the axis the plane of the picture stretches angles away from it by 1 / cos^2.
  flare.sunHalfSize = glm::abs(sunRadiusRad / (scale * (ahead * ahead)));
  flare.shown = within(flare.sunAt.x, flare.sunHalfSize.x) * within(flare.sunAt.y, flare.sunHalfSize.y);
  if (flare.shown <= 0.0f) return flare;
  const glm::vec3 light = illuminance * flare.shown;
  flare.sprites[0] = spriteOf(kGlow, flare.sunAt, view, light);
  for (std::size_t i = 0; i < kGhosts.size(); ++i)
    flare.sprites[i + 1] =
        spriteOf(kGhosts[i], axis + LensFlare::kGhostsAt[i] * (flare.sunAt - axis), view, light);
  return flare;
}

}  // namespace welkin::shading
