// SPDX-License-Identifier: Apache-2.0
// What SkyLight is found from: six small pictures all around a place, and one towards a light, which somebody
// draws. Needs a current context.
#pragma once

#include <array>
#include <functional>
#include <glm/vec3.hpp>

#include "welkin/gpu/draw.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/sky_light.h"
#include "welkin/shading/view.h"

namespace welkin::render {

class SkyLightProbe {
 public:
  static constexpr int kFaces = 6, kPictures = kFaces + 2;

  // Draws a view over a target that is empty; picture: 0 to kPictures - 1, always the same of the same kind.
  using Draw = std::function<void(const shading::View& view, const gpu::Target& target, int picture)>;

  // side: of the six pictures, pixels.
  explicit SkyLightProbe(int side) : side_(side) {}
  int side() const { return side_; }

  // The coefficients of the luminance all around.
  std::array<glm::vec3, 9> luminance(const glm::dvec3& eyeM, const Draw& draw);
  // The share that comes through, one minus the mean of what alpha is drawn over a disc; picture: kFaces or
  // the one after it.
  float through(const glm::dvec3& eyeM, const glm::vec3& direction, float radiusRad, int picture,
                const Draw& draw);

 private:
  static constexpr int kDiscSide = 16;
  int side_;
  gpu::Texture2D face_{side_, side_, {.format = gpu::Format::kRgba32F}},
      disc_{kDiscSide, kDiscSide, {.format = gpu::Format::kRgba32F}};
  gpu::Framebuffer toFace_{face_}, toDisc_{disc_};
};

}  // namespace welkin::render
