// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/cloud_shapes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "welkin/core/random.h"
#include "welkin/weather/wind.h"

namespace welkin::scene {
namespace {

// One genus. Lengths are shares of the layer's depth, within limits, unless they end in M: cells are about as
// wide as clouds are deep (Stull, Practical Meteorology, 6.6). Cells are a twelfth of cellM, blobs of the 3D
// noises a fifth of their period.
struct Habit {
  double cell, cellMinM, cellMaxM;  // distance between cells
  double patchM;                    // size of mesoscale patches
  double cellWeight, fractalWeight, patchWeight;
  double warp;            // share of the cell
  double stretch;         // along the wind
  double dome, domeFull;  // domeFull: so much more at 8 oktas, that gaps which close stay as hollows
  double domePower, belly, anvil;
  double bottomSoft, topSoft;
  double blob, blobMinM, blobMaxM;  // largest blob of the 3D noise
  double shapeAmount, shapeAtBase, shapeStretch, shapeTall;
  double detailM;  // largest bump of the fine noise
  double detailAmount;
  double edge, lift;
  double shear;    // displacement of the top, share of the depth
  double riseMps;  // speed at which shapes move up through the cloud
};

// In the order of weather::Genus. Chosen by eye against photographs of the International Cloud Atlas.
constexpr std::array<Habit, 11> kHabits = {{
    // cumulus: flat bases, domed towers, cauliflower
    {1.7, 700, 4000, 9000, .84, .20, .50, .10, 1.0, 2.6, 2.0, 1.55, .05, 0,  .05,
     .06, .42, 250,  900,  .48, .22, 1.0, 1.0, 75,  .14, .20, .75,  .15, 1.2},
    // stratocumulus: lumps and rolls, shallow, flat below
    {4.0, 900, 3500, 14000, .78, .40, .42, .10, 1.7, 1.40, 2.6, 1.6, .10, 0, .12,
     .18, .90, 250,  700,   .42, .50, 1.2, 1.0, 80,  .17,  .20, .60, .10, .5},
    // stratus: a featureless sheet, gently uneven above
    {6.0, 1500, 5000, 20000, .15, .85, .50, .50, 1.3, .40, 2.0, 1.6, .30, 0, .25,
     .35, 1.2,  300,  900,   .34, .75, 1.5, 1.0, 90,  .20, .40, .30, .10, .2},
    // nimbostratus: deep, dark, ragged beneath
    {1.2, 3000, 9000, 30000, .20, .80, .55, .60, 1.3, .50, 0,   2.5, .50, 0, .12,
     .25, .30,  400,  1200,  .35, .80, 1.3, 1.0, 220, .12, .60, .30, .20, .4},
    // cumulonimbus: broad below, an anvil above that the wind draws out
    {1.9, 12000, 24000, 50000, .80, .20, .38, .08, 1.0, .50,  0,   1.0, -.70, 1.05, .02,
     .12, .13,   600,   1300,  .24, .30, 1.0, 1.0, 160, .065, .15, .55, .40,  4.0},
    // altocumulus: patches of small flat cells
    {1.4, 400, 900, 5500, .80, .20, .90, .20, 1.3, 1.3, 1.0, 1.6, 1.2, 0, .20,
     .25, .55, 120, 300,  .28, .70, 1.2, 0.4, 60,  .12, .60, .20, .20, .3},
    // altostratus: a thin wide veil, streaked
    {3.0, 3000, 9000, 40000, .10, .85, .52, .60, 2.2, .35, 0,   2.0, .35, 0, .30,
     .35, .50,  500,  1500,  .30, .80, 2.5, 1.0, 260, .10, .90, .10, .60, .2},
    // cirrus: fibres drawn out by wind shear
    {2.0, 1200, 3000, 26000, .10, .80, .58, 1.10, 7.0, .60, 0,    1.0, .30, 0, .25,
     .25, .70,  350,  700,   .75, .90, 9.0, 1.0,  130, .55, 1.70, .00, 4.0, .3},
    // cirrocumulus: grains and ripples
    {.9,  180, 380, 9000, .82, .25, .52, .15, 1.8, .45, 0,   2.0, .35, 0, .25,
     .25, .40, 90,  200,  .40, .80, 1.8, 1.0, 45,  .15, .60, .00, .50, .2},
    // cirrostratus: an even veil
    {5.0, 4000, 9000, 60000, .05, .80, .60, .60, 4.0, .25, 0,    2.0, .25, 0, .30,
     .30, .80,  700,  1500,  .22, .90, 5.0, 1.0, 300, .10, 1.50, .00, 2.0, .1},
    // fog
    {8.0, 900, 2500, 9000, .10, .85, .50, .50, 1.3, .70, 0,   1.6, 0,   0, .001,
     .40, 1.2, 90,   220,  .30, .40, 1.5, 1.0, 60,  .12, .60, .00, .20, .1},
}};

// Deep cumulus: towers that are broad below, with turrets above.
constexpr Habit kCongestus = {1.7, 700, 9000, 20000, .78, .25, .40, .10, 1.0, 1.9, 2.0, 1.85, -.10, 0,  .05,
                              .05, .28, 250,  2000,  .54, .25, 1.0, 1.0, 115, .10, .18, .75,  .15,  1.2};
// What is left of nimbostratus that is broken: torn patches that thin out upwards, not blocks of a deck.
constexpr Habit kBrokenRainClouds = {1.2, 3000, 9000, 16000, .15, .90, .45, .60, 1.8,  3.2,
                                     0,   1.1,  .25,  0,     .12, .25, .30, 400, 1200, .55,
                                     .70, 1.8,  0.6,  140,   .22, 1.3, .20, .60, .4};
constexpr double kDeckOktas = 7.5, kBrokenOktas = 4.5;  // of either

constexpr double kMediocrisM = 1000.0, kCongestusM = 2000.0;  // depths of either

Habit mixed(const Habit& a, const Habit& b, double share) {
  using Numbers = std::array<double, sizeof(Habit) / sizeof(double)>;
  auto numbers = std::bit_cast<Numbers>(a);
  const auto others = std::bit_cast<Numbers>(b);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = std::lerp(numbers[i], others[i], share);
  return std::bit_cast<Habit>(numbers);
}

Habit habitOf(const weather::Layer& layer) {
  const double depthM = layer.topM - layer.baseM;
  const Habit& habit = kHabits[static_cast<std::size_t>(layer.genus)];
  if (layer.genus == weather::Genus::kNimbostratus)
    return mixed(habit, kBrokenRainClouds,
                 std::clamp((kDeckOktas - layer.oktas) / (kDeckOktas - kBrokenOktas), 0.0, 1.0));
  if (layer.genus != weather::Genus::kCumulus) return habit;
  return mixed(habit, kCongestus, std::clamp((depthM - kMediocrisM) / (kCongestusM - kMediocrisM), 0.0, 1.0));
}

// How much farther apart cumulus stand than at half cover. They are as broad then as they are deep, where few
// in the same pattern would be its peaks alone, slender and pointed.
double spacingOf(const weather::Layer& layer) {
  constexpr double kHalf = 4.0, kFewest = 1.0, kPower = 0.8;
  if (layer.genus != weather::Genus::kCumulus) return 1.0;
  return std::pow(kHalf / std::clamp(layer.oktas, kFewest, kHalf), kPower);
}

}  // namespace

double dropletDiameterUm(const weather::Weather& weather) {
  constexpr double kWithoutWater = 16.0;
  double diameter = 0.0, weight = 1e-9;
  for (const weather::Layer& layer : weather.layers) {
    if (isIce(layer.genus)) continue;
    diameter += 2.0 * layer.effectiveRadiusUm * layer.oktas;
    weight += layer.oktas;
  }
  return diameter > 0.0 ? diameter / weight : kWithoutWater;
}

glm::vec3 noiseShiftM(const weather::Layer& layer, double lag, double riseMps, float periodM,
                      double secondsAfter, double fromM) {
  const auto period = static_cast<double>(periodM);
  return {field::withinPeriod(-lag * layer.windSpeedMps * secondsAfter, period), 0.0,
          field::withinPeriod(riseMps * secondsAfter, period) + fromM};
}

field::CloudLayer shapeOf(const weather::Layer& layer, std::uint64_t seed, double secondsAfter) {
  const double depth = layer.topM - layer.baseM;
  const Habit habit = habitOf(layer);
  const double spacing = spacingOf(layer);
  const double cell = spacing * std::clamp(habit.cell * depth, habit.cellMinM, habit.cellMaxM);
  const double blob = std::clamp(habit.blob * depth, habit.blobMinM, habit.blobMaxM);
  const double weights =
      std::sqrt(habit.cellWeight * habit.cellWeight + habit.fractalWeight * habit.fractalWeight +
                habit.patchWeight * habit.patchWeight);
  const glm::dvec2 windDirection = weather::windTowards(layer.windFromDeg);
  Random random(seed);
  const double offsetX = 2.0e5 * random.uniform(), offsetY = 2.0e5 * random.uniform();
  const double offsetZ = 1.0e4 * random.uniform();

  field::CloudLayer s{};
  s.baseM = static_cast<float>(layer.baseM);
  s.topM = static_cast<float>(layer.topM);
  s.extinction = static_cast<float>(layer.extinctionPerM);
  s.threshold = 0.0f;
  s.driftM = glm::vec2(glm::dvec2(offsetX, offsetY));
  s.shearM = glm::vec2(windDirection * (habit.shear * depth));
  s.along = glm::vec2(windDirection);
  s.stretch = static_cast<float>(habit.stretch);
  s.cellM = static_cast<float>(kCloudsAPeriod * cell);
  s.cellWeight = static_cast<float>(habit.cellWeight / weights);
  s.fractalWeight = static_cast<float>(habit.fractalWeight / weights);
  s.patchWeight = static_cast<float>(habit.patchWeight / weights);
  s.patchM = static_cast<float>(6.0 * spacing * habit.patchM);
  s.warpM = static_cast<float>(habit.warp * cell);
  s.dome = static_cast<float>(habit.dome + habit.domeFull * std::clamp((layer.oktas - 4.0) / 4.0, 0.0, 1.0));
  s.domePower = static_cast<float>(habit.domePower);
  s.belly = static_cast<float>(habit.belly);
  s.anvil = static_cast<float>(habit.anvil);
  s.bottomSoft = static_cast<float>(habit.bottomSoft);
  s.topSoft = static_cast<float>(habit.topSoft);
  s.shapeM = static_cast<float>(5.0 * blob);
  s.shapeAmount = static_cast<float>(habit.shapeAmount);
  s.shapeAtBase = static_cast<float>(habit.shapeAtBase);
  s.shapeStretch = static_cast<float>(habit.shapeStretch);
  s.shapeTall = static_cast<float>(habit.shapeTall);
  s.detailM = static_cast<float>(5.0 * habit.detailM);
  s.detailAmount = static_cast<float>(habit.detailAmount);
  // Shapes rise through the cloud and lag behind it; the fine ones faster. So every octave moves against the
  // others and the sum never returns, while any instant can be had directly.
  s.shapeShiftM = noiseShiftM(layer, kShapeLag, habit.riseMps, s.shapeM, secondsAfter, offsetZ);
  s.detailShiftM = noiseShiftM(layer, kDetailLag, 1.8 * habit.riseMps, s.detailM, secondsAfter, offsetZ);
  s.edge = static_cast<float>(habit.edge / spacing);  // as deep in metres
  s.lift = static_cast<float>(habit.lift);
  // The steepest: tops, and the underside of an anvil.
  const double atTop = depth / std::max(4.0, s.dome * habit.domePower);
  const double underAnvil = habit.anvil > 0.0 ? 0.14 * depth / habit.anvil : depth;
  s.reachM = static_cast<float>(std::min({0.08 * cell, atTop, underAnvil}));
  return s;
}

}  // namespace welkin::scene
