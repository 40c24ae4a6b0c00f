// SPDX-License-Identifier: Apache-2.0
// What is particular to [[sheet]] in files: presets, and paths. For the .cpp files of this folder alone.
#pragma once

#include <string>
#include <vector>

#include "welkin/scene/sheet.h"
#include "welkin/scene/toml_reader.h"

namespace welkin::scene {

// A path that stands in the file `name`, from here.
std::string besideFile(const std::string& name, const std::string& path);

// As many sheets as the file has, each as its preset has it, before the reader sets what the file says.
// Mistakes are left for the reader, but for names that are no preset's: ParseError.
std::vector<Sheet> startingSheets(const toml::table& root, const std::string& name);

// After it: they are valid (ParseError), nothing is left of presets, and paths are from here.
void finishSheets(std::vector<Sheet>& sheets, const toml::table& root, const std::string& name);

}  // namespace welkin::scene
