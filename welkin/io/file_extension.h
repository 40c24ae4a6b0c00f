// SPDX-License-Identifier: Apache-2.0
// The extension by which a file's format is chosen.
#pragma once

#include <filesystem>
#include <string>

namespace welkin::io {

// ".png" of "Sky.PNG"; empty where there is none. Only the letters A to Z are made small.
inline std::string lowerExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

}  // namespace welkin::io
