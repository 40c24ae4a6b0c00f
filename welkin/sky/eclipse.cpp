// SPDX-License-Identifier: Apache-2.0
#include "welkin/sky/eclipse.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "welkin/core/glsl.h"
#include "welkin/core/units.h"

namespace welkin::sky {
namespace {

namespace shared {
using namespace welkin::glsl;
#include "shaders/lib/eclipse.glsl"
}  // namespace shared

constexpr double kEarthShadowRadiusM = 1.01 * 6378.137e3;

// No shadow that far from the observer lights or darkens what is seen.
constexpr double kFarthestM = 1000e3;

// Area that two circles have in common, of the first's, whose radius is 1: two segments.
double commonArea(double distance, double radius) {
  if (distance >= 1.0 + radius) return 0.0;
  if (distance <= std::abs(1.0 - radius)) return std::min(1.0, radius * radius);
  const double first = (distance * distance + 1.0 - radius * radius) / (2.0 * distance),
               second = distance - first;
  const auto segment = [](double r, double toChord) {
    return r * r * std::acos(std::clamp(toChord / r, -1.0, 1.0)) -
           toChord * std::sqrt(std::max(r * r - toChord * toChord, 0.0));
  };
  return (segment(1.0, first) + segment(radius, second)) / kPi;
}

// Angle between two directions, of which small ones keep their digits.
double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

SolarEclipse solarEclipse(const glm::dvec3& sunM, const glm::dvec3& moonM) {
  SolarEclipse e;
  const double sunDistanceM = glm::length(sunM), moonDistanceM = glm::length(moonM);
  const double sunRadius = std::asin(kSunRadiusM / sunDistanceM),
               moonRadius = std::asin(std::min(kMoonRadiusM / moonDistanceM, 1.0)) / sunRadius;
  const glm::dvec3 toMoon = (moonM / moonDistanceM - sunM / sunDistanceM) / sunRadius;
  const double perMetre = (1.0 / moonDistanceM - 1.0 / sunDistanceM) / sunRadius;
  const double distance = glm::length(toMoon);
  if (distance - kFarthestM * perMetre >= 1.0 + moonRadius) return e;
  e.obscuration = commonArea(distance, moonRadius);
  e.shadow = {glm::vec3(toMoon), static_cast<float>(moonRadius), static_cast<float>(perMetre), 1.0f};
  e.shadow.share = sunShareAt(e.shadow, glm::vec3(sunM / sunDistanceM), glm::vec3(0.0f));
  return e;
}

float sunShareAt(const MoonShadow& shadow, const glm::vec3& sunDirection, const glm::vec3& fromPointM) {
  if (!shadow.any()) return 1.0f;
  return shared::sunShareAt({shadow.toMoon, shadow.moonRadius, shadow.perMetre, shadow.share}, sunDirection,
                            fromPointM);
}

glm::vec3 LunarEclipse::shareAt(const glm::vec3& across) const {
  return shared::sunOnMoon(glm::length(at + moonRadius * across), earthRadius);
}

LunarEclipse lunarEclipse(const glm::dvec3& sunM, const glm::dvec3& moonM) {
  LunarEclipse e;
  const double distanceM = glm::length(moonM), sunDistanceM = glm::length(sunM - moonM);
  const glm::dvec3 toSun = (sunM - moonM) / sunDistanceM, outwards = moonM / distanceM;
  // As the moon sees it.
  const double sunRadius = std::asin(kSunRadiusM / sunDistanceM);
  const double earth = std::asin(kEarthShadowRadiusM / distanceM) / sunRadius,
               moon = kMoonRadiusM * (1.0 / distanceM + 1.0 / sunDistanceM) / sunRadius,
               distance = angleBetween(-moonM, toSun) / sunRadius;
  const double inPenumbra = (earth + 1.0 + moon - distance) / (2.0 * moon);
  if (inPenumbra <= 0.0) return e;
  e.penumbralMagnitude = inPenumbra;
  e.umbralMagnitude = std::max((earth - 1.0 + moon - distance) / (2.0 * moon), 0.0);
  const glm::dvec3 axis = glm::normalize(sunM), aside = outwards - axis * glm::dot(axis, outwards);
  e.at = glm::vec3(aside * (distance / std::max(glm::length(aside), 1e-12)));
  e.moonRadius = static_cast<float>(moon);
  e.earthRadius = static_cast<float>(earth);
  // Evenly over the disc: H. Vogel 1979, "A better way to construct the sunflower head".
  constexpr int kPoints = 256;
  const glm::dvec3 right = glm::normalize(
                       glm::cross(axis, std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0))),
                   up = glm::cross(right, axis);
  glm::vec3 sum(0.0f);
  for (int i = 0; i < kPoints; ++i) {
    const double r = std::sqrt((i + 0.5) / kPoints), a = 2.39996323 * i;
    sum += e.shareAt(glm::vec3(r * (std::cos(a) * right + std::sin(a) * up)));
  }
  e.share = sum / static_cast<float>(kPoints);
  return e;
}

}  // namespace welkin::sky
