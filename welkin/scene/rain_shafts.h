// SPDX-License-Identifier: Apache-2.0
// Rain and snow that are seen from afar: shafts beneath the thickest parts of a layer that is drawn as a
// volume. To all that draws clouds a shaft is one more layer of their field, behind those of the weather; to
// cover it is none.
#pragma once

#include <array>
#include <cstddef>

#include "welkin/field/cloud_layer.h"
#include "welkin/scene/scene.h"
#include "welkin/weather/weather.h"

namespace welkin::scene {

// The layers of a weather that shafts hang from, at most weather::kMaxRainingLayers.
struct RainingLayers {
  std::array<std::size_t, weather::kMaxRainingLayers> of{};
  std::size_t count = 0;
};
RainingLayers rainingLayers(const Scene& scene, const weather::Weather& weather);

// What a layer of the clouds' field belongs to.
struct LayerOfField {
  std::size_t of;  // index of the weather's layer
  bool isShaft;
};
LayerOfField layerOfField(const Scene& scene, const weather::Weather& weather, std::size_t index);
// Whether it is drawn as a volume, and what scatters light in it.
bool isVolumeInField(const Scene& scene, const weather::Weather& weather, std::size_t index);
// Ice is crystals that grow by themselves, and snow what they make when they cling together: without halos.
enum class CloudMatter { kDroplets, kIce, kSnow, kRain };
constexpr bool isFrozen(CloudMatter matter) {
  return matter == CloudMatter::kIce || matter == CloudMatter::kSnow;
}
CloudMatter matterInField(const Scene& scene, const weather::Weather& weather, std::size_t index);
// Whether there is a layer of rain, or of ice.
bool hasRain(const Scene& scene, const weather::Weather& weather);
bool hasIce(const Scene& scene, const weather::Weather& weather);

// The shaft beneath a layer, whose shape is settled (its threshold above all) and which lies above the
// ground; like it not yet moved by the wind.
field::CloudLayer shaftBeneath(const weather::Weather& weather, const weather::Layer& layer,
                               const field::CloudLayer& shape, double secondsAfter);

}  // namespace welkin::scene
