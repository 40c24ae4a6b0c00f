// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/air.h"

#include <array>
#include <cmath>
#include <glm/exponential.hpp>

#include "welkin/core/parallel.h"
#include "welkin/optics/phase.h"
#include "welkin/reference/directions.h"
#include "welkin/sky/atmosphere_glsl.h"

namespace welkin::reference {
namespace {

constexpr double kStepM = 20e3;  // longest; a chord of it sags by 8 m
constexpr int kMostPieces = 24;

// Of the table of extinctions: between two entries an exponential of 1200 m is a line within 1.4e-4. Along so
// little of a way it is one as well.
constexpr double kShortM = 500.0, kEntryM = 40.0, kEntriesTopM = 25e3, kLineM = 60.0;

// Of AirToLight.
constexpr int kHeights = 200, kCosines = 160;
constexpr double kTableTopM = 20e3, kCosineReach = 0.04;

double henyeyGreenstein(double c, double g) {
  const double d = 1.0 + g * g - 2.0 * g * c;
  return (1.0 - g * g) / (4.0 * kPi * d * std::sqrt(d));
}

double sampleHenyeyGreenstein(double u, double g) {
  if (std::abs(g) < 1e-4) return 2.0 * u - 1.0;
  const double s = (1.0 - g * g) / (1.0 + g * (2.0 * u - 1.0));
  return std::clamp((1.0 + g * g - s * s) / (2.0 * g), -1.0, 1.0);
}

// Integral of the tent max(1 - |x|, 0) from minus infinity to x.
double tentIntegral(double x) {
  if (x <= -1.0) return 0.0;
  if (x >= 1.0) return 1.0;
  return x < 0.0 ? 0.5 * (1.0 + x) * (1.0 + x) : 1.0 - 0.5 * (1.0 - x) * (1.0 - x);
}

// Mean of exp(-h / scale) over a step along which h goes from h0 to h1 evenly but for a sag, a parabola of
// which two thirds of the greatest is the mean.
double meanExponential(double h0, double h1, double sagM, double scale) {
  const double x = (h1 - h0) / scale;
  const double mean = std::abs(x) < 1e-4 ? 1.0 - 0.5 * x : -std::expm1(-x) / x;
  const double sag = 2.0 / 3.0 * sagM / scale;
  return std::exp(-h0 / scale) * mean * (1.0 + sag * (1.0 + 0.6 * sag));
}

}  // namespace

Air::Air(const sky::AtmosphereUniforms& u)
    : u_(u), ground_(u.groundAltitudeM), top_(u.topAltitudeM - u.groundAltitudeM) {
  fineG_ = (u.aerosolG - static_cast<double>(sky::shared::kHazePeakWeight) * sky::shared::kHazePeakG) /
           (1.0 - static_cast<double>(sky::shared::kHazePeakWeight));
  const glm::vec3 sum = u.rayleighScattering + u.aerosolExtinction + u.ozoneAbsorption;
  empty_ = sum.x + sum.y + sum.z <= 0.0f;
  for (double h = 0.0; h <= kEntriesTopM + 2.0 * kEntryM; h += kEntryM)
    extinctions_.emplace_back(at(h).extinction);
}

Air::Medium Air::at(double heightM) const {
  const double h = heightM + ground_;
  const double aerosol = std::exp(-std::max(heightM, 0.0) / u_.aerosolScaleHeightM);
  const double ozone = std::max(1.0 - std::abs(h - u_.ozoneAltitudeM) / u_.ozoneHalfWidthM, 0.0);
  Medium m;
  m.rayleigh = glm::dvec3(u_.rayleighScattering) * std::exp(-h / u_.rayleighScaleHeightM);
  m.aerosol = glm::dvec3(u_.aerosolScattering) * aerosol;
  m.extinction =
      m.rayleigh + glm::dvec3(u_.aerosolExtinction) * aerosol + glm::dvec3(u_.ozoneAbsorption) * ozone;
  return m;
}

void Air::addStep(Columns& columns, double h0, double h1, double sagM, double dt) const {
  columns.rayleigh += dt * meanExponential(h0 + ground_, h1 + ground_, sagM, u_.rayleighScaleHeightM);
  columns.aerosol += dt * meanExponential(h0, h1, sagM, u_.aerosolScaleHeightM);
  const double x0 = (h0 + ground_ - u_.ozoneAltitudeM) / u_.ozoneHalfWidthM,
               x1 = (h1 + ground_ - u_.ozoneAltitudeM) / u_.ozoneHalfWidthM;
  if (std::max(x0, x1) <= -1.0 || std::min(x0, x1) >= 1.0) return;
  columns.ozone += dt * (std::abs(x1 - x0) < 1e-4 ? std::max(1.0 - std::abs(0.5 * (x0 + x1)), 0.0)
                                                  : (tentIntegral(x1) - tentIntegral(x0)) / (x1 - x0));
}

glm::dvec3 Air::opticalDepth(const Sphere& earth, const Ray& ray, double t) const {
  Columns columns;
  const int n = std::max(1, static_cast<int>(std::ceil(t / kStepM)));
  const double dt = t / n;
  double h0 = earth.height(ray.from);
  for (int i = 0; i < n && dt > 0.0; ++i) {
    const double h1 = earth.height(ray.at(dt * (i + 1)));
    // Chord against arc: (1 - mu^2) dt^2 / (8 r) lower in the middle.
    const double mu = (h1 - h0) / dt;
    const double sag = std::max(1.0 - mu * mu, 0.0) * dt * dt / (8.0 * earth.radiusM());
    addStep(columns, std::max(h0, 0.0), std::max(h1, 0.0), sag, dt);
    h0 = h1;
    if (h0 > top_ && mu > 0.0) break;
  }
  return glm::dvec3(u_.rayleighScattering) * columns.rayleigh +
         glm::dvec3(u_.aerosolExtinction) * columns.aerosol + glm::dvec3(u_.ozoneAbsorption) * columns.ozone;
}

glm::dvec3 Air::transmittance(const Sphere& earth, const Ray& ray, double t) const {
  const double h0 = std::max(earth.height(ray.from), 0.0);
  if (t > kShortM || h0 > kEntriesTopM - kShortM) return glm::exp(-opticalDepth(earth, ray, t));
  auto extinction = [&](double h) {
    const double x = h * (1.0 / kEntryM);
    const auto i = static_cast<std::size_t>(x);
    const glm::dvec3 a(extinctions_[i]), b(extinctions_[i + 1]);
    return a + (b - a) * (x - static_cast<double>(i));
  };
  glm::dvec3 tau;
  if (t < kLineM) {
    tau = t * extinction(std::max(earth.height(ray.at(0.5 * t)), 0.0));
  } else {
    // Two points of Gauss.
    constexpr double kFirst = 0.21132486540518712;
    const double h1 = std::max(earth.height(ray.at(t)), 0.0);
    tau = 0.5 * t * (extinction(h0 + kFirst * (h1 - h0)) + extinction(h1 + kFirst * (h0 - h1)));
  }
  if (std::max({tau.x, tau.y, tau.z}) > 0.05) return glm::exp(-tau);
  return 1.0 - tau * (1.0 - tau * (0.5 - tau * (1.0 / 6.0 - tau / 24.0)));  // the series of exp(-tau)
}

glm::dvec3 Air::opticalDepthToSpace(const Sphere& earth, const Ray& ray) const {
  double near = 0.0, far = 0.0;
  if (!earth.crossings(ray, top_, near, far) || far <= 0.0) return glm::dvec3(0.0);
  if (near <= 0.0) return opticalDepth(earth, ray, far);
  return opticalDepth(earth, {ray.at(near), ray.way}, far - near);
}

Air::Place Air::samplePlace(const Sphere& earth, const Ray& ray, double t, const glm::dvec3& weights,
                            Random& random) const {
  // Pieces of even extinction, finer near the lowest point, where the air is densest.
  std::array<double, kMostPieces + 1> edges;
  std::array<double, kMostPieces> extinction, mass;
  const int n = t < 2e3 ? 1 : t < 30e3 ? 8 : kMostPieces;
  const double low = std::clamp(-earth.cosine(ray.from, ray.way) * earth.radiusM(), 0.0, t);
  const double share = glm::dot(weights, glm::dvec3(1.0));
  double through = 1.0, total = 0.0;
  edges[0] = 0.0;
  // As many pieces on either side as the side is long.
  const int before = n == 1 ? 0 : static_cast<int>(std::lround(n * low / t));
  for (int i = 0; i < n; ++i) {
    double end = t;
    if (i < before) {
      const double x = 1.0 - static_cast<double>(i + 1) / before;
      end = low - low * x * x;
    } else if (n > before) {
      const double x = static_cast<double>(i + 1 - before) / (n - before);
      end = low + (t - low) * x * x;
    }
    if (i + 1 == n) end = t;
    const Medium m = at(earth.height(ray.at(0.5 * (edges[i] + end))));
    extinction[i] = std::max(glm::dot(m.extinction, weights) / share, 1e-30);
    const double step = extinction[i] * (end - edges[i]);
    mass[i] = through * -std::expm1(-step) *
              std::max(glm::dot(m.rayleigh + m.aerosol, weights) / share, 1e-30) / extinction[i];
    total += mass[i];
    through *= std::exp(-step);
    edges[i + 1] = end;
  }
  double u = unit(random) * total;
  int i = 0;
  while (i + 1 < n && u >= mass[i]) u -= mass[i++];
  const double width = edges[i + 1] - edges[i], opaque = -std::expm1(-extinction[i] * width);
  const double v = std::clamp(u / mass[i], 0.0, 1.0 - 0x1p-53);
  const double into = std::min(-std::log1p(-v * opaque) / extinction[i], width);
  const double density = mass[i] / total * extinction[i] * std::exp(-extinction[i] * into) / opaque;
  return {edges[i] + into, density};
}

double Air::phaseRayleigh(double c) const {
  return 3.0 / (16.0 * kPi) * (1.0 + c * c);
}

double Air::phaseAerosol(double c) const {
  constexpr double w = sky::shared::kHazePeakWeight;
  return (1.0 - w) * henyeyGreenstein(c, fineG_) + w * henyeyGreenstein(c, sky::shared::kHazePeakG);
}

double Air::sampleRayleigh(Random& random) const {
  // Inverse of (4 + 3 c + c^3) / 8.
  const double a = 4.0 * unit(random) - 2.0, b = std::cbrt(a + std::sqrt(a * a + 1.0));
  return std::clamp(b - 1.0 / b, -1.0, 1.0);
}

double Air::sampleAerosol(Random& random) const {
  const bool peak = unit(random) < static_cast<double>(sky::shared::kHazePeakWeight);
  return sampleHenyeyGreenstein(unit(random), peak ? static_cast<double>(sky::shared::kHazePeakG) : fineG_);
}

AirToLight::AirToLight(const Air& air, const Sphere& earth, const glm::dvec3& direction)
    : air_(&air), earth_(&earth), firstCosine_(direction.z - kCosineReach) {
  depths_.resize(static_cast<std::size_t>(kHeights) * kCosines);
  parallelFor(kHeights, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j)
      for (int i = 0; i < kCosines; ++i) {
        const double h = kTableTopM * static_cast<double>(j) / (kHeights - 1);
        const double c = std::clamp(firstCosine_ + 2.0 * kCosineReach * i / (kCosines - 1), -1.0, 1.0);
        depths_[j * kCosines + static_cast<std::size_t>(i)] = compute(h, c);
      }
  });
}

glm::dvec3 AirToLight::compute(double heightM, double cosine) const {
  const glm::dvec3 w(std::sqrt(std::max(0.0, 1.0 - cosine * cosine)), 0.0, cosine);
  return air_->opticalDepthToSpace(*earth_, {{0.0, 0.0, heightM}, w});
}

glm::dvec3 AirToLight::transmittance(const glm::dvec3& p, const glm::dvec3& way) const {
  const double h = std::max(earth_->height(p), 0.0), c = earth_->cosine(p, way);
  if (c < 0.0) {
    // Lower than the horizon: cos^2 > 1 - (R / r)^2.
    const double r = earth_->radiusM() / (earth_->radiusM() + h);
    if (c * c > 1.0 - r * r) return glm::dvec3(0.0);
  }
  const double x = (c - firstCosine_) / (2.0 * kCosineReach) * (kCosines - 1),
               y = h / kTableTopM * (kHeights - 1);
  // Ways that dip are computed: the table's neighbours may lie under the ground.
  if (x < 0.0 || x >= kCosines - 1 || y >= kHeights - 1 || c < 0.0 || std::abs(c) > 0.9999)
    return glm::exp(-compute(h, c));
  const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
  const double u = x - static_cast<double>(i), v = y - static_cast<double>(j);
  const glm::dvec3* d = &depths_[j * kCosines + i];
  return glm::exp(
      -((1.0 - v) * ((1.0 - u) * d[0] + u * d[1]) + v * ((1.0 - u) * d[kCosines] + u * d[kCosines + 1])));
}

}  // namespace welkin::reference
