// SPDX-License-Identifier: Apache-2.0
// Asked-for weather is delivered weather: real reports, eight seeds each, the cover measured on the clouds.
// The same for all example reports is bench/cover_bench.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "welkin/core/parallel.h"
#include "welkin/field/cloud_field.h"
#include "welkin/scene/cloud_cover.h"
#include "welkin/scene/sky_state.h"
#include "welkin/weather/metar.h"

namespace welkin::scene {
namespace {

constexpr int kSeeds = 8;
constexpr double kToleranceOktas = 0.5;

Scene sceneOf(const std::string& metar) {
  Scene scene;
  scene.metar = metar;
  const weather::Metar decoded = weather::parseMetar(metar).metar;
  scene.time = {2026, 7, *decoded.day, *decoded.hour, *decoded.minute, 0.0};
  scene.place = {47.0, 8.0, 0.0};
  return scene;
}

std::shared_ptr<const field::CloudNoise> noiseOf(int seed) {
  static std::array<std::shared_ptr<const field::CloudNoise>, kSeeds + 1> made;
  if (!made[seed]) made[seed] = field::makeCloudNoise(static_cast<std::uint64_t>(seed));
  return made[seed];
}

void expectDelivered(const std::string& metar) {
  SCOPED_TRACE(metar);
  Scene scene = sceneOf(metar);
  const weather::Weather weather = weatherOf(scene);
  ASSERT_FALSE(weather.layers.empty());
  std::vector<double> layers(weather.layers.size(), 0.0);
  double sky = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    scene.seed = seed;
    const auto clouds =
        cloudsAt(scene, weather, calibrateClouds(scene, weather, noiseOf(seed)), noiseOf(seed), 0.0);
    const DeliveredCover cover = measureCover(scene, weather, clouds, 0.0);
    ASSERT_EQ(cover.layers.size(), layers.size());
    for (std::size_t i = 0; i < layers.size(); ++i) layers[i] += cover.layers[i].deliveredOktas / kSeeds;
    sky += cover.sky.deliveredOktas / kSeeds;
  }
  for (std::size_t i = 0; i < layers.size(); ++i)
    EXPECT_NEAR(layers[i], weather.layers[i].oktas, kToleranceOktas) << "layer " << i;
  EXPECT_NEAR(sky, weather.requestedOktas, kToleranceOktas);
}

TEST(CoverDelivery, OfOneLayer) {
  for (const char* metar : {
           "NLWW 231130Z AUTO 09004KT 9999 FEW020/// 27/24 Q1011",
           "LSZH 211120Z 24008KT 9999 SCT040 24/12 Q1018",
           "LSZH 211120Z 24008KT 9999 BKN250 24/12 Q1018",
           "EGLL 211120Z 24008KT 9999 BKN012 14/12 Q1018",
           "EGLL 211120Z 24008KT 4000 DZ OVC008 14/13 Q1018",
           "KMCO 212053Z 24008KT 10SM SCT035CB 31/24 A2992",
       })
    expectDelivered(metar);
}

TEST(CoverDelivery, OfFogAndWhatIsSeenThroughIt) {
  for (const char* metar : {
           "LOAN 231100Z 10006KT 0400 FG VV002",
           "ESGG 230020Z 14004KT 0900 R03/P2000N R21/P2000N FG BKN002 08/08 Q1011",
           "LOWG 230020Z AUTO VRB01KT 0300 R16/0350N R34/0375N FG FEW000 BKN001 09/09 Q1022",
           "KQFV 262130Z AUTO 01002KT 0800 FG CLR 14/12 A3006 RMK A02 TSNO",
           "LIBV 222355Z 19001KT 3000 MIFG NSC 16/16 Q1022",
           "EDDV 220220Z AUTO VRB01KT 7000 0350 R27R/P2000N R27L/P2000N BCFG NSC 11/11 Q1010",
           "KNUW 231053Z 10003KT 5SM BR BCFG SCT001 SCT035 05/04 A3001",
       })
    expectDelivered(metar);
}

TEST(CoverDelivery, OfTwoLayers) {
  for (const char* metar : {
           "UIBB 180730Z 26006MPS 9999 SCT016CB BKN100 M11/M15 Q1025 NOSIG",
           "UTSS 231100Z 31004KT 280V350 9999 BKN013 BKN060CB 13/10 Q1026 R09/290255 NOSIG",
           "VVDN 180730Z 31003KT 5000 BR FEW015 BKN050 19/16 Q1019 NOSIG",
           "VRMH 230000Z 25005KT 9999 FEW018TCU SCT270 27/25 Q1011",
           "EKSB 230020Z AUTO 22004KT 180V250 9999 BKN013/// BKN041/// 13/12 Q1013",
           "KCFS 180754Z AUTO 27010KT 5SM BR BKN008 OVC015 M01/M02 A3015 RMK AO2",
       })
    expectDelivered(metar);
}

TEST(CoverDelivery, OfManyLayers) {
  for (const char* metar : {
           "WBKL 262100Z 02001KT 8000 -RA SCT010 FEW014CB SCT030 BKN130 26/24 Q1011",
           "SAOC 220245Z 20010G20KT 9999 RA FEW015 SCT025 BKN035 FEW045CB 11/07 Q1022",
           "MMCE 262048Z 09008KT 7SM FEW015TCU FEW100 SCT250 32/23 A2978 RMK SLP081 52027 967 8/271",
           "PTSA 220150Z 04010KT 10SM BKN020TCU BKN130 BKN300 31/24 A2975 RMK TCU NE",
           "CYCP 262132Z 00000KT 15SM VCSH FEW006 FEW030 BKN055TCU RMK SF1CF2TCU3",
           "LRBM 230030Z AUTO 26011KT 3500 DZ FEW002/// BKN006/// BKN012/// 11/11 Q1018",
       })
    expectDelivered(metar);
}

// Clouds belong to the weather, not to who looks at them, when, or on how many cores.
TEST(CoverDelivery, CalibrationIsAFunctionOfTheWeatherAlone) {
  Scene scene = sceneOf("PTSA 220150Z 04010KT 10SM BKN020TCU BKN130 BKN300 31/24 A2975");
  const weather::Weather weather = weatherOf(scene);
  auto calibrate = [&] { return calibrateClouds(scene, weather, noiseOf(1)); };
  const std::vector<LayerCalibration> once = calibrate();

  scene.camera.eyeM = 6000.0;
  scene.atS = 900.0;
  const int before = threadCount();
  setThreadCount(3);
  const std::vector<LayerCalibration> again = calibrate();
  setThreadCount(1);
  const std::vector<LayerCalibration> alone = calibrate();
  setThreadCount(before);
  EXPECT_EQ(once, again);
  EXPECT_EQ(once, alone);
}

// Not only at the scene's time: other clouds are in view later.
TEST(CoverDelivery, AtEveryInstant) {
  for (const char* metar : {
           "EGLL 211120Z 24015KT 9999 FEW040 14/12 Q1013",
           "EGLL 211120Z 24015KT 9999 SCT030 14/12 Q1013",
           "KMCO 212053Z 24008KT 10SM SCT035CB 31/24 A2992",
           "EGLL 211120Z 24020KT 9999 SCT250 14/12 Q1013",
           "EGLL 211120Z 24020KT 9999 BKN012 14/12 Q1013",
           "EGLL 211120Z 24008KT 9999 FEW040 SCT250 14/12 Q1013",
       }) {
    SCOPED_TRACE(metar);
    Scene scene = sceneOf(metar);
    scene.drift.windDeg = 40.0;
    SkyState state = buildSky(scene, 0.0);
    for (double t = -1187.0; t < 7200.0; t += 1187.0) {
      moveSky(state, t);
      const DeliveredCover cover = measureCover(scene, state.weather, *state.clouds, t);
      for (const LayerCover& layer : cover.layers)
        EXPECT_NEAR(layer.deliveredOktas, layer.requestedOktas, kToleranceOktas) << t;
      EXPECT_NEAR(cover.sky.deliveredOktas, cover.sky.requestedOktas, kToleranceOktas) << t;
    }
  }
}

TEST(CoverDelivery, KeyInstantsAreCloserTheFasterCloudsPass) {
  const auto interval = [](const std::string& metar) {
    const Scene scene = sceneOf(metar);
    return coverKeyInterval(scene, weatherOf(scene));
  };
  EXPECT_EQ(interval("EGLL 211120Z 00000KT CAVOK 14/12 Q1013"), 0.0);
  EXPECT_EQ(interval("EGLL 211120Z 24001KT 9999 SCT040 14/12 Q1013"), 240.0);
  const double slow = interval("EGLL 211120Z 24008KT 9999 SCT040 14/12 Q1013"),
               fast = interval("EGLL 211120Z 24040KT 9999 SCT040 14/12 Q1013"),
               low = interval("EGLL 211120Z 24040KT 9999 SCT006 14/12 Q1013");
  EXPECT_LT(fast, slow);
  EXPECT_LT(low, fast);
  EXPECT_GE(low, 7.5);
}

TEST(CoverDelivery, AKeyInstantInPortionsIsTheSame) {
  const Scene scene = sceneOf("PTSA 220150Z 04010KT 10SM BKN020TCU BKN130 BKN300 31/24 A2975");
  const weather::Weather weather = weatherOf(scene);
  const CoverKey first = firstCoverKey(scene, weather, noiseOf(1), false);
  EXPECT_EQ(first.layers, calibrateClouds(scene, weather, noiseOf(1)));
  CoverKeyInProgress portions, whole;
  for (const double atS : {0.0, 480.0}) {
    portions.start(scene, weather, noiseOf(1), first.layers, atS);
    for (int part = 7; part < portions.parts() + 7; part += 7) portions.computeTo(part);
    whole.start(scene, weather, noiseOf(1), first.layers, atS);
    whole.computeTo(whole.parts());
    EXPECT_EQ(portions.key(), whole.key());
    EXPECT_EQ(portions.key() == first, atS == 0.0);
  }
}

TEST(CoverDelivery, BetweenKeyInstantsItIsBlended) {
  const CoverKey before{60.0, {{7, 0.5f, 0.01f}}}, after{120.0, {{7, 1.5f, 0.03f}}};
  std::vector<LayerCalibration> blended;
  blendCover(before, after, 75.0, blended);
  EXPECT_EQ(blended, (std::vector<LayerCalibration>{{7, 0.75f, std::lerp(0.01f, 0.03f, 0.25f)}}));
  blendCover(before, {}, 60.0, blended);
  EXPECT_EQ(blended, before.layers);
}

// Wherever the sequence has been before.
TEST(CoverDelivery, ASequenceHasTheStillsCalibration) {
  const Scene scene = sceneOf("UIBB 180730Z 26006MPS 9999 SCT016CB BKN100 M11/M15 Q1025 NOSIG");
  SkyState moved = buildSky(scene, 0.0);
  for (const double t : {0.5, 60.0, 6939.0, -20.0, 20.0}) {
    moveSky(moved, t);
    EXPECT_EQ(moved.calibration, buildSky(scene, t).calibration) << t;
    EXPECT_EQ(moved.calibration, calibrationAt(scene, moved.weather, moved.clouds->sharedNoise(), t)) << t;
  }
}

TEST(CoverDelivery, ALaterSkyIsTheSameFromAnEarlierOneAsFromNothing) {
  const Scene scene = sceneOf("UIBB 180730Z 26006MPS 9999 SCT016CB BKN100 M11/M15 Q1025 NOSIG");
  const SkyState first = buildSky(scene, 0.0);
  const SkyState later = buildSky(scene, 631.0), continued = buildSky(scene, 631.0, &first);
  SkyState moved = first;
  moveSky(moved, 631.0);
  ASSERT_EQ(later.clouds->layers().size(), 3u);  // snow falls from the first
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<float> a, b, c;
    auto into = [](std::vector<float>& v) {
      return [&v](const char*, const auto& value) {
        const auto* p = reinterpret_cast<const float*>(&value);
        v.insert(v.end(), p, p + sizeof(value) / sizeof(float));
      };
    };
    forEachMember(later.clouds->layers()[i], into(a));
    forEachMember(continued.clouds->layers()[i], into(b));
    forEachMember(moved.clouds->layers()[i], into(c));
    EXPECT_EQ(a, b);
    EXPECT_EQ(a, c);
    EXPECT_NE(later.clouds->layers()[i].driftM, first.clouds->layers()[i].driftM);
  }
}

}  // namespace
}  // namespace welkin::scene
