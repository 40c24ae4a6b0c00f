// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/scene_files.h"

namespace welkin::scene {

std::vector<std::string> filesOf(const Scene& scene) {
  std::vector<std::string> files;
  for (const MetaballCloud& cloud : scene.metaballs)
    if (!cloud.file.empty()) files.push_back(cloud.file);
  for (const Sheet& sheet : scene.sheets)
    if (sheet.texture) files.push_back(*sheet.texture);
  if (scene.skyBox.strip) files.push_back(*scene.skyBox.strip);
  for (const auto* face : scene.skyBox.faces())
    if (*face) files.push_back(**face);
  return files;
}

}  // namespace welkin::scene
