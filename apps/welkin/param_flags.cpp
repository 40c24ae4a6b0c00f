// SPDX-License-Identifier: Apache-2.0
#include "param_flags.h"

#include <algorithm>

namespace welkin::app {

std::string flagName(std::string_view key) {
  for (const std::string_view unit : {"_m", "_deg", "_voxels"})
    if (key.ends_with(unit)) {
      key.remove_suffix(unit.size());
      break;
    }
  std::string name = "--" + std::string(key);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

std::vector<ParamFlag> paramFlags(std::span<const scene::ParamDoc> rows,
                                  const std::map<std::string_view, std::string_view>& renamed,
                                  const std::map<std::string_view, std::string_view>& groups,
                                  std::span<const std::string_view> without) {
  std::vector<ParamFlag> flags;
  for (const scene::ParamDoc& row : rows) {
    if (std::find(without.begin(), without.end(), row.key) != without.end()) continue;
    const auto other = renamed.find(row.key);
    flags.push_back({other == renamed.end() ? flagName(row.key) : std::string(other->second), row.path,
                     std::string(groups.at(row.group))});
  }
  return flags;
}

}  // namespace welkin::app
