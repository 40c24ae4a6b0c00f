// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/scene_file.h"

#include <algorithm>
#include <filesystem>
#include <initializer_list>

#include "welkin/core/error.h"
#include "welkin/scene/sheet_reader.h"
#include "welkin/scene/theme.h"
#include "welkin/scene/toml_reader.h"
#include "welkin/scene/toml_writer.h"

namespace welkin::scene {
namespace {

// Layers with what is typical of their genus, before the reader sets what the file says. Mistakes are left
// for the reader.
std::vector<weather::Layer> typicalLayers(const toml::table& root, double latitudeDeg) {
  std::vector<weather::Layer> layers;
  const toml::array* list = root["layer"].as_array();
  if (list == nullptr) return layers;
  const auto& names = kEnumNames<weather::Genus>;
  for (const toml::node& element : *list) {
    weather::Layer layer;
    if (const toml::table* table = element.as_table()) {
      const auto name = (*table)["genus"].value<std::string>();
      const auto it = name ? std::find(names.begin(), names.end(), *name) : names.end();
      const int genus =
          it == names.end() ? static_cast<int>(layer.genus) : static_cast<int>(it - names.begin());
      layer = weather::typicalLayer(static_cast<weather::Genus>(genus), latitudeDeg);
      if (const auto base = (*table)["base_m"].value<double>())
        layer.topM = *base + (layer.topM - layer.baseM);
    }
    layers.push_back(layer);
  }
  return layers;
}

bool isBuiltIn(const std::string& theme) {
  return std::find(kThemeNames.begin(), kThemeNames.end(), theme) != kThemeNames.end();
}

// The theme that the file names, or that wins over it; notes its file.
std::optional<Theme> themeIn(const toml::table& root, const std::string& name,
                             const std::optional<std::string>& wins, std::optional<std::string>& file) {
  if (wins && !isBuiltIn(*wins)) file = *wins;
  if (wins) return readTheme(*wins);
  const toml::node* node = root.get("theme");
  const auto theme = node ? node->value<std::string>() : std::nullopt;
  if (!theme) return std::nullopt;
  try {
    if (isBuiltIn(*theme)) return readTheme(*theme);
    file = besideFile(name, *theme);
    return readTheme(*file);
  } catch (const ParameterError& e) {
    throw ParseError(name, static_cast<int>(node->source().begin.line),
                     static_cast<int>(node->source().begin.column), e.what());
  }
}

}  // namespace

bool SceneFile::gives(std::string_view path) const {
  return std::find(given.begin(), given.end(), path) != given.end();
}

SceneFile parseScene(std::string_view text, const std::string& name, std::optional<double> latitudeDeg,
                     const std::optional<std::string>& theme) {
  const toml::table root = parseToml(text, name);
  SceneFile file;
  Scene& scene = file.scene;
  if (!latitudeDeg) latitudeDeg = root["place"]["latitude_deg"].value<double>();
  scene.layers = typicalLayers(root, latitudeDeg.value_or(scene.place.latitudeDeg));
  const std::optional<Theme> start = themeIn(root, name, theme, file.themeFile);
  if (start) apply(*start, scene);
  scene.sheets = startingSheets(root, name);
  TomlReader reader(root, name, documentParams<Scene>());
  describe(scene, reader);
  reader.finish();
  file.given = std::move(reader.given);

  scene.theme.reset();
  finishSheets(scene.sheets, name);
  for (MetaballCloud& cloud : scene.metaballs)
    if (!cloud.file.empty()) cloud.file = besideFile(name, cloud.file);
  if (start) scene.sheets.insert(scene.sheets.begin(), start->sheets.begin(), start->sheets.end());
  SkyBox& box = scene.skyBox;
  for (auto* path : {&box.strip, &box.px, &box.nx, &box.py, &box.ny, &box.pz, &box.nz})
    if (*path) *path = besideFile(name, **path);
  return file;
}

SceneFile readSceneFile(const std::string& path, std::optional<double> latitudeDeg,
                        const std::optional<std::string>& theme) {
  return parseScene(readText(path, "a scene file"), path, latitudeDeg, theme);
}

std::vector<ParamDoc> documentSceneFile() {
  std::vector<ParamDoc> rows = documentParams<Scene>();
  for (ParamDoc& row : rows)
    if (row.group == "[[layer]]" && row.key != "genus" && row.key != "oktas") row.defaultValue = "typical";
  return rows;
}

std::string sceneToToml(const Scene& scene) {
  return toToml(scene);
}

}  // namespace welkin::scene
