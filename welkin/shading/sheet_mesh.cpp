// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/sheet_mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "welkin/core/units.h"

namespace welkin::shading {
namespace {

constexpr int kSegments = 48;  // around the eye

constexpr double kPlaneReach = 20.0;  // half-sides in heights: it ends 3 degrees above the horizon
constexpr int kPlaneRings = 12;       // of squares about the middle
constexpr int kSkyRings = 32;
constexpr double kSkyLowestDeg = -0.5;  // below the horizon of an eye on the ground
constexpr double kDomeReach = 10.0;     // radius in heights

// Where a line of the plane lies, of its half-side; they are closer in the middle, which is nearest to the
// eye.
double planeLine(int i) {
  const double x = static_cast<double>(i) / kPlaneRings;
  return x * std::abs(x);
}

// A ring of the sky plane, by elevation from the ground, since that is what is seen: distance along the ray
// to the sphere of the sheet, from an eye on the ground.
struct RingAt {
  double distanceM, elevation;
};
RingAt skyRing(int ring, double heightM, double earthRadiusM) {
  const double lowest = radians(kSkyLowestDeg);
  const double x = 1.0 - static_cast<double>(ring) / kSkyRings;
  const double elevation = lowest + (0.5 * kPi - lowest) * x * x;
  const double b = earthRadiusM * std::sin(elevation);
  return {std::sqrt(b * b + heightM * (2.0 * earthRadiusM + heightM)) - b, elevation};
}

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
  SheetMesh mesh;
  const int n = 2 * kPlaneRings + 1;
  const auto line = [&](int i) { return kPlaneReach * heightM * planeLine(i - kPlaneRings); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double out = std::max(std::abs(line(i)), std::abs(line(j))) / (kPlaneReach * heightM);
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
  std::vector<Ring> rings;
  for (int r = 0; r <= kSkyRings; ++r) {
    const RingAt at = skyRing(r, heightM, earthRadiusM);
    rings.push_back({at.distanceM * std::cos(at.elevation), at.distanceM * std::sin(at.elevation),
                     r == kSkyRings ? 0.0f : 1.0f});
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

SheetMesh hemisphereMesh(double radiusM) {
  constexpr int kRings = 9;
  std::vector<Ring> rings;
  for (int r = 0; r <= kRings; ++r) {
    const double zenith = 0.5 * kPi * r / kRings;
    rings.push_back({radiusM * std::sin(zenith), r == kRings ? 0.0 : radiusM * std::cos(zenith),
                     r == kRings ? 0.0f : 1.0f});
  }
  return ringsMesh(rings, 4 * kRings);
}

SheetMesh meshOf(const scene::Sheet& sheet, double earthRadiusM) {
  switch (sheet.surface) {
    case scene::SheetSurface::kPlane:
      return planeMesh(sheet.heightM);
    case scene::SheetSurface::kSkyPlane:
      return skyPlaneMesh(sheet.heightM, earthRadiusM);
    case scene::SheetSurface::kHemisphere:
      return hemisphereMesh(sheet.heightM);
    case scene::SheetSurface::kDome:
      break;
  }
  return domeMesh(sheet.heightM, kDomeReach * sheet.heightM, kSegments);
}

SheetShape shapeOf(const scene::Sheet& sheet, double earthRadiusM, double eyeM) {
  constexpr float kFar = 1e9f;
  const double h = sheet.heightM;
  const auto height = static_cast<float>(h);
  switch (sheet.surface) {
    case scene::SheetSurface::kPlane:
      return {{1.0f, 1e12f, height, static_cast<float>(kPlaneReach * h)},
              static_cast<float>(kPlaneReach * h / 3.0)};
    case scene::SheetSurface::kSkyPlane: {
      const auto radius = [&](int ring) {
        const RingAt at = skyRing(ring, h, earthRadiusM);
        return at.distanceM * std::cos(at.elevation);
      };
      double inner = radius(kSkyRings - 1), outer = radius(kSkyRings);
      if (eyeM > h) {
        // Past the horizon to the sheet behind it.
        inner = std::max(inner, std::sqrt(2.0 * earthRadiusM * eyeM) + std::sqrt(2.0 * earthRadiusM * h));
        outer = std::max(outer, 1.02 * inner);
      }
      return {{1.0f, static_cast<float>(earthRadiusM), height, static_cast<float>(outer)},
              static_cast<float>(inner)};
    }
    case scene::SheetSurface::kHemisphere:
      return {{1.0f, 0.0f, height, kFar}, kFar};
    case scene::SheetSurface::kDome:
      break;
  }
  const auto stretch = static_cast<float>(kDomeReach);
  return {{stretch, 0.0f, stretch * height, kFar}, kFar};
}

}  // namespace welkin::shading
