// SPDX-License-Identifier: Apache-2.0
// Draws a SkyState: atmosphere, discs, ground and all layers, volumes and sheets, in one march, accumulated
// to convergence.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "welkin/core/image.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {

struct PassTime {
  std::string name;
  double ms = 0.0;  // wall clock, finished on the device
};

struct Picture {
  Image<float> luminance;       // RGB, linear Rec. 709, cd/m2
  double autoExposureEv = 0.0;  // EV at ISO 100 that automatic exposure chooses for it
  std::vector<PassTime> passes;
};

// Called with the fraction done in [0, 1]; may throw to stop (Interrupted).
using Progress = std::function<void(double fraction)>;

// How light that is scattered more than once in clouds is found: as Welkin does, or, to compare, by the
// octaves that others use or not at all.
enum class CloudLight { kFull, kOctaves, kSingle };

struct RendererOptions {
  bool debug = false;  // record what the driver reports as errors; slower on some drivers
  CloudLight cloudLight = CloudLight::kFull;
};

// Owns a headless graphics context and everything on it. Not thread-safe: use from the thread that made it,
// beside others if wished. An application's own EGL context stays current, and its display initialised.
class SkyRenderer {
 public:
  explicit SkyRenderer(const RendererOptions& options = {});  // throws GpuError where there is no EGL
  ~SkyRenderer();
  SkyRenderer(const SkyRenderer&) = delete;
  SkyRenderer& operator=(const SkyRenderer&) = delete;

  // Draws with the camera and output settings of state.scene, towards state.headingDeg.
  Picture draw(const scene::SkyState& state, const Progress& progress = {});

  std::string deviceName() const;

  // What the driver has reported since the last call, see gpu::Context::takeErrors(). Empty is good.
  std::vector<std::string> takeErrors();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace welkin::render
