// SPDX-License-Identifier: Apache-2.0
// Light that reaches ground, clouds and air from all sides; of the ground against the reference renderer's.
#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <map>
#include <string>

#include "tests/testing/skies.h"
#include "welkin/core/colour.h"
#include "welkin/core/units.h"
#include "welkin/scene/sky_state.h"
#include "welkin/weather/weather.h"

namespace welkin::scene {
namespace {

constexpr double kNoHazeM = 300e3;

Scene sceneUnder(weather::Genus genus, double oktas, const std::string& time) {
  Scene s;
  s.time = parseUtcTime(time);
  s.place.latitudeDeg = 45.0;
  s.technique = Technique::kVolume;
  if (oktas > 0.0) {
    weather::Layer layer = weather::typicalLayer(genus, 45.0);
    layer.oktas = oktas;
    s.layers = {layer};
  }
  return s;
}

SkyState skyUnder(weather::Genus genus, double oktas, const char* time, double visibilityM = kNoHazeM,
                  double eyeM = 2.0) {
  Scene s = sceneUnder(genus, oktas, time);
  s.camera.eyeM = eyeM;
  s.visibilityM = visibilityM;
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

// What of the light on the ground comes from sky and clouds: 1.7 km of ground from 700 m straight down, of
// eight seeds (stratocumulus: four, congestus: twelve), `--renderer reference` to 8 or 10 %, less the sun's
// straight light as the marched renderer has it there, in the light of the clear sky.
TEST(AmbientLight, OfSkyAndCloudsOnTheGroundIsAsTraced) {
  using enum weather::Genus;
  struct Traced {
    weather::Genus genus;
    double topM, oktas;
    const char* time;
    double light;
  };
  const Traced traced[] = {{kCumulus, 2200, 2, "11:30", 1.45},       {kCumulus, 2200, 2, "16:30", 1.22},
                           {kCumulus, 2200, 2, "18:00", 1.10},       {kCumulus, 2200, 4, "11:30", 2.22},
                           {kCumulus, 2200, 4, "16:30", 1.68},       {kCumulus, 2200, 4, "18:00", 1.07},
                           {kCumulus, 2200, 6, "11:30", 2.92},       {kCumulus, 2200, 6, "16:30", 1.66},
                           {kCumulus, 2200, 6, "18:00", 0.96},       {kStratocumulus, 1600, 3, "11:30", 1.87},
                           {kStratocumulus, 1600, 3, "16:30", 1.58}, {kStratocumulus, 1600, 3, "18:00", 1.15},
                           {kStratocumulus, 1600, 5, "11:30", 2.64}, {kStratocumulus, 1600, 5, "16:30", 1.75},
                           {kStratocumulus, 1600, 5, "18:00", 1.05}, {kStratocumulus, 1600, 7, "11:30", 3.35},
                           {kStratocumulus, 1600, 7, "16:30", 1.67}, {kStratocumulus, 1600, 7, "18:00", 0.83},
                           {kCumulus, 4000, 3, "11:30", 1.30},       {kCumulus, 4000, 3, "17:00", 0.97}};
  const auto light = [](const Traced& t, double oktas) {
    Scene s = sceneUnder(t.genus, oktas, "2026-06-21T" + std::string(t.time) + ":00Z");
    s.place.latitudeDeg = 47.46;
    s.place.longitudeDeg = 8.55;
    for (weather::Layer& layer : s.layers) layer.baseM = 1000.0, layer.topM = t.topM;
    const glm::vec3 rgb = buildSky(s, 0.0).ambient.skyOnGround;
    return static_cast<double>(luminanceOf(&rgb.x));
  };
  std::map<std::string, double> clear;  // by the time
  for (const Traced& t : traced)
    if (!clear.contains(t.time)) clear[t.time] = light(t, 0.0);
  double squares = 0.0;
  for (const Traced& t : traced) {
    const double off = light(t, t.oktas) / clear[t.time] / t.light - 1.0;
    EXPECT_NEAR(off, 0.0, 0.25) << static_cast<int>(t.genus) << " " << t.oktas << " " << t.time;
    squares += off * off;
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(std::size(traced))), 0.13);
}

// Haze under a deck, and in it, where light goes far: what of the ground's luminance it leaves. Nimbostratus
// of 300 to 2,800 m, the sun 20 degrees up, straight down from 2 m, `--renderer reference --spp 700`, in that
// with a visibility of 300 km; red and blue, to 5 %.
TEST(AmbientLight, OfTheGroundUnderADeckInHazeIsAsTraced) {
  struct Traced {
    double visibilityM, red, blue;
  };
  const auto groundAt = [](double visibilityM) {
    Scene s = sceneUnder(weather::Genus::kNimbostratus, 8.0, "2026-01-21T11:20:00Z");
    s.place.latitudeDeg = 50.0;
    s.place.longitudeDeg = 8.0;
    s.layers[0].baseM = 300.0, s.layers[0].topM = 2800.0;
    s.visibilityM = visibilityM;
    return buildSky(s, 0.0).ambient.ground;
  };
  const glm::vec3 clear = groundAt(300e3);
  for (const Traced& t : {Traced{5000.0, 0.753, 0.700}, {1500.0, 0.672, 0.662}, {800.0, 0.552, 0.568}}) {
    SCOPED_TRACE(t.visibilityM);
    const glm::vec3 hazy = groundAt(t.visibilityM);
    EXPECT_NEAR(hazy.x / clear.x, t.red, 0.1);
    EXPECT_NEAR(hazy.z / clear.z, t.blue, 0.1);
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

float greenTowards(const AirLight& light, const glm::vec3& way) {
  return light.mean.y + light.along[0].y * way.x + light.along[1].y * way.y + light.along[2].y * way.z;
}

// Haze scatters forward: towards the sky about a low sun there is more than away from it, over a deck more
// towards the deck, and under one no side is brighter than another.
TEST(AmbientLight, OfHazeIsMoreWhereLightComesFrom) {
  using enum weather::Genus;
  const char* morning = "2026-06-21T06:00:00Z";
  const SkyState clear = skyUnder(kStratus, 0.0, morning, 30e3),
                 under = skyUnder(kNimbostratus, 8.0, morning, 30e3),
                 over = skyUnder(kStratus, 8.0, morning, 30e3, 5000.0);
  const glm::vec3 sun = clear.lights[0].direction;
  const glm::vec3 level = glm::vec3(sun.x, sun.y, 0.0f) / std::hypot(sun.x, sun.y);
  const auto ratio = [](const AirLight& light, const glm::vec3& way) {
    return greenTowards(light, way) / greenTowards(light, -way);
  };
  EXPECT_GT(ratio(clear.ambient.air.haze, level), 1.2f);
  EXPECT_LT(ratio(clear.ambient.air.haze, level), 4.0f);
  EXPECT_NEAR(ratio(under.ambient.air.haze, level), 1.0f, 0.15f);
  EXPECT_GT(ratio(over.ambient.air.haze, {0.0f, 0.0f, -1.0f}), 1.3f);
  // None of it by clouds where there are none.
  EXPECT_EQ(clear.ambient.air.cloudGlow.mean, glm::vec3(0.0f));
  EXPECT_NEAR(greenTowards(clear.ambient.air.cloudGlow, level), 0.0f, 1e-4f * clear.ambient.air.haze.mean.y);
  EXPECT_GT(over.ambient.air.cloudGlow.mean.y, 0.1f * over.ambient.air.haze.mean.y);
}

// Over a deck the sky has the deck's light, bluer than that is, and less of it from higher up; in and under
// it the sky has that of the air over its top, so that nothing jumps on the way through. Clear skies have
// none.
TEST(AmbientLight, OfCloudsIsInTheSkyOverThem) {
  using enum weather::Genus;
  const char* noon = "2026-06-21T12:00:00Z";
  const SkyState clear = skyUnder(kStratocumulus, 0.0, noon, 30e3, 2500.0),
                 over = skyUnder(kStratocumulus, 8.0, noon, 30e3, 2500.0);
  EXPECT_EQ(clear.ambient.air.overClouds, glm::vec3(0.0f));
  const EyeAir& air = over.ambient.air;
  EXPECT_GT(air.overClouds.y, 0.2f * (over.ambient.airSources.upward - over.ambient.airSources.bare).y);
  EXPECT_LT(air.overClouds.y, 0.6f * (over.ambient.airSources.upward - over.ambient.airSources.bare).y);
  ASSERT_GT(air.overCloudsM, 1000.0f);
  ASSERT_LT(air.overCloudsM, 2500.0f);
  const double topM = static_cast<double>(air.overCloudsM);
  const glm::vec3 atTop = airAbout(over, topM).overClouds;
  EXPECT_EQ(airAbout(over, 2.0).overClouds, atTop);
  EXPECT_NEAR(airAbout(over, topM + 1.0).overClouds.y, atTop.y, 1e-3f * atTop.y);
  // As much comes down as the air sends back, but for what ozone takes.
  const sky::Atmosphere& atmosphere = *over.atmosphere;
  const double altitudeM = atmosphere.groundAltitudeM() + topM;
  double down = 0.0;
  constexpr int kSteps = 200;
  for (int i = 0; i < kSteps; ++i) {
    const double mu = (i + 0.5) / kSteps;
    down += 2.0 * mu / kSteps *
            static_cast<double>(atTop.y * (1.0f - atmosphere.transmittanceToSpace(altitudeM, mu).y));
  }
  const double sent = static_cast<double>((atmosphere.sphericalAlbedo(altitudeM) *
                                           (over.ambient.airSources.upward - over.ambient.airSources.bare))
                                              .y);
  EXPECT_NEAR(down, sent, 0.15 * sent);
}

// Clouds that make the air darker make no side of it brighter: what they add from one side is part of what
// they add in the mean.
TEST(AmbientLight, OfCloudsInSunlitAirHasNoSideWithoutAMean) {
  using enum weather::Genus;
  int darker = 0, brighter = 0;
  for (const auto genus : {kCumulus, kStratocumulus, kNimbostratus})
    for (const double oktas : {3.0, 6.0, 8.0})
      for (const char* time : {"2026-06-21T05:00:00Z", "2026-06-21T11:00:00Z"})
        for (const double eyeM : {2.0, 5000.0}) {
          const AirLight glow = skyUnder(genus, oktas, time, 30e3, eyeM).ambient.air.cloudGlow;
          for (int c = 0; c < 3; ++c) {
            const float along = glm::length(glm::vec3(glow.along[0][c], glow.along[1][c], glow.along[2][c]));
            EXPECT_LE(along, 1.2001f * glow.mean[c])
                << static_cast<int>(genus) << " " << oktas << " " << time;
            (glow.mean[c] > 0.0f ? brighter : darker) += 1;
          }
        }
  EXPECT_GT(darker, 0);
  EXPECT_GT(brighter, 0);
}

// The report's snow and dust are in the ground and the air, unless the scene says otherwise.
TEST(AmbientLight, ReportsWhitenTheGroundAndColourTheAir) {
  const auto skyOf = [](const char* report, Snow snow, sky::Aerosol aerosol) {
    Scene s = testing::clearScene(40.0);
    s.metar = report;
    s.ground.snow = snow;
    s.atmosphere.aerosol = aerosol;
    return buildSky(s, 0.0);
  };
  constexpr auto kFrost = "EFHK 211150Z 27010KT 9999 -SN NSC M12/M15 Q1005",
                 kDust = "HECA 211150Z 27025KT 0800 SS NSC 34/04 Q1005";
  const SkyState frost = skyOf(kFrost, Snow::kAuto, sky::Aerosol::kAuto),
                 bare = skyOf(kFrost, Snow::kNone, sky::Aerosol::kAuto),
                 dust = skyOf(kDust, Snow::kAuto, sky::Aerosol::kAuto),
                 haze = skyOf(kDust, Snow::kAuto, sky::Aerosol::kHaze),
                 both = skyOf(kDust, Snow::kLying, sky::Aerosol::kAuto);
  EXPECT_GT(frost.ambient.ground.y, 3.0f * bare.ambient.ground.y);
  EXPECT_EQ(glm::vec3(groundAlbedo(bare.scene, bare.weather)), glm::vec3(bare.scene.ground.albedo));
  EXPECT_EQ(frost.atmosphere->uniforms().groundAlbedo, glm::vec3(groundAlbedo(frost.scene, frost.weather)));
  const auto redness = [](const SkyState& s) { return s.ambient.skyLow.x / s.ambient.skyLow.z; };
  EXPECT_GT(redness(dust), 1.2f * redness(haze));
  EXPECT_GT(both.ambient.ground.y, 3.0f * dust.ambient.ground.y);
}

}  // namespace
}  // namespace welkin::scene
