// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/splat_pass.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <numeric>

#include "welkin/render/programs.h"
#include "welkin/shading/shader_library.h"

namespace welkin::render {
namespace {

// As lib/splat_stack.glsl has them: finer stacks for clouds that are larger in view.
struct StackClass {
  int sidePx, slices, columns;
  float leastShare;  // radius over distance
  std::size_t most;  // clouds
  int width() const { return sidePx * columns; }
  int height() const { return sidePx * slices / columns; }
};
constexpr std::array<StackClass, 4> kClasses = {{{128, 64, 8, 0.05f, 8},
                                                 {64, 32, 8, 0.12f, 8},
                                                 {32, 16, 4, 0.03f, 64},
                                                 {16, 8, 4, 0.0f, std::numeric_limits<std::size_t>::max()}}};
constexpr int kStacks = 3;  // to the light, to the zenith, from the eye
constexpr int kFinestLive = 1;
// Nearer than that, in radii of a cloud, there is none from the eye.
constexpr double kEyeStackFrom = 1.15;

constexpr int kTilePx = 4, kFineTilePx = 16, kTilesInRow = 256;
constexpr double kMostFineTexels = 2e6;  // of all tiles together
constexpr int kShadowPx = 1024;

// A sort that has moved so many places for each ball had better begin anew.
constexpr std::size_t kMostMoves = 24;

gpu::Program programOf(const char* vertex, const char* fragment, const shading::ShaderDefines& defines = {}) {
  constexpr auto kDialect = shading::ShaderDialect::kGl330;
  return gpu::Program::graphics(shading::assembleShader(vertex, kDialect, defines),
                                shading::assembleShader(fragment, kDialect, defines));
}

bool drawn(const field::Metaball& b) {
  return b.density != 0.0 && b.radiusM > 0.0;
}

// Across, upward and away from the light.
glm::dmat3 axesOf(const glm::dvec3& toLight) {
  const glm::dvec3 away = -glm::normalize(toLight);
  const glm::dvec3 other = std::abs(away.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 across = glm::normalize(glm::cross(away, other));
  return {across, glm::cross(across, away), away};
}

// Grows, never shrinks, so that it settles.
void atLeast(gpu::Texture2D& texture, std::optional<gpu::Framebuffer>& framebuffer, int width, int height,
             gpu::Format format) {
  if (texture.width() >= width && texture.height() >= height) return;
  const int tall = std::max(height, texture.height() + texture.height() / 2);
  framebuffer.reset();
  texture = gpu::Texture2D(width, tall, {.format = format});
  framebuffer.emplace(texture);
}

// Cone around the picture.
struct ViewCone {
  glm::dvec3 axis;
  double halfAngle;
};
ViewCone coneOf(const shading::ViewParts& view) {
  const auto ray = [&](float x, float y) {
    const glm::vec3 r(view.rayScale.x * x + view.rayScale.z, view.rayScale.y * y + view.rayScale.w, -1.0f);
    return glm::normalize(glm::dvec3(view.enuFromCamera * r));
  };
  ViewCone cone{ray(0.0f, 0.0f), 0.0};
  for (const float x : {-1.0f, 1.0f})
    for (const float y : {-1.0f, 1.0f})
      cone.halfAngle =
          std::max(cone.halfAngle, std::acos(std::clamp(glm::dot(cone.axis, ray(x, y)), -1.0, 1.0)));
  return cone;
}

bool mayBeSeen(const ViewCone& cone, const glm::dvec3& centreM, double radiusM) {
  const double distance = glm::length(centreM);
  if (distance <= radiusM) return true;
  const double angle = std::acos(std::clamp(glm::dot(cone.axis, centreM) / distance, -1.0, 1.0));
  return angle <= cone.halfAngle + std::asin(radiusM / distance);
}

}  // namespace

struct SplatPass::Block {
  std::uint32_t cloud = 0;
  glm::dvec3 centreM{0.0};  // from the eye
  float share = 0.0f;       // radius over distance
  int stackClass = 0, x = 0, y = 0;
  std::array<float, 2 * kStacks> halves{};  // half side and half depth of each stack
};

SplatPass::SplatPass(SplatDetail detail)
    : detail_(detail),
      depth_(programOf("pass/splat_depth.vert", "pass/splat_depth.frag")),
      sum_(programOf("pass/splat_sum.vert", "pass/splat_sum.frag")),
      light_(programOf("pass/splat_light.vert", "pass/splat_light.frag")) {
  for (std::size_t i = 0; i < eye_.size(); ++i) {
    shading::ShaderDefines defines;
    if (i & 1) defines.emplace_back("WELKIN_DISTANCE", "1");
    if (i & 2) defines.emplace_back("WELKIN_ENGINE_DEPTH", "1");
    eye_[i] = programOf("pass/splat.vert", "pass/splat.frag", defines);
  }
}

SplatPass::~SplatPass() = default;

void SplatPass::setSky(const shading::Uniforms& sky, const glm::vec3& toLight) {
  setUniforms(light_, sky);
  toLight_ = toLight;
}

// The clouds in view, and a block of the stacks' texture for each.
void SplatPass::findBlocks(std::span<const SplatCloud> clouds, const shading::ViewParts& view) {
  const ViewCone cone = coneOf(view);
  blocks_.clear();
  bySize_.clear();
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
    for (const field::Metaball& b : clouds[i].balls) {
      if (!drawn(b)) continue;
      low = glm::min(low, b.centreM - b.radiusM);
      high = glm::max(high, b.centreM + b.radiusM);
    }
    if (!(low.x < high.x)) continue;
    const glm::dvec3 centreM = 0.5 * (low + high) - view.eyeM;
    const double radiusM = 0.5 * glm::length(high - low);
    if (!mayBeSeen(cone, centreM, radiusM)) continue;
    blocks_.push_back({.cloud = static_cast<std::uint32_t>(i),
                       .centreM = centreM,
                       .share = static_cast<float>(radiusM / std::max(glm::length(centreM), 1e-3))});
    bySize_.push_back(static_cast<std::uint32_t>(blocks_.size() - 1));
  }
  if (blocks_.empty()) return;
  // The largest first.
  std::sort(bySize_.begin(), bySize_.end(), [this](std::uint32_t a, std::uint32_t b) {
    return blocks_[a].share != blocks_[b].share ? blocks_[a].share > blocks_[b].share : a < b;
  });
  int row = 0, x = 0, last = detail_ == SplatDetail::kStill ? 0 : kFinestLive;
  const int stacksWidth = kStacks * kClasses[static_cast<std::size_t>(last)].width();
  std::size_t inClass = 0;
  for (const std::uint32_t i : bySize_) {
    Block& b = blocks_[i];
    b.stackClass = last;
    while (b.share < kClasses[static_cast<std::size_t>(b.stackClass)].leastShare ||
           inClass >= kClasses[static_cast<std::size_t>(b.stackClass)].most) {
      ++b.stackClass;
      inClass = 0;
    }
    const StackClass& own = kClasses[static_cast<std::size_t>(b.stackClass)];
    if (b.stackClass != last || x + kStacks * own.width() > stacksWidth) {
      if (x > 0) row += kClasses[static_cast<std::size_t>(last)].height();
      x = 0;
    }
    last = b.stackClass;
    ++inClass;
    b.x = x, b.y = row;
    x += kStacks * own.width();
  }
  const int height = row + (x > 0 ? kClasses[static_cast<std::size_t>(last)].height() : 0);
  atLeast(slices_, toSlices_, stacksWidth, height, gpu::Format::kR32F);
  atLeast(depths_, toDepths_, stacksWidth, height, gpu::Format::kR32F);
}

// What a cloud's balls add to the slices of a stack.
void SplatPass::addStack(const SplatCloud& cloud, const glm::dvec3& eyeM, const glm::dmat3& axes, int beside,
                         Block& block) {
  const StackClass& own = kClasses[static_cast<std::size_t>(block.stackClass)];
  const double centreM = glm::length(block.centreM);
  const bool perspective = beside == 2;
  // Of a ball: across, upward, away; and the scale of the picture there.
  const auto along = [&](const field::Metaball& b) {
    const glm::dvec3 at = (b.centreM - eyeM - block.centreM) * axes;
    const double scale = perspective ? centreM / std::max(centreM + at.z, 0.1 * centreM) : 1.0;
    return glm::dvec4(at.x * scale, at.y * scale, at.z, scale);
  };
  double half = 0.0, halfDepth = 0.0;
  for (const field::Metaball& b : cloud.balls) {
    if (!drawn(b)) continue;
    const glm::dvec4 at = glm::abs(along(b));
    half = std::max({half, at.x + at.w * b.radiusM, at.y + at.w * b.radiusM});
    halfDepth = std::max(halfDepth, at.z + b.radiusM);
  }
  // Wider by what balls that are smaller than a texel are widened.
  half *= own.sidePx / (own.sidePx - 4.0);
  const double texelM = 2.0 * half / (own.sidePx - 2.0);
  halfDepth += texelM;
  block.halves[static_cast<std::size_t>(2 * beside)] = static_cast<float>(half);
  block.halves[static_cast<std::size_t>(2 * beside + 1)] = static_cast<float>(halfDepth);
  const double sliceM = 2.0 * halfDepth / own.slices;
  for (const field::Metaball& b : cloud.balls) {
    if (!drawn(b)) continue;
    // So that no ball falls between texels; it keeps its mass.
    const glm::dvec4 at = along(b);
    const double radiusM = std::max(b.radiusM, texelM / at.w), share = b.radiusM / radiusM;
    const double z = at.z + halfDepth;
    const int first = std::max(static_cast<int>((z - radiusM) / sliceM), 0);
    const int end = std::min(static_cast<int>((z + radiusM) / sliceM) + 1, own.slices);
    const double depth = b.density * share * share * share * radiusM;
    const double px = block.x + beside * own.width() + (0.5 + 0.5 * at.x / half) * own.sidePx +
                      -at.x / half;  // the margin: a texel on both sides
    const double py = block.y + (0.5 + 0.5 * at.y / half) * own.sidePx - at.y / half;
    for (int slice = first; slice < end; ++slice) {
      const int column = slice % own.columns, row = slice / own.columns;
      values_.insert(values_.end(),
                     {static_cast<float>(px + own.sidePx * column), static_cast<float>(py + own.sidePx * row),
                      static_cast<float>(at.w * radiusM / texelM), static_cast<float>(depth),
                      static_cast<float>((slice * sliceM - z) / radiusM),
                      static_cast<float>(((slice + 1) * sliceM - z) / radiusM), 0.0f, 0.0f});
    }
  }
}

void SplatPass::drawStacks(std::span<const SplatCloud> clouds, const glm::dvec3& eyeM) {
  const glm::dmat3 sun = axesOf(toLight_), sky = axesOf({0.0, 0.0, 1.0});
  values_.clear();
  for (Block& b : blocks_) {
    addStack(clouds[b.cloud], eyeM, sun, 0, b);
    addStack(clouds[b.cloud], eyeM, sky, 1, b);
    b.halves[4] = b.halves[5] = 0.0f;
    if (b.share * kEyeStackFrom < 1.0) addStack(clouds[b.cloud], eyeM, axesOf(-b.centreM), 2, b);
  }
  inSlices_.upload(values_);
  const glm::vec2 perTexel(1.0f / static_cast<float>(slices_.width()),
                           1.0f / static_cast<float>(slices_.height()));
  depth_.set("uPerTexel", perTexel);
  toSlices_->clear();
  inSlices_.draw(depth_, *toSlices_, {.blend = gpu::Blend::kAdd});

  values_.clear();
  for (const Block& b : blocks_) {
    const StackClass& own = kClasses[static_cast<std::size_t>(b.stackClass)];
    for (int beside = 0; beside < kStacks; ++beside)
      values_.insert(values_.end(), {static_cast<float>(b.x + beside * own.width()), static_cast<float>(b.y),
                                     static_cast<float>(own.sidePx), 0.0f});
  }
  inBlocks_.upload(values_);
  sum_.set("uPerTexel", perTexel);
  sum_.bind("uSlices", slices_);
  inBlocks_.draw(sum_, *toDepths_, {});
  light_.set("uSunStack", glm::mat3(sun));
  light_.set("uSkyStack", glm::mat3(sky));
}

// Insertion from the last frame's order: next to nothing where little has moved. The order is total, by
// distance and then by number, so that it is the same however it was found. A ball's distance is that of a
// place in its front half, which is what is seen of it.
void SplatPass::sort() {
  distances_.resize(pieces_.size());
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    distances_[i] = glm::length(pieces_[i].centreM) - 0.5f * pieces_[i].radiusM;
  const auto before = [this](std::uint32_t a, std::uint32_t b) {
    return distances_[a] != distances_[b] ? distances_[a] > distances_[b] : a < b;
  };
  if (order_.size() != pieces_.size()) {
    order_.resize(pieces_.size());
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

void SplatPass::drawLight(const shading::ViewParts& view, const SkyTextures& tables) {
  const int rows = (static_cast<int>(pieces_.size()) + kTilesInRow - 1) / kTilesInRow;
  int tilePx = kTilePx;
  if (detail_ == SplatDetail::kStill)
    tilePx = std::clamp(static_cast<int>(std::sqrt(kMostFineTexels / static_cast<double>(pieces_.size()))),
                        kTilePx, kFineTilePx);
  atLeast(tiles_, toTiles_, kTilesInRow * tilePx, rows * tilePx, gpu::Format::kRgba32F);
  tileLayout_ = glm::vec3(tilePx, tiles_.width() / static_cast<float>(tilePx),
                          tiles_.height() / static_cast<float>(tilePx));
  light_.set("uTiles", tileLayout_);
  light_.set("uTilesInRow", static_cast<float>(kTilesInRow));
  light_.set("uEyeM", static_cast<float>(view.eyeM.z));
  light_.set("uEnuFromCamera", view.enuFromCamera);
  light_.set("uRayScale", view.rayScale);
  tables.bind(light_);
  light_.bind("uDepths", depths_);
  inTiles_.draw(light_, *toTiles_, {});
}

void SplatPass::drawBalls(const shading::ViewParts& view, const SplatTarget& to) {
  gpu::Program& p = eye_[(to.distance ? 1u : 0u) + (to.depth.texture != 0 ? 2u : 0u)];
  p.set("uTiles", tileLayout_);
  p.set("uTilesInRow", static_cast<float>(kTilesInRow));
  p.set("uClipFromEnu", view.clipFromEnu);
  p.set("uEnuFromCamera", view.enuFromCamera);
  p.set("uRayScale", view.rayScale);
  p.set("uScale", to.scale);
  p.bind("uLight", tiles_);
  if (to.depth.texture == 0) {
    quads_.draw(p, to.target, {.blend = gpu::Blend::kOver});
    return;
  }
  const glm::dmat4& m = to.projection;
  const bool reversed = to.depth.reversed;
  p.set("uDepthCorner", glm::vec2(to.target.area.x, to.target.area.y));
  p.set("uDepthLaw", reversed ? glm::vec3(m[3][2], m[2][2], 1.0) : glm::vec3(-m[3][2], 1.0 - m[2][2], -2.0));
  p.set("uAhead", -view.enuFromCamera[2]);
  const gpu::TexelReader::Binding binding(depthReader_, p, "uDepth", to.depth.texture);
  quads_.draw(p, to.target, {.blend = gpu::Blend::kOver});
}

void SplatPass::drawShadow(std::span<const SplatCloud> clouds, const glm::dvec3& eyeM) {
  shadowHalfM_ = 0.0f;
  if (toLight_.z <= 0.0f) return;
  const glm::dmat3 axes = axesOf(toLight_);
  const glm::dvec3 underEye(eyeM.x, eyeM.y, 0.0);
  const auto near = [&](const field::Metaball& b) {
    return drawn(b) && glm::length(b.centreM - underEye) - b.radiusM < kShadowReachM;
  };
  glm::dvec2 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  for (const SplatCloud& cloud : clouds)
    for (const field::Metaball& b : cloud.balls) {
      if (!near(b)) continue;
      const glm::dvec2 at((b.centreM - underEye) * axes);
      low = glm::min(low, at - b.radiusM);
      high = glm::max(high, at + b.radiusM);
    }
  if (!(low.x < high.x)) return;
  if (shadow_.width() == 0) {
    shadow_ = gpu::Texture2D(kShadowPx, kShadowPx, {.format = gpu::Format::kR32F});
    toShadow_.emplace(shadow_);
  }
  const glm::dvec2 middle = 0.5 * (low + high);
  const double half = 0.5 * std::max(high.x - low.x, high.y - low.y) * kShadowPx / (kShadowPx - 4.0);
  const double texelM = 2.0 * half / kShadowPx;
  values_.clear();
  for (const SplatCloud& cloud : clouds)
    for (const field::Metaball& b : cloud.balls) {
      if (!near(b)) continue;
      const glm::dvec2 at = (glm::dvec2((b.centreM - underEye) * axes) - middle) / half;
      const double radiusM = std::max(b.radiusM, texelM), share = b.radiusM / radiusM;
      values_.insert(
          values_.end(),
          {static_cast<float>((0.5 + 0.5 * at.x) * kShadowPx),
           static_cast<float>((0.5 + 0.5 * at.y) * kShadowPx), static_cast<float>(radiusM / texelM),
           static_cast<float>(b.density * share * share * share * radiusM), -1.0f, 1.0f, 0.0f, 0.0f});
    }
  inSlices_.upload(values_);
  depth_.set("uPerTexel", glm::vec2(1.0f / kShadowPx));
  toShadow_->clear();
  inSlices_.draw(depth_, *toShadow_, {.blend = gpu::Blend::kAdd});
  shadowAxes_ = {glm::vec4(axes[0], middle.x), glm::vec4(axes[1], middle.y)};
  shadowHalfM_ = static_cast<float>(half);
}

void SplatPass::setShadow(gpu::Program& program) const {
  program.set("uSplatShadowAxes", std::span<const glm::vec4>(shadowAxes_));
  program.set("uSplatShadowHalfM", shadowHalfM_);
  if (shadow_.width() > 0) program.bind("uSplatShadow", shadow_);
}

void SplatPass::draw(std::span<const SplatCloud> clouds, const shading::ViewParts& view,
                     const SkyTextures& tables, const SplatTarget& to) {
  findBlocks(clouds, view);
  if (blocks_.empty()) return;
  drawStacks(clouds, view.eyeM);

  pieces_.clear();
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    for (const field::Metaball& b : clouds[blocks_[i].cloud].balls)
      if (drawn(b))
        pieces_.push_back({glm::vec3(b.centreM - view.eyeM), static_cast<float>(b.radiusM),
                           static_cast<float>(b.density), static_cast<std::uint32_t>(i)});
  sort();
  values_.clear();
  for (std::size_t tile = 0; tile < order_.size(); ++tile) {
    const Piece& b = pieces_[order_[tile]];
    const Block& block = blocks_[b.block];
    const SplatCloud& cloud = clouds[block.cloud];
    const StackClass& own = kClasses[static_cast<std::size_t>(block.stackClass)];
    const glm::vec3 centre(block.centreM);
    values_.insert(values_.end(), {b.centreM.x,
                                   b.centreM.y,
                                   b.centreM.z,
                                   b.radiusM,
                                   b.density,
                                   static_cast<float>(tile),
                                   static_cast<float>(cloud.phase),
                                   cloud.albedo,
                                   centre.x,
                                   centre.y,
                                   centre.z,
                                   block.halves[4],
                                   block.halves[0],
                                   block.halves[1],
                                   block.halves[2],
                                   block.halves[3],
                                   static_cast<float>(block.x),
                                   static_cast<float>(block.y),
                                   static_cast<float>(own.sidePx),
                                   block.halves[5]});
  }
  inTiles_.upload(values_);
  drawLight(view, tables);
  values_.clear();
  for (std::size_t tile = 0; tile < order_.size(); ++tile) {
    const Piece& b = pieces_[order_[tile]];
    values_.insert(values_.end(), {b.centreM.x, b.centreM.y, b.centreM.z, b.radiusM, b.density,
                                   static_cast<float>(tile), 0.0f, 0.0f});
  }
  quads_.upload(values_);
  drawBalls(view, to);
}

}  // namespace welkin::render
