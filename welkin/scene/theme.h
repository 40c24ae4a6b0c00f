// SPDX-License-Identifier: Apache-2.0
// A look of thin layers under a name: their sheets and how they are drawn, without place, time or eye. Saved
// as a scene file that holds nothing else, so that it can be drawn as it is, too.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "welkin/scene/scene.h"

namespace welkin::scene {

struct Theme {
  Technique technique = Technique::kSkyPlane;
  SheetTier tier = SheetTier::kLit;
  Drift drift;
  std::vector<Sheet> sheets;

  bool operator==(const Theme&) const = default;
};
void describe(Theme& t, ParamVisitor& v);

// Those that are built in: the layers of G. Tarantilis's thesis on planes, alone and all three together, his
// dome, and three domes, low, middle and high, over one another as in "Realistic Real-Time Skies" by
// Guthikonda, Meena, Linder and Yi.
inline constexpr std::array<std::string_view, 6> kThemeNames = {
    "thesis-overcast", "thesis-broken", "thesis-few", "thesis-combined", "thesis-dome", "realistic-skies"};

// A built-in theme by its name, or that of a file. Throws ParameterError for a name that is neither built in
// nor ends in .toml, naming the nearest; IoError and ParseError as readSceneFile(), for keys that do not
// belong to a theme as well. Paths in a file are taken from where it lies.
Theme readTheme(const std::string& nameOrPath);

Theme themeOf(const Scene& scene);
void apply(const Theme& theme, Scene& scene);  // in the place of its technique, tier, drift and sheets

// A file that reads back as the same theme.
std::string themeToToml(const Theme& theme);

}  // namespace welkin::scene
