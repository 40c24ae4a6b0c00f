// SPDX-License-Identifier: Apache-2.0
// What a call of `welkin render` asks for, flags and scene file put together and checked. Nothing is computed
// or written here.
#pragma once

#include <string>

#include "command_line.h"
#include "welkin/scene/scene.h"

namespace welkin::app {

enum class OutputKind { kPng, kExr, kHdr, kVideo };

struct RenderSettings {
  scene::Scene scene;
  std::string out;  // path or, for several pictures, a pattern with %d or %04d
  OutputKind kind = OutputKind::kPng;
  bool numbered = false;  // `out` is a pattern
  std::string report;     // empty: none
  int pngBits = 8;        // 8 or 16
  int threads = 0;        // 0: all
};

// Sets place.* from "LAT,LON[,ALT_M]"; `flag` stands in messages.
void setPlace(scene::Scene& scene, const std::string& flag, const std::string& text);

// Throws UsageError for flags, ParseError and IoError for the scene file, ParameterError for what does not
// fit together.
RenderSettings renderSettings(const RenderArgs& args);

}  // namespace welkin::app
