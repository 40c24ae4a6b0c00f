// SPDX-License-Identifier: Apache-2.0
// A shader's complete text, ready for the compiler, and the names of the files that it was put together from.
#pragma once

#include <string>
#include <vector>

namespace welkin {

struct ShaderSource {
  std::string text;
  // files[i] is the file that "#line N i" in the text and "i:N" in a compiler's log speak of. files[0] is the
  // one asked for.
  std::vector<std::string> files;
};

}  // namespace welkin
