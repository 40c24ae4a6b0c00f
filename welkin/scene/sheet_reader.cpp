// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/sheet_reader.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace welkin::scene {
namespace {

constexpr std::int64_t kDomeTexels = 128;  // unless told; a volume has them in three directions

}  // namespace

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
    const auto surface = table ? (*table)["surface"].value<std::string>() : std::nullopt;
    if (surface == kEnumNames<SheetSurface>[static_cast<std::size_t>(SheetSurface::kDome)])
      sheet.texels = std::min(sheet.texels, kDomeTexels);
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
