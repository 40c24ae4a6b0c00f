// SPDX-License-Identifier: Apache-2.0
// Paths of the reference renderer, many at a time.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "welkin/reference/sky_tracer.h"

namespace welkin::testing {

// Path i of directions[i].
inline std::vector<reference::SkySample> traced(const reference::SkyTracer& tracer,
                                                const std::vector<glm::dvec3>& directions) {
  std::vector<reference::SkySample> samples(directions.size());
  tracer.traceDirections(directions, 0, samples);
  return samples;
}

// Paths 0, 1... of one direction.
inline std::vector<reference::SkySample> traced(const reference::SkyTracer& tracer,
                                                const glm::dvec3& direction, int count) {
  return traced(tracer, std::vector<glm::dvec3>(static_cast<std::size_t>(count), direction));
}

inline std::vector<reference::SkySample> traced(const reference::SkyTracer& tracer,
                                                const std::vector<reference::PixelPath>& paths) {
  std::vector<reference::SkySample> samples(paths.size());
  tracer.trace(paths, samples);
  return samples;
}

// Paths 0, 1... of one pixel.
inline std::vector<reference::SkySample> traced(const reference::SkyTracer& tracer, int x, int y, int count) {
  std::vector<reference::PixelPath> paths;
  for (int i = 0; i < count; ++i) paths.push_back({x, y, static_cast<std::uint64_t>(i)});
  return traced(tracer, paths);
}

// Paths 0, 1... of the picture's pixels in turn, row by row, of a width and height.
inline std::vector<reference::SkySample> tracedInTurn(const reference::SkyTracer& tracer, int width,
                                                      int height, int count) {
  std::vector<reference::PixelPath> paths;
  for (int i = 0; i < count; ++i)
    paths.push_back({i % width, i / width % height, static_cast<std::uint64_t>(i)});
  return traced(tracer, paths);
}

}  // namespace welkin::testing
