// SPDX-License-Identifier: Apache-2.0
// `welkin help scene`: what a scene file may say.
#pragma once

#include "command_line.h"

namespace welkin::app {

// Prints to standard output; returns the exit code.
int runHelpScene(const HelpSceneArgs& args);

}  // namespace welkin::app
