// SPDX-License-Identifier: Apache-2.0
#include "tests/testing/pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "welkin/core/units.h"

namespace welkin::testing {

double luminanceOf(glm::vec3 rgb) {
  return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
}

glm::vec3 pixel(const Image<float>& picture, int x, int y) {
  return {picture.at(x, y, 0), picture.at(x, y, 1), picture.at(x, y, 2)};
}

glm::vec3 sample(const Image<float>& picture, double x, double y) {
  const double fx = std::clamp(x - 0.5, 0.0, picture.width - 1.0);
  const double fy = std::clamp(y - 0.5, 0.0, picture.height - 1.0);
  const int x0 = static_cast<int>(fx), y0 = static_cast<int>(fy);
  const int x1 = std::min(x0 + 1, picture.width - 1), y1 = std::min(y0 + 1, picture.height - 1);
  const float u = static_cast<float>(fx - x0), v = static_cast<float>(fy - y0);
  const glm::vec3 top = pixel(picture, x0, y0) * (1.0f - u) + pixel(picture, x1, y0) * u;
  const glm::vec3 bottom = pixel(picture, x0, y1) * (1.0f - u) + pixel(picture, x1, y1) * u;
  return top * (1.0f - v) + bottom * v;
}

glm::vec3 meanOf(const Image<float>& picture, int y0, int y1) {
  if (y1 < 0) y1 = picture.height;
  glm::dvec3 sum(0.0);
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < picture.width; ++x) sum += glm::dvec3(pixel(picture, x, y));
  return glm::vec3(sum / (static_cast<double>(picture.width) * (y1 - y0)));
}

long firstBadValue(const Image<float>& picture) {
  const auto bad = std::find_if_not(picture.data.begin(), picture.data.end(),
                                    [](float v) { return std::isfinite(v) && v >= 0.0f; });
  return bad == picture.data.end() ? -1 : static_cast<long>(bad - picture.data.begin());
}

Difference difference(const Image<std::uint8_t>& a, const Image<std::uint8_t>& b) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels)
    throw std::invalid_argument("pictures of different sizes");
  std::vector<int> steps(a.data.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i] = std::abs(int{a.data[i]} - int{b.data[i]});
    sum += steps[i];
  }
  const auto nth = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() * 99 / 100);
  std::nth_element(steps.begin(), nth, steps.end());
  return {sum / static_cast<double>(steps.size()), static_cast<double>(*nth)};
}

double relativeDifference(const Image<float>& a, const Image<float>& b) {
  double sum = 0.0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const double l = luminanceOf(pixel(a, x, y)), m = luminanceOf(pixel(b, x, y));
      sum += std::abs(l - m) / (0.5 * (l + m));
    }
  return sum / (a.width * a.height);
}

glm::vec3 horizontalIlluminance(const Image<float>& equirect) {
  glm::dvec3 sum(0.0);
  for (int y = 0; y < equirect.height / 2; ++y) {
    // Integral of sine times cosine of the elevation over the row.
    const double top = kPi * (0.5 - static_cast<double>(y) / equirect.height);
    const double bottom = kPi * (0.5 - (y + 1.0) / equirect.height);
    const double weight =
        0.5 * (std::pow(std::sin(top), 2) - std::pow(std::sin(bottom), 2)) * 2.0 * kPi / equirect.width;
    for (int x = 0; x < equirect.width; ++x) sum += weight * glm::dvec3(pixel(equirect, x, y));
  }
  return glm::vec3(sum);
}

}  // namespace welkin::testing
