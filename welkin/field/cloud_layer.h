// SPDX-License-Identifier: Apache-2.0
// The shape of one layer of cloud; the struct itself stands in shaders/lib/cloud_layer.glsl, for CPU and GPU
// alike.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "welkin/core/glsl.h"

namespace welkin::field {

using glm::vec2, glm::vec3;

#include "shaders/lib/cloud_layer.glsl"

// Calls f(name, value) for every member, in order: what uniform packing and dumps are made from.
template <class F>
void forEachMember(const CloudLayer& l, F&& f) {
  f("baseM", l.baseM), f("topM", l.topM), f("extinction", l.extinction), f("threshold", l.threshold);
  f("driftM", l.driftM), f("shearM", l.shearM), f("along", l.along), f("stretch", l.stretch);
  f("cellM", l.cellM), f("cellWeight", l.cellWeight), f("fractalWeight", l.fractalWeight);
  f("patchWeight", l.patchWeight), f("patchM", l.patchM), f("patchShift", l.patchShift);
  f("warpM", l.warpM);
  f("dome", l.dome), f("domePower", l.domePower), f("belly", l.belly), f("anvil", l.anvil);
  f("bottomSoft", l.bottomSoft), f("topSoft", l.topSoft);
  f("shapeM", l.shapeM), f("shapeAmount", l.shapeAmount), f("shapeAtBase", l.shapeAtBase);
  f("shapeStretch", l.shapeStretch), f("shapeTall", l.shapeTall);
  f("detailM", l.detailM), f("detailAmount", l.detailAmount);
  f("shapeShiftM", l.shapeShiftM), f("detailShiftM", l.detailShiftM);
  f("edge", l.edge), f("lift", l.lift), f("reachM", l.reachM);
}

// Moves the layer's pattern, and its 3D noises with it, east and north by any distance: exactly, as whole
// periods of each noise, of which each has another, are left out before anything is rounded to float.
void moveLayer(CloudLayer& layer, glm::dvec2 byM);

// A displacement of something with a period, less whole periods: as it is within half a period of 0.
double withinPeriod(double displacement, double period);

}  // namespace welkin::field
