// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/live_splats.h"

#include <algorithm>
#include <cmath>

#include "welkin/field/cloud_field.h"
#include "welkin/render/sky_splats.h"

namespace welkin::render {
namespace {

// While clouds drift and grow there may come to be more of them than at first.
constexpr std::size_t kRoom = 2;

}  // namespace

bool LiveSplats::in(const scene::SkyState& state) {
  return state.metaballs && !state.metaballs->empty();
}

void LiveSplats::change(const scene::SkyState& state) {
  state.metaballs->at(state.secondsAfter, {0.0, 0.0, state.scene.camera.eyeM}, state.clouds->earthRadiusM(),
                      balls_, scene::MetaballDetail::kAsBalls);  // more than with pictures of far clouds
  state.metaballs->at(state.secondsAfter, {0.0, 0.0, state.scene.camera.eyeM}, state.clouds->earthRadiusM(),
                      shadowBalls_, scene::MetaballDetail::kAsShadow);
  for (scene::CloudBalls* balls : {&balls_, &shadowBalls_}) {
    balls->balls.reserve(kRoom * balls->balls.size());
    balls->filled.reserve(kRoom * balls->filled.size());
    balls->clouds.reserve(kRoom * balls->clouds.size());
  }
  clouds_.reserve(kRoom * balls_.clouds.size());
  shadowClouds_.reserve(kRoom * shadowBalls_.clouds.size());
  pass_.reserve(kRoom * balls_.clouds.size(), kRoom * balls_.balls.size(), state.metaballs->shapes());
  eyeM_.reset();
}

void LiveSplats::update(const scene::SkyState& state, const shading::Uniforms& skyUniforms) {
  pass_.setSky(skyUniforms, shading::splatLights(state));
  eyeM_.reset();
}

void LiveSplats::lookFrom(const scene::SkyState& state, const glm::dvec3& eyeM) {
  if (eyeM_ == eyeM) return;
  eyeM_ = eyeM;
  state.metaballs->at(state.secondsAfter, eyeM, state.clouds->earthRadiusM(), balls_);
  state.metaballs->at(state.secondsAfter, eyeM, state.clouds->earthRadiusM(), shadowBalls_,
                      scene::MetaballDetail::kAsShadow);
  splatClouds(balls_, shadowBalls_, clouds_);
  splatClouds(shadowBalls_, shadowBalls_, shadowClouds_);
  double low = 1e9, high = 0.0;
  for (const field::Metaball& b : shadowBalls_.balls) {
    low = std::min(low, b.centreM.z);
    high = std::max(high, b.centreM.z);
  }
  heightM_ = 0.5 * (std::max(low, 0.0) + high);  // of far ones, over the curved earth, the ground's
  pass_.drawShadow(shadowClouds_, eyeM);
}

float LiveSplats::lightFrom(const glm::vec3& direction) const {
  const glm::dvec3 d(direction);
  double depth = 0.0;
  for (std::size_t i = 0; i < shadowBalls_.clouds.size(); ++i) {
    double own = 0.0;
    for (const field::Metaball& b : shadowBalls_.ballsOf(i)) own += field::columnAlong(b, *eyeM_, d);
    depth += std::max(own, 0.0);
  }
  return static_cast<float>(std::exp(-depth));
}

void LiveSplats::draw(const shading::ViewParts& view, const SkyTextures& tables, const SplatTarget& to) {
  pass_.draw(clouds_, view, tables, to);
}

}  // namespace welkin::render
