// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/cover_warnings.h"

#include <cmath>

#include "welkin/core/param_range.h"
#include "welkin/field/cover.h"

namespace welkin::scene {
namespace {

constexpr double kShortOktas = 0.5;  // by which less is covered than was asked for

bool isShort(const LayerCover& cover) {
  return cover.requestedOktas - cover.deliveredOktas > kShortOktas;
}

std::string oktasText(double oktas) {
  return numberText(std::round(10.0 * oktas) / 10.0);
}

std::string shortfall(const std::string& called, double coveredOktas, double askedOktas) {
  return called + " covers " + oktasText(coveredOktas) + " oktas and not " + oktasText(askedOktas);
}

std::string nameOf(const weather::Layer& layer) {
  return "the " + std::string(kEnumNames<weather::Genus>[static_cast<std::size_t>(layer.genus)]) + " from " +
         numberText(layer.baseM) + " to " + numberText(layer.topM) + " m";
}

// Nothing where the sheet is as it should be.
std::string sheetWarning(const std::string& called, const Sheet& sheet, const LayerCover& cover,
                         const std::string& remedy) {
  if (isShort(cover))
    return shortfall(called, cover.deliveredOktas, cover.requestedOktas) + ": it hides too little; " + remedy;
  if (cover.requestedOktas > 0.0 && sheet.oktas && isOneVeil(sheet))
    return called + " is so thin that its gaps hide as much as its clouds; " + remedy;
  return "";
}

}  // namespace

std::string coversLess(const weather::Layer& layer, double coveredOktas, double askedOktas) {
  return shortfall(nameOf(layer), coveredOktas, askedOktas);
}

std::vector<std::string> coverWarnings(const Scene& scene, const weather::Weather& weather,
                                       const std::vector<LayerCalibration>& calibration,
                                       const DeliveredCover& cover) {
  constexpr float kNear = 0.1f;  // of the least threshold
  std::vector<std::string> all;
  const auto add = [&all](std::string warning) {
    if (!warning.empty()) all.push_back(std::move(warning));
  };
  const std::vector<Sheet> sheets = sheetsOf(scene, weather);
  std::size_t sheet = 0;
  for (std::size_t i = 0; i < weather.layers.size(); ++i) {
    const weather::Layer& layer = weather.layers[i];
    const LayerCover& c = cover.layers[i];
    if (isSheet(scene, layer))
      add(sheetWarning(nameOf(layer), sheets[sheet++], c, "a greater extinction_per_m hides more"));
    else if (isVolume(scene, layer) && isShort(c) &&
             calibration[i].threshold < field::kLeastThreshold + kNear)
      add(coversLess(layer, c.deliveredOktas, c.requestedOktas) +
          ": it is too thin; a greater extinction_per_m or a thicker layer covers more");
  }
  for (std::size_t k = 0; k < cover.sheets.size(); ++k)
    add(sheetWarning("[[sheet]] " + std::to_string(k + 1), sheets[sheet + k], cover.sheets[k],
                     "a greater bias or a smaller density hides more"));
  return all;
}

}  // namespace welkin::scene
