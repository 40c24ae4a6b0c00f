// SPDX-License-Identifier: Apache-2.0
// A flag for each described parameter, so that whatever the library can do has a flag, described once.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "usage_error.h"
#include "welkin/scene/param_docs.h"
#include "welkin/scene/param_text.h"

namespace welkin::app {

// Texts from the command line, by the path of the parameter: "cloud.cutoff" to "0.7".
using ParamTexts = std::map<std::string, std::string>;

struct ParamFlag {
  std::string name;  // "--cutoff"
  std::string path;  // "cloud.cutoff"
  std::string group;
};

// The name that a parameter has as a flag: its key with hyphens and without its unit ("--voxel" for voxel_m).
std::string flagName(std::string_view key);

// Flags of all rows but those whose key is in `without`. `renamed` maps keys to names that are not the usual
// ones; `groups` gives the heading in the help for the group of a row ("" for the top).
std::vector<ParamFlag> paramFlags(std::span<const scene::ParamDoc> rows,
                                  const std::map<std::string_view, std::string_view>& renamed,
                                  const std::map<std::string_view, std::string_view>& groups,
                                  std::span<const std::string_view> without);

// Sets what the texts say. Throws UsageError that names the flag.
template <class T>
void applyTexts(T& params, const ParamTexts& texts, std::span<const ParamFlag> flags) {
  for (const ParamFlag& flag : flags) {
    const auto text = texts.find(flag.path);
    if (text == texts.end()) continue;
    try {
      scene::setParam(params, flag.path, text->second);
    } catch (const ParameterError& e) {
      throw UsageError(flag.name + ": " + e.what());
    }
  }
}

}  // namespace welkin::app
