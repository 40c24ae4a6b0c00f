// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/mipmaps.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "welkin/core/parallel.h"

namespace welkin::io {
namespace {

constexpr double kKaiserHalfWidth = 3.0, kKaiserAlpha = 4.0;
constexpr std::size_t kValuesAtOnce = 1 << 14;  // of a parallel chunk

// Modified Bessel function of the first kind of order 0, by its power series.
double besselI0(double x) {
  double sum = 1.0, term = 1.0;
  for (int k = 1; term > 1e-17 * sum; ++k) {
    term *= (x / 2.0 / k) * (x / 2.0 / k);
    sum += term;
  }
  return sum;
}

// J. F. Kaiser 1974, "Nonrecursive digital filter design using the I0-sinh window function". x in texels of
// the smaller level.
double kaiserSinc(double x) {
  const double t = x / kKaiserHalfWidth;
  if (std::abs(t) >= 1.0) return 0.0;
  const double sinc = x == 0.0 ? 1.0 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
  return sinc * besselI0(kKaiserAlpha * std::sqrt(1.0 - t * t)) / besselI0(kKaiserAlpha);
}

int half(int n) {
  return std::max(n / 2, 1);
}

TexelShape smaller(TexelShape s) {
  s.nx = half(s.nx);
  s.ny = half(s.ny);
  s.nz = half(s.nz);
  return s;
}

struct Part {
  int index;
  float weight;
};
using Parts = std::vector<std::vector<Part>>;

// Of each texel of the smaller level, the texels inside [0, size) that it is made of, each once.
Parts sources(int size, MipFilter filter, MipEdges edges) {
  Parts parts;
  for (const MipTap& tap : mipTaps(size, filter)) {
    std::map<int, double> sum;
    for (std::size_t j = 0; j < tap.weights.size(); ++j) {
      const int outside = tap.first + static_cast<int>(j);
      const int index =
          edges == MipEdges::kRepeat ? ((outside % size) + size) % size : std::clamp(outside, 0, size - 1);
      sum[index] += static_cast<double>(tap.weights[j]);
    }
    auto& texel = parts.emplace_back();
    for (const auto& [index, weight] : sum) texel.push_back({index, static_cast<float>(weight)});
  }
  return parts;
}

// The same seen from the other side: of each texel of the larger level, those that it goes into.
Parts targets(int size, const Parts& from) {
  Parts to(static_cast<std::size_t>(size));
  for (std::size_t i = 0; i < from.size(); ++i)
    for (const Part& p : from[i])
      to[static_cast<std::size_t>(p.index)].push_back({static_cast<int>(i), p.weight});
  return to;
}

}  // namespace

std::vector<TexelShape> mipShapes(const TexelShape& top) {
  std::vector<TexelShape> shapes = {top};
  while (shapes.back().nx > 1 || shapes.back().ny > 1 || shapes.back().nz > 1)
    shapes.push_back(smaller(shapes.back()));
  return shapes;
}

std::vector<MipTap> mipTaps(int size, MipFilter filter) {
  assert(size >= 1 && filter != MipFilter::kNone);
  if (size == 1) return {{0, {1.0f}}};
  const int count = half(size);
  const double scale = static_cast<double>(size) / count;
  const double reach = filter == MipFilter::kBox ? 0.5 : kKaiserHalfWidth;
  std::vector<MipTap> taps;
  for (int i = 0; i < count; ++i) {
    const double centre = (i + 0.5) * scale;
    const int first = static_cast<int>(std::floor(centre - reach * scale + 1e-9));
    const int end = static_cast<int>(std::ceil(centre + reach * scale - 1e-9));
    std::vector<double> weights;
    double sum = 0.0;
    for (int j = first; j < end; ++j) {
      const double weight = filter == MipFilter::kBox
                                ? std::min(j + 1.0, (i + 1) * scale) - std::max<double>(j, i * scale)
                                : kaiserSinc((j + 0.5 - centre) / scale);
      weights.push_back(weight);
      sum += weight;
    }
    MipTap& tap = taps.emplace_back(MipTap{first, {}});
    for (const double weight : weights) tap.weights.push_back(static_cast<float>(weight / sum));
  }
  return taps;
}

// From the runs of one level to those of the next, which then makes its own next. Any picture (nx, ny) is
// taken for the volume (nx, 1, ny), so that rows are its slices and only a few of them are in memory.
class MipChain::Level {
 public:
  Level(int number, const TexelShape& from, MipFilter filter, MipEdges edges, const Emit& emit)
      : number_(number),
        from_(from),
        to_(smaller(from)),
        emit_(emit),
        x_(sources(from.nx, filter, edges)),
        y_(sources(from.ny, filter, edges)),
        z_(sources(from.nz, filter, edges)),
        zTargets_(targets(from.nz, z_)) {
    if (to_.nx > 1 || to_.ny > 1 || to_.nz > 1)
      next_ = std::make_unique<Level>(number + 1, to_, filter, edges, emit);
    channels_ = static_cast<std::size_t>(countOf(from.format.channels));
    plane_.resize(valuesOf(to_));
  }

  void add(int z, const std::vector<float>& slice) {
    reducePlane(slice);
    for (const Part& target : zTargets_[static_cast<std::size_t>(z)]) {
      Waiting& w = waiting_[target.index];
      if (w.values.empty()) {
        w.values.assign(plane_.size(), 0.0f);
        w.missing = z_[static_cast<std::size_t>(target.index)].size();
      }
      parallelFor(plane_.size(), kValuesAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) w.values[i] += target.weight * plane_[i];
      });
      if (--w.missing > 0) continue;
      const std::vector<float> done = std::move(w.values);
      waiting_.erase(target.index);
      bytes_.resize(done.size() * bytesOf(to_.format.type));
      fromFloats(done, to_.format.type, bytes_);
      emit_(number_, target.index, bytes_);
      if (next_) next_->add(target.index, done);
    }
  }

 private:
  // A slice of the smaller level to which slices of the larger one are still to come.
  struct Waiting {
    std::vector<float> values;
    std::size_t missing = 0;
  };

  static std::size_t valuesOf(const TexelShape& s) { return s.sliceBytes() / bytesOf(s.format.type); }

  // Along y and then along x, into plane_.
  void reducePlane(const std::vector<float>& slice) {
    const std::size_t wide = static_cast<std::size_t>(from_.nx) * channels_;
    const std::size_t narrow = static_cast<std::size_t>(to_.nx) * channels_;
    const std::size_t grain = std::max<std::size_t>(kValuesAtOnce / wide, 1);
    parallelFor(static_cast<std::size_t>(to_.ny), grain, [&](std::size_t begin, std::size_t end) {
      std::vector<float> row(wide);
      for (std::size_t y = begin; y < end; ++y) {
        std::fill(row.begin(), row.end(), 0.0f);
        for (const Part& p : y_[y]) {
          const float* source = slice.data() + static_cast<std::size_t>(p.index) * wide;
          for (std::size_t i = 0; i < wide; ++i) row[i] += p.weight * source[i];
        }
        float* out = plane_.data() + y * narrow;
        for (const auto& parts : x_)
          for (std::size_t c = 0; c < channels_; ++c) {
            float sum = 0.0f;
            for (const Part& p : parts)
              sum += p.weight * row[static_cast<std::size_t>(p.index) * channels_ + c];
            *out++ = sum;
          }
      }
    });
  }

  int number_;
  TexelShape from_, to_;
  const Emit emit_;
  std::size_t channels_ = 1;
  Parts x_, y_, z_, zTargets_;
  std::map<int, Waiting> waiting_;
  std::vector<float> plane_;
  std::vector<std::byte> bytes_;
  std::unique_ptr<Level> next_;
};

MipChain::MipChain(const TexelShape& top, MipFilter filter, MipEdges edges, const Emit& emit) : top_(top) {
  TexelShape runs = top;
  if (!top.volume) std::swap(runs.ny, runs.nz);
  if (mipShapes(top).size() > 1) first_ = std::make_unique<Level>(1, runs, filter, edges, emit);
  floats_.resize(runs.sliceBytes() / bytesOf(top.format.type));
}

MipChain::~MipChain() = default;

void MipChain::add(std::span<const std::byte> run) {
  if (!first_) return;
  const std::size_t bytes = bytesOf(top_.format.type);
  parallelFor(floats_.size(), kValuesAtOnce, [&](std::size_t begin, std::size_t end) {
    toFloats(top_.format.type, run.subspan(begin * bytes, (end - begin) * bytes),
             std::span(floats_).subspan(begin, end - begin));
  });
  first_->add(runs_++, floats_);
}

}  // namespace welkin::io
