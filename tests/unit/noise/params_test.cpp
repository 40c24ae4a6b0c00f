// SPDX-License-Identifier: Apache-2.0
#include "welkin/noise/params.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/noise/noise.h"

namespace welkin::noise {
namespace {

TEST(NoiseParams, RefuseWhatDoesNotFitTogether) {
  const auto refused = [](auto change) {
    NoiseParams p;
    change(p);
    EXPECT_THROW(Noise{p}, ParameterError);
  };
  EXPECT_NO_THROW(Noise{NoiseParams{}});
  refused([](NoiseParams& p) { p.frequency.y = 2.5; });
  refused([](NoiseParams& p) { p.frequency.y = 0.0; });
  refused([](NoiseParams& p) { p.frequency.x = std::numeric_limits<double>::quiet_NaN(); });
  refused([](NoiseParams& p) { p.offset.z = std::numeric_limits<double>::infinity(); });
  refused([](NoiseParams& p) { p.lacunarity = 1.9; });
  refused([](NoiseParams& p) { p.octaves = 0; });
  refused([](NoiseParams& p) { p.octaves = 25; });
  refused([](NoiseParams& p) { p.dimensions = 4; });
  refused([](NoiseParams& p) { p.time = 1.0, p.timePeriod = 2.5; });
  refused([](NoiseParams& p) { p.timePeriod = 2.0; });
  refused([](NoiseParams& p) { p.kind = Kind::kCellular, p.fractal = Fractal::kBillow; });
  refused([](NoiseParams& p) { p.kind = Kind::kCurl, p.table = Table::kPublished; });
  refused(
      [](NoiseParams& p) { p.kind = Kind::kPerlinWorley, p.normalisation = Normalisation::kUnitVariance; });
  // Integers hold what the last octave comes to.
  refused([](NoiseParams& p) { p.time = 1.0, p.octaves = 24, p.timeLacunarity = 16.0, p.lacunarity = 1.0; });
  const auto distorted = [](double cells) {
    return [cells](NoiseParams& p) {
      p.kind = Kind::kDistorted, p.octaves = 4, p.lacunarity = 16.0, p.frequency = glm::dvec3(1, 1, cells);
    };
  };
  refused(distorted(2e5));  // times 4096 times 7.77
  NoiseParams held;
  distorted(1e5)(held);
  EXPECT_NO_THROW(Noise{held});
  EXPECT_NO_THROW((Noise{{.octaves = 24, .lacunarity = 1.0, .timeLacunarity = 16.0}})) << "without a time";
}

TEST(NoiseFill, RefusesWrongBuffersAndBoxes) {
  const Noise noise(NoiseParams{});
  std::vector<float> out(64);
  const Grid grid = Grid::tile({4, 4, 4});
  EXPECT_NO_THROW(noise.fill(grid, std::span(out)));
  EXPECT_THROW(noise.fill(Grid::tile({4, 4, 5}), std::span(out)), ParameterError);
  EXPECT_THROW(noise.fill(grid, Box{{1, 0, 0}, {4, 4, 4}}, std::span(out)), ParameterError);
  EXPECT_THROW(noise.fill(grid, Box{{0, -1, 0}, {4, 4, 4}}, std::span(out)), ParameterError);
  EXPECT_THROW(noise.fill(Grid{{4, 4, 4}, glm::dvec3(0.0)}, std::span(out)), ParameterError);
  NoiseParams plane;
  plane.dimensions = 2;
  EXPECT_THROW(Noise(plane).fill(grid, std::span(out)), ParameterError);
}

}  // namespace
}  // namespace welkin::noise
