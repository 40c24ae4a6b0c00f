// SPDX-License-Identifier: Apache-2.0
#include "welkin/fit/ball_system.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "welkin/core/parallel.h"

namespace welkin::fit {
namespace {

constexpr int kSlabSlices = 4;
constexpr double kFewVoxels = 3e5;  // that balls cover together: threads would take longer to start
constexpr std::size_t kGrain = 4;

void forSlabs(const BallLists& lists, const std::function<void(int)>& body) {
  const auto count = static_cast<std::size_t>(lists.slabs());
  parallelFor(count, lists.many() ? 1 : count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) body(static_cast<int>(s));
  });
}

}  // namespace

BallLists::BallLists(const BallGrid& grid, std::span<const GridBall> balls) : nz_(grid.nz) {
  lists_.resize(static_cast<std::size_t>((grid.nz + kSlabSlices - 1) / kSlabSlices));
  double voxels = 0.0;
  const double voxel = grid.step.x * grid.step.y * grid.step.z;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const SliceRange slices = field::slicesOf(grid, balls[i]);
    for (int z = slices.begin; z < slices.end;) {
      const int s = z / kSlabSlices, end = std::min(slices.end, (s + 1) * kSlabSlices);
      lists_[static_cast<std::size_t>(s)].push_back({static_cast<std::uint32_t>(i), {z, end}});
      z = end;
    }
    voxels += std::min(4.2 * std::pow(balls[i].radius, 3.0) / voxel, static_cast<double>(grid.floats()));
  }
  many_ = voxels > kFewVoxels;
}

SliceRange BallLists::slab(int s) const {
  return {s * kSlabSlices, std::min(nz_, (s + 1) * kSlabSlices)};
}

double residual(const DensityGrid& data, std::span<const GridBall> balls, const BallLists& lists,
                std::vector<float>& r) {
  const BallGrid& grid = data.grid;
  r.resize(grid.floats());
  std::vector<double> squares(static_cast<std::size_t>(lists.slabs()));
  forSlabs(lists, [&](int s) {
    const SliceRange slab = lists.slab(s);
    const std::size_t begin = grid.row(0, slab.begin), end = grid.row(0, slab.end);
    for (std::size_t i = begin; i < end; ++i) r[i] = -data.density[i];
    for (const BallLists::Entry& e : lists.entries(s))
      addBall(grid, balls[e.ball], balls[e.ball].weight, e.slices, r.data());
    double sum = 0.0;
    for (int z = slab.begin; z < slab.end; ++z)
      for (int y = 0; y < grid.ny; ++y) {
        const float* row = &r[grid.row(y, z)];
        float parts[8] = {};  // of a row of at most 65536 voxels: floats will do, and the compiler's vectors
        for (int x = 0; x + 8 <= grid.stride; x += 8)
          for (int k = 0; k < 8; ++k) parts[k] += row[x + k] * row[x + k];
        for (const float part : parts) sum += static_cast<double>(part);
      }
    squares[static_cast<std::size_t>(s)] = sum;
  });
  double sum = 0.0;
  for (const double s : squares) sum += s;
  return sum;
}

Jacobian::Jacobian(const DensityGrid& data, std::span<const GridBall> balls)
    : data_(data), balls_(balls), lists_(data.grid, balls) {}

void Jacobian::times(std::span<const double> p, std::vector<float>& out) const {
  const BallGrid& grid = data_.grid;
  out.resize(grid.floats());
  forSlabs(lists_, [&](int s) {
    const SliceRange slab = lists_.slab(s);
    std::fill(out.begin() + static_cast<std::ptrdiff_t>(grid.row(0, slab.begin)),
              out.begin() + static_cast<std::ptrdiff_t>(grid.row(0, slab.end)), 0.0f);
    for (const BallLists::Entry& e : lists_.entries(s)) {
      const double* q = &p[std::size_t{5} * e.ball];
      addBallStep(grid, balls_[e.ball], {q[0], {q[1], q[2], q[3]}, q[4]}, e.slices, out.data());
    }
  });
}

void Jacobian::transposedTimes(const std::vector<float>& r, std::span<double> out) const {
  parallelFor(balls_.size(), lists_.many() ? kGrain : balls_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const BallStep s = gatherBall(data_.grid, balls_[i], r.data());
      const double values[5] = {s.weight, s.centre.x, s.centre.y, s.centre.z, s.logRadius};
      std::copy_n(values, 5, &out[5 * i]);
    }
  });
}

std::vector<BallBlock> Jacobian::blocks() const {
  std::vector<BallBlock> blocks(balls_.size());
  parallelFor(balls_.size(), lists_.many() ? kGrain : balls_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) blocks[i] = blockOfBall(data_.grid, balls_[i]);
  });
  return blocks;
}

BallPatch patchOf(const BallGrid& grid, const GridBall& ball, double factor) {
  const glm::dvec3 c = ball.centre - grid.first;
  const field::VoxelRange x = field::voxelsWithin(c.x, ball.radius, grid.step.x, grid.nx),
                          y = field::voxelsWithin(c.y, ball.radius, grid.step.y, grid.ny),
                          z = field::voxelsWithin(c.z, ball.radius, grid.step.z, grid.nz);
  BallPatch patch;
  patch.grid = {std::max(x.end - x.begin, 0), std::max(y.end - y.begin, 0), std::max(z.end - z.begin, 0)};
  patch.grid.stride = patch.grid.nx + field::kRowPadding;
  patch.grid.first = grid.first + glm::dvec3(x.begin, y.begin, z.begin) * grid.step;
  patch.grid.step = grid.step;
  patch.voxels.assign(patch.grid.floats(), 0.0f);
  addBall(patch.grid, ball, factor, field::slicesOf(patch.grid, ball), patch.voxels.data());
  return patch;
}

std::vector<std::vector<std::uint32_t>> neighboursOf(std::span<const GridBall> balls) {
  // Along one axis in order, so that only those within reach are looked at.
  std::vector<std::uint32_t> order(balls.size());
  double widest = 0.0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    order[i] = static_cast<std::uint32_t>(i);
    widest = std::max(widest, balls[i].radius);
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double x = balls[a].centre.x, y = balls[b].centre.x;
    return x != y ? x < y : a < b;
  });
  std::vector<std::vector<std::uint32_t>> neighbours(balls.size());
  parallelFor(order.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const GridBall& ball = balls[order[n]];
      std::vector<std::uint32_t>& list = neighbours[order[n]];
      const auto look = [&](std::uint32_t other) {
        const double reach = ball.radius + balls[other].radius;
        if (square(balls[other].centre - ball.centre) < reach * reach) list.push_back(other);
      };
      for (std::size_t m = n; m > 0 && ball.centre.x - balls[order[m - 1]].centre.x < ball.radius + widest;
           --m)
        look(order[m - 1]);
      for (std::size_t m = n + 1;
           m < order.size() && balls[order[m]].centre.x - ball.centre.x < ball.radius + widest; ++m)
        look(order[m]);
      std::sort(list.begin(), list.end());
    }
  });
  return neighbours;
}

}  // namespace welkin::fit
