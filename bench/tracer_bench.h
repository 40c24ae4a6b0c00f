// SPDX-License-Identifier: Apache-2.0
// How fast the reference renderer traces skies, and how soon their noise is gone: what `welkin bench tracer`
// prints.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace welkin::bench {

// One thread's paths at every few pixels of a scene, traced twice: at first the bounds of its clouds are made
// on the way, which a long picture does once; the second time is measured.
struct TracerRow {
  std::string scene;
  double pathsPerS = 0.0;      // of processor time
  double eventsPerS = 0.0;     // of paths from the eye
  double allEventsPerS = 0.0;  // with those on chains from sun and moon
  double boundsS = 0.0;        // what the first time took longer
  double deviation = 0.0;      // of a path, relative to its pixel's mean: mean over pixels
  // Processor time, hours, until pixels of 320 x 180 are within 2 % in the mean: what becomes better only
  // where speed is not bought by noise.
  double hoursTo2Percent = 0.0;
  double mean = 0.0, error = 0.0;  // luminance over the pixels, cd/m2, and its standard error
};

inline constexpr int kTracerPaths = 48;  // a pixel

// folder: of scenes X.toml. Throws ParameterError for a folder without them.
std::vector<TracerRow> measureTracer(const std::filesystem::path& folder, std::uint64_t seed);

}  // namespace welkin::bench
