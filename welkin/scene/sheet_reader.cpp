// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/sheet_reader.h"

#include <filesystem>
#include <utility>

namespace welkin::scene {

std::string besideFile(const std::string& name, const std::string& path) {
  return (std::filesystem::path(name).parent_path() / path).string();  // an absolute path stays what it is
}

std::vector<Sheet> startingSheets(const toml::table& root, const std::string& name) {
  std::vector<Sheet> sheets;
  const toml::array* list = root["sheet"].as_array();
  if (list == nullptr) return sheets;
  for (const toml::node& element : *list) {
    Sheet sheet;
    const toml::table* table = element.as_table();
    const toml::node* node = table ? table->get("preset") : nullptr;
    if (const auto preset = node ? node->value<std::string>() : std::nullopt) {
      try {
        sheet = sheetOf(sheetPreset(*preset));
      } catch (const ParameterError& e) {
        throw errorAt(*node, name, e.what());
      }
      // The one takes the other's place, unless the file gives both.
      if (table->contains("exponent")) sheet.density.reset();
    }
    sheets.push_back(std::move(sheet));
  }
  return sheets;
}

void finishSheets(std::vector<Sheet>& sheets, const toml::table& root, const std::string& name) {
  validateEach(sheets, root, "sheet", name);
  for (Sheet& sheet : sheets) {
    sheet.preset.reset();
    if (sheet.texture) sheet.texture = besideFile(name, *sheet.texture);
  }
}

}  // namespace welkin::scene
