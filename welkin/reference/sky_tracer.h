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
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "welkin/reference/cloud_phases.h"
#include "welkin/scene/sky_state.h"

namespace welkin::reference {

struct SkySettings {
  std::uint64_t seed = 1;
  DropletModel droplets = DropletModel::kFit;
};

// Path `index` of a pixel.
struct PixelPath {
  int x = 0, y = 0;
  std::uint64_t index = 0;
};

// What one path finds.
struct SkySample {
  glm::dvec3 luminance{0.0};  // cd/m2, linear Rec. 709
  bool cloud = false;        // the straight way from the eye ends in a cloud: the mean is the clouds' opacity
  std::uint32_t events = 0;  // scatterings, and reflections of the ground
  std::uint32_t chained = 0;  // scatterings besides, on chains of light from sun or moon
};

struct TracedSky;  // traced_sky.h

class SkyTracer {
 public:
  // Throws ParameterError for what is not traced.
  SkyTracer(const scene::SkyState& state, const SkySettings& settings);
  ~SkyTracer();
  SkyTracer(const SkyTracer&) = delete;
  SkyTracer& operator=(const SkyTracer&) = delete;

  int width() const;
  int height() const;

  // Each a pure function of the seed and of its path, whatever others are traced beside it; fastest for
  // hundreds at a time. Safe to call from several threads. As many samples as paths.
  void trace(std::span<const PixelPath> paths, std::span<SkySample> samples) const;

  // The same for directions from the eye, unit, east-north-up: path first + i of the direction i.
  void traceDirections(std::span<const glm::dvec3> directions, std::uint64_t first,
                       std::span<SkySample> samples) const;

 private:
  std::unique_ptr<const TracedSky> sky_;
};

}  // namespace welkin::reference
