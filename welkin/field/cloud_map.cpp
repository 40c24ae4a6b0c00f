// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/cloud_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/noise/noise.h"

namespace welkin::field {
namespace {

constexpr double kMargin = 0.95;              // of the box, that the centred ellipsoid takes
constexpr double kMostVoxels = 2147483648.0;  // 2^31: 8 GiB
constexpr int kSlabSlices = 4;

// What the map's noise is among all noises: lattice cells are the unit of its domain.
noise::NoiseParams noiseOf(const MapNoise& n) {
  noise::NoiseParams p;
  p.kind = n.kind == MapNoiseKind::kValue ? noise::Kind::kValue : noise::Kind::kPerlin;
  p.tile = false;
  p.frequency = glm::dvec3(1.0);
  p.octaves = std::max<std::int64_t>(n.octaves, 1);
  p.persistence = n.persistence;
  p.interpolation = n.interpolation;
  p.smooth = n.smooth;
  p.seed = n.seed;
  if (n.kind == MapNoiseKind::kPerlin)
    p.offset.z = 0.37;  // off the lattice points, where all octaves are 0
  else if (n.seed == 0)
    p.table = noise::Table::kPublished;
  p.normalisation =
      n.fold == MapFold::kShifted ? noise::Normalisation::kUnitVariance : noise::Normalisation::kRaw;
  return p;
}

// Noise on a box of voxels, made positive.
class NoiseSource {
 public:
  explicit NoiseSource(const CloudMapParams& p)
      : settings_(p.noise),
        noise_(noiseOf(p.noise)),
        grid_{{static_cast<int>(p.nx), static_cast<int>(p.ny), static_cast<int>(p.nz)},
              glm::dvec3(1.0 / p.noise.cellVoxels)} {}

  void fill(std::vector<float>& out, glm::ivec3 begin, glm::ivec3 count) const {
    out.assign(static_cast<std::size_t>(count.x) * count.y * count.z, 1.0f);
    if (settings_.octaves == 0) return;
    noise_.fill(grid_, noise::Box{begin, count}, std::span(out));
    if (settings_.fold == MapFold::kAbsolute)
      for (float& v : out) v = std::abs(v);
    else
      for (float& v : out) v = std::clamp(0.5f + v / 6.0f, 0.0f, 1.0f);
  }

 private:
  const MapNoise& settings_;
  noise::Noise noise_;
  noise::Grid grid_;
};

// A few slices: what of them the ellipsoids fill, and how much.
class Slab {
 public:
  Slab(const CloudMapParams& p, int z0, int z1) : p_(p), z0_(z0), z1_(z1), first_(firstVoxelM(p)) {
    q_.assign(static_cast<std::size_t>(p.nx) * static_cast<std::size_t>(p.ny) * (z1 - z0), 0.0f);
  }

  void unite(const EllipsoidForm& e) {
    const Range zs = voxels(e.centreM().z, e.extentM().z, 2), ys = voxels(e.centreM().y, e.extentM().y, 1);
    for (int z = std::max(zs.begin, z0_); z < std::min(zs.end, z1_); ++z) {
      const double height = first_.z + p_.voxelM * z;
      if (p_.baseM && height < *p_.baseM) continue;
      for (int y = ys.begin; y < ys.end; ++y) {
        const EllipsoidForm::Line line = e.alongX(first_.y + p_.voxelM * y, height);
        if (line.nearest >= 1.0) continue;
        const Range xs = voxels(line.xMiddle, std::sqrt((1.0 - line.nearest) / line.curvature), 0);
        if (xs.begin >= xs.end) continue;
        low_ = glm::min(low_, glm::ivec3(xs.begin, y, z));
        high_ = glm::max(high_, glm::ivec3(xs.end, y + 1, z + 1));
        float* row = &q_[index({0, y, z})];
        for (int x = xs.begin; x < xs.end; ++x) {
          const double d = first_.x + p_.voxelM * x - line.xMiddle;
          const auto q = static_cast<float>(1.0 - line.nearest - line.curvature * d * d);
          if (q > 0.0f) row[x] += q - q * row[x];
        }
      }
    }
  }

  // Multiplies in the noise and writes what reaches the threshold. Returns the greatest Q * noise.
  float finish(const NoiseSource& source, Volume<float>& map) const {
    if (low_.x >= high_.x) return 0.0f;
    const glm::ivec3 count = high_ - low_;
    std::vector<float> noise;
    source.fill(noise, low_, count);
    const auto threshold = static_cast<float>(p_.threshold), dynamics = static_cast<float>(p_.dynamics);
    float greatest = 0.0f;
    std::size_t n = 0;
    for (int z = low_.z; z < high_.z; ++z)
      for (int y = low_.y; y < high_.y; ++y)
        for (int x = low_.x; x < high_.x; ++x, ++n) {
          const float density = q_[index({x, y, z})] * noise[n];
          greatest = std::max(greatest, density);
          if (density >= threshold) map.at(x, y, z) = dynamics * density;
        }
    return greatest;
  }

 private:
  struct Range {
    int begin, end;
  };
  // Voxels whose centres are nearer than `reach` to `middle` on that axis.
  Range voxels(double middle, double reach, int axis) const {
    const std::int64_t counts[] = {p_.nx, p_.ny, p_.nz};
    const auto most = static_cast<double>(counts[axis]);
    const double from = std::ceil((middle - reach - first_[axis]) / p_.voxelM);
    const double to = std::floor((middle + reach - first_[axis]) / p_.voxelM) + 1.0;
    return {static_cast<int>(std::clamp(from, 0.0, most)), static_cast<int>(std::clamp(to, 0.0, most))};
  }
  std::size_t index(glm::ivec3 v) const {
    return (static_cast<std::size_t>(v.z - z0_) * static_cast<std::size_t>(p_.ny) + v.y) *
               static_cast<std::size_t>(p_.nx) +
           v.x;
  }

  const CloudMapParams& p_;
  int z0_, z1_;
  glm::dvec3 first_;
  std::vector<float> q_;
  glm::ivec3 low_{std::numeric_limits<int>::max()}, high_{0};  // the box of what is not zero
};

}  // namespace

void describe(MapNoise& n, ParamVisitor& v) {
  v.choice({"kind", "", "the noise in the ellipsoids"}, n.kind);
  v.value({"octaves", "", "scales of noise that are summed; 0: none, the ellipsoids are smooth", 0, 16},
          n.octaves);
  v.value({"persistence", "", "amplitude of an octave, of the one before", 0, 2}, n.persistence);
  v.value({"cell_voxels", "voxels", "size of the largest octave's cells", 0.5, 100000}, n.cellVoxels);
  v.choice({"interpolation", "", "between the lattice points of value noise"}, n.interpolation);
  v.value({"smooth", "", "average value noise over the 27 lattice points around each"}, n.smooth);
  v.choice({"fold", "", "how the noise is made positive: its absolute value, or shifted to 0..1"}, n.fold);
  v.value({"seed", "", "another noise of the same kind", 0, 9007199254740991.0}, n.seed);
}

void describe(CloudMapParams& p, ParamVisitor& v) {
  v.value({"nx", "voxels", "east", 1, 65536}, p.nx);
  v.value({"ny", "voxels", "north", 1, 65536}, p.ny);
  v.value({"nz", "voxels", "up", 1, 65536}, p.nz);
  v.value({"voxel_m", "m", "edge of a voxel", 0.001, 10000}, p.voxelM);
  v.value({"threshold", "", "density below which there is clear air", 0, 10}, p.threshold);
  v.value({"dynamics", "", "factor of the density", 1e-6, 1e6}, p.dynamics);
  v.value({"base_m", "m", "no cloud below this height, for a flat base", -1e6, 1e6}, p.baseM);
  v.group({"noise", "", "the noise"}, p.noise);
}

void validate(const CloudMapParams& p) {
  const double voxels = static_cast<double>(p.nx) * static_cast<double>(p.ny) * static_cast<double>(p.nz);
  if (std::min({p.nx, p.ny, p.nz}) < 1 || voxels > kMostVoxels)
    throw ParameterError(
        "size " + std::to_string(p.nx) + "x" + std::to_string(p.ny) + "x" + std::to_string(p.nz) + " has " +
        (voxels > kMostVoxels ? "more than 2147483648 voxels" : "no voxels") + "; expected 1 to 2147483648");
}

glm::dvec3 firstVoxelM(const CloudMapParams& p) {
  return {p.voxelM * 0.5 * (1.0 - static_cast<double>(p.nx)),
          p.voxelM * 0.5 * (1.0 - static_cast<double>(p.ny)), p.voxelM * 0.5};
}

Ellipsoid centredEllipsoid(const CloudMapParams& p) {
  const glm::dvec3 half = 0.5 * p.voxelM * glm::dvec3(p.nx, p.ny, p.nz);
  return {{0.0, 0.0, half.z}, kMargin * half, glm::dvec3(0.0)};
}

Volume<float> cloudMap(const CloudMapParams& p, std::span<const Ellipsoid> ellipsoids,
                       const std::function<void(double)>& progress) {
  validate(p);
  Volume<float> map(static_cast<int>(p.nx), static_cast<int>(p.ny), static_cast<int>(p.nz), 1);
  const NoiseSource source(p);
  const std::vector<EllipsoidForm> forms(ellipsoids.begin(), ellipsoids.end());
  const int slabs = (map.nz + kSlabSlices - 1) / kSlabSlices, together = 2 * threadCount();
  std::vector<float> greatest(slabs, 0.0f);
  for (int done = 0; done < slabs; done += together) {
    if (progress) progress(static_cast<double>(done) / slabs);
    parallelFor(std::min(together, slabs - done), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const int s = done + static_cast<int>(i);
        Slab slab(p, s * kSlabSlices, std::min((s + 1) * kSlabSlices, map.nz));
        for (const EllipsoidForm& form : forms) slab.unite(form);
        greatest[s] = slab.finish(source, map);
      }
    });
  }
  const float most = *std::max_element(greatest.begin(), greatest.end());
  if (most <= 0.0f)
    throw ParameterError("the cloud is empty: no ellipsoid has a voxel in the box above its base");
  if (most < static_cast<float>(p.threshold))
    throw ParameterError("the cloud is empty: its greatest density is " + std::to_string(most) +
                         "; expected a threshold below that");
  return map;
}

}  // namespace welkin::field
