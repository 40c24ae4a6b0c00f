// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sky_light_probe.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

namespace welkin::render {
namespace {

// Right and up are for any direction but these two's own.
glm::dvec3 upFor(const glm::dvec3& ahead) {
  return std::abs(ahead.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(0.0, 1.0, 0.0);
}

shading::View viewTowards(const glm::dvec3& eyeM, const glm::dvec3& ahead, double halfTan) {
  return {glm::lookAt(eyeM, eyeM + ahead, upFor(ahead)),
          glm::perspective(2.0 * std::atan(halfTan), 1.0, 1.0, 1000.0)};
}

}  // namespace

std::array<glm::vec3, 9> SkyLightProbe::luminance(const glm::dvec3& eyeM, const Draw& draw) {
  std::array<glm::dvec3, 9> sums{};
  for (int f = 0; f < kFaces; ++f) {
    glm::dvec3 ahead(0.0);
    ahead[f / 2] = f % 2 == 0 ? 1.0 : -1.0;
    const shading::View view = viewTowards(eyeM, ahead, 1.0);
    toFace_.clear();
    draw(view, toFace_, f);
    const Image<float> picture = toFace_.readPicture(0, 3);
    const glm::dmat3 camera = glm::transpose(glm::dmat3(view.view));
    for (int y = 0; y < side_; ++y)
      for (int x = 0; x < side_; ++x) {
        const glm::dvec3 ray(2.0 * (x + 0.5) / side_ - 1.0, 1.0 - 2.0 * (y + 0.5) / side_, -1.0);
        const double length = glm::length(ray), steradians = 4.0 / (side_ * side_ * length * length * length);
        const std::array<float, 9> harmonics = skyHarmonics(glm::vec3(camera * ray / length));
        const glm::dvec3 light(picture.at(x, y, 0), picture.at(x, y, 1), picture.at(x, y, 2));
        for (std::size_t i = 0; i < sums.size(); ++i)
          sums[i] += steradians * static_cast<double>(harmonics[i]) * light;
      }
  }
  std::array<glm::vec3, 9> out;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = glm::vec3(sums[i]);
  return out;
}

float SkyLightProbe::through(const glm::dvec3& eyeM, const glm::vec3& direction, float radiusRad, int picture,
                             const Draw& draw) {
  toDisc_.clear();
  draw(viewTowards(eyeM, glm::dvec3(direction), std::tan(static_cast<double>(radiusRad))), toDisc_, picture);
  const Image<float> alpha = toDisc_.readPicture(0, 4);
  double sum = 0.0;
  int count = 0;
  for (int y = 0; y < kDiscSide; ++y)
    for (int x = 0; x < kDiscSide; ++x) {
      if (std::hypot(x + 0.5 - 0.5 * kDiscSide, y + 0.5 - 0.5 * kDiscSide) > 0.5 * kDiscSide) continue;
      sum += 1.0 - static_cast<double>(alpha.at(x, y, 3));
      ++count;
    }
  return static_cast<float>(std::min(std::max(sum / count, 0.0), 1.0));
}

}  // namespace welkin::render
