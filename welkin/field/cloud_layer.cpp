// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/cloud_layer.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace welkin::field {
namespace {

using namespace welkin::glsl;
#include "shaders/lib/clouds.glsl"

void shiftBy(vec3& shiftM, glm::dvec2 byM, double periodM) {
  shiftM.x = static_cast<float>(withinPeriod(static_cast<double>(shiftM.x) + byM.x, periodM));
  shiftM.y = static_cast<float>(withinPeriod(static_cast<double>(shiftM.y) + byM.y, periodM));
}

}  // namespace

double withinPeriod(double displacement, double period) {
  return std::remainder(displacement, period);
}

// In the frame of cloudPatternPosition(), whole periods of the cells need no displacement. Patches and 3D
// noises, whose periods are others, are moved by them instead. All of it with the rounded numbers that the
// shaders have: over the way of a year, a last digit makes hundreds of metres.
void moveLayer(CloudLayer& l, glm::dvec2 byM) {
  const glm::dvec2 along(l.along);
  const double stretch = static_cast<double>(l.stretch), cellM = static_cast<double>(l.cellM);
  const glm::dvec2 p(glm::dot(byM, along), byM.y * along.x - byM.x * along.y);
  const glm::dvec2 rest(withinPeriod(p.x, cellM * stretch), withinPeriod(p.y, cellM)), whole = p - rest;
  if (whole == glm::dvec2(0.0)) {
    l.driftM = vec2(glm::dvec2(l.driftM) + byM);
    return;
  }
  const glm::dvec2 restM(rest.x * along.x - rest.y * along.y, rest.x * along.y + rest.y * along.x);
  l.driftM = vec2(glm::dvec2(l.driftM) + restM / glm::dot(along, along));
  const glm::dvec2 drawn(whole.x / stretch, whole.y);
  const double c = static_cast<double>(kPatchCosine), s = static_cast<double>(kPatchSine);
  const glm::dvec2 patches =
      glm::dvec2(l.patchShift) +
      glm::dvec2(c * drawn.x - s * drawn.y, s * drawn.x + c * drawn.y) / static_cast<double>(l.patchM);
  l.patchShift = vec2(withinPeriod(patches.x, 1.0), withinPeriod(patches.y, 1.0));
  const glm::dvec2 noises(whole.x / static_cast<double>(l.shapeStretch), whole.y);
  shiftBy(l.shapeShiftM, noises, static_cast<double>(l.shapeM));
  shiftBy(l.detailShiftM, noises, static_cast<double>(l.detailM));
}

}  // namespace welkin::field
