// SPDX-License-Identifier: Apache-2.0
// `welkin cloud`: a volume of cloud density in ellipsoids.
#pragma once

#include <vector>

#include "command_line.h"
#include "param_flags.h"
#include "welkin/scene/param_docs.h"

namespace welkin::app {

std::vector<scene::ParamDoc> cloudParamDocs();
std::vector<ParamFlag> cloudParamFlags();

// Returns the exit code. Throws UsageError for flags, ParseError for the file of ellipsoids, ParameterError
// for a cloud that is empty, IoError for files.
int runCloud(const CloudArgs& args);

}  // namespace welkin::app
