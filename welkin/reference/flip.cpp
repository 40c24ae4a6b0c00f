// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/flip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "welkin/core/colour.h"
#include "welkin/core/parallel.h"
#include "welkin/core/units.h"

namespace welkin::reference {
namespace {

using Plane = Image<float>;

// Rec. 709 primaries with the white of the same.
const glm::dmat3 kXyzFromRgb =
    glm::transpose(glm::dmat3(10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0,
                              2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0,
                              1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0));
const glm::dmat3 kRgbFromXyz = glm::inverse(kXyzFromRgb);
const glm::dvec3 kWhite = kXyzFromRgb * glm::dvec3(1.0);

glm::dvec3 linearOf(const float* srgb) {
  glm::dvec3 rgb;
  for (int c = 0; c < 3; ++c) rgb[c] = linearOfSrgb(std::clamp(static_cast<double>(srgb[c]), 0.0, 1.0));
  return rgb;
}

// CIELAB's opponent axes without its cube roots, in which filters are linear.
glm::dvec3 opponentOf(const glm::dvec3& rgb) {
  const glm::dvec3 t = kXyzFromRgb * rgb / kWhite;
  return {116.0 * t.y - 16.0, 500.0 * (t.x - t.y), 200.0 * (t.y - t.z)};
}
glm::dvec3 linearOfOpponent(const glm::dvec3& o) {
  const double y = (o.x + 16.0) / 116.0;
  return kRgbFromXyz * (glm::dvec3(y + o.y / 500.0, y, y - o.z / 200.0) * kWhite);
}

// CIELAB, its chroma in proportion to lightness: colours of the dark look alike (R. W. G. Hunt 1952).
glm::dvec3 huntLab(const glm::dvec3& rgb) {
  constexpr double kDelta = 6.0 / 29.0;
  glm::dvec3 t = kXyzFromRgb * rgb / kWhite;
  for (int c = 0; c < 3; ++c)
    t[c] = t[c] > kDelta * kDelta * kDelta ? std::cbrt(t[c]) : t[c] / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
  const double lightness = 116.0 * t.y - 16.0;
  return {lightness, 0.01 * lightness * 500.0 * (t.x - t.y), 0.01 * lightness * 200.0 * (t.y - t.z)};
}
double colourDistance(const glm::dvec3& a, const glm::dvec3& b) {
  return std::abs(a.x - b.x) + glm::length(glm::dvec2(a.y - b.y, a.z - b.z));
}

// A filter that is the same along x as along y but for what it weighs: half of a row of weights, from the
// middle on, mirrored with this sign.
struct Taps {
  std::vector<double> weights;
  double mirrored = 1.0;

  double sum() const {
    double s = weights[0];
    for (std::size_t i = 1; i < weights.size(); ++i) s += (1.0 + mirrored) * weights[i];
    return s;
  }
};

// Beyond the border is the border. Along x, then along y.
Plane filtered(const Plane& in, const Taps& x, const Taps& y) {
  const auto pass = [](const Plane& from, const Taps& taps, bool rows) {
    Plane to(from.width, from.height, 1);
    const int last = (rows ? from.width : from.height) - 1;
    parallelFor(static_cast<std::size_t>(from.height), 8, [&](std::size_t begin, std::size_t end) {
      for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
        for (int u = 0; u < from.width; ++u) {
          const int at = rows ? u : v;
          const auto value = [&](int i) {
            const int clamped = std::clamp(at + i, 0, last);
            return static_cast<double>(rows ? from.at(clamped, v) : from.at(u, clamped));
          };
          double sum = taps.weights[0] * value(0);
          for (int i = 1; i < static_cast<int>(taps.weights.size()); ++i)
            sum += taps.weights[static_cast<std::size_t>(i)] * (value(i) + taps.mirrored * value(-i));
          to.at(u, v) = static_cast<float>(sum);
        }
    });
    return to;
  };
  return pass(pass(in, x, true), y, false);
}

// The eye's sensitivity to contrast along an opponent axis: a sum of Gaussians, a sqrt(pi / b)
// exp(-pi^2 x^2 / b) with x in degrees.
struct Gaussian {
  double a, b;
};
constexpr std::array<std::array<Gaussian, 2>, 3> kSensitivity = {
    {{{{1.0, 0.0047}, {0.0, 1e-5}}}, {{{1.0, 0.0053}, {0.0, 1e-5}}}, {{{34.1, 0.04}, {13.5, 0.025}}}}};

Plane seenAlong(const Plane& in, std::size_t axis, double pixelsPerDegree) {
  // All axes as far as the widest reaches.
  const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * kPi * kPi)) * pixelsPerDegree));
  Plane out(in.width, in.height, 1);
  double total = 0.0;
  for (const Gaussian& g : kSensitivity[axis]) {
    if (g.a == 0.0) continue;
    Taps taps;
    for (int i = 0; i <= radius; ++i) {
      const double x = i / pixelsPerDegree;
      taps.weights.push_back(std::exp(-kPi * kPi * x * x / g.b));
    }
    const double weight = g.a * std::sqrt(kPi / g.b);
    total += weight * taps.sum() * taps.sum();
    const Plane part = filtered(in, taps, taps);
    for (std::size_t i = 0; i < out.data.size(); ++i)
      out.data[i] += static_cast<float>(weight) * part.data[i];
  }
  for (float& v : out.data) v /= static_cast<float>(total);
  return out;
}

// Calls body(i) for the index of each pixel.
template <class Body>
void forPixels(std::size_t count, const Body& body) {
  parallelFor(count, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

// How much of an edge and of a point there is at each pixel of a picture of lightness in [0, 1].
struct Features {
  Plane edges, points;
};
Features featuresOf(const Plane& lightness, double pixelsPerDegree) {
  constexpr double kWidthDeg = 0.082;  // between the peaks of a detector
  const double sd = 0.5 * kWidthDeg * pixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3.0 * sd));
  Taps smooth, slope{{}, -1.0}, bend;
  for (int i = 0; i <= radius; ++i) {
    const double g = std::exp(-0.5 * i * i / (sd * sd));
    smooth.weights.push_back(g);
    slope.weights.push_back(-i * g);
    bend.weights.push_back((i * i / (sd * sd) - 1.0) * g);
  }
  // In the plane, what is positive sums to 1, what is negative to -1.
  const double across = smooth.sum();
  double oneSide = 0.0, positive = 0.0, negative = 0.0;
  for (int i = 0; i <= radius; ++i) {
    const auto k = static_cast<std::size_t>(i);
    oneSide -= slope.weights[k];
    (bend.weights[k] > 0.0 ? positive : negative) += (i == 0 ? 1.0 : 2.0) * bend.weights[k];
  }
  for (int i = 0; i <= radius; ++i) {
    const auto k = static_cast<std::size_t>(i);
    slope.weights[k] /= oneSide * across;
    bend.weights[k] /= (bend.weights[k] > 0.0 ? positive : -negative) * across;
  }
  const auto magnitude = [&](const Taps& taps) {
    Plane x = filtered(lightness, taps, smooth);
    const Plane y = filtered(lightness, smooth, taps);
    for (std::size_t i = 0; i < x.data.size(); ++i) x.data[i] = std::hypot(x.data[i], y.data[i]);
    return x;
  };
  return {magnitude(slope), magnitude(bend)};
}

// A picture as the eye has it: colours filtered by its sensitivity, and features.
struct Seen {
  std::vector<glm::dvec3> lab;
  Features features;
};
Seen seenOf(const Image<float>& srgb, double pixelsPerDegree) {
  const int w = srgb.width, h = srgb.height;
  const std::size_t count = static_cast<std::size_t>(w) * h;
  std::array<Plane, 3> opponent = {Plane(w, h, 1), Plane(w, h, 1), Plane(w, h, 1)};
  Plane lightness(w, h, 1);
  forPixels(count, [&](std::size_t i) {
    const glm::dvec3 o = opponentOf(linearOf(&srgb.data[3 * i]));
    for (int c = 0; c < 3; ++c) opponent[static_cast<std::size_t>(c)].data[i] = static_cast<float>(o[c]);
    lightness.data[i] = static_cast<float>((o.x + 16.0) / 116.0);
  });
  for (std::size_t c = 0; c < 3; ++c) opponent[c] = seenAlong(opponent[c], c, pixelsPerDegree);
  Seen seen{std::vector<glm::dvec3>(count), featuresOf(lightness, pixelsPerDegree)};
  forPixels(count, [&](std::size_t i) {
    const glm::dvec3 o(opponent[0].data[i], opponent[1].data[i], opponent[2].data[i]);
    seen.lab[i] = huntLab(glm::clamp(linearOfOpponent(o), 0.0, 1.0));
  });
  return seen;
}

constexpr double kColourExponent = 0.7, kFeatureExponent = 0.5;

// Differences of colour to [0, 1]: the smaller 40 % of what they can be take 95 % of it.
double ofColours(const glm::dvec3& a, const glm::dvec3& b) {
  constexpr double kShare = 0.4, kTo = 0.95;
  static const double most =
      std::pow(colourDistance(huntLab({0.0, 1.0, 0.0}), huntLab({0.0, 0.0, 1.0})), kColourExponent);
  const double d = std::pow(colourDistance(a, b), kColourExponent);
  const double knee = kShare * most;
  return d < knee ? kTo / knee * d : kTo + (d - knee) / (most - knee) * (1.0 - kTo);
}

}  // namespace

Image<float> flipOf(const Image<float>& a, const Image<float>& b, double pixelsPerDegree) {
  assert(a.width == b.width && a.height == b.height && a.channels == 3 && b.channels == 3);
  const Seen seenA = seenOf(a, pixelsPerDegree), seenB = seenOf(b, pixelsPerDegree);
  Image<float> flip(a.width, a.height, 1);
  forPixels(flip.data.size(), [&](std::size_t i) {
    const auto apart = [i](const Plane& p, const Plane& q) { return std::abs(p.data[i] - q.data[i]); };
    const double feature = std::max(apart(seenA.features.edges, seenB.features.edges),
                                    apart(seenA.features.points, seenB.features.points));
    const double ofFeatures = std::pow(feature / std::sqrt(2.0), kFeatureExponent);
    const double colours = ofColours(seenA.lab[i], seenB.lab[i]);
    flip.data[i] = static_cast<float>(std::min(std::pow(colours, 1.0 - ofFeatures), 1.0));
  });
  return flip;
}

}  // namespace welkin::reference
