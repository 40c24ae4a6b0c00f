// SPDX-License-Identifier: Apache-2.0
// Small scenes to draw: the sun at a given height, a layer of a given genus, a few pixels at low quality.
// All of them lie at 30 degrees north on the meridian of Greenwich, at sea level, unless said otherwise.
#pragma once

#include <functional>
#include <initializer_list>
#include <vector>

#include "welkin/scene/scene.h"
#include "welkin/scene/sky_state.h"

namespace welkin::testing {

inline constexpr double kTestLatitudeDeg = 30.0;

// A clear sky on the afternoon or in the night after 2026-06-21T12:00Z at which the sun's centre stands at
// the elevation, from -36 to 83 degrees. 32 x 18 pixels, perspective, low quality, looking 12 degrees up.
scene::Scene clearScene(double sunElevationDeg);

// The same with a layer of each genus, as it typically is, at 4 oktas each or as told.
scene::Scene cloudyScene(double sunElevationDeg, std::initializer_list<weather::Genus> genera,
                         double oktas = 4.0);

// Midnight under a full moon near the zenith, and under a new moon below the ground.
scene::Scene moonlitScene();
scene::Scene moonlessScene();

// Changes of a scene, for one line where one is enough.
scene::Scene sized(scene::Scene s, int width, int height);
scene::Scene looking(scene::Scene s, double headingDeg, double pitchDeg, double fovDeg = 70.0);
scene::Scene projected(scene::Scene s, scene::Projection projection, int width, int height);
scene::Scene fromHeight(scene::Scene s, double eyeM);

// The same sky with its layers, of cloud and of rain, changed.
void changeLayers(scene::SkyState& state, const std::function<void(std::vector<field::CloudLayer>&)>& change);

// The sky of a scene without air, discs and light of the ground, in a sun of so many lux.
scene::SkyState airlessSky(scene::Scene s, double sunLux);

}  // namespace welkin::testing
