// SPDX-License-Identifier: Apache-2.0
// Light through a sky by Monte Carlo, without bias: the picture that fast renderers approximate. Clouds,
// those of metaballs too, air, ground, sun and moon are those of a SkyState; all orders of scattering are
// traced, in clouds with their full detail at any distance. docs/theory.md has the method and its sources.
//
// What is not traced: thin sheets and pictures in the place of the sky, which are refused, and the lens.
// Metaballs scatter by their phase function every time, not the first time alone.
// Beyond 1000 km from the eye there is no cloud. The moon's disc lights as an even one does.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>

#include "welkin/reference/cloud_phases.h"
#include "welkin/scene/sky_state.h"

namespace welkin::reference {

struct SkySettings {
  std::uint64_t seed = 1;
  DropletModel droplets = DropletModel::kFit;
};

// One path.
struct SkySample {
  glm::dvec3 luminance{0.0};  // cd/m2, linear Rec. 709
  bool cloud = false;        // the straight way from the eye ends in a cloud: the mean is the clouds' opacity
  std::uint32_t events = 0;  // scatterings, and reflections of the ground
  std::uint32_t chained = 0;  // scatterings besides, on chains of light from sun or moon
};

class SkyTracer {
 public:
  // Throws ParameterError for what is not traced.
  SkyTracer(const scene::SkyState& state, const SkySettings& settings);
  ~SkyTracer();
  SkyTracer(const SkyTracer&) = delete;
  SkyTracer& operator=(const SkyTracer&) = delete;

  int width() const;
  int height() const;

  // Path `index` of a pixel, a pure function of the seed and of these. Safe to call from several threads.
  SkySample trace(int x, int y, std::uint64_t index) const;

  // The same for a direction from the eye, unit, east-north-up.
  SkySample traceDirection(const glm::dvec3& direction, std::uint64_t index) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace welkin::reference
