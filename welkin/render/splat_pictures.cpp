// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/splat_pictures.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "welkin/render/programs.h"
#include "welkin/render/splat_cloud.h"

namespace welkin::render {
namespace {

constexpr int kGridPoints = 64;   // on the side of a shape's grid: some five in the radius of a ball
constexpr int kSoft = 3;          // points on either side that light from the sky comes through
constexpr int kCoarse = 4;        // points between those at which distances are known
constexpr int kMostTexels = 255;  // across a picture, odd
constexpr std::size_t kFloatsInTile = 24;

// A mean over the points around, across and along x or y: of what skylight comes through.
void soften(Volume<float>& grid, int channel, bool alongX) {
  std::array<float, kGridPoints + 1> sums{};
  for (int z = 0; z < kGridPoints; ++z)
    for (int j = 0; j < kGridPoints; ++j) {
      const auto value = [&](int i) -> float& {
        return alongX ? grid.at(i, j, z, channel) : grid.at(j, i, z, channel);
      };
      for (int i = 0; i < kGridPoints; ++i)
        sums[static_cast<std::size_t>(i + 1)] = sums[static_cast<std::size_t>(i)] + value(i);
      for (int i = 0; i < kGridPoints; ++i) {
        const int end = std::min(i + kSoft + 1, kGridPoints), begin = std::max(i - kSoft, 0);
        value(i) = (sums[static_cast<std::size_t>(end)] - sums[static_cast<std::size_t>(begin)]) /
                   (2.0f * kSoft + 1.0f);
      }
    }
}

// The field of a cloud's finest balls, how much of it is above and below each point, and how far the next
// ball is.
Volume<float> gridOf(const scene::LibraryCloud& cloud, const field::Box& box) {
  const glm::dvec3 step = (box.high - box.low) / (kGridPoints - 1.0);
  const Volume<float> density =
      field::rasterise(cloud.levels.back(), {kGridPoints, kGridPoints, kGridPoints, step, box.low});
  Volume<float> grid(kGridPoints, kGridPoints, kGridPoints, 4);
  const auto half = static_cast<float>(0.5 * step.z);
  const auto at = [&](int x, int y, int z) { return std::max(density.at(x, y, z), 0.0f); };
  for (int y = 0; y < kGridPoints; ++y)
    for (int x = 0; x < kGridPoints; ++x) {
      float above = 0.0f, below = 0.0f;
      for (int z = 0; z < kGridPoints; ++z) {
        if (z > 0) below += half * (at(x, y, z - 1) + at(x, y, z));
        grid.at(x, y, z, 0) = at(x, y, z);
        grid.at(x, y, z, 2) = below;
      }
      for (int z = kGridPoints - 1; z >= 0; --z) {
        if (z < kGridPoints - 1) above += half * (at(x, y, z + 1) + at(x, y, z));
        grid.at(x, y, z, 1) = above;
      }
    }
  for (const int channel : {1, 2})
    for (const bool alongX : {true, true, false, false}) soften(grid, channel, alongX);
  // Distances from every few points, and how far those are at most.
  const double inexact = kCoarse * glm::length(step);
  for (int z = 0; z < kGridPoints; z += kCoarse)
    for (int y = 0; y < kGridPoints; y += kCoarse)
      for (int x = 0; x < kGridPoints; x += kCoarse) {
        const glm::dvec3 p = box.low + step * glm::dvec3(x, y, z);
        double nearest = std::numeric_limits<double>::max();
        for (const field::Metaball& b : cloud.levels.back())
          nearest = std::min(nearest, glm::length(p - b.centreM) - b.radiusM);
        const auto clear = static_cast<float>(std::max(nearest - inexact, 0.0));
        for (int k = 0; k < kCoarse * kCoarse * kCoarse; ++k)
          grid.at(x + k % kCoarse, y + k / kCoarse % kCoarse, z + k / (kCoarse * kCoarse), 3) = clear;
      }
  return grid;
}

// From a cloud's frame to the world's.
glm::dvec3 turned(const glm::dvec3& p, double turnRad) {
  const double c = std::cos(turnRad), s = std::sin(turnRad);
  return {c * p.x + s * p.y, c * p.y - s * p.x, p.z};
}

}  // namespace

SplatPictures::SplatPictures(const PictureFineness& fineness) : fineness_(fineness) {
  for (std::size_t i = 0; i < lightPrograms_.size(); ++i) {
    shading::ShaderDefines defines;
    if (i == 1) defines.emplace_back("WELKIN_SECOND_LIGHT", "1");
    lightPrograms_[i] = graphicsProgram("pass/splat_picture.vert", "pass/splat_picture.frag", defines);
  }
}

void SplatPictures::reserve(std::size_t pictures, std::span<const scene::LibraryCloud* const> shapes) {
  pictures_.reserve(pictures);
  byHeight_.reserve(pictures);
  values_.reserve(kFloatsInTile * pictures);
  for (const scene::LibraryCloud* shape : shapes) shapeOf(*shape);
  if (!shapes.empty()) fillGrids();
}

void SplatPictures::setSky(const shading::Uniforms& sky, const shading::SplatLights& lights) {
  lights_ = lights;
  gpu::Program& light = lightProgram();
  setUniforms(light, sky);
  light.set("uSunStack", glm::mat3(axesOf(lights.toKey)));
  light.set("uGlowStack", glm::mat3(axesOf(lights.toGlow)));
  if (!lights.toSecond) return;
  light.set("uSecondStack", glm::mat3(axesOf(*lights.toSecond)));
  light.set("uSecondDirection", *lights.toSecond);
}

std::size_t SplatPictures::shapeOf(const scene::LibraryCloud& cloud) {
  const auto known = std::ranges::find(shapes_, &cloud, &Shape::cloud);
  if (known != shapes_.end()) return static_cast<std::size_t>(known - shapes_.begin());
  const field::Box box = field::boundsOf(cloud.levels.back());
  shapes_.push_back({&cloud, 0.5 * (box.low + box.high), 0.5 * (box.high - box.low)});
  gridsKnow_ = false;
  return shapes_.size() - 1;
}

void SplatPictures::fillGrids() {
  if (gridsKnow_) return;
  gridsKnow_ = true;
  // A power of two, so that coordinates come to the same whatever shapes come to be known.
  columns_ = static_cast<int>(std::bit_ceil(shapes_.size()));
  Volume<float> all(columns_ * kGridPoints, kGridPoints, kGridPoints, 4);
  for (int i = 0; i < static_cast<int>(shapes_.size()); ++i) {
    const Shape& shape = shapes_[static_cast<std::size_t>(i)];
    const Volume<float> own = gridOf(*shape.cloud, {shape.middle - shape.half, shape.middle + shape.half});
    for (int z = 0; z < kGridPoints; ++z)
      for (int y = 0; y < kGridPoints; ++y)
        for (int x = 0; x < kGridPoints; ++x)
          for (int k = 0; k < 4; ++k) all.at(i * kGridPoints + x, y, z, k) = own.at(x, y, z, k);
  }
  grids_ = gpu::Texture3D(all, {.format = gpu::Format::kRgba16F});
}

SplatPictures::Bounds SplatPictures::boundsOf(const scene::CloudBalls::Far& cloud, const glm::dvec3& eyeM) {
  const Shape& shape = shapes_[shapeOf(*cloud.shape)];
  return {cloud.placed.baseM + cloud.placed.widthM * turned(shape.middle, cloud.placed.turnRad) - eyeM,
          cloud.placed.widthM * glm::length(shape.half)};
}

void SplatPictures::add(const scene::CloudBalls::Far& cloud, const glm::dvec3& eyeM) {
  const Bounds bounds = boundsOf(cloud, eyeM);
  const Shape& shape = shapes_[shapeOf(*cloud.shape)];
  // As lib/splat_ray.glsl has the frame of a ball.
  const double distanceM = glm::length(bounds.centreM);
  const glm::dvec3 forward = bounds.centreM / distanceM;
  const glm::dvec3 right = glm::normalize(
      glm::cross(forward, std::abs(forward.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0)));
  const glm::dvec3 up = glm::cross(right, forward);
  // What is nearer than the middle is larger in view.
  const auto along = [&](const glm::dvec3& axis) {
    return cloud.placed.widthM * glm::dot(glm::abs(turned(axis, -cloud.placed.turnRad)), shape.half);
  };
  const double larger = distanceM / std::max(distanceM - along(forward), 0.5 * distanceM);
  Picture& p = pictures_.emplace_back();
  p.cloud = cloud;
  p.centreM = bounds.centreM;
  p.radiusM = static_cast<float>(along(forward));
  p.halfRightM = larger * along(right);
  p.halfUpM = larger * along(up);
}

int SplatPictures::findTiles(double pixelRad, int widthPx, int row) {
  const auto size = [&](Picture& p, double coarser) {
    const double distanceM = static_cast<double>(glm::length(p.centreM));
    const double texelM = std::max(coarser * fineness_.texelPx * pixelRad * distanceM,
                                   2.0 * std::max(p.halfRightM, p.halfUpM) / (kMostTexels - 3.0));
    const auto odd = [&](double halfM) { return 2 * static_cast<int>(std::ceil(halfM / texelM)) + 1; };
    p.texelM = static_cast<float>(texelM);
    p.texels = {odd(p.halfRightM), odd(p.halfUpM)};
    return 4.0 * p.halfRightM * p.halfUpM / (texelM * texelM);
  };
  double texels = 0.0;
  for (Picture& p : pictures_) texels += size(p, 1.0);
  if (texels > fineness_.texels)
    for (Picture& p : pictures_) size(p, std::sqrt(texels / fineness_.texels));
  byHeight_.clear();
  for (std::uint32_t i = 0; i < pictures_.size(); ++i) byHeight_.push_back(i);
  std::sort(byHeight_.begin(), byHeight_.end(), [this](std::uint32_t a, std::uint32_t b) {
    const int high = pictures_[a].texels.y, other = pictures_[b].texels.y;
    return high != other ? high > other : a < b;
  });
  int x = 0, height = 0;
  for (const std::uint32_t i : byHeight_) {
    Picture& p = pictures_[i];
    if (x + p.texels.x > widthPx) {
      row += height;
      x = height = 0;
    }
    p.corner = {x, row};
    x += p.texels.x;
    height = std::max(height, p.texels.y);
  }
  return row + height;
}

void SplatPictures::draw(const shading::ViewParts& view, const SkyTextures& tables, const Light& light,
                         const gpu::Target& to) {
  if (pictures_.empty()) return;
  fillGrids();
  values_.clear();
  for (const Picture& p : pictures_) {
    const scene::MetaballLayer::Cloud& placed = p.cloud.placed;
    const std::size_t number = shapeOf(*p.cloud.shape);
    const glm::vec3 half(shapes_[number].half);
    const double depth = placed.extinctionPerM * placed.widthM;
    values_.insert(values_.end(), {p.centreM.x,
                                   p.centreM.y,
                                   p.centreM.z,
                                   static_cast<float>(placed.widthM),
                                   half.x,
                                   half.y,
                                   half.z,
                                   static_cast<float>(number),
                                   static_cast<float>(std::cos(placed.turnRad)),
                                   static_cast<float>(std::sin(placed.turnRad)),
                                   static_cast<float>(depth),
                                   p.cloud.share,
                                   static_cast<float>(p.corner.x),
                                   static_cast<float>(p.corner.y),
                                   static_cast<float>(p.texels.x),
                                   static_cast<float>(p.texels.y),
                                   p.shadeHalves.x,
                                   p.shadeHalves.y,
                                   static_cast<float>(p.shade.x),
                                   static_cast<float>(p.shade.y),
                                   p.texelM,
                                   static_cast<float>(light.shadePx),
                                   0.0f,
                                   0.0f});
  }
  tiles_.upload(values_);
  gpu::Program& program = lightProgram();
  program.set("uPerTexel", 1.0f / glm::vec2(to.area.width, to.area.height));
  program.set("uEyeM", static_cast<float>(view.eyeM.z));
  program.set("uEnuFromCamera", view.enuFromCamera);
  program.set("uRayScale", view.rayScale);
  program.set("uShapePoints", glm::vec2(kGridPoints, columns_));
  tables.bind(program);
  program.bind("uDepths", light.depths);
  program.bind("uShapes", grids_);
  tiles_.draw(program, to, {});
}

}  // namespace welkin::render
