// SPDX-License-Identifier: Apache-2.0
#include "tests/testing/metaball_scene.h"

#include <filesystem>
#include <fstream>
#include <string>

#include "welkin/core/random.h"
#include "welkin/scene/metaball_file.h"

namespace welkin::testing {

scene::MetaballCloud MetaballFolder::cloud(const std::vector<field::Metaball>& balls,
                                           const glm::dvec3& positionM) const {
  return levels({balls}, positionM);
}

scene::MetaballCloud MetaballFolder::ball(double radiusM, double extinctionPerM,
                                          const glm::dvec3& positionM) const {
  return cloud({{{0.0, 0.0, 0.0}, radiusM, extinctionPerM}}, positionM);
}

scene::MetaballCloud MetaballFolder::levels(const std::vector<std::vector<field::Metaball>>& levels,
                                            const glm::dvec3& positionM) const {
  scene::MetaballFile file;
  for (const std::vector<field::Metaball>& balls : levels) file.levels.push_back({balls, {}, {}});
  const std::filesystem::path path = folder_.path() / (std::to_string(files_++) + ".json");
  std::ofstream(path) << scene::metaballText(file);
  scene::MetaballCloud cloud;
  cloud.file = path.string();
  cloud.positionM = positionM;
  cloud.extinctionPerM = 1.0;
  return cloud;
}

std::vector<field::Metaball> lumpOfBalls(int count, double extinctionPerM) {
  std::vector<field::Metaball> balls;
  Random random(7);
  while (static_cast<int>(balls.size()) < count) {
    glm::dvec3 p;
    for (int k = 0; k < 3; ++k) p[k] = 800.0 * (random.uniform() - 0.5);
    const double radiusM = 80.0 + 120.0 * random.uniform();
    if (p.x * p.x + p.y * p.y + p.z * p.z < 400.0 * 400.0) balls.push_back({p, radiusM, extinctionPerM});
  }
  return balls;
}

}  // namespace welkin::testing
