// SPDX-License-Identifier: Apache-2.0
// `welkin fit`: a cloud map made into metaballs.
#pragma once

#include <vector>

#include "command_line.h"
#include "param_flags.h"
#include "welkin/scene/param_docs.h"

namespace welkin::app {

std::vector<scene::ParamDoc> fitParamDocs();
std::vector<ParamFlag> fitParamFlags();

// Returns the exit code. Throws UsageError for flags, ParameterError for a map that cannot be fitted,
// ParseError for a file to resume from, IoError for files. When interrupted it writes what there is before it
// throws Interrupted.
int runFit(const FitArgs& args);

}  // namespace welkin::app
