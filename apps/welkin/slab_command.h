// SPDX-License-Identifier: Apache-2.0
// `welkin render` of a scene with a slab: light through it by the reference renderer, as a report.
#pragma once

#include "render_settings.h"

namespace welkin::app {

// Traces settings.scene.slab and writes settings.report; returns the exit code. Interrupted, it writes what
// there is and returns 130.
int runSlab(const RenderSettings& settings);

}  // namespace welkin::app
