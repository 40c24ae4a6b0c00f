// SPDX-License-Identifier: Apache-2.0
// What a call of `welkin render` asks for, flags and scene file put together and checked. Nothing is computed
// or written here.
#pragma once

#include <optional>
#include <string>

#include "command_line.h"
#include "welkin/io/write_image.h"
#include "welkin/reference/sky_tracer.h"
#include "welkin/scene/scene.h"

namespace welkin::app {

struct RenderSettings {
  scene::Scene scene;
  std::string out;                                 // path or, for several pictures, a pattern with %d or %04d
  bool video = false;                              // .mp4 or .webm
  io::ImageFormat format = io::ImageFormat::kPng;  // when it is no video
  bool numbered = false;                           // `out` is a pattern
  std::string report;                              // empty: none
  int pngBits = 8;                                 // 8 or 16
  bool reference = false;                          // the reference renderer, not the GPU's
  std::optional<int> spp;                          // of the reference renderer: paths at most
  std::optional<double> noise;                     // and the relative standard error to stop at
  std::string resume;                              // and its unfinished work; empty: none
  int threads = 0;                                 // 0: all
};

// A number and a whole number from `low` to `high`, and the one that --threads takes. Throw UsageError.
double numberIn(const char* flag, const std::string& text, double low, double high);
int wholeNumber(const char* flag, const std::string& text, int low, int high);
int threadsOf(const std::string& text);

// Sets place.* from "LAT,LON[,ALT_M]"; `flag` stands in messages.
void setPlace(scene::Scene& scene, const std::string& flag, const std::string& text);

// Throws UsageError for flags, ParseError and IoError for the scene file, ParameterError for what does not
// fit together.
RenderSettings renderSettings(const RenderArgs& args);

}  // namespace welkin::app
