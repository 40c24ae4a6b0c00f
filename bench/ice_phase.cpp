// SPDX-License-Identifier: Apache-2.0
// Writes welkin/optics/ice_table.h, how crystals of ice turn rays of light: ice_phase OUT [PRISTINE
// [MILLIONS]]
//
// Rays through hexagonal prisms in all positions alike, as A. Macke, J. Mueller and E. Raschke 1996, "Single
// scattering properties of atmospheric ice crystals": reflected and refracted with their polarisation by
// Fresnel's equations until little is left, over the visible wavelengths, without absorption. Half of what is
// scattered is by columns and half by plates. PRISTINE (0.37 where it is not given) of it is by crystals with
// smooth faces, which make halos; at those of the others each ray meets the face tilted at random, as there.
// L. Forster and B. Mayer 2022, "Ice crystal characterization in cirrus clouds III", found 37 % of smooth and
// 63 % of severely roughened crystals to agree best with 4,400 photographs of cirrus with a halo.
//
// Without diffraction, half of what crystals so large scatter, and without rays that leave as they came,
// through parallel faces; seen over the sun's disc. Colours are linear Rec. 709. Takes a minute or two, for
// MILLIONS of rays (100). Prints what the table does not say: the share
// of those rays, and with it the integrals before they are made 1, and mean cosines.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <iterator>
#include <vector>

#include "bench/phase_table.h"
#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/core/units.h"

namespace welkin::bench {
namespace {

using Amplitude = std::complex<double>;

constexpr double kFirstUm = 0.395, kLastUm = 0.705;
constexpr double kRoughness = 0.5;                           // sigma of the tilts' slopes: severely roughened
constexpr double kRouletteBelow = 0.02, kRouletteTo = 0.06;  // of a ray's light
constexpr int kBlocks = 128;                                 // of rays
constexpr double kStraightRad = 1e-6;
constexpr double kBackFromDeg = 177.0;  // see evenBehind()

// S. G. Warren and R. E. Brandt 2008, "Optical constants of ice from the ultraviolet to the microwave: A
// revised compilation", at 266 K: each 0.01 um from 0.39 um.
double indexOfIce(double wavelengthUm) {
  constexpr double kIndex[] = {1.3203, 1.3194, 1.3185, 1.3177, 1.3170, 1.3163, 1.3157, 1.3151, 1.3145,
                               1.3140, 1.3135, 1.3130, 1.3126, 1.3121, 1.3117, 1.3114, 1.3110, 1.3106,
                               1.3103, 1.3100, 1.3097, 1.3094, 1.3091, 1.3088, 1.3085, 1.3083, 1.3080,
                               1.3078, 1.3076, 1.3073, 1.3071, 1.3069, 1.3067};
  const double at = std::clamp((wavelengthUm - 0.39) / 0.01, 0.0, std::size(kIndex) - 1.001);
  const auto i = static_cast<std::size_t>(at);
  return kIndex[i] + (at - static_cast<double>(i)) * (kIndex[i + 1] - kIndex[i]);
}

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : random_(seed) {}
  double operator()() { return static_cast<double>(random_.next() >> 11) * 0x1p-53; }
  double between(double a, double b) { return a + (b - a) * (*this)(); }

 private:
  Random random_;
};

// A hexagonal prism with sides 1 long along its base.
struct Prism {
  static constexpr int kFaces = 8;
  double halfLength;
  std::array<glm::dvec3, kFaces> normals;  // outwards
  std::array<double, kFaces> distances, areas;

  explicit Prism(double lengthOverWidth) : halfLength(lengthOverWidth) {  // which is 2
    for (int i = 0; i < 6; ++i) {
      const double a = kPi / 3.0 * i;
      normals[i] = {std::cos(a), std::sin(a), 0.0};
      distances[i] = 0.5 * std::sqrt(3.0);
      areas[i] = 2.0 * halfLength;
    }
    for (int i = 6; i < 8; ++i) {
      normals[i] = {0.0, 0.0, i == 6 ? 1.0 : -1.0};
      distances[i] = halfLength;
      areas[i] = 1.5 * std::sqrt(3.0);
    }
  }
  double crossSection(const glm::dvec3& way) const {
    double sum = 0.0;
    for (int i = 0; i < kFaces; ++i) sum += areas[i] * std::max(-glm::dot(way, normals[i]), 0.0);
    return sum;
  }
  double meanCrossSection() const {  // A. Cauchy: a quarter of the surface
    double sum = 0.0;
    for (const double area : areas) sum += 0.25 * area;
    return sum;
  }
  int faceMetBy(const glm::dvec3& way, Chance& chance) const {
    double left = chance() * crossSection(way);
    for (int i = 0; i < kFaces; ++i) {
      left -= areas[i] * std::max(-glm::dot(way, normals[i]), 0.0);
      if (left < 0.0) return i;
    }
    return kFaces - 1;
  }
  glm::dvec3 placeOn(int face, Chance& chance) const {
    const glm::dvec3 middle = distances[face] * normals[face];
    if (face < 6)
      return middle + chance.between(-halfLength, halfLength) * glm::dvec3(0.0, 0.0, 1.0) +
             chance.between(-0.5, 0.5) * glm::dvec3(-normals[face].y, normals[face].x, 0.0);
    for (;;) {
      const glm::dvec3 p(chance.between(-1.0, 1.0), chance.between(-1.0, 1.0), 0.0);
      bool inside = true;
      for (int i = 0; i < 6; ++i) inside = inside && glm::dot(p, normals[i]) < distances[i];
      if (inside) return middle + p;
    }
  }
  // The face by which a ray from inside comes to the surface, and that place.
  int leave(glm::dvec3& at, const glm::dvec3& way, int from) const {
    double least = 1e9;
    int face = from;
    for (int i = 0; i < kFaces; ++i) {
      const double c = glm::dot(way, normals[i]);
      if (i == from || c <= 0.0) continue;
      const double t = (distances[i] - glm::dot(at, normals[i])) / c;
      if (t < least) {
        least = t;
        face = i;
      }
    }
    at += std::max(least, 0.0) * way;
    return face;
  }
};

// The electric field of light, along two axes across the ray's way.
struct Wave {
  std::array<std::array<Amplitude, 2>, 2> field;  // [which of two polarisations it came with][axis]
  glm::dvec3 axis;                                // the first; the other is cross(axis, way)

  double light() const {
    double sum = 0.0;
    for (const auto& f : field) sum += 0.5 * (std::norm(f[0]) + std::norm(f[1]));
    return sum;
  }
  void scale(double by) {
    for (auto& f : field)
      for (Amplitude& a : f) a *= by;
  }
};

struct Ray {
  glm::dvec3 way;
  Wave wave;
};

// A ray at a surface; index: before it over behind it; normal: against the ray.
struct Split {
  Ray reflected, refracted;
  bool total = false;  // nothing is refracted
};
Split splitAt(const Ray& ray, const glm::dvec3& normal, double index) {
  const double c = -glm::dot(ray.way, normal), sine2 = index * index * (1.0 - c * c);
  Split split;
  split.total = sine2 >= 1.0;
  split.reflected.way = glm::normalize(ray.way + 2.0 * c * normal);
  const double real = std::sqrt(std::abs(1.0 - sine2));
  const Amplitude t = split.total ? Amplitude(0.0, real) : Amplitude(real, 0.0);
  glm::dvec3 across = glm::cross(ray.way, normal);
  across = glm::length(across) > 1e-9 ? glm::normalize(across) : ray.wave.axis;
  // Into axes across and along the plane of incidence.
  const double x = glm::dot(across, ray.wave.axis), y = glm::dot(across, glm::cross(ray.wave.axis, ray.way));
  const Amplitude rs = (index * c - t) / (index * c + t), rp = (c - index * t) / (c + index * t);
  const Amplitude ts = 2.0 * index * c / (index * c + t), tp = 2.0 * index * c / (c + index * t);
  const double flux = split.total ? 0.0 : std::sqrt(real / (index * c));
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& f = ray.wave.field[k];
    const Amplitude s = x * f[0] + y * f[1], p = x * f[1] - y * f[0];
    split.reflected.wave.field[k] = {rs * s, rp * p};
    split.refracted.wave.field[k] = {flux * ts * s, flux * tp * p};
  }
  split.reflected.wave.axis = split.refracted.wave.axis = across;
  if (!split.total) split.refracted.way = glm::normalize(index * ray.way + (index * c - real) * normal);
  return split;
}

// The same at a face that may be rough: tilted by slopes of C. Cox and W. Munk 1954's distribution, so that
// rays leave on the sides of it that they should.
Split splitAtFace(const Ray& ray, const glm::dvec3& normal, double index, double roughness, Chance& chance) {
  constexpr int kTries = 30;
  if (roughness > 0.0) {
    const glm::dvec3 a = glm::normalize(
        glm::cross(normal, std::abs(normal.z) < 0.5 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0)));
    const glm::dvec3 b = glm::cross(normal, a);
    for (int k = 0; k < kTries; ++k) {
      const double slope = roughness * std::sqrt(-std::log(1.0 - chance())), turn = 2.0 * kPi * chance();
      const glm::dvec3 tilted = glm::normalize(normal + slope * (std::cos(turn) * a + std::sin(turn) * b));
      if (glm::dot(ray.way, tilted) >= -1e-6) continue;
      const Split split = splitAt(ray, tilted, index);
      if (glm::dot(split.reflected.way, normal) <= 0.0) continue;
      if (!split.total && glm::dot(split.refracted.way, normal) >= 0.0) continue;
      return split;
    }
  }
  return splitAt(ray, normal, index);
}

struct Sums {
  std::vector<glm::dvec3> turned = std::vector<glm::dvec3>(kFine, glm::dvec3(0.0));  // by angles
  glm::dvec3 straight{0.0}, all{0.0};

  void add(const Sums& other) {
    for (std::size_t i = 0; i < kFine; ++i) turned[i] += other.turned[i];
    straight += other.straight;
    all += other.all;
  }
};

void trace(const Prism& prism, double roughness, Chance& chance, Sums& sums) {
  const double wavelengthUm = chance.between(kFirstUm, kLastUm), index = indexOfIce(wavelengthUm);
  const double z = chance.between(-1.0, 1.0), turn = 2.0 * kPi * chance(), out = std::sqrt(1.0 - z * z);
  const glm::dvec3 came(out * std::cos(turn), out * std::sin(turn), z);
  const glm::dvec3 colour = colourOf(wavelengthUm) * prism.crossSection(came) / prism.meanCrossSection();
  sums.all += colour;
  const auto leaves = [&](const glm::dvec3& way, double light) {
    const double angle = std::atan2(glm::length(glm::cross(came, way)), glm::dot(came, way));
    if (angle < kStraightRad)
      sums.straight += light * colour;
    else
      sums.turned[static_cast<std::size_t>(std::lround(degrees(angle) / kFineDeg))] += light * colour;
  };
  int face = prism.faceMetBy(came, chance);
  glm::dvec3 at = prism.placeOn(face, chance);
  Ray ray{came, {}};
  ray.wave.axis = glm::normalize(
      glm::cross(came, std::abs(came.z) < 0.5 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0)));
  ray.wave.field = {{{1.0, 0.0}, {0.0, 1.0}}};
  const Split first = splitAtFace(ray, prism.normals[face], 1.0 / index, roughness, chance);
  leaves(first.reflected.way, first.reflected.wave.light());
  ray = first.refracted;
  for (;;) {
    const double left = ray.wave.light();
    if (left < kRouletteBelow) {
      if (chance() * kRouletteTo >= left) return;
      ray.wave.scale(std::sqrt(kRouletteTo / left));
    }
    face = prism.leave(at, ray.way, face);
    const Split split = splitAtFace(ray, -prism.normals[face], index, roughness, chance);
    if (!split.total) leaves(split.refracted.way, split.refracted.wave.light());
    ray = split.reflected;
  }
}

// Half columns and half plates, of lengths over widths for which each logarithm is as likely.
Sums sumsOf(double roughness, std::uint64_t rays) {
  constexpr double kColumns[] = {1.0, 4.0}, kPlates[] = {0.15, 0.6};
  std::vector<Sums> parts(kBlocks);
  parallelFor(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      Chance chance(hashOf(std::uint64_t{0x696365}, b, roughness > 0.0 ? 1u : 0u));
      for (std::uint64_t i = 0; i < rays / kBlocks; ++i) {
        const auto& range = i % 2 == 0 ? kColumns : kPlates;
        const Prism prism(range[0] * std::pow(range[1] / range[0], chance()));
        trace(prism, roughness, chance, parts[b]);
      }
    }
  });
  Sums all;
  for (const Sums& part : parts) all.add(part);
  return all;
}

// Corners of right angles send rays back to where they came from, exactly. Faces of some tens of micrometres
// spread that, by their diffraction, over a degree or two.
void evenBehind(std::vector<glm::dvec3>& phase) {
  const auto first = static_cast<std::size_t>(kBackFromDeg / kFineDeg);
  glm::dvec3 sum(0.0);
  double whole = 0.0;
  for (std::size_t i = first; i < kFine; ++i) {
    const double wide = std::max(std::sin(radians(kFineDeg * static_cast<double>(i))),
                                 0.125 * radians(kFineDeg));  // of the half step at its end
    sum += wide * phase[i];
    whole += wide;
  }
  std::fill(phase.begin() + static_cast<std::ptrdiff_t>(first), phase.end(), sum / whole);
}

}  // namespace
}  // namespace welkin::bench

int main(int argc, char** argv) {
  using namespace welkin;
  using namespace welkin::bench;
  if (argc < 2 || argc > 4) {
    fmt::print(stderr, "usage: ice_phase OUT [PRISTINE [MILLIONS]]\n");
    return 2;
  }
  try {
    const double pristine = argc > 2 ? std::atof(argv[2]) : 0.37;
    const double millions = argc > 3 ? std::atof(argv[3]) : 100.0;
    const auto rays = static_cast<std::uint64_t>(5e5 * millions);
    std::vector<glm::dvec3> phase(kFine, glm::dvec3(0.0));
    glm::dvec3 straight(0.0);
    for (const double roughness : {0.0, kRoughness}) {
      const Sums sums = sumsOf(roughness, rays);
      const double share = roughness > 0.0 ? 1.0 - pristine : pristine;
      straight += share * sums.straight / sums.all;
      for (std::size_t i = 0; i < kFine; ++i) {
        // Over the solid angle of what was rounded to this angle.
        const double angle = radians(kFineDeg * static_cast<double>(i)), half = 0.5 * radians(kFineDeg);
        const double wide = std::cos(std::max(angle - half, 0.0)) - std::cos(std::min(angle + half, kPi));
        phase[i] += share * sums.turned[i] / sums.all / (2.0 * kPi * wide);
      }
    }
    evenBehind(phase);
    fmt::print("of green light {:.4f} goes straight on\n", straight.y);
    writePhaseTable(
        argv[1], "Ice",
        fmt::format("Written by bench/ice_phase.cpp, which says what it is; {:.0f} % of smooth crystals.",
                    100.0 * pristine),
        rowsOf(phase,
               {{0.0, 1.0}, {12.0, 0.5}, {20.0, 0.1}, {26.0, 0.5}, {43.0, 0.25}, {50.0, 2.0}, {170.0, 1.0}}));
  } catch (const std::exception& e) {
    fmt::print(stderr, "ice_phase: {}\n", e.what());
    return 1;
  }
  return 0;
}
