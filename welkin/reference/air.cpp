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

constexpr double kStepM = 40e3;  // longest; a chord of it sags by 31 m
constexpr int kMostPieces = 24;
constexpr double kNoHaze = 18.0;  // scale heights up

// Of the table of extinctions: between two entries an exponential of 1200 m is a line within 1.4e-4. Along so
// little of a way it is one as well.
constexpr double kShortM = 500.0, kEntryM = 40.0, kEntriesTopM = 25e3, kLineM = 60.0;
constexpr double kPlaceM = 200.0;  // of the table by which places are drawn

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

// 1 - exp(-x), x >= 0; a series where the difference would lose digits.
double shareLost(double x) {
  return x < 1e-3 ? x * (1.0 - x * (0.5 - x / 6.0)) : 1.0 - std::exp(-x);
}

// Mean of exp(-h / scale) over a step along which h / scale rises by x evenly but for a sag, a parabola; from
// the exponentials at its ends.
double meanExponential(double e0, double e1, double x, double sag) {
  if (e0 + e1 <= 0.0) return 0.0;
  // What of the greatest sag counts: two thirds in the mean, less where most of the air is near an end.
  double mean = 0.0, counts = 0.0;
  if (std::abs(x) < 0.1) {
    mean = e0 * (1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x / 120.0))));
    counts = 2.0 / 3.0 - x * x / 90.0;
  } else {
    mean = (e0 - e1) / x;
    counts = 4.0 / x * ((e0 + e1) / (e0 - e1) - 2.0 / x);
  }
  const double s = counts * sag;
  return mean * (1.0 + s * (1.0 + 0.6 * s));
}

}  // namespace

Air::Air(const sky::AtmosphereUniforms& u)
    : u_(u), ground_(u.groundAltitudeM), top_(u.topAltitudeM - u.groundAltitudeM) {
  fineG_ = (u.aerosolG - static_cast<double>(sky::shared::kHazePeakWeight) * sky::shared::kHazePeakG) /
           (1.0 - static_cast<double>(sky::shared::kHazePeakWeight));
  const glm::vec3 sum = u.rayleighScattering + u.aerosolExtinction + u.ozoneAbsorption;
  empty_ = sum.x + sum.y + sum.z <= 0.0f;
  for (double h = 0.0; h <= kEntriesTopM + 2.0 * kEntryM; h += kEntryM) {
    const glm::dvec3 here = at(h).extinction, more = at(h + kEntryM).extinction - here;
    ExtinctionEntry& e = extinctions_.emplace_back();
    for (int c = 0; c < 3; ++c) {
      e.at[static_cast<std::size_t>(c)] = static_cast<float>(here[c]);
      e.more[static_cast<std::size_t>(c)] = static_cast<float>(more[c]);
    }
  }
  for (double h = 0.5 * kPlaceM; h <= top_ + 2.0 * kPlaceM; h += kPlaceM) {
    const Medium m = at(h);
    places_.push_back({glm::vec3(m.extinction), glm::vec3(m.rayleigh + m.aerosol)});
  }
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

double Air::ozoneOver(double h0, double h1) const {
  const double x0 = (h0 + ground_ - u_.ozoneAltitudeM) / u_.ozoneHalfWidthM,
               x1 = (h1 + ground_ - u_.ozoneAltitudeM) / u_.ozoneHalfWidthM;
  if (std::max(x0, x1) <= -1.0 || std::min(x0, x1) >= 1.0) return 0.0;
  return std::abs(x1 - x0) < 1e-4 ? std::max(1.0 - std::abs(0.5 * (x0 + x1)), 0.0)
                                  : (tentIntegral(x1) - tentIntegral(x0)) / (x1 - x0);
}

glm::dvec3 Air::opticalDepth(const Sphere& earth, const Ray& ray, double t) const {
  // Metres of sea-level air, of ground-level aerosol, of the ozone layer's peak.
  double rayleigh = 0.0, aerosol = 0.0, ozone = 0.0;
  const double perRayleigh = 1.0 / u_.rayleighScaleHeightM, perAerosol = 1.0 / u_.aerosolScaleHeightM;
  auto ofAerosol = [&](double h) { return h * perAerosol < kNoHaze ? std::exp(-h * perAerosol) : 0.0; };
  const int n = std::max(1, static_cast<int>(std::ceil(t / kStepM)));
  const double dt = t / n;
  double h0 = std::max(earth.height(ray.from), 0.0), r0 = std::exp(-(h0 + ground_) * perRayleigh),
         a0 = ofAerosol(h0);
  for (int i = 0; i < n && dt > 0.0; ++i) {
    const double h1 = std::max(earth.height(ray.at(dt * (i + 1))), 0.0), rise = h1 - h0;
    // Chord against arc: (1 - mu^2) dt^2 / (8 r) lower in the middle.
    const double mu = rise / dt, sag = std::max(1.0 - mu * mu, 0.0) * dt * dt / (8.0 * earth.radiusM());
    const double r1 = std::exp(-(h1 + ground_) * perRayleigh), a1 = ofAerosol(h1);
    rayleigh += dt * meanExponential(r0, r1, rise * perRayleigh, sag * perRayleigh);
    aerosol += dt * meanExponential(a0, a1, rise * perAerosol, sag * perAerosol);
    ozone += dt * ozoneOver(h0 - 2.0 / 3.0 * sag, h1 - 2.0 / 3.0 * sag);
    h0 = h1, r0 = r1, a0 = a1;
    if (h0 > top_ && mu > 0.0) break;
  }
  return glm::dvec3(u_.rayleighScattering) * rayleigh + glm::dvec3(u_.aerosolExtinction) * aerosol +
         glm::dvec3(u_.ozoneAbsorption) * ozone;
}

glm::dvec3 Air::transmittance(const Sphere& earth, const Ray& ray, double t) const {
  if (t > kShortM) return glm::exp(-opticalDepth(earth, ray, t));
  constexpr double kTop = kEntriesTopM / kEntryM;
  auto entryAt = [&](double along) { return std::max(earth.height(ray.at(along)), 0.0) * (1.0 / kEntryM); };
  auto add = [&](double x, float weight, Four& tau) {
    const auto i = static_cast<std::size_t>(x);
    const auto f = static_cast<float>(x - static_cast<double>(i));
    const Four &a = extinctions_[i].at, &more = extinctions_[i].more;
    for (std::size_t c = 0; c < 4; ++c) tau[c] += weight * (a[c] + f * more[c]);
  };
  Four tau{};
  const auto length = static_cast<float>(t);
  if (t < kLineM) {
    const double x = entryAt(0.5 * t);
    if (x > kTop) return glm::exp(-opticalDepth(earth, ray, t));
    add(x, length, tau);
  } else {
    // Two points of Gauss.
    constexpr double kFirst = 0.21132486540518712;
    const double x0 = entryAt(0.0), x1 = entryAt(t);
    if (std::max(x0, x1) > kTop) return glm::exp(-opticalDepth(earth, ray, t));
    add(x0 + kFirst * (x1 - x0), 0.5f * length, tau);
    add(x1 + kFirst * (x0 - x1), 0.5f * length, tau);
  }
  if (std::max({tau[0], tau[1], tau[2]}) > 0.05f)
    return {std::exp(-tau[0]), std::exp(-tau[1]), std::exp(-tau[2])};
  Four lost;  // the series of 1 - exp(-tau)
  for (std::size_t c = 0; c < 4; ++c)
    lost[c] = tau[c] * (1.0f - tau[c] * (0.5f - tau[c] * (1.0f / 6.0f - tau[c] * (1.0f / 24.0f))));
  return 1.0 - glm::dvec3(lost[0], lost[1], lost[2]);
}

glm::dvec3 Air::opticalDepthToSpace(const Sphere& earth, const Ray& ray) const {
  double near = 0.0, far = 0.0;
  if (!earth.crossings(ray, top_, near, far) || far <= 0.0) return glm::dvec3(0.0);
  if (near <= 0.0) return opticalDepth(earth, ray, far);
  return opticalDepth(earth, {ray.at(near), ray.way}, far - near);
}

Air::Place Air::samplePlace(const Sphere& earth, const Ray& ray, double t, const glm::dvec3& weights,
                            Random& random) const {
  // Pieces of even extinction, finer near the lowest point, where the air is densest. What the table and the
  // series leave out is left out of the density as well.
  std::array<double, kMostPieces + 1> edges;
  std::array<double, kMostPieces> extinction, opaque, mass;
  const int n = t < 2e3 ? 1 : t < 30e3 ? 8 : kMostPieces;
  const double low = std::clamp(-earth.cosine(ray.from, ray.way) * earth.radiusM(), 0.0, t);
  const glm::dvec3 chances = weights / (weights.x + weights.y + weights.z);
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
    const double h = std::max(earth.height(ray.at(0.5 * (edges[i] + end))), 0.0);
    const auto entry = static_cast<std::size_t>(h * (1.0 / kPlaceM));
    const PlaceEntry& m = places_[std::min(entry, places_.size() - 1)];
    extinction[i] = std::max(glm::dot(glm::dvec3(m.extinction), chances), 1e-30);
    opaque[i] = shareLost(extinction[i] * (end - edges[i]));
    mass[i] =
        through * opaque[i] * std::max(glm::dot(glm::dvec3(m.scattering), chances), 1e-30) / extinction[i];
    total += mass[i];
    through *= 1.0 - opaque[i];
    edges[i + 1] = end;
  }
  double u = unit(random) * total;
  int i = 0;
  while (i + 1 < n && u >= mass[i]) u -= mass[i++];
  const double width = edges[i + 1] - edges[i];
  const double v = std::clamp(u / mass[i], 0.0, 1.0 - 0x1p-53);
  const double into = std::min(-std::log1p(-v * opaque[i]) / extinction[i], width);
  const double density = mass[i] / total * extinction[i] * std::exp(-extinction[i] * into) / opaque[i];
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
