// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/metaballs.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include "welkin/core/error.h"
#include "welkin/core/glsl.h"
#include "welkin/core/parallel.h"
#include "welkin/field/metaball_grid.h"

namespace welkin::field {
namespace {

// Shared with the GPU.
using namespace welkin::glsl;
#include "shaders/lib/splat.glsl"

constexpr int kSlabSlices = 4;
constexpr int kMostBins = 64;  // on an axis

constexpr double kMostM = 1e15, kMostDensity = 1e30;

}  // namespace

double columnAlong(const Metaball& ball, const glm::dvec3& from, const glm::dvec3& direction) {
  const glm::dvec3 to = ball.centreM - from;
  const double along = glm::dot(to, direction), aside2 = glm::dot(to, to) - along * along;
  return ball.density * ball.radiusM *
         static_cast<double>(splatColumn(static_cast<float>(aside2 / (ball.radiusM * ball.radiusM)),
                                         static_cast<float>(-along / ball.radiusM), 1.0f));
}

double integralOf(std::span<const Metaball> balls) {
  double sum = 0.0;
  for (const Metaball& b : balls) sum += b.density * b.radiusM * b.radiusM * b.radiusM;
  return kWyvillIntegral * sum;
}

double medianRadiusOf(std::span<const Metaball> balls) {
  std::vector<double> radii;
  radii.reserve(balls.size());
  for (const Metaball& b : balls) radii.push_back(b.radiusM);
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return *middle;
}

Box boundsOf(std::span<const Metaball> balls) {
  if (balls.empty()) return {glm::dvec3(0.0), glm::dvec3(0.0)};
  Box box{glm::dvec3(std::numeric_limits<double>::max()), glm::dvec3(std::numeric_limits<double>::lowest())};
  for (const Metaball& b : balls) {
    box.low = glm::min(box.low, b.centreM - b.radiusM);
    box.high = glm::max(box.high, b.centreM + b.radiusM);
  }
  return box;
}

void validate(std::span<const Metaball> balls) {
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Metaball& b = balls[i];
    const auto fail = [&](const std::string& what, double value, const char* expected) {
      std::ostringstream text;
      text << "ball " << i << ": the " << what << " is " << value << "; expected " << expected;
      throw ParameterError(text.str());
    };
    for (int a = 0; a < 3; ++a)
      if (!(std::abs(b.centreM[a]) <= kMostM))
        fail(std::string("centre's ") + "xyz"[a], b.centreM[a], "a number within 1e15 m of 0");
    if (!(b.radiusM > 0.0 && b.radiusM <= kMostM))
      fail("radius", b.radiusM, "a positive number up to 1e15 m");
    if (!(std::abs(b.density) <= kMostDensity)) fail("density", b.density, "a number from -1e30 to 1e30");
  }
}

MetaballField::MetaballField(std::vector<Metaball> balls) : balls_(std::move(balls)) {
  validate(balls_);
  if (balls_.empty()) return;
  bounds_ = field::boundsOf(balls_);
  const glm::dvec3 size = bounds_.high - bounds_.low;
  // Bins about half as large as a ball that is neither small nor large.
  const double bin = medianRadiusOf(balls_);
  for (int axis = 0; axis < 3; ++axis) {
    bins_[axis] = static_cast<int>(std::clamp(std::ceil(size[axis] / bin), 1.0, double{kMostBins}));
    perMetre_[axis] = bins_[axis] / size[axis];
  }
  // Counted, then filled, in the order of the balls: sums are the same whatever bin they come from.
  const auto overBins = [this](const auto& each) {
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      const Metaball& b = balls_[i];
      const glm::ivec3 low = binOf(b.centreM - b.radiusM), high = binOf(b.centreM + b.radiusM);
      for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
          for (int x = low.x; x <= high.x; ++x)
            each((static_cast<std::size_t>(z) * bins_.y + y) * bins_.x + x, static_cast<std::uint32_t>(i));
    }
  };
  begins_.assign(static_cast<std::size_t>(bins_.x) * bins_.y * bins_.z + 1, 0);
  overBins([this](std::size_t n, std::uint32_t) { ++begins_[n + 1]; });
  for (std::size_t n = 1; n < begins_.size(); ++n) begins_[n] += begins_[n - 1];
  members_.resize(begins_.back());
  std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
  overBins([&](std::size_t n, std::uint32_t i) { members_[next[n]++] = i; });
}

glm::ivec3 MetaballField::binOf(const glm::dvec3& p) const {
  const glm::dvec3 q = glm::clamp((p - bounds_.low) * perMetre_, glm::dvec3(0.0), glm::dvec3(bins_ - 1));
  return glm::ivec3(q);
}

double MetaballField::operator()(const glm::dvec3& p) const {
  for (int axis = 0; axis < 3; ++axis)
    if (!(p[axis] >= bounds_.low[axis] && p[axis] <= bounds_.high[axis])) return 0.0;
  if (balls_.empty()) return 0.0;
  const glm::ivec3 bin = binOf(p);
  const std::size_t n = (static_cast<std::size_t>(bin.z) * bins_.y + bin.y) * bins_.x + bin.x;
  double sum = 0.0;
  for (std::uint32_t m = begins_[n]; m < begins_[n + 1]; ++m) {
    const Metaball& b = balls_[members_[m]];
    const glm::dvec3 d = p - b.centreM;
    sum += b.density * wyvillOfSquare((d.x * d.x + d.y * d.y + d.z * d.z) / (b.radiusM * b.radiusM));
  }
  return sum;
}

Volume<float> rasterise(std::span<const Metaball> balls, const VoxelFrame& frame) {
  validate(balls);
  Volume<float> volume(frame.nx, frame.ny, frame.nz, 1);
  const int slabs = (frame.nz + kSlabSlices - 1) / kSlabSlices;
  parallelFor(slabs, 1, [&](std::size_t begin, std::size_t end) {
    std::vector<float> padded;
    for (std::size_t slab = begin; slab < end; ++slab) {
      const int z0 = static_cast<int>(slab) * kSlabSlices, z1 = std::min(frame.nz, z0 + kSlabSlices);
      BallGrid grid{frame.nx, frame.ny, z1 - z0, frame.nx + kRowPadding, frame.firstVoxelM, frame.voxelSizeM};
      grid.first.z += z0 * frame.voxelSizeM.z;
      padded.assign(grid.floats(), 0.0f);
      for (const Metaball& b : balls) {
        const GridBall ball{b.centreM, b.radiusM, b.density};
        const SliceRange slices = slicesOf(grid, ball);
        if (slices.begin < slices.end) addBall(grid, ball, b.density, slices, padded.data());
      }
      for (int z = z0; z < z1; ++z)
        for (int y = 0; y < frame.ny; ++y)
          std::copy_n(&padded[grid.row(y, z - z0)], frame.nx, &volume.at(0, y, z));
    }
  });
  return volume;
}

}  // namespace welkin::field
