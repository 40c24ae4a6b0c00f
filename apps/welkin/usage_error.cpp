// SPDX-License-Identifier: Apache-2.0
#include "usage_error.h"

#include <filesystem>

#include "welkin/scene/toml_reader.h"

namespace welkin::app {

std::string wrongKind(const std::string& path, const std::string& expected) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return path + ": " + (extension.empty() ? "no extension" : "unknown extension " + extension) +
         "; expected " + expected;
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& names) {
  const std::string near = nearestName(word, names);
  return near.empty() ? "" : "; did you mean " + near + "?";
}

}  // namespace welkin::app
