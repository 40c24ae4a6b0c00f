// SPDX-License-Identifier: Apache-2.0
// `welkin render --renderer reference` of a sky: traces it until there are paths enough or little noise.
#pragma once

#include "render_settings.h"

namespace welkin::app {

// Returns the exit code: 130 when interrupted, what there is being written.
int runReference(const RenderSettings& settings);

}  // namespace welkin::app
