// SPDX-License-Identifier: Apache-2.0
#include "help_command.h"

#include <fmt/format.h>

#include "welkin/scene/scene_file.h"

namespace welkin::app {

int runHelpScene(const HelpSceneArgs& args) {
  const auto docs = scene::documentSceneFile();
  if (args.markdown)
    fmt::print("{}", scene::markdownTable(docs));
  else
    fmt::print("A scene file is TOML. Every key may be left out.\n\n{}", scene::plainTable(docs));
  return 0;
}

}  // namespace welkin::app
