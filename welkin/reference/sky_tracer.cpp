// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/sky_tracer.h"

#include <cassert>
#include <glm/geometric.hpp>
#include <vector>

#include "welkin/reference/directions.h"
#include "welkin/reference/sky_paths.h"
#include "welkin/reference/traced_sky.h"

namespace welkin::reference {

SkyTracer::SkyTracer(const scene::SkyState& state, const SkySettings& settings)
    : sky_(std::make_unique<const TracedSky>(state, settings)) {}
SkyTracer::~SkyTracer() = default;

int SkyTracer::width() const {
  return static_cast<int>(sky_->state.scene.output.width);
}
int SkyTracer::height() const {
  return static_cast<int>(sky_->state.scene.output.height);
}

void SkyTracer::trace(std::span<const PixelPath> paths, std::span<SkySample> samples) const {
  assert(paths.size() == samples.size());
  std::vector<PathStart> starts;
  std::vector<std::size_t> seen;  // of the paths: those of pixels that show sky
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const PixelPath& path = paths[i];
    const std::uint64_t pixel = static_cast<std::uint64_t>(path.y) * static_cast<std::uint64_t>(width()) +
                                static_cast<std::uint64_t>(path.x);
    Random random(hashOf(sky_->seed, pixel, path.index));
    glm::vec3 direction(0.0f);
    float pixelRad = 0.0f;
    const glm::vec2 px(static_cast<float>(path.x + unit(random)), static_cast<float>(path.y + unit(random)));
    samples[i] = {};
    if (!scene::directionAt(sky_->projector, px, direction, pixelRad)) continue;
    starts.push_back({glm::normalize(glm::dvec3(direction)), pixelRad, random.next()});
    seen.push_back(i);
  }
  std::vector<SkySample> traced(starts.size());
  tracePaths(*sky_, starts, traced);
  for (std::size_t i = 0; i < seen.size(); ++i) samples[seen[i]] = traced[i];
}

void SkyTracer::traceDirections(std::span<const glm::dvec3> directions, std::uint64_t first,
                                std::span<SkySample> samples) const {
  assert(directions.size() == samples.size());
  std::vector<PathStart> starts;
  for (const glm::dvec3& direction : directions)
    starts.push_back(
        {glm::normalize(direction), 0.0f, hashOf(sky_->seed, std::uint64_t{0x5d1a}, first + starts.size())});
  tracePaths(*sky_, starts, samples);
}

}  // namespace welkin::reference
