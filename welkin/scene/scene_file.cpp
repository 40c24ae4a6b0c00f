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
#include "welkin/weather/metar.h"

namespace welkin::scene {
namespace {

// What is typical of the genus, before the reader sets what the file says. Other mistakes are left for the
// reader; to it a radius of ice would be a key that is not known.
weather::Layer typicalLayer(const toml::table& table, double latitudeDeg, const std::string& file) {
  const auto& names = kEnumNames<weather::Genus>;
  const auto name = table["genus"].value<std::string>();
  const auto it = name ? std::find(names.begin(), names.end(), *name) : names.end();
  const auto genus =
      it == names.end() ? weather::Layer{}.genus : static_cast<weather::Genus>(it - names.begin());
  weather::Layer layer = weather::typicalLayer(genus, latitudeDeg);
  layer.oktas = weather::typicalOktas(genus);
  if (const auto base = table["base_m"].value<double>()) layer.topM = *base + (layer.topM - layer.baseM);
  const toml::node* radius = table.get("effective_radius_um");
  if (radius != nullptr && isIce(genus))
    throw errorAt(*radius, file,
                  "effective_radius_um is of droplets, and " + *name + " is of ice; expected none");
  return layer;
}

std::vector<weather::Layer> typicalLayers(const toml::table& root, double latitudeDeg,
                                          const std::string& file) {
  std::vector<weather::Layer> layers;
  const toml::array* list = root["layer"].as_array();
  if (list == nullptr) return layers;
  for (const toml::node& element : *list) {
    const toml::table* table = element.as_table();
    layers.push_back(table ? typicalLayer(*table, latitudeDeg, file) : weather::Layer{});
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
    throw errorAt(*node, name, e.what());
  } catch (const IoError& e) {
    throw errorAt(*node, name, std::string("theme: ") + e.what());
  }
}

// The files that a picture cannot do without.
void requireFiles(const toml::table& root, const std::string& name) {
  const auto require = [&](const char* key, const toml::node* node) {
    const auto file = node ? node->value<std::string>() : std::nullopt;
    if (!file) return;
    if (file->empty())
      throw errorAt(*node, name, std::string(key) + " is empty; expected the name of a file");
    const std::string path = besideFile(name, *file);
    if (!std::filesystem::exists(path))
      throw errorAt(*node, name, std::string(key) + ": there is no file " + path);
  };
  for (const char* key : {"strip", "px", "nx", "py", "ny", "pz", "nz"})
    require(key, root["sky_box"][key].node());
  if (const toml::array* clouds = root["metaballs"].as_array())
    for (const toml::node& cloud : *clouds) require("file", cloud.as_table()->get("file"));
}

// The ranges of what the file gives are checked by now: only base and top can be at odds. The one that it
// does not give is no key that a message may name.
void validateLayers(const std::vector<weather::Layer>& layers, const toml::table& root,
                    const std::string& name) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const weather::Layer& layer = layers[i];
    const toml::table& table = *root["layer"][i].as_table();
    const toml::node *base = table.get("base_m"), *top = table.get("top_m");
    const std::string genus(kEnumNames<weather::Genus>[static_cast<std::size_t>(layer.genus)]);
    try {
      weather::validate(layer);
    } catch (const ParameterError& e) {
      if (base && !top)
        throw errorAt(*base, name,
                      "base_m is " + numberText(layer.baseM) + ", too high for the typical thickness of " +
                          genus + ", " + numberText(layer.topM - layer.baseM) +
                          " m; expected a lower one, or a top_m");
      if (top && !base)
        throw errorAt(*top, name,
                      "top_m is " + numberText(layer.topM) + "; expected it above the typical base of " +
                          genus + ", " + numberText(layer.baseM) + " m, or a base_m");
      throw errorAt(top ? *top : table, name, e.what());
    }
  }
}

// A report that the file gives.
void validateReport(const Scene& scene, const toml::table& root, const std::string& name) {
  if (!scene.metar) return;
  const weather::MetarResult result = weather::parseMetar(*scene.metar);
  if (!result.ok())
    throw errorAt(*root.get("metar"), name,
                  "metar: column " + std::to_string(result.errors.front().column) +
                      " of the report: " + result.errors.front().reason);
  if (result.metar.nil)
    throw errorAt(*root.get("metar"), name, "metar: the report is NIL, which says nothing about the weather");
}

// Keys of a table that are at odds.
template <class T>
void validateTable(const T& group, const toml::table& root, std::string_view key, const std::string& name) {
  try {
    validate(group);
  } catch (const ParameterError& e) {
    const toml::node* node = root.get(key);
    throw errorAt(node ? *node : root, name, e.what());
  }
}

// A slab stands in the place of the whole sky: what describes that would be without effect. What a file gives
// with its default, as `welkin info` prints it, asks for nothing.
void refuseSky(const SceneFile& file, const toml::table& root, const std::string& name) {
  const auto refuse = [&](const std::string& path, const std::string& called, const std::string& hint) {
    if (const toml::node* node = root.at_path(path).node())
      throw errorAt(*node, name, called + " has no effect beside a slab; " + hint);
  };
  const std::string oneOfTwo = "expected one of the two";
  refuse("theme", "theme", oneOfTwo);
  const Scene& scene = file.scene;
  if (!scene.layers.empty()) refuse("layer", "[[layer]]", oneOfTwo);
  if (!scene.sheets.empty()) refuse("sheet", "[[sheet]]", oneOfTwo);
  if (!scene.metaballs.empty()) refuse("metaballs", "[[metaballs]]", oneOfTwo);
  const std::vector<ParamDoc> rows = documentParams(scene), defaults = documentParams<Scene>();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ParamDoc& row = rows[i];
    const bool ofSlab = row.group == "[slab]" || row.path == "seed";
    if (!ofSlab && row.defaultValue != defaults[i].defaultValue && file.gives(row.path))
      refuse(row.path, row.key + (row.group.empty() ? "" : " in " + row.group),
             row.path == "ground.albedo" ? "did you mean ground_albedo in [slab]?" : oneOfTwo);
  }
}

// At the key of [slab] that the message begins with, or at what makes a slab of it.
void validateSlab(const SceneFile& file, const toml::table& root, const std::string& name) {
  const Scene& scene = file.scene;
  try {
    validate(scene.slab);
  } catch (const ParameterError& e) {
    const std::string_view message = e.what();
    const toml::node* at = root["slab"][message.substr(0, message.find(' '))].node();
    if (at == nullptr) at = root.get(scene.slab.opticalDepth ? "slab" : "slab_column");
    throw errorAt(*at, name, e.what());
  }
  if (!scene.slab.empty()) return refuseSky(file, root, name);
  if (scene.slab != Slab{})
    throw errorAt(*root.get("slab"), name,
                  "slab has no optical_depth; expected one, or columns: [[slab_column]]");
}

// What does not fit together in the whole of the file.
std::optional<ParseError> misfitIn(const Scene& scene, const toml::table& root, const std::string& name) {
  try {
    validate(scene);
  } catch (const MisfitError& e) {
    for (const std::string& key : e.keys())
      if (const toml::node* node = root.at_path(key).node()) return errorAt(*node, name, e.what());
    return ParseError(name, 0, 0, e.what());
  } catch (const ParameterError& e) {
    return ParseError(name, 0, 0, e.what());
  }
  return std::nullopt;
}

SceneFile parseDraft(std::string_view text, const std::string& name, std::optional<double> latitudeDeg,
                     const std::optional<std::string>& theme) {
  const toml::table root = parseToml(text, name);
  SceneFile file;
  Scene& scene = file.scene;
  if (!latitudeDeg) latitudeDeg = root["place"]["latitude_deg"].value<double>();
  scene.layers = typicalLayers(root, latitudeDeg.value_or(scene.place.latitudeDeg), name);
  const std::optional<Theme> start = themeIn(root, name, theme, file.themeFile);
  if (start) apply(*start, scene);
  scene.sheets = startingSheets(root, name);
  TomlReader reader(root, name, documentParams<Scene>());
  describe(scene, reader);
  reader.finish();
  file.given = std::move(reader.given);
  setNaturalSize(scene, file.gives("output.width"), file.gives("output.height"));

  scene.theme.reset();
  validateReport(scene, root, name);
  if (!file.gives("time")) setTimeOfReport(scene);
  validateLayers(scene.layers, root, name);
  finishSheets(scene.sheets, root, name);
  validateEach(scene.metaballs, root, "metaballs", name);
  validateTable(scene.skyBox, root, "sky_box", name);
  validateSlab(file, root, name);
  for (MetaballCloud& cloud : scene.metaballs)
    if (!cloud.file.empty()) cloud.file = besideFile(name, cloud.file);
  if (start) scene.sheets.insert(scene.sheets.begin(), start->sheets.begin(), start->sheets.end());
  SkyBox& box = scene.skyBox;
  for (auto* path : {&box.strip, &box.px, &box.nx, &box.py, &box.ny, &box.pz, &box.nz})
    if (*path) *path = besideFile(name, **path);
  file.misfit = misfitIn(scene, root, name);
  return file;
}

SceneFile fitting(SceneFile file) {
  if (file.misfit) throw ParseError(*file.misfit);
  return file;
}

}  // namespace

bool SceneFile::gives(std::string_view path) const {
  return std::find(given.begin(), given.end(), path) != given.end();
}

void setTimeOfReport(Scene& scene) {
  if (!scene.metar) return;
  const weather::Metar report = weather::parseMetar(*scene.metar).metar;
  if (!report.day) return;
  UtcTime time = Scene{}.time;
  const UtcTime monthStart{time.year, time.month, 1, *report.hour, *report.minute, 0.0};
  constexpr double kDayS = 86400.0;
  time = addSeconds(monthStart, (*report.day - 1) * kDayS);
  if (time.day != *report.day)  // no two months in a row lack it
    time = addSeconds(addSeconds(monthStart, -kDayS), (*report.day - 31) * kDayS);
  scene.time = time;
}

SceneFile parseScene(std::string_view text, const std::string& name, std::optional<double> latitudeDeg,
                     const std::optional<std::string>& theme) {
  return fitting(parseDraft(text, name, latitudeDeg, theme));
}

SceneFile readSceneDraft(const std::string& path, std::optional<double> latitudeDeg,
                         const std::optional<std::string>& theme) {
  const std::string text = readText(path, "a scene file");
  SceneFile file = parseDraft(text, path, latitudeDeg, theme);
  requireFiles(parseToml(text, path), path);
  return file;
}

SceneFile readSceneFile(const std::string& path, std::optional<double> latitudeDeg,
                        const std::optional<std::string>& theme) {
  return fitting(readSceneDraft(path, latitudeDeg, theme));
}

std::vector<ParamDoc> documentSceneFile() {
  std::vector<ParamDoc> rows = documentParams<Scene>();
  for (ParamDoc& row : rows) {
    if (row.group == "[[layer]]" && row.key != "genus") row.defaultValue = "typical";
    if (row.path == "output.width" || row.path == "output.height") row.defaultValue = "of the projection";
  }
  return rows;
}

std::string sceneToToml(const Scene& scene) {
  return toToml(scene);
}

}  // namespace welkin::scene
