// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/living_octaves.h"

namespace welkin::scene {

void describe(LivingOctaves& o, ParamVisitor& v) {
  v.choice({"kernel", "",
            "of living octaves: gradient noise; pallister: 32 x 32 values, bilinear; course: 32 x 32 values, "
            "Gaussian"},
           o.kernel);
  v.choice({"blend", "",
            "of living octaves from keyframe to keyframe: variance-preserving keeps their contrast, linear "
            "lets it dip half way"},
           o.blend);
  v.value({"interval_s", "s", "between keyframes of the first living octave", 0.1, 86400}, o.intervalS);
  v.value({"interval_ratio", "", "interval of a living octave over that of the one before", 0.1, 2},
          o.intervalRatio);
  v.value({"scroll_mps", "m/s", "by which a living octave drifts faster along the wind than the one before",
           -50, 50},
          o.scrollMps);
  v.value(
      {"updates_per_s", "1/s", "how often living octaves are composed anew; 0: for every instant", 0, 1000},
      o.updatesPerS);
}

void describe(LayerOctaves& o, ParamVisitor& v) {
  v.value({"resolution", "", "texels of the pattern, a side", 32, 1024}, o.resolution);
  v.value({"count", "", "of octaves", 1, 8}, o.count);
  describe(o.living, v);
}

}  // namespace welkin::scene
