// SPDX-License-Identifier: Apache-2.0
#include "help_command.h"

#include <fmt/format.h>

#include <filesystem>

#include "usage_error.h"
#include "welkin/scene/param_json.h"
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

int runInfo(const InfoArgs& args) {
  const std::string extension = std::filesystem::path(args.file).extension().string();
  if (extension != ".toml")
    throw UsageError(args.file + ": this version knows scene files only; expected a name ending in .toml");
  const scene::Scene s = scene::readSceneFile(args.file).scene;
  scene::validate(s);
  fmt::print("{}", args.json ? scene::toJson(s) + "\n" : scene::sceneToToml(s));
  return 0;
}

}  // namespace welkin::app
