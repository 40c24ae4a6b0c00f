// SPDX-License-Identifier: Apache-2.0
// `welkin noise`: textures and volumes of noise, and of cloud condensed from it.
#pragma once

#include <vector>

#include "command_line.h"
#include "param_flags.h"
#include "welkin/scene/param_docs.h"

namespace welkin::app {

// The described parameters that have a flag, and their flags.
std::vector<scene::ParamDoc> noiseParamDocs();
std::vector<ParamFlag> noiseParamFlags();

// Writes slice by slice. Returns the exit code. Throws UsageError for flags, IoError for files.
int runNoise(const NoiseArgs& args);

}  // namespace welkin::app
