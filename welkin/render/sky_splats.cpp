// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sky_splats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "welkin/field/cloud_field.h"
#include "welkin/scene/projector.h"

namespace welkin::render {
namespace {

constexpr int kLeastFacePx = 64, kMostFacePx = 2048;

struct Face {
  glm::dvec3 right, up, ahead;
  double tanX, tanY;
};

// In the order of lib/splat_layer.glsl; a texel of margin all around.
std::array<Face, 6> cubeFaces(int sidePx) {
  std::array<Face, 6> faces;
  const double tan = sidePx / (sidePx - 2.0);
  for (int i = 0; i < 6; ++i) {
    glm::dvec3 ahead(0.0), up(0.0, 0.0, 1.0);
    ahead[i / 2] = i % 2 == 0 ? 1.0 : -1.0;
    if (i / 2 == 2) up = {0.0, 1.0, 0.0};
    faces[static_cast<std::size_t>(i)] = {glm::cross(ahead, up), up, ahead, tan, tan};
  }
  return faces;
}

Face pictureFace(const scene::SkyState& state) {
  const scene::Projector p = scene::projectorOf(state);
  const glm::dmat3 enuFromCamera(p.enuFromCamera);
  const double tan = static_cast<double>(p.halfWidthTan);
  return {enuFromCamera[0], enuFromCamera[2], enuFromCamera[1], tan,
          tan * static_cast<double>(p.sizePx.y / p.sizePx.x)};
}

shading::View viewOf(const Face& face, double eyeM) {
  shading::View view;
  view.view = glm::dmat4(glm::transpose(glm::dmat3(face.right, face.up, -face.ahead)));
  view.view[3] = view.view * glm::dvec4(0.0, 0.0, -eyeM, 1.0);
  view.projection = glm::frustum(-face.tanX, face.tanX, -face.tanY, face.tanY, 1.0, 1e6);
  return view;
}

// Of a face of a cube, about as fine as the picture.
int facePx(const scene::SkyState& state) {
  const scene::Output& o = state.scene.output;
  double rad = 2.0 / static_cast<double>(o.height);
  if (state.scene.camera.projection == scene::Projection::kFisheye)
    rad = std::numbers::pi / static_cast<double>(std::min(o.width, o.height));
  if (state.scene.camera.projection == scene::Projection::kEquirect)
    rad = std::numbers::pi / static_cast<double>(o.height);
  return std::clamp(static_cast<int>(std::ceil(2.0 / rad)) + 2, kLeastFacePx, kMostFacePx);
}

}  // namespace

void splatClouds(const scene::CloudBalls& balls, const scene::CloudBalls& shades,
                 std::vector<SplatCloud>& out) {
  out.clear();
  for (std::size_t i = 0; i < balls.clouds.size(); ++i) {
    const scene::CloudBalls::Cloud& cloud = balls.clouds[i];
    const std::span<const field::Metaball> own = balls.ballsOf(i);
    out.push_back({own, cloud.phase, cloud.albedo, own.size() - (cloud.end - cloud.coarseEnd),
                   cloud.coarseShare, shades.ballsOf(i), cloud.far});
  }
}

void SkySplats::update(const scene::SkyState& state) {
  using scene::MetaballDetail;
  for (const bool shadow : {false, true}) {
    scene::CloudBalls& balls = shadow ? shadowBalls_ : balls_;
    balls.balls.clear();
    balls.clouds.clear();
    if (state.scene.metaballsAs == scene::MetaballRender::kSplats)
      state.metaballs->at(state.secondsAfter, {0.0, 0.0, state.scene.camera.eyeM},
                          state.clouds->earthRadiusM(), balls,
                          shadow ? MetaballDetail::kAsShadow : MetaballDetail::kAsSeen);
  }
  splatClouds(balls_, shadowBalls_, clouds_);
  splatClouds(shadowBalls_, shadowBalls_, shadowClouds_);
}

void SkySplats::draw(const scene::SkyState& state, const SkyTextures& tables, gpu::Program& program) {
  if (!pass_) pass_.emplace(SplatDetail::kStill);
  pass_->setSky(shading::skyUniforms(state), shading::splatLights(state));
  const double eyeM = state.scene.camera.eyeM;
  pass_->drawShadow(shadowClouds_, {0.0, 0.0, eyeM});

  const bool plane = state.scene.camera.projection == scene::Projection::kPerspective;
  const int side = facePx(state);
  const int width = plane ? static_cast<int>(state.scene.output.width) : side,
            height = plane ? static_cast<int>(state.scene.output.height) : side;
  const int columns = plane ? 1 : 3, rows = plane ? 1 : 2;
  if (light_.width() != columns * width || light_.height() != rows * height) {
    target_.reset();
    light_ = gpu::Texture2D(columns * width, rows * height, {.format = gpu::Format::kRgba32F});
    distance_ = gpu::Texture2D(columns * width, rows * height, {.format = gpu::Format::kRgba32F});
    target_.emplace(light_);
    target_->attach(1, distance_);
  }
  target_->clear(0);
  target_->clear(1);

  std::array<Face, 6> faces = cubeFaces(side);
  if (plane) faces[0] = pictureFace(state);
  std::vector<glm::vec4> axes;
  for (int i = 0; i < columns * rows; ++i) {
    const Face& face = faces[static_cast<std::size_t>(i)];
    const gpu::Target target(target_->id(), {width * (i % 3), height * (i / 3), width, height});
    pass_->draw(clouds_, shading::partsOf(viewOf(face, eyeM), height), tables, {target, 1.0f, true, {}, {}});
    axes.emplace_back(face.right, face.tanX);
    axes.emplace_back(face.up, face.tanY);
    axes.emplace_back(face.ahead, 0.0);
  }
  program.set("uSplatFaces", columns * rows);
  program.set("uSplatAxes", std::span<const glm::vec4>(axes));
}

void SkySplats::bind(gpu::Program& program) const {
  program.bind("uSplatLight", light_);
  program.bind("uSplatDistance", distance_);
  pass_->setShadow(program);
}

}  // namespace welkin::render
