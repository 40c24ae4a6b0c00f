// SPDX-License-Identifier: Apache-2.0
// The files that a scene names.
#pragma once

#include <string>
#include <vector>

#include "welkin/scene/scene.h"

namespace welkin::scene {

// Paths of metaballs, textures of sheets and pictures of the sky box, in the order of the scene.
std::vector<std::string> filesOf(const Scene& scene);

}  // namespace welkin::scene
