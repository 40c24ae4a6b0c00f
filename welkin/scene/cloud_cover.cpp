// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/cloud_cover.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "welkin/core/random.h"
#include "welkin/field/cloud_field.h"
#include "welkin/field/cover.h"
#include "welkin/scene/cloud_shapes.h"

namespace welkin::scene {
namespace {

constexpr double kOktas = 8.0;
constexpr field::CoverView kCalibrationView{.directions = 1500};
constexpr field::CoverView kReportView{.directions = 4000};  // other directions than those of the calibration

constexpr int kPatterns = 5;             // places in a layer's pattern that are tried
constexpr double kCloseOktas = 0.15;     // a union as close as this will do
constexpr double kMostExtraOktas = 0.2;  // by which a layer's own cover may differ for the sake of the union
constexpr double kLeastOpenSky = 0.02;   // below which what lies above hardly matters

// Candidate 0 is the layer's usual pattern.
std::uint64_t patternSeed(const Scene& scene, std::size_t layer, int candidate) {
  const auto seed = static_cast<std::uint64_t>(scene.seed);
  return candidate == 0 ? hashOf(seed, 77, layer) : hashOf(seed, 77, layer, candidate);
}

std::vector<float> sumOf(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<float> sum(a.size());
  std::transform(a.begin(), a.end(), b.begin(), sum.begin(), std::plus<>());
  return sum;
}

// A layer settled in one way, and what comes of it.
struct Trial {
  LayerCalibration layer;
  std::vector<float> together;  // optical depths of it and all beneath, by direction
  double offOktas = 0.0;        // their cover, less what it should be
};

// Gives one layer its place above those already settled.
class LayerSettler {
 public:
  // `beneath`: optical depths of the layers below. `together`: fraction that is to be covered by those and
  // this one.
  LayerSettler(const weather::Layer& layer, std::shared_ptr<const field::CloudNoise> noise,
               double groundAltitudeM, const std::vector<float>& beneath, double together)
      : layer_(layer),
        noise_(std::move(noise)),
        groundAltitudeM_(groundAltitudeM),
        beneath_(beneath),
        together_(together) {}

  // The layer in the pattern of `seed`, covering by itself what it should and `extraOktas` more.
  Trial tried(std::uint64_t seed, double extraOktas) const {
    const double fraction = std::clamp((layer_.oktas + extraOktas) / kOktas, 0.0, 1.0);
    const field::CloudField start(noise_, {shapeOf(layer_, seed, 0.0)}, groundAltitudeM_);
    const field::CloudLayer c = field::calibrated(start, 0, fraction, kCalibrationView);
    Trial trial;
    trial.layer = {seed, c.threshold, c.extinction};
    trial.together = sumOf(
        beneath_,
        field::layerOpticalDepths(field::CloudField(noise_, {c}, groundAltitudeM_), kCalibrationView, 0));
    trial.offOktas = kOktas * (field::coverOf(trial.together) - together_);
    return trial;
  }

 private:
  const weather::Layer& layer_;
  std::shared_ptr<const field::CloudNoise> noise_;
  double groundAltitudeM_;
  const std::vector<float>& beneath_;
  double together_;
};

}  // namespace

// Layers are settled from the ground up. Towards the horizon every layer hides more than overhead, and the
// patterns of one sky are but one draw: so the union of two layers is seldom what random overlap says, and on
// the whole less. Another place in the layer's endless pattern is as good as the first for all else, so a few
// are tried until the union comes close; what then is left over is made up by a little more or less of the
// layer.
std::vector<LayerCalibration> calibrateClouds(const Scene& scene, const weather::Weather& weather,
                                              std::shared_ptr<const field::CloudNoise> noise) {
  std::vector<LayerCalibration> result;
  std::vector<float> beneath(kCalibrationView.directions, 0.0f);
  double clear = 1.0;  // the share of the sky that random overlap leaves
  for (std::size_t i = 0; i < weather.layers.size(); ++i) {
    clear *= 1.0 - weather.layers[i].oktas / kOktas;
    const double open = 1.0 - field::coverOf(beneath);  // where the layer can be seen
    const LayerSettler settler(weather.layers[i], noise, scene.place.altitudeM, beneath, 1.0 - clear);
    Trial best = settler.tried(patternSeed(scene, i, 0), 0.0);
    if (i > 0 && open > kLeastOpenSky) {
      for (int k = 1; k < kPatterns && std::abs(best.offOktas) > kCloseOktas; ++k) {
        Trial other = settler.tried(patternSeed(scene, i, k), 0.0);
        if (std::abs(other.offOktas) < std::abs(best.offOktas)) best = std::move(other);
      }
      if (std::abs(best.offOktas) > kCloseOktas) {
        const double extra = std::clamp(-best.offOktas / open, -kMostExtraOktas, kMostExtraOktas);
        Trial other = settler.tried(best.layer.seed, extra);
        if (std::abs(other.offOktas) < std::abs(best.offOktas)) best = std::move(other);
      }
    }
    result.push_back(best.layer);
    beneath = std::move(best.together);
  }
  return result;
}

std::shared_ptr<const field::CloudField> cloudsAt(const Scene& scene, const weather::Weather& weather,
                                                  const std::vector<LayerCalibration>& calibration,
                                                  std::shared_ptr<const field::CloudNoise> noise,
                                                  double secondsAfter) {
  std::vector<field::CloudLayer> shapes;
  for (std::size_t i = 0; i < weather.layers.size(); ++i) {
    field::CloudLayer shape = shapeOf(weather.layers[i], calibration[i].seed, secondsAfter);
    shape.threshold = calibration[i].threshold;
    shape.extinction = calibration[i].extinction;
    shapes.push_back(shape);
  }
  return std::make_shared<field::CloudField>(std::move(noise), std::move(shapes), scene.place.altitudeM);
}

DeliveredCover measureCover(const weather::Weather& weather, const field::CloudField& clouds) {
  DeliveredCover cover;
  std::vector<float> together(kReportView.directions);
  for (std::size_t i = 0; i < weather.layers.size(); ++i) {
    const std::vector<float> depths = field::layerOpticalDepths(clouds, kReportView, static_cast<int>(i));
    cover.layers.push_back({weather.layers[i].oktas, kOktas * field::coverOf(depths)});
    together = sumOf(together, depths);
  }
  cover.sky = {weather.requestedOktas, kOktas * field::coverOf(together)};
  return cover;
}

}  // namespace welkin::scene
