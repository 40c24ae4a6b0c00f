// SPDX-License-Identifier: Apache-2.0
// How dense the clouds of each layer must be to cover as much of the sky as the weather says.
//
// Cover is calibrated for who stands on the ground at the place. What is in view from there changes as clouds
// drift by, few and large ones as much as from nothing to all of the sky; so it is calibrated at key
// instants, and in between thresholds are blended, linearly. Pure functions of (scene, weather, instant),
// whatever the eye.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "welkin/field/cloud_layer.h"
#include "welkin/field/cover.h"
#include "welkin/scene/scene.h"
#include "welkin/weather/weather.h"

namespace welkin::scene {

// What calibration settles for one layer.
struct LayerCalibration {
  std::uint64_t seed = 0;   // of the layer's pattern, the same at all instants
  float threshold = 0.0f;   // CloudLayer's
  float extinction = 0.0f;  // 1/m; more than the weather's where that would be too thin to count as cloud

  bool operator==(const LayerCalibration&) const = default;
};

// At the scene's time, for each layer of the weather, so that each covers by itself what it should and all of
// them together what they should by random overlap. `noise` is that of the scene's seed. Layers that are
// drawn as sheets or metaballs are left out: nothing is settled for them.
std::vector<LayerCalibration> calibrateClouds(const Scene& scene, const weather::Weather& weather,
                                              const std::shared_ptr<const field::CloudNoise>& noise);

// The calibration at a key instant.
struct CoverKey {
  double atS = std::numeric_limits<double>::quiet_NaN();  // after the scene's time; none yet
  std::vector<LayerCalibration> layers;

  bool operator==(const CoverKey&) const = default;
};

// Seconds between key instants, which are its whole multiples: 240 or a half, a quarter and so on of it, so
// that clouds drift by less than they are high above the ground. 0: nothing is calibrated.
double coverKeyInterval(const Scene& scene, const weather::Weather& weather);

// The one at the scene's time. Where another is what is wanted, `patternsOnly` has only seeds settled, at
// less cost.
CoverKey firstCoverKey(const Scene& scene, const weather::Weather& weather,
                       const std::shared_ptr<const field::CloudNoise>& noise, bool patternsOnly);

// A key instant in portions, for frame loops: the same key whatever the portions. Allocates nothing once it
// has made one of the same scene.
class CoverKeyInProgress {
 public:
  // patterns: of any key of the scene, of which the seeds are taken.
  void start(const Scene& scene, const weather::Weather& weather,
             const std::shared_ptr<const field::CloudNoise>& noise,
             const std::vector<LayerCalibration>& patterns, double atS);
  int parts() const { return kLayerParts * static_cast<int>(layers_.size()); }
  void computeTo(int part);                     // the first `part` of them
  const CoverKey& key() const { return key_; }  // complete after computeTo(parts())

 private:
  static constexpr int kTrialParts = field::CoverSearch::kMostSteps + 1, kLayerParts = 2 * kTrialParts;
  struct Wanted {
    field::CloudLayer shape{};
    double oktas = 0.0;
    bool isVolume = false;
  };
  void settle(std::size_t layer, bool again);

  std::shared_ptr<const field::CloudNoise> noise_;
  double groundAltitudeM_ = 0.0;
  std::vector<Wanted> layers_;
  field::CoverSearch search_;
  std::vector<float> beneath_, together_, closest_;  // optical depths by direction: of all lower layers, ...
  double clear_ = 1.0;                               // the share of the sky that random overlap leaves
  double offOktas_ = 0.0;                            // of the layer's first trial
  bool again_ = false;                               // a second is worth it
  CoverKey key_;
  int done_ = 0;
};

// The calibration `secondsAfter` the scene's time, blended from the key instants about it; at the first the
// second may be any.
void blendCover(const CoverKey& before, const CoverKey& after, double secondsAfter,
                std::vector<LayerCalibration>& blended);

// The same from nothing.
std::vector<LayerCalibration> calibrationAt(const Scene& scene, const weather::Weather& weather,
                                            const std::shared_ptr<const field::CloudNoise>& noise,
                                            double secondsAfter);

}  // namespace welkin::scene
