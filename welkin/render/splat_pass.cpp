// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/splat_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "welkin/render/programs.h"
#include "welkin/shading/shader_library.h"

namespace welkin::render {
namespace {

// As lib/splat_stack.glsl has them.
constexpr int kColumns = 8, kRows = 4, kSlices = kColumns * kRows, kTilePx = 64;

// A sort that has moved so many places for each ball had better begin anew.
constexpr std::size_t kMostMoves = 24;

gpu::Program programOf(const char* vertex, const char* fragment) {
  constexpr auto kDialect = shading::ShaderDialect::kGl330;
  return gpu::Program::graphics(shading::assembleShader(vertex, kDialect),
                                shading::assembleShader(fragment, kDialect));
}

using StackNames = std::array<std::string, 6>;
StackNames stackNames(const std::string& name) {
  return {name + ".centreM", name + ".across", name + ".upward",
          name + ".away",    name + ".halfM",  name + ".halfDepthM"};
}
const StackNames kStack = stackNames("uStack"), kSun = stackNames("uSunStack"),
                 kSky = stackNames("uSkyStack");

bool drawn(const field::Metaball& b) {
  return b.density != 0.0 && b.radiusM > 0.0;
}

}  // namespace

struct SplatPass::Stack {
  glm::dvec3 axes[3];  // across, upward, away
  glm::dvec3 centreM;  // from the eye
  double halfM, halfDepthM;

  void set(gpu::Program& p, const std::string* names) const {
    p.set(names[0], glm::vec3(centreM));
    for (int i = 0; i < 3; ++i) p.set(names[1 + i], glm::vec3(axes[i]));
    p.set(names[4], static_cast<float>(halfM));
    p.set(names[5], static_cast<float>(halfDepthM));
  }
};

SplatPass::SplatPass()
    : depth_(programOf("pass/splat_depth.vert", "pass/splat_depth.frag")),
      sum_(fullscreenProgram("pass/splat_sum.frag")),
      eye_(programOf("pass/splat.vert", "pass/splat.frag")) {
  for (StackTextures* t : {&sun_, &sky_}) {
    t->slices = gpu::Texture2D(kColumns * kTilePx, kRows * kTilePx, {.format = gpu::Format::kR32F});
    t->depths = gpu::Texture2D(kColumns * kTilePx, kRows * kTilePx, {.format = gpu::Format::kR32F});
    t->toSlices.attach(0, t->slices);
    t->toDepths.attach(0, t->depths);
  }
}

void SplatPass::setSky(const shading::Uniforms& sky, const glm::vec3& toLight) {
  setUniforms(eye_, sky);
  toLight_ = toLight;
}

// Insertion from the last frame's order: next to nothing where little has moved. The order is total, by
// distance and then by number, so that it is the same however it was found.
void SplatPass::sort(std::span<const field::Metaball> balls, const glm::dvec3& eyeM) {
  distances_.resize(balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const glm::dvec3 d = balls[i].centreM - eyeM;
    distances_[i] = d.x * d.x + d.y * d.y + d.z * d.z;
  }
  const auto before = [this](std::uint32_t a, std::uint32_t b) {
    return distances_[a] != distances_[b] ? distances_[a] > distances_[b] : a < b;
  };
  if (order_.size() != balls.size()) {
    order_.resize(balls.size());
    std::iota(order_.begin(), order_.end(), 0u);
    std::sort(order_.begin(), order_.end(), before);
    return;
  }
  std::size_t moves = 0;
  for (std::size_t i = 1; i < order_.size(); ++i) {
    const std::uint32_t own = order_[i];
    std::size_t to = i;
    for (; to > 0 && before(own, order_[to - 1]); --to, ++moves) order_[to] = order_[to - 1];
    order_[to] = own;
    if (moves > kMostMoves * order_.size()) {
      std::sort(order_.begin(), order_.end(), before);
      return;
    }
  }
}

void SplatPass::drawStack(std::span<const field::Metaball> balls, const glm::dvec3& eyeM,
                          const glm::vec3& toLight, const std::string* names, const StackTextures& to) {
  Stack stack;
  stack.axes[2] = -glm::normalize(glm::dvec3(toLight));
  const glm::dvec3 other =
      std::abs(stack.axes[2].z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
  stack.axes[0] = glm::normalize(glm::cross(stack.axes[2], other));
  stack.axes[1] = glm::cross(stack.axes[0], stack.axes[2]);
  glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  const auto along = [&](const field::Metaball& b) {
    const glm::dvec3 d = b.centreM - eyeM;
    return glm::dvec3(glm::dot(d, stack.axes[0]), glm::dot(d, stack.axes[1]), glm::dot(d, stack.axes[2]));
  };
  for (const field::Metaball& b : balls) {
    if (!drawn(b)) continue;
    const glm::dvec3 at = along(b);
    low = glm::min(low, at - b.radiusM);
    high = glm::max(high, at + b.radiusM);
  }
  // Wider by what balls that are smaller than a texel are widened.
  const glm::dvec3 middle = 0.5 * (low + high), half = 0.5 * (high - low);
  stack.halfM = std::max(half.x, half.y) * kTilePx / (kTilePx - 4.0);
  const double texelM = 2.0 * stack.halfM / (kTilePx - 2.0);
  stack.halfDepthM = half.z + texelM;
  stack.centreM = middle.x * stack.axes[0] + middle.y * stack.axes[1] + middle.z * stack.axes[2];

  values_.clear();
  const double sliceM = 2.0 * stack.halfDepthM / kSlices, beginM = middle.z - stack.halfDepthM;
  for (const field::Metaball& b : balls) {
    if (!drawn(b)) continue;
    // So that no ball falls between texels; it keeps its mass.
    const double radiusM = std::max(b.radiusM, texelM), share = b.radiusM / radiusM;
    const double z = along(b).z - beginM;
    const int first = std::max(static_cast<int>((z - radiusM) / sliceM), 0);
    const int last = std::min(static_cast<int>((z + radiusM) / sliceM), kSlices - 1);
    const glm::vec3 c(b.centreM - eyeM);
    for (int slice = first; slice <= last; ++slice)
      values_.insert(values_.end(), {c.x, c.y, c.z, static_cast<float>(radiusM),
                                     static_cast<float>(b.density * share * share * share),
                                     static_cast<float>(slice), 0.0f, 0.0f});
  }
  slices_.upload(values_);
  stack.set(depth_, kStack.data());
  to.toSlices.clear();
  slices_.draw(depth_, to.toSlices, {.blend = gpu::Blend::kAdd});
  sum_.bind("uSlices", to.slices);
  triangle_.draw(sum_, to.toDepths);
  stack.set(eye_, names);
}

void SplatPass::draw(std::span<const field::Metaball> balls, const SplatLook& look,
                     const shading::ViewParts& view, const SkyTextures& tables, const gpu::Target& target) {
  if (std::none_of(balls.begin(), balls.end(), drawn)) return;
  drawStack(balls, view.eyeM, toLight_, kSun.data(), sun_);
  drawStack(balls, view.eyeM, {0.0f, 0.0f, 1.0f}, kSky.data(), sky_);

  sort(balls, view.eyeM);
  values_.clear();
  for (const std::uint32_t i : order_) {
    const field::Metaball& b = balls[i];
    if (!drawn(b)) continue;
    const glm::vec3 c(b.centreM - view.eyeM);
    values_.insert(values_.end(), {c.x, c.y, c.z, static_cast<float>(b.radiusM),
                                   static_cast<float>(b.density), 0.0f, 0.0f, 0.0f});
  }
  quads_.upload(values_);
  eye_.set("uEyeM", static_cast<float>(view.eyeM.z));
  eye_.set("uClipFromEnu", view.clipFromEnu);
  eye_.set("uEnuFromCamera", view.enuFromCamera);
  eye_.set("uRayScale", view.rayScale);
  eye_.set("uScale", look.scale);
  eye_.set("uAlbedo", look.albedo);
  eye_.set("uPhase", static_cast<int>(look.phase));
  tables.bind(eye_);
  eye_.bind("uSunDepths", sun_.depths);
  eye_.bind("uSkyDepths", sky_.depths);
  quads_.draw(eye_, target, {.blend = gpu::Blend::kOver});
}

}  // namespace welkin::render
