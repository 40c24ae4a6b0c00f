// SPDX-License-Identifier: Apache-2.0
// `welkin convert`: pictures and volumes from one kind of file to another.
#pragma once

#include "command_line.h"

namespace welkin::app {

// Reads one file and writes the other, by the rules of welkin/io/convert_texels.h: what cannot be kept is an
// error. Returns the exit code. Throws UsageError for flags that make no sense, ParameterError and IoError
// for files.
int runConvert(const ConvertArgs& args);

}  // namespace welkin::app
