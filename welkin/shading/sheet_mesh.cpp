// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/sheet_mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "welkin/core/units.h"

namespace welkin::shading {
namespace {

constexpr int kSegments = 48;  // around the eye

struct Ring {
  double radiusM, zM;
  float alpha;
};

// Rings about the zenith, the first of radius 0: a fan, then strips.
SheetMesh ringsMesh(const std::vector<Ring>& rings, int segments) {
  SheetMesh mesh;
  for (const Ring& ring : rings)
    for (int s = 0; s < segments; ++s) {
      const double a = 2.0 * kPi * s / segments;
      mesh.vertices.insert(mesh.vertices.end(), {static_cast<float>(ring.radiusM * std::cos(a)),
                                                 static_cast<float>(ring.radiusM * std::sin(a)),
                                                 static_cast<float>(ring.zM), ring.alpha});
    }
  const auto index = [&](std::size_t ring, int s) {
    return static_cast<std::uint32_t>(ring * static_cast<std::size_t>(segments) +
                                      static_cast<std::size_t>(s % segments));
  };
  for (std::size_t r = 0; r + 1 < rings.size(); ++r)
    for (int s = 0; s < segments; ++s) {
      const std::uint32_t in0 = index(r, s), in1 = index(r, s + 1), out0 = index(r + 1, s),
                          out1 = index(r + 1, s + 1);
      // Seen from below east and west change sides: clockwise in x and y.
      mesh.indices.insert(mesh.indices.end(), {out0, in0, out1});
      if (r > 0) mesh.indices.insert(mesh.indices.end(), {out1, in0, in1});
    }
  return mesh;
}

}  // namespace

SheetMesh planeMesh(double heightM) {
  constexpr double kReach = 20.0;  // half-sides in heights: it ends 3 degrees above the horizon
  constexpr int kRings = 12;       // of squares about the middle
  SheetMesh mesh;
  const int n = 2 * kRings + 1;
  // Lines lie closer in the middle, which is nearest to the eye.
  const auto line = [&](int i) {
    const double x = static_cast<double>(i - kRings) / kRings;
    return kReach * heightM * x * std::abs(x);
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double out = std::max(std::abs(line(i)), std::abs(line(j))) / (kReach * heightM);
      mesh.vertices.insert(mesh.vertices.end(), {static_cast<float>(line(i)), static_cast<float>(line(j)),
                                                 static_cast<float>(heightM),
                                                 static_cast<float>(std::min(1.5 * (1.0 - out), 1.0))});
    }
  for (int j = 0; j + 1 < n; ++j)
    for (int i = 0; i + 1 < n; ++i) {
      const auto a = static_cast<std::uint32_t>(j * n + i), b = a + 1, c = a + static_cast<std::uint32_t>(n),
                 d = c + 1;
      mesh.indices.insert(mesh.indices.end(), {a, c, b, b, c, d});
    }
  return mesh;
}

SheetMesh skyPlaneMesh(double heightM, double earthRadiusM) {
  constexpr int kRings = 32;
  // By elevation from the ground, since that is what is seen: to half a degree below the horizon.
  const double lowest = radians(-0.5);
  std::vector<Ring> rings;
  for (int r = 0; r <= kRings; ++r) {
    const double x = 1.0 - static_cast<double>(r) / kRings;
    const double elevation = lowest + (0.5 * kPi - lowest) * x * x;
    // Distance along the ray to the sphere of the sheet, from an eye on the ground.
    const double b = earthRadiusM * std::sin(elevation);
    const double t = std::sqrt(b * b + heightM * (2.0 * earthRadiusM + heightM)) - b;
    rings.push_back({t * std::cos(elevation), t * std::sin(elevation), r == kRings ? 0.0f : 1.0f});
  }
  return ringsMesh(rings, kSegments);
}

SheetMesh domeMesh(double heightM, double radiusM, int segments) {
  constexpr int kRings = 20;
  std::vector<Ring> rings;
  for (int r = 0; r <= kRings; ++r) {
    const double x = 1.0 - static_cast<double>(r) / kRings;
    const double elevation = 0.5 * kPi * x * x;
    constexpr float kFading[] = {0.0f, 0.3f, 0.7f};
    rings.push_back({radiusM * std::cos(elevation), heightM * std::sin(elevation),
                     kRings - r < 3 ? kFading[kRings - r] : 1.0f});
  }
  return ringsMesh(rings, segments);
}

SheetMesh meshOf(const scene::Sheet& sheet, double earthRadiusM) {
  switch (sheet.surface) {
    case scene::SheetSurface::kPlane:
      return planeMesh(sheet.heightM);
    case scene::SheetSurface::kSkyPlane:
      return skyPlaneMesh(sheet.heightM, earthRadiusM);
    case scene::SheetSurface::kDome:
      break;
  }
  return domeMesh(sheet.heightM, 10.0 * sheet.heightM, kSegments);
}

}  // namespace welkin::shading
