// SPDX-License-Identifier: Apache-2.0
// A volume of OpenGL's by its name, as an engine holds one. Needs a current context.
#pragma once

#include "welkin/core/image.h"

namespace welkin::testing {

// Level 0 of a 3D texture in four channels; the sizes are those that OpenGL tells.
Volume<float> readVolume(unsigned name);

}  // namespace welkin::testing
