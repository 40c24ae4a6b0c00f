// SPDX-License-Identifier: Apache-2.0
// `welkin bench`: how fast Welkin is on this machine.
#pragma once

#include "command_line.h"

namespace welkin::app {

// Measures the named subjects (none: all) and prints tables in Markdown, or one JSON object. Returns the exit
// code. Throws UsageError for a subject that does not exist, GpuError where there is no EGL, and UsageError
// in a program built without benchmarks.
int runBench(const BenchArgs& args);

}  // namespace welkin::app
