// SPDX-License-Identifier: Apache-2.0
// `--report`: what was asked, what was delivered and what it cost, as JSON.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "render_settings.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/sky_state.h"

namespace welkin::app {

struct FrameReport {
  std::string path;  // empty for a frame of a video
  UtcTime time;
  double exposureEv = 0.0;
  double ms = 0.0;  // wall clock, writing included
};

// What the reference renderer says of its work.
struct TraceReport {
  std::int64_t samples = 0;  // of each pixel
  double noise = 0.0;        // reference::SkyFilm::meanRelativeError()
  bool complete = true;      // not interrupted
  double pathsPerSecond = 0.0;
  std::uint64_t events = 0;
  double eventsPerSecond = 0.0;
};

struct RenderReport {
  scene::SkyState state;                 // of the first frame
  std::vector<render::PassTime> passes;  // of the first frame, the program's own first
  std::string device;
  std::vector<FrameReport> frames;
  double totalMs = 0.0;
  std::optional<TraceReport> traced;
};

// The JSON text of the report.
std::string reportJson(const RenderSettings& settings, const RenderReport& report);

// What a picture file says about itself: key and text.
std::map<std::string, std::string> pictureMetadata(const scene::SkyState& state, double exposureEv,
                                                   io::ImageFormat format);
inline constexpr const char* kMeaningKey = "welkin_meaning";  // of what the values mean

// The most memory that this process has held so far.
double peakRssMib();

}  // namespace welkin::app
