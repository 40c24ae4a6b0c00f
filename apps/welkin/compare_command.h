// SPDX-License-Identifier: Apache-2.0
// `welkin compare`: how far one picture is from another.
#pragma once

#include "command_line.h"

namespace welkin::app {

int runCompare(const CompareArgs& args);

}  // namespace welkin::app
