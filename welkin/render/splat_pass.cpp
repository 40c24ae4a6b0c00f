// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/splat_pass.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>

#include "welkin/render/programs.h"
#include "welkin/render/view_cone.h"
#include "welkin/shading/shader_library.h"

namespace welkin::render {
namespace {

// What a stack takes of the texture, as lib/splat_stack.glsl has it.
struct StackSize {
  int sidePx = 0;
  int slices() const { return sidePx / 2; }
  int fours() const { return (slices() + 3) / 4; }
  int columns() const { return sidePx > 32 ? 4 : 2; }
  int width() const { return sidePx * columns(); }
  int height() const { return sidePx * ((fours() + columns() - 1) / columns()); }
};
// Stacks are the finer the larger a cloud is in view, without steps: the size that a stack takes of the
// texture has steps, but of it as much is used as makes texels and slices so fine as they are to be.
struct Fineness {
  double mostPx, mostShare;  // texels on a slice's side, of a cloud with that share: radius over distance
  double cubes;              // sides cubed, of all clouds around the eye, before all of them get coarser
};
constexpr double kLeastPx = 12.0;
constexpr int kStepPx = 4;
constexpr Fineness kLiveFineness{64.0, 0.12, 2e6}, kStillFineness{128.0, 0.05, 12e6};
// Clouds close about the eye are finer than their share of those cubes; when they stand so thick that the
// texture would have more rows, all get coarser still.
constexpr int kMostRows = 8192;
constexpr double kCoarser = 0.8;
constexpr int kMostTries = 16;
constexpr PictureFineness kLivePictures{2.0, 4e5}, kStillPictures{1.0, 4e6};
// A picture has a stack of few slices for what shades it, and its own shade by its shape.
constexpr StackSize kShadeSize{8};

// What a cloud has stacks of, beside one another, the last one where there is a second light; and by itself,
// as it is so much coarser, that from the side that the sky is bright on.
enum : int { kFromKey, kFromZenith, kFromEye, kFromSecond, kMostStacks, kFromGlow = kMostStacks };
constexpr StackSize kGlowSize{16};
// Nearer than the one, in radii of a cloud, there is none from the eye; from the other on it counts in full.
constexpr double kEyeStackFrom = 1.15, kEyeStackAll = 1.6, kEyeStackPart = 0.4;  // as pass/splat_light.frag

// How far clouds shade others: fading out over the last third of it.
constexpr double kShadeReachM = 12000.0;

// A ball's light is sampled along as many rays as it needs by its size in view, on a square of so many a
// side.
struct Rays {
  double perPx;     // of its radius beyond the first
  int least, most;  // on the side
  double texels;    // of all balls together, before the largest get fewer
};
constexpr Rays kLiveRays{1.0, 2, 4, 2e6}, kStillRays{2.0, 3, 16, 2e6};
constexpr std::size_t kMostTilePx = 16;
constexpr int kTilesWidthPx = 1024;

// Floats of a ball in all slices of its five stacks and of those that it shades; few balls need more.
constexpr std::size_t kValuesInBall = 230;
// Of what shades a picture.
constexpr std::size_t kValuesInPicture = 600;

// What `add` finds of a cloud's balls: of the two levels that fade into one another, each by itself, as `mix`
// puts them together; nothing where there are no balls.
template <class T, class Add, class Mix>
std::optional<T> mixed(const SplatCloud& cloud, Add&& add, Mix&& mix) {
  std::array<std::optional<T>, 2> found;
  for (std::size_t i = 0; i < cloud.balls.size(); ++i)
    if (drawn(cloud.balls[i])) add(cloud.balls[i], found[i < cloud.coarse ? 0 : 1]);
  if (!found[0] || !found[1]) return found[0] ? found[0] : found[1];
  return mix(*found[1], *found[0], static_cast<double>(cloud.coarseShare));
}

// Grows, never shrinks, so that it settles; to powers of two, so that whatever was drawn before coordinates
// come to the same.
void atLeast(gpu::Texture2D& texture, std::optional<gpu::Framebuffer>& framebuffer, int width, int height,
             gpu::Format format) {
  if (texture.width() >= width && texture.height() >= height) return;
  const int tall = static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(height, texture.height()))));
  framebuffer.reset();
  texture = gpu::Texture2D(width, tall, {.format = format});
  framebuffer.emplace(texture);
}

const Fineness& finenessOf(SplatDetail detail) {
  return detail == SplatDetail::kStill ? kStillFineness : kLiveFineness;
}
int stacksWidthOf(const Fineness& fineness) {
  return kMostStacks * StackSize{static_cast<int>(fineness.mostPx)}.width();
}
double finePx(const Fineness& fineness, double share) {
  return fineness.mostPx * std::sqrt(share / fineness.mostShare);
}

}  // namespace

struct SplatPass::Block {
  std::uint32_t cloud = 0;
  glm::dvec3 centreM{0.0};   // from the eye
  float share = 0.0f;        // radius over distance
  double finePx = kLeastPx;  // used of a slice's side
  StackSize size;
  int x = 0, y = 0;
  int pitchPx = 0;                                    // from a stack to the next
  std::array<float, 2 * (kMostStacks + 1)> halves{};  // half side and half depth of each stack
};

SplatPass::SplatPass(SplatDetail detail)
    : detail_(detail),
      depth_(graphicsProgram("pass/splat_depth.vert", "pass/splat_depth.frag")),
      pictures_(detail == SplatDetail::kStill ? kStillPictures : kLivePictures) {
  for (std::size_t i = 0; i < lightPrograms_.size(); ++i) {
    shading::ShaderDefines defines;
    if (i == 1) defines.emplace_back("WELKIN_SECOND_LIGHT", "1");
    lightPrograms_[i] = graphicsProgram("pass/splat_light.vert", "pass/splat_light.frag", defines);
  }
  for (std::size_t i = 0; i < eye_.size(); ++i) {
    shading::ShaderDefines defines;
    if (i & 1) defines.emplace_back("WELKIN_DISTANCE", "1");
    if (i & 2) defines.emplace_back("WELKIN_ENGINE_DEPTH", "1");
    eye_[i] = graphicsProgram("pass/splat.vert", "pass/splat.frag", defines);
  }
}

SplatPass::~SplatPass() = default;

void SplatPass::reserve(std::size_t clouds, std::size_t balls,
                        std::span<const scene::LibraryCloud* const> shapes) {
  blocks_.reserve(clouds);
  glows_.reserve(clouds);
  shades_.reserve(clouds);
  pictures_.reserve(clouds, shapes);
  wholes_.reserve(clouds);
  bySize_.reserve(clouds);
  pieces_.reserve(balls);
  order_.reserve(balls);
  distances_.reserve(balls);
  tileOf_.reserve(balls);
  values_.reserve(kValuesInBall * balls + kValuesInPicture * clouds);
}

void SplatPass::setSky(const shading::Uniforms& sky, const shading::SplatLights& lights) {
  lights_ = lights;
  setUniforms(lightProgram(), sky);
  pictures_.setSky(sky, lights);
}

// The clouds in view, and a block of the stacks' texture for each.
void SplatPass::findBlocks(std::span<const SplatCloud> clouds, const shading::ViewParts& view) {
  const ViewCone cone = coneOf(view);
  blocks_.clear();
  shades_.clear();
  pictures_.clear();
  wholes_.clear();
  bySize_.clear();
  const Fineness& fineness = finenessOf(detail_);
  const auto cube = [&](double px) { return std::pow(std::clamp(px, kLeastPx, fineness.mostPx), 3.0); };
  double cubes = 0.0;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const scene::CloudBalls::Far& far = clouds[i].far;
    if (far.share > 0.0f) {
      const SplatPictures::Bounds bounds = pictures_.boundsOf(far, view.eyeM);
      if (mayBeSeen(cone, bounds.centreM, bounds.radiusM)) {
        pictures_.add(far, view.eyeM);
        Block& shade = shades_.emplace_back();
        shade.cloud = static_cast<std::uint32_t>(i);
        shade.centreM = bounds.centreM;
        shade.size = kShadeSize;
        shade.pitchPx = kShadeSize.sidePx;
        shade.halves[0] = static_cast<float>(bounds.radiusM);
        shade.halves[1] = 2.0f * shade.halves[0];
        pictures_.all().back().shadeHalves = {shade.halves[0], shade.halves[1]};
      }
      if (far.share >= 1.0f) {
        wholes_.push_back({bounds.centreM, bounds.radiusM});
        continue;
      }
    }
    const std::optional<field::Box> box = mixed<field::Box>(
        clouds[i],
        [](const field::Metaball& b, std::optional<field::Box>& all) {
          const field::Box own{b.centreM - b.radiusM, b.centreM + b.radiusM};
          all = all ? field::Box{glm::min(all->low, own.low), glm::max(all->high, own.high)} : own;
        },
        [](const field::Box& fine, const field::Box& coarse, double share) {
          return field::Box{glm::mix(fine.low, coarse.low, share), glm::mix(fine.high, coarse.high, share)};
        });
    if (!box) {
      wholes_.push_back({glm::dvec3(0.0), 0.0});
      continue;
    }
    const glm::dvec3 centreM = 0.5 * (box->low + box->high) - view.eyeM;
    const double radiusM = 0.5 * glm::length(box->high - box->low);
    const double share = radiusM / std::max(glm::length(centreM), 1e-3);
    wholes_.push_back({centreM, radiusM});
    cubes += static_cast<double>(1.0f - far.share) * cube(finePx(fineness, share));
    if (!mayBeSeen(cone, centreM, radiusM)) continue;
    Block& block = blocks_.emplace_back();
    block.cloud = static_cast<std::uint32_t>(i);
    block.centreM = centreM;
    block.share = static_cast<float>(share);
    bySize_.push_back(static_cast<std::uint32_t>(blocks_.size() - 1));
  }
  double coarser = std::cbrt(std::min(fineness.cubes / std::max(cubes, 1.0), 1.0));
  // The largest first.
  std::sort(bySize_.begin(), bySize_.end(), [this](std::uint32_t a, std::uint32_t b) {
    return blocks_[a].share != blocks_[b].share ? blocks_[a].share > blocks_[b].share : a < b;
  });
  int rows = placeBlocks(coarser);
  for (int i = 0; i < kMostTries && rows > kMostRows; ++i) rows = placeBlocks(coarser *= kCoarser);
  stacksHeight_ = std::max(rows, 1);
  const int stacksWidth = stacksWidthOf(fineness);
  atLeast(depths_, toDepths_, stacksWidth, stacksHeight_, gpu::Format::kRgba32F);
}

// Gives each block its texels, that part of those that its size in view asks for; returns the rows.
int SplatPass::placeBlocks(double coarser) {
  const Fineness& fineness = finenessOf(detail_);
  const int stacks = lights_.toSecond ? kMostStacks : kFromSecond;
  const int stacksWidth = stacksWidthOf(fineness);
  int row = 0, x = 0;
  StackSize last;
  for (const std::uint32_t i : bySize_) {
    Block& b = blocks_[i];
    b.finePx =
        std::clamp(coarser * finePx(fineness, static_cast<double>(b.share)), kLeastPx, fineness.mostPx);
    b.size.sidePx = kStepPx * static_cast<int>(std::ceil(b.finePx / kStepPx));
    if (b.size.sidePx != last.sidePx || x + stacks * b.size.width() > stacksWidth) {
      if (x > 0) row += last.height();
      x = 0;
    }
    last = b.size;
    b.x = x, b.y = row;
    b.pitchPx = b.size.width();
    x += stacks * b.pitchPx;
  }
  if (x > 0) row += last.height();
  x = 0;
  glows_.clear();
  for (const Block& b : blocks_) {
    Block& glow = glows_.emplace_back(b);
    glow.size = kGlowSize;
    glow.finePx = kGlowSize.sidePx;
    glow.pitchPx = 0;
    glow.x = x, glow.y = row;
    x += kGlowSize.width();
    if (x + kGlowSize.width() <= stacksWidth && glows_.size() < blocks_.size()) continue;
    row += kGlowSize.height();
    x = 0;
  }
  const int shadeWidth = (lights_.toSecond ? 2 : 1) * kShadeSize.sidePx;
  for (std::size_t i = 0; i < shades_.size(); ++i) {
    shades_[i].x = x, shades_[i].y = row;
    pictures_.all()[i].shade = {x, row};
    x += shadeWidth;
    if (x + shadeWidth <= stacksWidth && i + 1 < shades_.size()) continue;
    row += kShadeSize.sidePx;
    x = 0;
  }
  return row;
}

// What a cloud's balls add to the slices of a stack.
void SplatPass::addStack(const SplatCloud& cloud, const glm::dvec3& eyeM, const glm::dmat3& axes, int beside,
                         Block& block) {
  const StackSize& own = block.size;
  const double centreM = glm::length(block.centreM);
  const bool perspective = beside == kFromEye;
  // Of a ball: across, upward, away; and the scale of the picture there.
  const auto along = [&](const field::Metaball& b) {
    const glm::dvec3 at = (b.centreM - eyeM - block.centreM) * axes;
    const double scale = perspective ? centreM / std::max(centreM + at.z, 0.1 * centreM) : 1.0;
    return glm::dvec4(at.x * scale, at.y * scale, at.z, scale);
  };
  const glm::dvec2 reach = *mixed<glm::dvec2>(
      cloud,
      [&](const field::Metaball& b, std::optional<glm::dvec2>& all) {
        const glm::dvec4 at = glm::abs(along(b));
        all = glm::max(all.value_or(glm::dvec2(0.0)),
                       glm::dvec2(std::max(at.x, at.y) + at.w * b.radiusM, at.z + b.radiusM));
      },
      [](const glm::dvec2& fine, const glm::dvec2& coarse, double share) {
        return glm::mix(fine, coarse, share);
      });
  // A margin for what balls that are smaller than a texel are widened, and for filtering.
  const double texelM = 2.0 * reach.x / (block.finePx - 4.0);
  const double half = 0.5 * texelM * (own.sidePx - 2.0);
  // The first slice towards a light is for what shades the cloud from farther away.
  const double sliceM = 2.0 * (reach.y + texelM) /
                        (0.5 * block.finePx - (beside == kFromKey || beside == kFromSecond ? 2.0 : 0.0));
  const double halfDepth = 0.5 * sliceM * own.slices();
  block.halves[static_cast<std::size_t>(2 * beside)] = static_cast<float>(half);
  block.halves[static_cast<std::size_t>(2 * beside + 1)] = static_cast<float>(halfDepth);
  for (const field::Metaball& b : cloud.balls) {
    if (!drawn(b)) continue;
    const glm::dvec4 at = along(b);
    addSlices(block, beside, {at.x, at.y, at.z + halfDepth, at.w * b.radiusM, b.radiusM, b.density}, texelM,
              sliceM);
  }
}

// A ball in the slices from its own on; z: from the stack's front. What is in front of the stack counts from
// its first slice on.
void SplatPass::addSlices(const Block& block, int beside, const InStack& ball, double texelM, double sliceM) {
  const StackSize& own = block.size;
  // So that no ball falls between texels; it keeps its mass.
  const double wider = std::max(texelM / ball.seenM, 1.0), radiusM = ball.radiusM * wider;
  const int first = std::max(static_cast<int>((ball.z - radiusM) / sliceM), 0);
  const double depth = ball.density * radiusM / (wider * wider * wider);
  const double px = 0.5 * own.sidePx + ball.x / texelM, py = 0.5 * own.sidePx + ball.y / texelM;
  for (int four = first / 4; four < own.fours(); ++four) {
    // Its tile, which it may not leave: see pass/splat_depth.vert.
    const int left = block.x + beside * block.pitchPx + own.sidePx * (four % own.columns()),
              lower = block.y + own.sidePx * (four / own.columns());
    values_.insert(values_.end(), {static_cast<float>(left + px), static_cast<float>(lower + py),
                                   static_cast<float>(wider * ball.seenM / texelM), static_cast<float>(depth),
                                   static_cast<float>(((4 * four + 1) * sliceM - ball.z) / radiusM),
                                   static_cast<float>(sliceM / radiusM),
                                   static_cast<float>(256 * left + own.sidePx), static_cast<float>(lower)});
  }
}

// What other clouds' balls add to the stack of a light: those in front of it to its first slice. place: which
// stack of the block it is.
void SplatPass::addShades(std::span<const SplatCloud> clouds, const glm::dvec3& eyeM, const glm::dmat3& axes,
                          int place, const Block& block) {
  const auto half = static_cast<double>(block.halves[static_cast<std::size_t>(2 * place)]),
             halfDepthM = static_cast<double>(block.halves[static_cast<std::size_t>(2 * place + 1)]);
  const double texelM = 2.0 * half / (block.size.sidePx - 2.0),
               sliceM = 2.0 * halfDepthM / block.size.slices();
  for (std::size_t c = 0; c < clouds.size(); ++c) {
    const Whole& whole = wholes_[c];
    if (c == block.cloud || whole.radiusM <= 0.0) continue;
    const glm::dvec3 middle = (whole.centreM - block.centreM) * axes;
    const double aheadM = -middle.z - halfDepthM;  // of the stack
    if (std::max(std::abs(middle.x), std::abs(middle.y)) > half + whole.radiusM || aheadM > kShadeReachM ||
        middle.z > halfDepthM + whole.radiusM)
      continue;
    const double share = 1.0 - glm::smoothstep(2.0 / 3.0, 1.0, aheadM / kShadeReachM);
    for (const field::Metaball& b : clouds[c].shades()) {
      if (!drawn(b)) continue;
      const glm::dvec3 at = (b.centreM - eyeM - block.centreM) * axes;
      if (std::max(std::abs(at.x), std::abs(at.y)) > half + b.radiusM) continue;
      addSlices(block, place, {at.x, at.y, at.z + halfDepthM, b.radiusM, b.radiusM, share * b.density},
                texelM, sliceM);
    }
  }
}

void SplatPass::drawStacks(std::span<const SplatCloud> clouds, const glm::dvec3& eyeM) {
  const glm::dmat3 key = axesOf(lights_.toKey), zenith = axesOf({0.0, 0.0, 1.0}),
                   glow = axesOf(lights_.toGlow), second = axesOf(lights_.toSecond.value_or(lights_.toKey));
  values_.clear();
  for (Block& b : glows_) addStack(clouds[b.cloud], eyeM, glow, kFromGlow, b);
  for (Block& b : blocks_) {
    const SplatCloud& cloud = clouds[b.cloud];
    addStack(cloud, eyeM, key, kFromKey, b);
    addShades(clouds, eyeM, key, kFromKey, b);
    addStack(cloud, eyeM, zenith, kFromZenith, b);
    b.halves[2 * kFromEye] = b.halves[2 * kFromEye + 1] = 0.0f;
    if (b.share * kEyeStackFrom < 1.0) addStack(cloud, eyeM, axesOf(-b.centreM), kFromEye, b);
    if (!lights_.toSecond) continue;
    addStack(cloud, eyeM, second, kFromSecond, b);
    addShades(clouds, eyeM, second, kFromSecond, b);
  }
  for (Block& shade : shades_) {
    addShades(clouds, eyeM, key, 0, shade);
    if (!lights_.toSecond) continue;
    shade.halves[2] = shade.halves[0], shade.halves[3] = shade.halves[1];
    addShades(clouds, eyeM, second, 1, shade);
  }
  inSlices_.upload(values_);
  const gpu::Tile area{0, 0, depths_.width(), stacksHeight_};
  depth_.set("uPerTexel", 1.0f / glm::vec2(area.width, area.height));
  toDepths_->clear();
  inSlices_.draw(depth_, {toDepths_->id(), area}, {.blend = gpu::Blend::kAdd});
  gpu::Program& light = lightProgram();
  light.set("uSunStack", glm::mat3(key));
  light.set("uSkyStack", glm::mat3(zenith));
  light.set("uGlowStack", glm::mat3(glow));
  light.set("uSecondStack", glm::mat3(second));
  if (lights_.toSecond) light.set("uSecondDirection", *lights_.toSecond);
}

void SplatPass::addPieces(std::span<const SplatCloud> clouds, const glm::dvec3& eyeM) {
  pieces_.clear();
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const SplatCloud& cloud = clouds[blocks_[i].cloud];
    for (const field::Metaball& b : cloud.balls)
      if (drawn(b))
        pieces_.push_back({glm::vec3(b.centreM - eyeM), static_cast<float>(b.radiusM),
                           static_cast<float>(b.density), static_cast<std::uint32_t>(i)});
  }
  const std::span<const SplatPictures::Picture> pictures = pictures_.all();
  for (std::size_t i = 0; i < pictures.size(); ++i)
    pieces_.push_back(
        {pictures[i].centreM, pictures[i].radiusM, 0.0f, kPicture | static_cast<std::uint32_t>(i)});
}

// A ball's distance is that of a place in its front half, which is what is seen of it; a picture's, that of
// the cloud's front, before its balls.
void SplatPass::sort() {
  distances_.resize(pieces_.size());
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    distances_[i] =
        glm::length(pieces_[i].centreM) - (pieces_[i].block & kPicture ? 1.0f : 0.5f) * pieces_[i].radiusM;
  order_.sort(distances_);
}

// A tile for each ball, those of one size in rows of their own.
void SplatPass::findTiles(double pixelRad) {
  const Rays& rays = detail_ == SplatDetail::kStill ? kStillRays : kLiveRays;
  std::array<std::size_t, kMostTilePx + 1> counts{};
  tileOf_.resize(pieces_.size());
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const double centreM = std::max(static_cast<double>(glm::length(pieces_[i].centreM)), 1e-3);
    const double radiusPx = static_cast<double>(pieces_[i].radiusM) / (centreM * pixelRad);
    const int side = static_cast<int>(std::ceil(std::min(rays.perPx * (radiusPx - 1.0), 1e3)));
    tileOf_[i].z = static_cast<float>(std::clamp(side, rays.least, rays.most));
    if (pieces_[i].block & kPicture) continue;
    ++counts[static_cast<std::size_t>(tileOf_[i].z)];
  }
  int most = rays.most;
  for (; most > rays.least; --most) {
    double texels = 0.0;
    for (int side = rays.least; side <= rays.most; ++side)
      texels +=
          std::pow(std::min(side, most), 2.0) * static_cast<double>(counts[static_cast<std::size_t>(side)]);
    if (texels <= rays.texels) break;
  }
  for (int side = most + 1; side <= rays.most; ++side) {
    std::size_t& count = counts[static_cast<std::size_t>(side)];
    counts[static_cast<std::size_t>(most)] += count;
    count = 0;
  }
  std::array<glm::ivec2, kMostTilePx + 1> next{};
  tilesHeight_ = 0;
  for (int side = rays.least; side <= most; ++side) {
    next[static_cast<std::size_t>(side)] = {0, tilesHeight_};
    const int inRow = kTilesWidthPx / side, count = static_cast<int>(counts[static_cast<std::size_t>(side)]);
    tilesHeight_ += side * ((count + inRow - 1) / inRow);
  }
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (pieces_[i].block & kPicture) continue;
    glm::vec3& tile = tileOf_[i];
    const int side = std::min(static_cast<int>(tile.z), most);
    glm::ivec2& at = next[static_cast<std::size_t>(side)];
    tile = {at.x, at.y, side};
    at.x += side;
    if (at.x + side > kTilesWidthPx) at = {0, at.y + side};
  }
  tilesHeight_ = pictures_.findTiles(pixelRad, kTilesWidthPx, tilesHeight_);
}

void SplatPass::drawLight(const shading::ViewParts& view, const SkyTextures& tables) {
  atLeast(tiles_, toTiles_, kTilesWidthPx, tilesHeight_, gpu::Format::kRgba32F);
  gpu::Program& light = lightProgram();
  light.set("uPerTexel", 1.0f / glm::vec2(kTilesWidthPx, tilesHeight_));
  light.set("uEyeM", static_cast<float>(view.eyeM.z));
  light.set("uEnuFromCamera", view.enuFromCamera);
  light.set("uRayScale", view.rayScale);
  tables.bind(light);
  light.bind("uDepths", depths_);
  const gpu::Target tiles(toTiles_->id(), {0, 0, kTilesWidthPx, tilesHeight_});
  // A fetch at a tile's edge has some 1e-4 of the texel beside it, which is not to be an earlier frame's.
  toTiles_->clear();
  inTiles_.draw(light, tiles, {});
  pictures_.draw(view, tables, {depths_, kShadeSize.sidePx}, tiles);
}

void SplatPass::drawBalls(const shading::ViewParts& view, const SplatTarget& to) {
  gpu::Program& p = eye_[(to.distance ? 1u : 0u) + (to.depth.texture != 0 ? 2u : 0u)];
  p.set("uPerTexel", 1.0f / glm::vec2(tiles_.width(), tiles_.height()));
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

void SplatPass::draw(std::span<const SplatCloud> clouds, const shading::ViewParts& view,
                     const SkyTextures& tables, const SplatTarget& to) {
  findBlocks(clouds, view);
  if (blocks_.empty() && shades_.empty()) return;
  drawStacks(clouds, view.eyeM);
  addPieces(clouds, view.eyeM);
  sort();
  findTiles(static_cast<double>(view.pixelRad));
  values_.clear();
  for (const std::uint32_t i : order_.order()) {
    const Piece& b = pieces_[i];
    if (b.block & kPicture) continue;
    const glm::vec3& tile = tileOf_[i];
    const Block &block = blocks_[b.block], &glow = glows_[b.block];
    const SplatCloud& cloud = clouds[block.cloud];
    const glm::vec3 centre(block.centreM);
    const double radii = 1.0 / std::max(static_cast<double>(block.share), 1e-9);
    // With the phase function, whose number is whole, how much the stack from the eye counts.
    const auto eyeStack =
        static_cast<float>(kEyeStackPart * glm::smoothstep(kEyeStackFrom, kEyeStackAll, radii));
    values_.insert(values_.end(), {b.centreM.x,
                                   b.centreM.y,
                                   b.centreM.z,
                                   b.radiusM,
                                   b.density,
                                   static_cast<float>(cloud.phase) + eyeStack,
                                   cloud.albedo,
                                   static_cast<float>(glow.x),
                                   centre.x,
                                   centre.y,
                                   centre.z,
                                   block.halves[2 * kFromEye],
                                   block.halves[2 * kFromKey],
                                   block.halves[2 * kFromKey + 1],
                                   block.halves[2 * kFromZenith],
                                   block.halves[2 * kFromZenith + 1],
                                   glow.halves[2 * kFromGlow],
                                   glow.halves[2 * kFromGlow + 1],
                                   block.halves[2 * kFromSecond],
                                   block.halves[2 * kFromSecond + 1],
                                   static_cast<float>(block.x),
                                   static_cast<float>(block.y),
                                   static_cast<float>(block.size.sidePx),
                                   block.halves[2 * kFromEye + 1],
                                   tile.x,
                                   tile.y,
                                   tile.z,
                                   static_cast<float>(glow.y)});
  }
  inTiles_.upload(values_);
  drawLight(view, tables);
  values_.clear();
  for (const std::uint32_t i : order_.order()) {
    const Piece& b = pieces_[i];
    if (b.block & kPicture) {
      const SplatPictures::Picture& p = pictures_.all()[b.block & ~kPicture];
      values_.insert(values_.end(), {b.centreM.x, b.centreM.y, b.centreM.z, b.radiusM, p.texelM,
                                     static_cast<float>(p.corner.x), static_cast<float>(p.corner.y),
                                     -static_cast<float>(1024 * p.texels.x + p.texels.y)});
      continue;
    }
    const glm::vec3& tile = tileOf_[i];
    const float share = 1.0f - clouds[blocks_[b.block].cloud].far.share;
    values_.insert(values_.end(), {b.centreM.x, b.centreM.y, b.centreM.z, b.radiusM, share * b.density,
                                   tile.x, tile.y, tile.z});
  }
  quads_.upload(values_);
  drawBalls(view, to);
}

}  // namespace welkin::render
