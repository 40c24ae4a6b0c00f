// SPDX-License-Identifier: Apache-2.0
// Scene files: a Scene as TOML (https://toml.io, version 1.0). Keys, units and ranges are those of the
// descriptions in scene.h, weather.h and atmosphere_params.h; docs/scene_file.md lists them.
//
// What a file leaves out keeps its default. A [[layer]] may name only its genus: the rest is
// weather::typicalLayer() for the latitude of the place; one that moves base_m but not top_m keeps the
// typical thickness.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/scene/param_docs.h"
#include "welkin/scene/scene.h"

namespace welkin::scene {

struct SceneFile {
  Scene scene;
  std::vector<std::string> given;  // paths of the parameters that the file names: "seed", "output.width"
  std::optional<std::string> themeFile;  // that a theme was read from; absent for built-in ones
  std::optional<ParseError> misfit;      // of a draft: what does not fit together in it

  bool gives(std::string_view path) const;
};

// latitudeDeg: of the place when something else than the file decides it, for what is typical of a layer
// there. theme: a name or path that wins over the file's `theme`. Throws IoError when the file cannot be
// read; ParseError with file:line:column for bad TOML, an unknown key (naming the nearest known one), a value
// of the wrong type, a value outside its range, keys that are at odds (validate() in scene.h), and a file
// that it names and that is not there, but for textures; what readTheme() throws.
//
// A picture whose width or height the file leaves out has the size that suits its projection.
//
// Presets and themes are replaced by what they stand for, and the paths of files, which are relative to the
// scene file, by paths from here.
SceneFile readSceneFile(const std::string& path, std::optional<double> latitudeDeg = {},
                        const std::optional<std::string>& theme = {});

// The same, but for values of several tables that do not fit together, which it only notes: for a caller who
// sets others in their place, checks the scene himself and throws `misfit` when it is not mended.
SceneFile readSceneDraft(const std::string& path, std::optional<double> latitudeDeg = {},
                         const std::optional<std::string>& theme = {});

// readSceneFile() from memory, without a look for files but a theme's; `name` stands for the file in
// messages, and its folder for the file's.
SceneFile parseScene(std::string_view text, const std::string& name, std::optional<double> latitudeDeg = {},
                     const std::optional<std::string>& theme = {});

// Gives the scene the day, hour and minute of its report, where that can be read, in the month and year of
// the scene's default time; a day that the month does not have, in the last month before it that has. The
// readers above do so where the file gives a report and no time.
void setTimeOfReport(Scene& scene);

// Every key of a scene file, with what is taken when the file does not have it.
std::vector<ParamDoc> documentSceneFile();

// A scene file that reads back as the same scene; every key is written but those that are absent.
std::string sceneToToml(const Scene& scene);

}  // namespace welkin::scene
