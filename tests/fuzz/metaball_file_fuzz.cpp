// SPDX-License-Identifier: Apache-2.0
// Any text as a file of metaballs: it is refused with a ParseError, or read, and then written and read again
// as the same balls.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "welkin/core/error.h"
#include "welkin/scene/metaball_file.h"

namespace {

using namespace welkin;

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  scene::MetaballFile file;
  try {
    file = scene::parseMetaballs(std::string(reinterpret_cast<const char*>(data), size), "fuzz.json");
  } catch (const ParseError&) {
    return 0;
  }
  require(!file.levels.empty());
  const scene::MetaballFile again = scene::parseMetaballs(scene::metaballText(file), "again.json");
  require(again.levels.size() == file.levels.size());
  for (std::size_t i = 0; i < file.levels.size(); ++i) {
    require(!file.levels[i].balls.empty());
    require(again.levels[i].balls == file.levels[i].balls);
    require(again.levels[i].relativeL2 == file.levels[i].relativeL2);
    require(again.levels[i].rmse == file.levels[i].rmse);
  }
  return 0;
}
