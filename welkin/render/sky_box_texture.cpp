// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sky_box_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/mat3x3.hpp>

#include "welkin/core/units.h"

namespace welkin::render {
namespace {

// Halves end at 65504. What is brighter is scaled down, but not so far that a night beside it would lose its
// precision: of discs of the sun no more is left than 64 times that.
constexpr float kMost = 60000.0f, kMostScale = 64.0f;

}  // namespace

SkyBoxTexture::SkyBoxTexture(const scene::SkyBox& box) : box_(box) {
  std::array<Image<float>, 6> faces = scene::skyBoxFaces(box);
  float brightest = 0.0f;
  for (const Image<float>& face : faces)
    brightest = std::max(brightest, *std::max_element(face.data.begin(), face.data.end()));
  scale_ = std::clamp(brightest / kMost, 1.0f, kMostScale);
  for (Image<float>& face : faces)
    for (float& x : face.data) x = std::min(x / scale_, kMost);
  faces_ = gpu::TextureCube(faces, {.format = gpu::Format::kRgba16F, .filter = gpu::Filter::kMipmap});
}

void SkyBoxTexture::bind(gpu::Program& program) const {
  // Columns are where east, north and up lie in the box.
  const auto turn = static_cast<float>(radians(box_.turnDeg));
  const float c = std::cos(turn), s = std::sin(turn);
  const bool yUp = box_.axes == scene::BoxAxes::kYUp;
  const auto inBox = [&](float east, float north, float up) {
    return yUp ? glm::vec3(east, up, -north) : glm::vec3(east, north, up);
  };
  // What lies in the box's north stands clockwise of north by the turn.
  program.set("uBoxFromEnu", glm::mat3(inBox(c, s, 0.0f), inBox(-s, c, 0.0f), inBox(0.0f, 0.0f, 1.0f)));
  program.set("uBoxScale", scale_);
  program.set("uBoxTexelsPerRad", 0.5f * static_cast<float>(faces_.width()));
  program.set("uBoxGround", box_.ground ? 1.0f : 0.0f);
  program.bind("uSkyBox", faces_);
}

}  // namespace welkin::render
