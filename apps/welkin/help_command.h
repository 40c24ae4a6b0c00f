// SPDX-License-Identifier: Apache-2.0
// `welkin help scene` and `welkin info`: what a scene file may say, and what one says.
#pragma once

#include "command_line.h"

namespace welkin::app {

// Both print to standard output and return the exit code.
int runHelpScene(const HelpSceneArgs& args);
int runInfo(const InfoArgs& args);

}  // namespace welkin::app
