// SPDX-License-Identifier: Apache-2.0
// Clouds that cover as much of the sky as the weather says: the shapes of its layers, calibrated
// (cover_calibration.h), and what they deliver.
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <vector>

#include "welkin/field/cloud_layer.h"
#include "welkin/scene/cover_calibration.h"
#include "welkin/scene/scene.h"
#include "welkin/weather/weather.h"

namespace welkin::field {
struct CloudNoise;
class CloudField;
}  // namespace welkin::field

namespace welkin::scene {

class MetaballSky;

struct LayerCover {
  double requestedOktas = 0.0;
  double deliveredOktas =
      0.0;  // measured from the ground at the place: hemisphere at optical depth above 0.3
};

// Where the wind has taken a layer since the scene's time, east and north.
glm::dvec2 windDriftM(const Scene& scene, const weather::Layer& layer, double secondsAfter);

// The layer `secondsAfter` the scene's time, where the wind has taken it.
field::CloudLayer layerAt(const Scene& scene, const weather::Layer& layer,
                          const LayerCalibration& calibration, double secondsAfter);

// The clouds `secondsAfter` the scene's time, all layers as if they were volumes, then the rain that falls
// from them (rain_shafts.h).
field::CloudField cloudsAt(const Scene& scene, const weather::Weather& weather,
                           const std::vector<LayerCalibration>& calibration,
                           std::shared_ptr<const field::CloudNoise> noise, double secondsAfter);
// The same in the place of clouds of the same scene at another instant. Allocates nothing.
void moveClouds(const Scene& scene, const weather::Weather& weather,
                const std::vector<LayerCalibration>& calibration, double secondsAfter,
                field::CloudField& clouds);

// What the clouds hide of the sky above the place.
struct DeliveredCover {
  std::vector<LayerCover> layers;  // each by itself, in the order of the weather's
  std::vector<LayerCover> sheets;  // the same of those by hand
  LayerCover sky;                  // all together
};

// Volumes as seen from the ground, and metaballs, which are those of the scene and only needed where a layer
// is drawn so; sheets as their patterns have it; a sheet lies over all others at random.
DeliveredCover measureCover(const Scene& scene, const weather::Weather& weather,
                            const field::CloudField& clouds, double secondsAfter,
                            const MetaballSky* metaballs = nullptr);

}  // namespace welkin::scene
