// SPDX-License-Identifier: Apache-2.0
// Paths of light through a sky, many at a time: each is followed by a coroutine of its own from event to
// event, and waits where it asks for a way through the clouds, which cloud_walks.h goes for all of them.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "welkin/reference/sky_tracer.h"
#include "welkin/reference/traced_sky.h"

namespace welkin::reference {

struct PathStart {
  glm::dvec3 way{0.0, 0.0, 1.0};  // from the eye, unit
  float pixelRad = 0.0f;          // of stars; 0: none are seen
  std::uint64_t seed = 0;
};

// A sample for each start, a pure function of it.
void tracePaths(const TracedSky& sky, std::span<const PathStart> starts, std::span<SkySample> samples);

}  // namespace welkin::reference
