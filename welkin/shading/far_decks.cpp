// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/far_decks.h"

#include <algorithm>
#include <cmath>

#include "welkin/core/units.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/rain_shafts.h"

namespace welkin::shading {
namespace {

// The length of the way s > 0 that is below a height.
double lengthBelow(double heightM, double from, double sine, double radiusM) {
  const double under = radiusM * sine * radiusM * sine + 2.0 * radiusM * (heightM - from);
  if (under <= 0.0) return 0.0;
  const double half = std::sqrt(under), middle = -radiusM * sine;
  return std::max(middle + half, 0.0) - std::max(middle - half, 0.0);
}

}  // namespace

FarDecks::FarDecks(const scene::SkyState& state) : radiusM_(state.clouds->earthRadiusM()) {
  const auto layers = state.clouds->layers();
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (!scene::isVolumeInField(state.scene, state.weather, i)) continue;
    const scene::LayerOfField of = scene::layerOfField(state.scene, state.weather, i);
    if (of.isShaft) continue;
    const double cover = std::clamp(state.weather.layers[of.of].oktas / kOktas, 0.0, 1.0),
                 cloudM = scene::cloudSpacingM(layers[i]);
    // From cloud to cloud, each there with a chance.
    const double passes =
        1.0 - cover + cover * std::exp(-scene::kMeanDensity * layers[i].extinction * cloudM);
    if (passes < 1.0) decks_[count_++] = {layers[i].baseM, layers[i].topM, -std::log(passes) / cloudM};
  }
  constexpr double kOpen = 0.05;
  for (const Deck& deck : decks()) openBelow_ &= through(deck.baseM, kFromBelow, false) > kOpen;
}

double FarDecks::through(double heightM, double sine, bool towardsLight) const {
  if (sine >= kLeastElevation) return 1.0;  // the line is longer
  double depth = 0.0;
  const double slope = std::max(std::abs(sine), kLeastElevation);
  for (const Deck& deck : decks()) {
    const double way =
        lengthBelow(deck.topM, heightM, sine, radiusM_) - lengthBelow(deck.baseM, heightM, sine, radiusM_);
    const double line = towardsLight ? deck.topM - std::clamp(heightM, deck.baseM, deck.topM)
                                     : std::clamp(heightM, deck.baseM, deck.topM) - deck.baseM;
    depth += deck.perM * std::max(way - line / slope, 0.0);
  }
  return std::exp(-depth);
}

}  // namespace welkin::shading
