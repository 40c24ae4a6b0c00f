// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/cover_calibration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "welkin/core/random.h"
#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"
#include "welkin/scene/cloud_cover.h"

namespace welkin::scene {
namespace {

constexpr field::CoverView kView{.directions = 1000};

constexpr int kPatterns = 5;             // places in a layer's pattern that are tried
constexpr double kCloseOktas = 0.2;      // a union as close as this will do
constexpr double kMostExtraOktas = 0.2;  // by which a layer's own cover may differ for the sake of the union
constexpr double kLeastOpenSky = 0.02;   // below which what lies above hardly matters

// Between key instants clouds drift by no more than this share of how high they are: of nine kinds of sky,
// with layers from 350 m to 9 km, cover half way between is within a quarter okta of what was asked for, RMS.
constexpr double kDriftShare = 0.8;
constexpr double kLongestS = 240.0, kShortestS = 7.5;

// Candidate 0 is the layer's usual pattern.
std::uint64_t patternSeed(const Scene& scene, std::size_t layer, int candidate) {
  const auto seed = static_cast<std::uint64_t>(scene.seed);
  return candidate == 0 ? hashOf(seed, 77, layer) : hashOf(seed, 77, layer, candidate);
}

// What a layer must cover by itself to cover `extraOktas` more than asked for.
double fractionOf(double oktas, double extraOktas) {
  return std::clamp((oktas + extraOktas) / kOktas, 0.0, 1.0);
}

// The cover of layers together, less what it should be.
double offOktas(const std::vector<float>& together, double clear) {
  return kOktas * (field::coverOf(together) - (1.0 - clear));
}

// Whether a union that is off may be helped by more or less of its upper layer. open: where that can be seen.
bool isWorthMore(double off, double open) {
  return open > kLeastOpenSky && std::abs(off) > kCloseOktas;
}
double extraOktas(double off, double open) {
  return std::clamp(-off / open, -kMostExtraOktas, kMostExtraOktas);
}

// A layer settled in one way, and what comes of it.
struct Trial {
  LayerCalibration layer;
  std::vector<float> together;  // optical depths of it and all beneath, by direction
  double offOktas = 0.0;        // their cover, less what it should be
};

void keepCloser(Trial& best, Trial other) {
  if (std::abs(other.offOktas) < std::abs(best.offOktas)) best = std::move(other);
}

LayerCalibration unsettled(const Scene& scene, const weather::Layer& layer, std::size_t i) {
  return {patternSeed(scene, i, 0), 0.0f, static_cast<float>(layer.extinctionPerM)};
}

}  // namespace

// Layers are settled from the ground up. Towards the horizon every layer hides more than overhead, and the
// patterns of one sky are but one draw: so the union of two layers is seldom what random overlap says, and on
// the whole less. Another place in the layer's endless pattern is as good as the first for all else, so a few
// are tried until the union comes close; what then is left over is made up by a little more or less of the
// layer.
std::vector<LayerCalibration> calibrateClouds(const Scene& scene, const weather::Weather& weather,
                                              const std::shared_ptr<const field::CloudNoise>& noise) {
  std::vector<LayerCalibration> result;
  std::vector<float> beneath(kView.directions, 0.0f);
  double clear = 1.0;  // the share of the sky that random overlap leaves
  field::CoverSearch search;
  for (std::size_t i = 0; i < weather.layers.size(); ++i) {
    const weather::Layer& layer = weather.layers[i];
    const LayerCalibration start = unsettled(scene, layer, i);
    if (!isVolume(scene, layer)) {
      result.push_back(start);
      continue;
    }
    clear *= 1.0 - layer.oktas / kOktas;
    // The layer in the pattern of `seed`, covering by itself what it should and `extra` more.
    auto tried = [&](std::uint64_t seed, double extra) {
      const field::CloudLayer shape = layerAt(scene, layer, {seed, 0.0f, start.extinction}, 0.0);
      search.start(noise, scene.place.altitudeM, shape, fractionOf(layer.oktas, extra), kView);
      while (!search.done()) search.step();
      std::vector<float> together = beneath;
      search.addOpticalDepths(together);
      const double off = offOktas(together, clear);
      return Trial{{seed, search.layer().threshold, search.layer().extinction}, std::move(together), off};
    };

    Trial best = tried(start.seed, 0.0);
    const double open = 1.0 - field::coverOf(beneath);
    if (i > 0) {
      for (int k = 1; k < kPatterns && isWorthMore(best.offOktas, open); ++k)
        keepCloser(best, tried(patternSeed(scene, i, k), 0.0));
      if (isWorthMore(best.offOktas, open))
        keepCloser(best, tried(best.layer.seed, extraOktas(best.offOktas, open)));
    }
    result.push_back(best.layer);
    beneath = std::move(best.together);
  }
  return result;
}

double coverKeyInterval(const Scene& scene, const weather::Weather& weather) {
  double most = kLongestS;  // what the fastest layer allows
  bool any = false;
  for (const weather::Layer& layer : weather.layers) {
    if (!isVolume(scene, layer)) continue;
    any = true;
    const double heightM = layer.baseM + 0.25 * (layer.topM - layer.baseM);
    if (layer.windSpeedMps * most > kDriftShare * heightM) most = kDriftShare * heightM / layer.windSpeedMps;
  }
  if (!any) return 0.0;
  double interval = kLongestS;
  while (interval > most && interval > kShortestS) interval *= 0.5;
  return interval;
}

CoverKey firstCoverKey(const Scene& scene, const weather::Weather& weather,
                       const std::shared_ptr<const field::CloudNoise>& noise, bool patternsOnly) {
  // The lowest layer keeps its usual pattern, so that one alone has nothing to choose.
  if (!patternsOnly || weather.layers.size() > 1) return {0.0, calibrateClouds(scene, weather, noise)};
  CoverKey key;
  for (std::size_t i = 0; i < weather.layers.size(); ++i)
    key.layers.push_back(unsettled(scene, weather.layers[i], i));
  return key;
}

void CoverKeyInProgress::start(const Scene& scene, const weather::Weather& weather,
                               const std::shared_ptr<const field::CloudNoise>& noise,
                               const std::vector<LayerCalibration>& patterns, double atS) {
  noise_ = noise;
  groundAltitudeM_ = scene.place.altitudeM;
  layers_.clear();
  key_.atS = atS;
  key_.layers.clear();
  for (std::size_t i = 0; i < weather.layers.size(); ++i) {
    const weather::Layer& layer = weather.layers[i];
    const LayerCalibration usual{patterns[i].seed, 0.0f, static_cast<float>(layer.extinctionPerM)};
    layers_.push_back({layerAt(scene, layer, usual, atS), layer.oktas, isVolume(scene, layer)});
    key_.layers.push_back(usual);
  }
  beneath_.assign(kView.directions, 0.0f);
  together_.resize(beneath_.size());
  closest_.resize(beneath_.size());
  clear_ = 1.0;
  done_ = 0;
}

void CoverKeyInProgress::computeTo(int part) {
  for (; done_ < std::min(part, parts()); ++done_) {
    const auto i = static_cast<std::size_t>(done_ / kLayerParts);
    const bool again = done_ % kLayerParts >= kTrialParts;
    const int step = done_ % kTrialParts;
    const Wanted& layer = layers_[i];
    if (!layer.isVolume || (again && !again_)) continue;
    if (step == 0) {
      const double open = 1.0 - field::coverOf(beneath_), extra = again ? extraOktas(offOktas_, open) : 0.0;
      search_.start(noise_, groundAltitudeM_, layer.shape, fractionOf(layer.oktas, extra), kView);
    }
    search_.step();
    if (step + 1 == kTrialParts) settle(i, again);
  }
}

// Keeps what the search has found, where that is closer than what there was. As in calibrateClouds(), but in
// the pattern that is chosen.
void CoverKeyInProgress::settle(std::size_t layer, bool again) {
  if (!again) clear_ *= 1.0 - layers_[layer].oktas / kOktas;
  together_ = beneath_;
  search_.addOpticalDepths(together_);
  const double off = offOktas(together_, clear_);
  if (!again || std::abs(off) < std::abs(offOktas_)) {
    key_.layers[layer].threshold = search_.layer().threshold;
    key_.layers[layer].extinction = search_.layer().extinction;
    closest_ = together_;
  }
  if (!again) {
    offOktas_ = off;
    again_ = layer > 0 && isWorthMore(off, 1.0 - field::coverOf(beneath_));
  }
  if (again || !again_) beneath_ = closest_;
}

void blendCover(const CoverKey& before, const CoverKey& after, double secondsAfter,
                std::vector<LayerCalibration>& blended) {
  blended = before.layers;
  if (secondsAfter == before.atS) return;
  const auto w = static_cast<float>((secondsAfter - before.atS) / (after.atS - before.atS));
  for (std::size_t i = 0; i < blended.size(); ++i) {
    blended[i].threshold = std::lerp(before.layers[i].threshold, after.layers[i].threshold, w);
    blended[i].extinction = std::lerp(before.layers[i].extinction, after.layers[i].extinction, w);
  }
}

std::vector<LayerCalibration> calibrationAt(const Scene& scene, const weather::Weather& weather,
                                            const std::shared_ptr<const field::CloudNoise>& noise,
                                            double secondsAfter) {
  const double interval = coverKeyInterval(scene, weather);
  std::vector<LayerCalibration> patterns = firstCoverKey(scene, weather, noise, true).layers;
  if (interval == 0.0) return patterns;
  const double before = std::floor(secondsAfter / interval) * interval;
  std::array<CoverKeyInProgress, 2> keys;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (k > 0 && secondsAfter == before) break;
    keys[k].start(scene, weather, noise, patterns, before + static_cast<double>(k) * interval);
    keys[k].computeTo(keys[k].parts());
  }
  std::vector<LayerCalibration> blended;
  blendCover(keys[0].key(), keys[1].key(), secondsAfter, blended);
  return blended;
}

}  // namespace welkin::scene
