// SPDX-License-Identifier: Apache-2.0
// shaders/lib/cloud_scattering.glsl: what must hold wherever its network is asked, seen before or not.
#include <gtest/gtest.h>

#include <cmath>

#include "welkin/core/glsl.h"

namespace welkin::render {
namespace {

using namespace welkin::glsl;
#include "shaders/lib/phase.glsl"
// After the phase functions that it calls.
#include "shaders/lib/cloud_light.glsl"
// After those.
#include "shaders/lib/cloud_light_fit.glsl"
// After all.
#include "shaders/lib/cloud_scattering.glsl"

constexpr PhasePeak kPeak{0.4f, 0.994f};

// A cloud of a kind.
CloudPlace placeOf(float ice, float cover) {
  return {ice, cover, 0.5f, 0.4f, 900.0f, 0.05f};
}

constexpr float kDepths[] = {0.0f, 1e-3f, 0.3f, 3.0f, 30.0f, 2000.0f};

template <class F>
void forEachPoint(F&& f) {
  for (const float toSun : kDepths)
    for (const float fromSun : kDepths)
      for (const float up : kDepths)
        for (const float toEye : {0.0f, 1.0f, 5.0f})
          for (const float c : {-1.0f, 0.0f, 0.9f, 1.0f})
            for (const float sunHeight : {-0.1f, 0.02f, 1.0f})
              for (const float distanceM : {0.0f, 3e3f, 2e5f})
                for (const float behind : {0.0f, 30.0f})
                  f(CloudDepths{toSun, fromSun, up, 10.0f},
                    CloudView{c,
                              0.3f,
                              toEye,
                              distanceM,
                              {behind, fromSun, behind, 5.0f},
                              {0.2f * fromSun / (1.0f + toSun), 0.05f * behind}},
                    behind / 30.0f, sunHeight);
}

TEST(CloudScattering, IsFiniteAndNeitherMakesNorTakesLightOfTheSky) {
  forEachPoint([](const CloudDepths& d, const CloudView& view, float cover, float sunHeight) {
    for (const float ice : {0.0f, 1.0f}) {
      const CloudScattering s = cloudScattering(d, view, placeOf(ice, cover), {0.1f, kPeak}, sunHeight);
      ASSERT_TRUE(std::isfinite(s.sun) && s.sun >= 0.0f) << d.toSun << " " << d.fromSun << " " << d.up;
      ASSERT_GE(s.shares.x, 0.0f);
      ASSERT_GE(s.shares.y, 0.0f);
      ASSERT_NEAR(s.shares.x + s.shares.y, 1.0f, 1e-6f);
    }
  });
}

// The first scattering and the peaks are left alone, the others are changed by a bounded factor.
TEST(CloudScattering, CorrectsWithinBounds) {
  int changed = 0, points = 0;
  forEachPoint([&](const CloudDepths& d, const CloudView& view, float cover, float sunHeight) {
    const float phase = phaseHenyeyGreenstein(view.cosSun, 0.85f), first = phase * std::exp(-d.toSun);
    const float plain =
        std::max(cloudSunSource(d, phase, view.cosSun, view.height, sunHeight) - first, 0.0f) + 1e-5f;
    const float others = cloudScattering(d, view, placeOf(0.0f, cover), {phase, kPeak}, sunHeight).sun -
                         first - cloudPeakSource(d.toSun, view.cosSun, kPeak);
    const float room = 1e-5f * (first + 1.0f);  // of rounding
    ASSERT_GE(others, plain * std::exp(-3.0f) - room);
    ASSERT_LE(others, plain * std::exp(3.0f) + room);
    ++points;
    if (std::abs(others / plain - 1.0f) > 0.05f) ++changed;
  });
  EXPECT_GT(changed, points / 2);
}

// Wisps scatter once.
TEST(CloudScattering, ThinCloudScattersOnce) {
  for (const float c : {-1.0f, 0.0f, 0.7f, 0.95f}) {
    const float phase = phaseHenyeyGreenstein(c, 0.85f);
    const CloudDepths wisp{1e-4f, 1e-4f, 1e-4f, 1e-4f};
    EXPECT_NEAR(cloudScattering(wisp, {c, 0.2f, 0.0f, 3e3f, wisp, {0.01f, 0.01f}}, placeOf(0.0f, 0.5f),
                                {phase, kPeak}, 0.6f)
                    .sun,
                phase, 0.01f * phase + 5e-4f)
        << c;
  }
}

// Through a thick deck in the sun's light comes the less the thicker it is, and an eye beneath it sees more
// sky through a thin one.
TEST(CloudScattering, ThickDecksAreDarkBeneath) {
  float lastSun = 1e9f, lastSky = 1.0f;
  for (const float tau : {8.0f, 16.0f, 32.0f, 64.0f, 128.0f}) {
    const CloudDepths d{tau / 0.7f, 0.5f, tau, 0.4f};
    const float fluence = 2.0f / (1.3f + 0.14f * tau);  // beneath a slab
    const CloudScattering s = cloudScattering(d, {0.4f, 0.5f, 0.4f, 2000.0f, d, {fluence, fluence}},
                                              placeOf(0.0f, 1.0f), {0.01f, kPeak}, 0.7f);
    EXPECT_LT(s.sun, lastSun) << tau;
    EXPECT_LT(s.shares.x, lastSky) << tau;
    lastSun = s.sun;
    lastSky = s.shares.x;
  }
}

}  // namespace
}  // namespace welkin::render
