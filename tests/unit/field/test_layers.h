// SPDX-License-Identifier: Apache-2.0
// Layers that the tests of fields share.
#pragma once

#include "welkin/field/cloud_field.h"

namespace welkin::field {

inline std::shared_ptr<const CloudNoise> testNoise() {
  static const auto noise = makeCloudNoise(1);
  return noise;
}

// Separate towers between 1000 and 2000 m.
inline CloudLayer cumulusLike(float threshold) {
  CloudLayer l{};
  l.baseM = 1000, l.topM = 2000, l.extinction = 0.05f, l.threshold = threshold;
  l.along = {1, 0}, l.stretch = 1;
  l.cellM = 18000, l.cellWeight = 0.8f, l.fractalWeight = 0.35f, l.patchWeight = 0.48f, l.patchM = 50000,
  l.warpM = 300;
  l.dome = 1.1f, l.domePower = 1.7f, l.bottomSoft = 0.05f, l.topSoft = 0.1f;
  l.shapeM = 2500, l.shapeAmount = 0.4f, l.shapeAtBase = 0.2f, l.shapeStretch = 1, l.shapeTall = 1;
  l.detailM = 500, l.detailAmount = 0.12f;
  l.edge = 0.12f, l.lift = 0.6f, l.reachM = 300;
  return l;
}

// A homogeneous sheet between 500 and 900 m, whatever the noise.
inline CloudLayer sheetLike() {
  CloudLayer l = cumulusLike(-50.0f);
  l.baseM = 500, l.topM = 900, l.extinction = 0.01f;
  l.dome = 0, l.lift = 0, l.bottomSoft = 0.02f, l.topSoft = 0.02f;
  return l;
}

}  // namespace welkin::field
