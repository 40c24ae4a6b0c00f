// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/theme.h"

#include <algorithm>
#include <filesystem>
#include <span>

#include "welkin/core/error.h"
#include "welkin/scene/sheet_reader.h"
#include "welkin/scene/toml_reader.h"
#include "welkin/scene/toml_writer.h"

namespace welkin::scene {
namespace {

Theme thesisPlanes(std::initializer_list<field::ThesisTexture> presets) {
  Theme theme;
  theme.technique = Technique::kPlane;
  for (const field::ThesisTexture preset : presets) {
    theme.sheets.push_back(sheetOf(preset));
    theme.sheets.back().surface = SheetSurface::kPlane;
  }
  return theme;
}

Theme thesisDome() {
  Theme theme;
  theme.technique = Technique::kDome;
  theme.sheets = {sheetOf(field::ThesisTexture::kDome)};
  return theme;
}

// The paper's half spheres, one in the other, with its four octaves. Cover and sharpness in the place of
// cutoff and density: cutoff = 1 - cover, density = 1 - sharpness. It has no numbers for them: chosen by eye,
// thinner with height.
Theme realisticSkies() {
  Theme theme;
  theme.technique = Technique::kDome;
  struct Layer {
    double heightM, cover, sharpness, bias, speedMps;
  };
  for (const Layer& layer : {Layer{1500.0, 0.34, 0.04, 1.0, 9.0}, Layer{4000.0, 0.34, 0.02, 0.8, 14.0},
                             Layer{8500.0, 0.42, 0.006, 0.5, 24.0}}) {
    Sheet s;
    s.surface = SheetSurface::kHemisphere;
    s.pattern = SheetPattern::kOctaves;
    s.living.kernel = OctaveKernel::kCourse;
    s.octaves = 4;
    s.heightM = layer.heightM;
    s.tileM = 4.0 * layer.heightM;
    s.cutoff = 1.0 - layer.cover;
    s.density = 1.0 - layer.sharpness;
    s.bias = layer.bias;
    s.windSpeedMps = layer.speedMps;
    theme.sheets.push_back(s);
  }
  return theme;
}

Theme builtIn(std::size_t index) {
  using enum field::ThesisTexture;
  switch (index) {
    case 0:
      return thesisPlanes({kOvercast});
    case 1:
      return thesisPlanes({kBroken});
    case 2:
      return thesisPlanes({kFew});
    case 3:
      return thesisPlanes({kOvercast, kBroken, kFew});
    case 4:
      return thesisDome();
    default:
      return realisticSkies();
  }
}

std::string notATheme(const std::string& name) {
  const std::vector<std::string> names(kThemeNames.begin(), kThemeNames.end());
  std::string message = "there is no theme \"" + name + "\"";
  if (const std::string near = nearestName(name, names); !near.empty())
    return message + "; did you mean \"" + near + "\"?";
  std::string list;
  for (const std::string& n : names) list += n + ", ";
  return message + "; expected one of " + list + "or a file that ends in .toml";
}

}  // namespace

void describe(Theme& t, ParamVisitor& v) {
  v.choice({"technique", "", "how the layers of the weather are drawn"}, t.technique);
  v.choice({"tier", "", "how they are lit"}, t.tier);
  v.group({"drift", "", "wind and cover that wander by themselves"}, t.drift);
  v.list({"sheet", "", "a thin layer of cloud"}, t.sheets);
}

Theme readTheme(const std::string& nameOrPath) {
  const auto it = std::find(kThemeNames.begin(), kThemeNames.end(), nameOrPath);
  if (it != kThemeNames.end()) return builtIn(static_cast<std::size_t>(it - kThemeNames.begin()));
  if (std::filesystem::path(nameOrPath).extension() != ".toml") throw ParameterError(notATheme(nameOrPath));
  const toml::table root = parseToml(readText(nameOrPath, "a theme"), nameOrPath);
  Theme theme;
  theme.sheets = startingSheets(root, nameOrPath);
  TomlReader reader(root, nameOrPath, documentParams<Theme>());
  describe(theme, reader);
  reader.finish();
  finishSheets(theme.sheets, root, nameOrPath);
  return theme;
}

Theme themeOf(const Scene& scene) {
  return {scene.technique, scene.tier, scene.drift, scene.sheets};
}

void apply(const Theme& theme, Scene& scene) {
  scene.technique = theme.technique;
  scene.tier = theme.tier;
  scene.drift = theme.drift;
  scene.sheets = theme.sheets;
}

std::string themeToToml(const Theme& theme) {
  return toToml(theme);
}

}  // namespace welkin::scene
