// SPDX-License-Identifier: Apache-2.0
// Light that reaches the ground under clouds, against the reference renderer's.
#include <gtest/gtest.h>

#include "welkin/core/units.h"
#include "welkin/scene/sky_state.h"
#include "welkin/weather/weather.h"

namespace welkin::scene {
namespace {

SkyState skyUnder(weather::Genus genus, double oktas, const char* time) {
  Scene s;
  s.time = parseUtcTime(time);
  s.place.latitudeDeg = 45.0;
  s.visibilityM = 300e3;
  s.technique = Technique::kVolume;
  if (oktas > 0.0) {
    weather::Layer layer = weather::typicalLayer(genus, 45.0);
    layer.oktas = oktas;
    s.layers = {layer};
  }
  return buildSky(s, 0.0);
}

// Mean luminance of 5 km of ground seen from 400 m, of eight seeds, `welkin render --renderer reference --spp
// 32`: shares of what it has under the clear sky, red, with their standard errors (which are those of where
// the clouds are).
struct Ground {
  weather::Genus genus;
  double oktas;
  const char* time;
  double share, error;
};

TEST(AmbientLight, OfTheGroundUnderCloudsIsAsTraced) {
  using enum weather::Genus;
  const Ground traced[] = {{kCumulus, 2, "2026-06-21T09:00:00Z", 0.972, 0.02},
                           {kCumulus, 4, "2026-06-21T09:00:00Z", 0.909, 0.04},
                           {kCumulus, 4, "2026-06-21T06:30:00Z", 0.772, 0.08},
                           {kCumulus, 4, "2026-06-21T05:00:00Z", 0.624, 0.09},
                           {kCumulus, 6, "2026-06-21T09:00:00Z", 0.713, 0.07},
                           {kCumulus, 6, "2026-06-21T06:30:00Z", 0.589, 0.095},
                           {kStratocumulus, 7, "2026-06-21T08:00:00Z", 0.713, 0.06},
                           {kStratocumulus, 5, "2026-06-21T10:00:00Z", 0.866, 0.014},
                           {kStratocumulus, 5, "2026-06-21T06:00:00Z", 0.638, 0.08},
                           {kNimbostratus, 8, "2026-06-21T11:00:00Z", 0.275, 0.007}};
  for (const Ground& g : traced) {
    const float under = skyUnder(g.genus, g.oktas, g.time).ambient.ground.x;
    const float clear = skyUnder(g.genus, 0.0, g.time).ambient.ground.x;
    EXPECT_NEAR(under / clear, g.share, 1.5 * g.error + 0.02)
        << static_cast<int>(g.genus) << " " << g.oktas << " " << g.time;
  }
}

// Clouds are whiter than the ground: the sky over them is brighter for it, and bluer.
TEST(AmbientLight, OfTheSkyIsMoreOverClouds) {
  const AmbientLight clear = skyUnder(weather::Genus::kStratus, 0.0, "2026-06-21T09:00:00Z").ambient,
                     deck = skyUnder(weather::Genus::kStratus, 8.0, "2026-06-21T09:00:00Z").ambient;
  const glm::vec3 more = deck.aboveLow.along[2] - clear.aboveLow.along[2];
  EXPECT_GT(more.z, 0.1f * clear.aboveLow.along[2].z);
  EXPECT_GT(more.z, 2.0f * more.x);
  EXPECT_GT(more.x, 0.0f);
}

}  // namespace
}  // namespace welkin::scene
