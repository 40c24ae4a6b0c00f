// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/picture_error.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "welkin/core/colour.h"
#include "welkin/core/error.h"

namespace welkin::reference {
namespace {

std::vector<float> luminances(const Image<float>& picture) {
  assert(picture.channels == 1 || picture.channels == 3);
  if (picture.channels == 1) return picture.data;
  std::vector<float> out(picture.data.size() / 3);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = luminanceOf(&picture.data[3 * i]);
  return out;
}

struct Luminances {
  std::vector<float> picture, truth;
  double least;  // that is divided by

  Luminances(const Image<float>& a, const Image<float>& b) : picture(luminances(a)), truth(luminances(b)) {
    assert(a.width == b.width && a.height == b.height);
    std::vector<float> sorted = truth;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    if (!sorted.empty()) std::nth_element(sorted.begin(), middle, sorted.end());
    least = sorted.empty() ? 0.0 : 0.01 * static_cast<double>(*middle);
    if (least > 0.0) return;
    // Black for the most part: a hundredth of the mean.
    double sum = 0.0;
    for (const float t : truth) sum += static_cast<double>(t);
    least = sum > 0.0 ? 0.01 * sum / static_cast<double>(truth.size()) : 0.0;
    if (!(least > 0.0)) throw ParameterError("the truth is black: no error is relative to it");
  }
  double relative(std::size_t i) const {
    return (static_cast<double>(picture[i]) - static_cast<double>(truth[i])) /
           std::max(static_cast<double>(truth[i]), least);
  }
};

// Between colours that are evenly spaced over [0, 1].
glm::vec3 between(std::span<const glm::vec3> colours, float x) {
  const float at = std::clamp(x, 0.0f, 1.0f) * static_cast<float>(colours.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), colours.size() - 2);
  return glm::mix(colours[i], colours[i + 1], at - static_cast<float>(i));
}
Image<float> coloured(const Image<float>& values, std::span<const glm::vec3> colours, float low, float high) {
  Image<float> out(values.width, values.height, 3);
  for (std::size_t i = 0; i < values.data.size(); ++i) {
    const glm::vec3 c = between(colours, (values.data[i] - low) / (high - low));
    for (int k = 0; k < 3; ++k) out.data[3 * i + static_cast<std::size_t>(k)] = c[k];
  }
  return out;
}

}  // namespace

PictureError errorOf(const Image<float>& picture, const Image<float>& truth, std::span<const float> weights) {
  const Luminances l(picture, truth);
  assert(weights.empty() || weights.size() == l.truth.size());
  PictureError e;
  double total = 0.0;
  for (std::size_t i = 0; i < l.truth.size(); ++i) {
    const double w = weights.empty() ? 1.0 : static_cast<double>(weights[i]);
    if (w <= 0.0) continue;
    const double r = l.relative(i);
    total += w;
    e.mean += w * static_cast<double>(l.picture[i]);
    e.meanOfTruth += w * static_cast<double>(l.truth[i]);
    e.relative += w * std::abs(r);
    e.relativeRms += w * r * r;
    e.largest = std::max(e.largest, std::abs(r));
  }
  if (!(total > 0.0)) throw ParameterError("no pixel has a weight");
  e.mean /= total;
  e.meanOfTruth /= total;
  e.relative /= total;
  e.relativeRms = std::sqrt(e.relativeRms / total);
  e.bias = (e.mean - e.meanOfTruth) / std::max(e.meanOfTruth, l.least);
  return e;
}

Image<float> biasMap(const Image<float>& picture, const Image<float>& truth) {
  const Luminances l(picture, truth);
  Image<float> map(picture.width, picture.height, 1);
  for (std::size_t i = 0; i < map.data.size(); ++i) map.data[i] = static_cast<float>(l.relative(i));
  return map;
}

Image<float> biasColours(const Image<float>& bias, double range) {
  // From blue over grey to red, of one lightness at the same distance from the middle.
  static constexpr std::array<glm::vec3, 5> kColours = {{{0.10f, 0.20f, 0.62f},
                                                         {0.46f, 0.61f, 0.90f},
                                                         {0.88f, 0.88f, 0.88f},
                                                         {0.93f, 0.56f, 0.43f},
                                                         {0.60f, 0.05f, 0.13f}}};
  return coloured(bias, kColours, static_cast<float>(-range), static_cast<float>(range));
}

Image<float> flipColours(const Image<float>& flip) {
  static constexpr std::array<glm::vec3, 9> kColours = {{{0.001f, 0.000f, 0.014f},
                                                         {0.110f, 0.065f, 0.277f},
                                                         {0.317f, 0.072f, 0.485f},
                                                         {0.512f, 0.148f, 0.508f},
                                                         {0.716f, 0.215f, 0.475f},
                                                         {0.904f, 0.319f, 0.388f},
                                                         {0.986f, 0.535f, 0.382f},
                                                         {0.997f, 0.766f, 0.534f},
                                                         {0.987f, 0.991f, 0.750f}}};
  return coloured(flip, kColours, 0.0f, 1.0f);
}

}  // namespace welkin::reference
