// SPDX-License-Identifier: Apache-2.0
// `welkin render`: draws a sky and writes it.
#pragma once

#include "command_line.h"

namespace welkin::app {

// Returns the exit code. Throws what renderSettings() throws, GpuError without graphics, IoError for what
// cannot be written and Interrupted; in each case nothing half-written is left behind.
int runRender(const RenderArgs& args);

}  // namespace welkin::app
