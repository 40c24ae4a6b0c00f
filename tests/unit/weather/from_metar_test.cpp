// SPDX-License-Identifier: Apache-2.0
// From reports to weather: what must be there, what must not, and that it is the same every time.
#include "welkin/weather/from_metar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/core/units.h"
#include "welkin/weather/choose_genus.h"
#include "welkin/weather/genus.h"
#include "welkin/weather/wind.h"

namespace welkin::weather {
namespace {

Weather weatherOf(std::string_view report, double latitudeDeg = 47.0, int month = 6,
                  double solarHour = 13.0) {
  return weatherFromMetar(parseMetar(report).metar, latitudeDeg, month, solarHour);
}

std::vector<Genus> generaOf(const Weather& w) {
  std::vector<Genus> genera;
  for (const Layer& l : w.layers) genera.push_back(l.genus);
  return genera;
}

bool anyNote(const Weather& w, std::string_view part) {
  return std::any_of(w.notes.begin(), w.notes.end(),
                     [&](const std::string& n) { return n.find(part) != std::string::npos; });
}

TEST(FromMetar, ClearSkiesInventNoLayer) {
  for (const char* sky : {"9999 SKC", "9999 CLR", "9999 NSC", "9999 NCD", "CAVOK", "9999", "9999 //////"}) {
    const Weather w = weatherOf("LSZH 211200Z 24005KT " + std::string(sky) + " 20/10 Q1015");
    EXPECT_TRUE(w.layers.empty()) << sky;
    EXPECT_EQ(w.requestedOktas, 0.0) << sky;
  }
  EXPECT_TRUE(anyNote(weatherOf("LSZH 211200Z 24005KT 9999 ////// 20/10 Q1015"), "cannot observe"));
}

// Rain that is seen to fall, layer by layer, mm/h.
TEST(FromMetar, ShaftsOfRainFallFromHeapsAndStorms) {
  const auto rainOf = [](const std::string& what) {
    std::vector<double> rain;
    for (const Layer& l : weatherOf("LSZH 211200Z 24005KT 9999 " + what + " 20/14 Q1015").layers)
      rain.push_back(l.rainMmPerH);
    return rain;
  };
  using Rain = std::vector<double>;
  EXPECT_EQ(rainOf("SCT030 BKN100"), (Rain{0.0, 0.0}));
  EXPECT_EQ(rainOf("RA OVC030"), (Rain{0.0}));  // everywhere, and in the visibility
  EXPECT_EQ(rainOf("FEW030TCU"), (Rain{0.0}));
  const Rain showers = rainOf("-SHRA FEW020TCU BKN100"), heavy = rainOf("+SHRA FEW020TCU BKN100");
  ASSERT_EQ(showers.size(), 2u);
  EXPECT_GT(showers[0], 0.5);
  EXPECT_EQ(showers[1], 0.0);
  EXPECT_GT(heavy[0], 5.0 * showers[0]);
  EXPECT_GT(rainOf("VCSH FEW020TCU")[0], 1.0);
  // A storm rains, if not at the station.
  EXPECT_EQ(rainOf("FEW020 SCT030CB")[0], 0.0);
  EXPECT_GT(rainOf("FEW020 SCT030CB")[1], 10.0);
  EXPECT_GT(rainOf("+TSRA SCT030CB")[0], 10.0);
  // From an overcast too, by its rate (15 mm/h and 1.2, times 1.6), once.
  EXPECT_EQ(rainOf("+SHRA OVC020"), (Rain{24.0}));
  EXPECT_EQ(rainOf("+SHRA FEW250 OVC020"), (Rain{24.0, 0.0}));
  EXPECT_EQ(rainOf("-SHRA OVC120"), (Rain{1.6 * 1.2}));
  EXPECT_EQ(rainOf("SHRA SCT020CB OVC040")[1], 0.0);
  EXPECT_EQ(rainOf("SHRA FEW020 BKN080")[1], 0.0);
  EXPECT_EQ(rainOf("SHRA OVC300"), (Rain{0.0}));
}

TEST(FromMetar, ShowersFromAnOvercastAreSaidAndDark) {
  const Weather heavy = weatherOf("LSZH 211200Z 24005KT 3000 +SHRA OVC020 12/11 Q1005");
  EXPECT_TRUE(anyNote(heavy, "Showers fall from a sheet of cloud at 610 m; it is taken for nimbostratus."));
  const auto depth = [](const Layer& l) { return l.extinctionPerM * (l.topM - l.baseM); };
  EXPECT_GT(depth(heavy.layers.at(0)), 23.0);
  EXPECT_TRUE(
      anyNote(weatherOf("LSZH 211200Z 24005KT 3000 SHRA OVC300 12/11 Q1005"), "no cloud that they could"));
  EXPECT_FALSE(anyNote(weatherOf("LSZH 211200Z 24005KT 3000 SHRA BKN030 12/11 Q1005"), "Showers"));
}

// Without a word about cloud precipitation falls from some; where there is said to be none, that is noted.
TEST(FromMetar, PrecipitationNeedsCloud) {
  const auto of = [](const std::string& groups) {
    return weatherOf("KJFK 211551Z 22005KT 9SM " + groups + " 12/11 A2990");
  };
  const Weather rain = of("+RA");
  EXPECT_EQ(generaOf(rain), std::vector{Genus::kNimbostratus});
  EXPECT_EQ(rain.requestedOktas, 8.0);
  EXPECT_TRUE(anyNote(rain, "says nothing about cloud, but precipitation falls: an overcast"));
  EXPECT_TRUE(anyNote(of("SHRA"), "broken towering cumulus"));
  EXPECT_TRUE(anyNote(of("+RA ///"), "cannot observe cloud, but precipitation falls"));
  for (const char* clear : {"CLR", "SKC", "NSC", "NCD"}) {
    const Weather w = of("-RA " + std::string(clear));
    EXPECT_TRUE(w.layers.empty()) << clear;
    EXPECT_TRUE(anyNote(w, "Precipitation falls from a sky that is said to be without cloud")) << clear;
    EXPECT_FALSE(anyNote(of(clear), "cloud")) << clear;
  }
  const Weather silent = weatherOf("KJFK 211551Z 22005KT 9SM 12/11 A2990");
  EXPECT_TRUE(silent.layers.empty());
  EXPECT_TRUE(anyNote(silent, "The report says nothing about cloud; none is drawn."));
  EXPECT_FALSE(anyNote(weatherOf("LSZH 211200Z 24005KT CAVOK 20/10 Q1015"), "cloud"));
}

TEST(FromMetar, SaysWhatOfTheVicinityIsNotDrawn) {
  EXPECT_TRUE(anyNote(weatherOf("LSZH 211200Z 24005KT 9999 VCFG FEW030 20/14 Q1015"), "not drawn: VCFG"));
  EXPECT_TRUE(anyNote(weatherOf("LSZH 211200Z 24005KT 9999 VCSH OVC100 20/14 Q1015"), "not drawn: VCSH"));
  EXPECT_FALSE(anyNote(weatherOf("LSZH 211200Z 24005KT 9999 VCSH FEW030TCU 20/14 Q1015"), "not drawn"));
}

TEST(FromMetar, BasesAndCoverAreThoseOfTheReport) {
  const Weather w = weatherOf("LSZH 211200Z 24005KT 9999 FEW020 SCT045 BKN250 20/14 Q1015");
  ASSERT_EQ(w.layers.size(), 3u);
  EXPECT_NEAR(w.layers[0].baseM, 2000 * kMetresPerFoot, 1e-9);
  EXPECT_NEAR(w.layers[1].baseM, 4500 * kMetresPerFoot, 1e-9);
  EXPECT_NEAR(w.layers[2].baseM, 25000 * kMetresPerFoot, 1e-9);
  EXPECT_NEAR(w.layers[0].oktas, 1.5, 1e-9);
  EXPECT_NEAR(w.layers[2].oktas, 8.0 * 2.5 / 4.5, 1e-9);
  EXPECT_EQ(w.requestedOktas, 6.0);
  EXPECT_FALSE(w.layers[0].baseAssumed);
}

TEST(FromMetar, GenusFollowsFromHeightAmountAndWeather) {
  struct Case {
    const char* report;
    double latitudeDeg;
    int month;
    double solarHour;
    std::vector<Genus> wanted;
  };
  using enum Genus;
  const Case cases[] = {
      {"LSZH 211200Z 24005KT 9999 SCT040 22/12 Q1015", 47, 6, 13, {kCumulus}},        // a summer's day
      {"LSZH 210000Z 24005KT 9999 SCT040 12/10 Q1015", 47, 6, 1, {kStratocumulus}},   // its night
      {"LSZH 211200Z 24005KT 9999 SCT040 02/M08 Q1015", 47, 1, 9, {kStratocumulus}},  // a winter's morning
      {"TBPB 210000Z 09012KT 9999 SCT018 26/22 Q1013", 13, 6, 1, {kCumulus}},  // trade cumulus at night
      {"LSZH 211200Z 24005KT 9999 BKN030 15/10 Q1015", 47, 6, 13, {kStratocumulus}},
      {"LSZH 211200Z 24005KT 5000 BR OVC006 08/07 Q1015", 47, 11, 13, {kStratus}},
      {"LSZH 211200Z 24005KT 4000 -DZ OVC008 08/07 Q1015", 47, 11, 13, {kStratus}},
      {"LSZH 211200Z 24005KT 6000 RA SCT010 OVC040 08/07 Q1005", 47, 11, 13, {kStratus, kNimbostratus}},
      {"LSZH 211200Z 24005KT 9999 -SHRA SCT030 08/04 Q1005", 47, 4, 13, {kCumulus}},
      {"LSZH 211200Z 24005KT 3000 +SHRA OVC020 12/11 Q1005", 47, 4, 13, {kNimbostratus}},
      {"LSZH 211200Z 24005KT 3000 SHSN OVC020 M01/M02 Q1005", 47, 1, 13, {kNimbostratus}},
      {"LSZH 211200Z 24005KT 3000 SHRA OVC008 12/11 Q1005", 47, 4, 13, {kNimbostratus}},
      {"LSZH 211200Z 24005KT 3000 SHRA BKN008 12/11 Q1005", 47, 4, 13, {kCumulus}},
      {"LSZH 211200Z 24005KT 3000 SHRA SCT010 OVC020 12/11 Q1005", 47, 4, 13, {kCumulus, kNimbostratus}},
      {"LSZH 211200Z 24005KT 3000 SHRA OVC080 12/11 Q1005", 47, 4, 13, {kNimbostratus}},
      {"LSZH 211200Z 24005KT 3000 SHRA OVC120 12/11 Q1005", 47, 4, 13, {kAltostratus}},
      {"LSZH 211200Z 24005KT 3000 SHRA BKN080 12/11 Q1005", 47, 4, 13, {kCumulus}},
      {"LSZH 211200Z 24005KT 3000 SHRA FEW020 BKN080 12/11 Q1005", 47, 4, 13, {kCumulus, kAltocumulus}},
      {"LSZH 211200Z 24005KT 3000 SHRA FEW020CB OVC040 12/11 Q1005",
       47,
       4,
       13,
       {kCumulonimbus, kStratocumulus}},
      {"LSZH 211200Z 24005KT 9999 FEW030CB SCT040 BKN100 20/14 Q1012",
       47,
       6,
       13,
       {kCumulonimbus, kCumulus, kAltocumulus}},
      {"LSZH 211200Z 24005KT 9999 FEW030TCU 20/14 Q1012", 47, 6, 13, {kCumulus}},
      {"LSZH 211200Z 24005KT 9999 BKN120 20/10 Q1012", 47, 6, 13, {kAltocumulus}},
      {"LSZH 211200Z 24005KT 9999 OVC120 20/10 Q1012", 47, 6, 13, {kAltostratus}},
      {"LSZH 211200Z 24005KT 9999 FEW280 20/10 Q1012", 47, 6, 13, {kCirrus}},
      {"LSZH 211200Z 24005KT 9999 OVC280 20/10 Q1012", 47, 6, 13, {kCirrostratus}},
      {"KBVU 262115Z 16023KT 10SM SCT085 35/13 A2978", 36, 7, 14, {kCumulus}},  // over the desert
      {"ENSB 211200Z 24005KT 9999 BKN140 M10/M15 Q1012",
       78,
       3,
       12,
       {kCirrostratus}},  // high cloud hangs low there
      {"WSSS 211200Z 24005KT 9999 BKN220 28/24 Q1010", 1, 3, 12, {kAltocumulus}},  // and here not
  };
  for (const Case& c : cases) {
    EXPECT_EQ(generaOf(weatherOf(c.report, c.latitudeDeg, c.month, c.solarHour)), c.wanted) << c.report;
  }
}

TEST(FromMetar, DepthsGrowWithTheName) {
  const auto depth = [](const char* sky, double latitudeDeg) {
    const Weather w =
        weatherOf("LSZH 211200Z 24005KT 9999 " + std::string(sky) + " 22/16 Q1012", latitudeDeg);
    return w.layers.at(0).topM - w.layers.at(0).baseM;
  };
  EXPECT_LT(depth("FEW025", 47), depth("SCT025", 47));
  EXPECT_LT(depth("SCT025", 47), depth("SCT025TCU", 47));
  EXPECT_LT(depth("SCT025TCU", 47), depth("SCT025CB", 47));
  EXPECT_LT(depth("SCT025CB", 70), depth("SCT025CB", 47));
  EXPECT_LT(depth("SCT025CB", 47), depth("SCT025CB", 5));
}

double depthOf(std::string_view report) {
  const Weather w = weatherOf(report);
  return w.layers.at(0).topM - w.layers.at(0).baseM;
}

TEST(FromMetar, WinterStormsAreShallower) {
  // 0.85 of 11,260 m at 47 degrees, less up to 0.4 of it from 15 C down to -10 C.
  const double top = 0.85 * levelsAt(47.0).highTopM, baseM = 2500 * kMetresPerFoot;
  EXPECT_NEAR(depthOf("LSZH 211200Z 24005KT 9999 SCT025CB 22/16 Q1012"), top - baseM, 1e-6);
  EXPECT_NEAR(depthOf("LSZH 211200Z 24005KT 9999 SCT025CB 05/02 Q1012"), 0.84 * top - baseM, 1e-6);
  EXPECT_NEAR(depthOf("LSZH 211200Z 24005KT 9999 SCT025CB M10/M12 Q1012"), 0.6 * top - baseM, 1e-6);
  EXPECT_NEAR(depthOf("LSZH 211200Z 24005KT 9999 SCT025CB M20/M22 Q1012"), 0.6 * top - baseM, 1e-6);
}

TEST(FromMetar, HeavyRainFallsFromDeeperNimbostratus) {
  EXPECT_NEAR(depthOf("LSZH 211200Z 24005KT 3000 RA OVC030 12/11 Q1005"), 2500.0, 1e-9);
  EXPECT_NEAR(depthOf("LSZH 211200Z 24005KT 3000 +RA OVC030 12/11 Q1005"), 3500.0, 1e-9);
}

TEST(FromMetar, ExtinctionInTheBodyOfClouds) {
  const auto of = [](const std::string& what) {
    return weatherOf("LSZH 211200Z 24005KT 9999 " + what + " 22/16 Q1012").layers.at(0).extinctionPerM;
  };
  EXPECT_EQ(of("SCT025"), 0.05);      // cumulus
  EXPECT_EQ(of("SCT025CB"), 0.04);    // cumulonimbus
  EXPECT_EQ(of("RA OVC030"), 0.025);  // nimbostratus
}

// What is pressed into less depth stays as opaque as it was, up to twice as dense.
TEST(FromMetar, ThinnerSheetsAreNoMoreTransparent) {
  const auto lowest = [](const std::string& sky) {
    return weatherOf("LSZH 211200Z 24005KT 9999 " + sky + " 10/09 Q1012", 47, 11, 8).layers.at(0);
  };
  const Layer free = lowest("BKN020"), pressed = lowest("BKN020 OVC028"), flat = lowest("BKN020 OVC022");
  EXPECT_EQ(free.genus, Genus::kStratocumulus);
  EXPECT_EQ(free.extinctionPerM, 0.035);
  EXPECT_NEAR(pressed.topM - pressed.baseM, 0.85 * 800 * kMetresPerFoot, 1e-6);
  EXPECT_NEAR(pressed.extinctionPerM * (pressed.topM - pressed.baseM), 0.035 * 350.0, 1e-6);
  EXPECT_EQ(flat.extinctionPerM, 0.07);
}

TEST(FromMetar, ASheetEndsBelowTheNext) {
  const Weather w = weatherOf("LSZH 211200Z 24005KT 9999 BKN020 OVC024 10/09 Q1012", 47, 11, 8);
  ASSERT_EQ(w.layers.size(), 2u);
  EXPECT_LT(w.layers[0].topM, w.layers[1].baseM);
}

TEST(FromMetar, VerticalVisibilityObscuresTheSky) {
  const Weather w = weatherOf("LOAN 231100Z 10006KT 0400 FG VV002 03/03 Q1020");
  ASSERT_EQ(w.layers.size(), 1u);
  const Layer& fog = w.layers[0];
  EXPECT_EQ(fog.genus, Genus::kFog);
  EXPECT_EQ(fog.baseM, 0.0);
  EXPECT_EQ(fog.oktas, 8.0);
  EXPECT_EQ(w.requestedOktas, 8.0);
  EXPECT_NEAR(std::exp(-fog.extinctionPerM * 400.0), 0.05, 1e-4) << "visibility is where 5 % is left";
  EXPECT_GE(fog.topM, 200 * kMetresPerFoot);
  EXPECT_GT(fog.extinctionPerM * fog.topM, 5.0) << "the sun's disc is hidden";
  EXPECT_GE(w.visibilityM, 5000.0) << "haze is not fog";
  EXPECT_EQ(weatherOf("EGPD 231053Z 00000KT 0800 RA BR VV002 10/10 Q1004").layers.at(0).genus, Genus::kFog);
}

TEST(FromMetar, DustAndSnowThatObscureAreNoFog) {
  const auto of = [](const std::string& what) {
    return weatherOf("OEJN 211200Z 33018KT " + what + " M03/M05 Q1006");
  };
  for (const char* weather : {"DU", "SA", "+SS", "DS", "FU", "VA", "HZ", "BLDU", "HZ BR", "BLSN", "DRSN"}) {
    const Weather w = of("0400 " + std::string(weather) + " VV003");
    EXPECT_TRUE(w.layers.empty()) << weather;
    EXPECT_EQ(w.requestedOktas, 0.0) << weather;
    EXPECT_NEAR(std::exp(-3.912 / w.visibilityM * 400.0), 0.05, 1e-4) << weather;
    EXPECT_TRUE(anyNote(w, "obscured by")) << weather;
    EXPECT_EQ(generaOf(of("0400 FG " + std::string(weather) + " VV003")), std::vector{Genus::kFog})
        << weather;
  }
  for (const char* snow : {"+SN", "SHSN", "-SN BLSN"}) {  // it falls from cloud that is not seen
    const Weather w = of("0400 " + std::string(snow) + " VV///");
    EXPECT_EQ(generaOf(w), std::vector{Genus::kNimbostratus}) << snow;
    EXPECT_EQ(w.requestedOktas, 8.0) << snow;
    EXPECT_NEAR(w.visibilityM, 522.3, 0.1) << snow;
    EXPECT_TRUE(anyNote(w, "obscured by snow and not by fog")) << snow;
  }
  EXPECT_NEAR(of("//// SS VV///").visibilityM, 652.9, 0.1) << "500 m by 5 %";
  EXPECT_EQ(generaOf(of("0400 BR VV003")), std::vector{Genus::kFog});
}

TEST(FromMetar, OfTooManyLayersTheSmallestAreLeftOut) {
  const Weather w = weatherOf(
      "LSZH 211200Z 24005KT 9999 FEW005 FEW008CB FEW010 SCT020 SCT025 BKN030 BKN040 BKN080 OVC100 12/11 "
      "Q1015");
  ASSERT_EQ(w.layers.size(), kMaxLayers - 1);
  EXPECT_EQ(w.requestedOktas, 8.0);
  EXPECT_EQ(w.layers.front().genus, Genus::kCumulonimbus);
  EXPECT_NEAR(w.layers[1].baseM, 2000 * kMetresPerFoot, 1e-9);
  EXPECT_NEAR(w.layers.back().baseM, 10000 * kMetresPerFoot, 1e-9);
  EXPECT_TRUE(anyNote(w, "7 of the 9 layers are drawn, without the smallest."));
}

TEST(FromMetar, FogUnderAReportedSkyIsShallow) {
  const Weather w = weatherOf("LIBV 222355Z 19001KT 0300 FG NSC 16/16 Q1022");
  ASSERT_EQ(w.layers.size(), 1u);
  EXPECT_EQ(w.layers[0].genus, Genus::kFog);
  EXPECT_LT(w.layers[0].topM * w.layers[0].extinctionPerM, 0.3) << "the zenith is seen through it";
  EXPECT_LT(w.requestedOktas, 2.0);
  EXPECT_EQ(weatherOf("LIBV 222355Z 19001KT 0300 FG 16/16 Q1022").requestedOktas, 8.0)
      << "no sky reported: none seen";
  EXPECT_EQ(weatherOf("LIBV 222355Z 19001KT 0300 FG OVC002 16/16 Q1022").requestedOktas, 8.0);
  const double full = weatherOf("LIBV 222355Z 19001KT 3000 PRFG NSC 16/16 Q1022").requestedOktas;
  const double patches = weatherOf("LIBV 222355Z 19001KT 3000 BCFG NSC 16/16 Q1022").requestedOktas;
  EXPECT_GT(full, patches);
  EXPECT_GT(patches, 0.0);
  const Weather below = weatherOf("LIBV 222355Z 19001KT 3000 MIFG NSC 16/16 Q1022");
  EXPECT_LE(below.layers[0].topM, 2.0);
  EXPECT_EQ(below.layers[0].oktas, 0.0) << "what is beneath the eye covers none of the sky";
  EXPECT_EQ(below.requestedOktas, 0.0);
  EXPECT_EQ(weatherOf("LIBV 222355Z 19001KT 3000 MIFG BKN030 16/16 Q1022").requestedOktas, 6.0);
  EXPECT_TRUE(weatherOf("LIBV 222355Z 19001KT 9999 VCFG NSC 16/16 Q1022").layers.empty());
}

TEST(FromMetar, SheetsEndBelowTheNext) {
  for (const char* sky : {"BKN005 OVC006", "BKN005 OVC007", "BKN005 OVC012", "BKN005 BKN006 OVC007"}) {
    const Weather w = weatherOf("LSZH 211200Z 24005KT 9999 " + std::string(sky) + " 12/11 Q1015");
    for (std::size_t i = 0; i + 1 < w.layers.size(); ++i)
      EXPECT_LE(w.layers[i].topM, w.layers[i + 1].baseM) << sky;
    for (const Layer& l : w.layers) EXPECT_NO_THROW(validate(l)) << sky;
  }
}

TEST(FromMetar, MissingBasesAreClimatologicalAndSaidToBe) {
  const Weather overcast = weatherOf("LSZH 211200Z 24005KT 9999 OVC/// 12/08 Q1015");
  ASSERT_EQ(overcast.layers.size(), 1u);
  EXPECT_TRUE(overcast.layers[0].baseAssumed);
  EXPECT_EQ(overcast.layers[0].oktas, 8.0);
  EXPECT_TRUE(anyNote(overcast, "assumed"));

  const Weather storm = weatherOf("EGLC 231120Z AUTO 14006KT 9999 SCT026/// //////CB 17/12 Q1001");
  ASSERT_EQ(storm.layers.size(), 2u);
  const Layer& cb = storm.layers[0];  // 625 m by Espy's rule, below 2,600 ft
  EXPECT_EQ(cb.genus, Genus::kCumulonimbus);
  EXPECT_TRUE(cb.baseAssumed);
  EXPECT_NEAR(cb.baseM, 625.0, 1e-9);
  EXPECT_TRUE(anyNote(storm, "without its base"));
  EXPECT_TRUE(anyNote(storm, "without its amount"));

  const Weather unseenRain = weatherOf("LFBL 231130Z AUTO 16011KT 9999 RA ////// 19/14 Q1009");
  ASSERT_EQ(unseenRain.layers.size(), 1u) << "rain falls from somewhere";
  EXPECT_TRUE(unseenRain.layers[0].baseAssumed);
}

TEST(FromMetar, ThunderMakesAStorm) {
  const Weather w = weatherOf("SVBI 262100Z 02003KT 9999 TSRA SCT017 BKN100 23/19 Q1008", 8.0);
  EXPECT_TRUE(w.thunder);
  EXPECT_EQ(w.layers.at(0).genus, Genus::kCumulonimbus);
  EXPECT_TRUE(anyNote(w, "Thunder"));
  EXPECT_FALSE(weatherOf("KSOW 262115Z 19013KT 10SM VCTS BKN060 25/09 A3018").thunder);
  EXPECT_TRUE(anyNote(weatherOf("KSOW 262115Z 19013KT 10SM VCTS BKN060 25/09 A3018"), "VCTS"));
  EXPECT_TRUE(weatherOf("KSOW 262115Z 19013KT 10SM TS CLR 25/09 A3018").layers.empty());
}

TEST(FromMetar, Precipitation) {
  struct Case {
    const char* group;
    PrecipitationKind kind;
  };
  for (const Case& c : {Case{"RA", PrecipitationKind::kRain}, Case{"-SN", PrecipitationKind::kSnow},
                        Case{"DZ", PrecipitationKind::kDrizzle}, Case{"PL", PrecipitationKind::kIcePellets},
                        Case{"+TSRAGR", PrecipitationKind::kHail}, Case{"SHGS", PrecipitationKind::kHail},
                        Case{"SGSN", PrecipitationKind::kSnow}, Case{"SGRA", PrecipitationKind::kSnow},
                        Case{"-RAGS", PrecipitationKind::kHail}, Case{"RASN", PrecipitationKind::kRain},
                        Case{"SNRA", PrecipitationKind::kSnow}, Case{"BLSN", PrecipitationKind::kNone},
                        Case{"BR", PrecipitationKind::kNone}, Case{"VCSH", PrecipitationKind::kNone},
                        Case{"FZRA", PrecipitationKind::kRain}}) {
    const Weather w = weatherOf("LSZH 211200Z 24005KT 5000 " + std::string(c.group) + " OVC030 05/04 Q1005");
    EXPECT_EQ(w.precipitation, c.kind) << c.group;
    EXPECT_EQ(w.precipitationMmPerH > 0.0, c.kind != PrecipitationKind::kNone) << c.group;
  }
  const auto rate = [](const char* group) {
    return weatherOf("LSZH 211200Z 24005KT 5000 " + std::string(group) + " OVC030 05/04 Q1005")
        .precipitationMmPerH;
  };
  EXPECT_LT(rate("-RA"), 2.5);  // AMS Glossary: light, moderate, heavy
  EXPECT_GT(rate("RA"), 2.5);
  EXPECT_LT(rate("RA"), 7.6);
  EXPECT_GT(rate("+RA"), 7.6);
  EXPECT_LT(rate("+DZ"), rate("-RA"));
  EXPECT_EQ(weatherOf("LSZH 211200Z 24005KT 5000 UP OVC030 M05/M06 Q1005").precipitation,
            PrecipitationKind::kSnow);
}

TEST(FromMetar, AerosolIsTheHeaviestAtTheStation) {
  const auto of = [](const std::string& what) {
    return weatherOf("OEJN 211200Z 33018KT " + what + " NSC 35/05 Q1006").aerosol;
  };
  for (const char* dust : {"2000 DU", "2000 SA", "2000 SS", "0200 +DS", "6000 PO", "3000 BLDU", "3000 BLSA",
                           "4900 DRSA", "4900 DRDU", "3000 FU DU", "3000 DU FU"})
    EXPECT_EQ(of(dust), Aerosol::kDust) << dust;
  for (const char* haze : {"3000 HZ", "3000 BR", "5000 DRDU", "9999 DRSA", "//// DRSA", "9999 VCSS",
                           "9999 VCBLDU", "3000 BLSN", "9999", "2000 +SHRA"})
    EXPECT_EQ(of(haze), Aerosol::kHaze) << haze;
  for (const char* smoke : {"3000 FU", "3000 HZ FU", "9999 DRDU FU"})
    EXPECT_EQ(of(smoke), Aerosol::kSmoke) << smoke;
  for (const char* ash : {"3000 VA", "3000 VA DU", "3000 DU FU VA"}) EXPECT_EQ(of(ash), Aerosol::kAsh) << ash;
}

TEST(FromMetar, SnowOnTheGroundByTheReportAlone) {
  const auto of = [](const std::string& weather, const std::string& rest) {
    return weatherOf("UUEE 211200Z 33008KT 3000 " + weather + " OVC020 " + rest).snowOnGround;
  };
  for (const char* snow : {"-SN", "SN", "+SN", "SG", "BLSN", "DRSN", "-SHSN", "RASN", "VCBLSN"}) {
    EXPECT_TRUE(of(snow, "00/M01 Q1006")) << snow;
    EXPECT_TRUE(of(snow, "///// Q1006")) << snow;
    EXPECT_FALSE(of(snow, "01/M01 Q1006")) << snow;
  }
  for (const char* none : {"FZRASN", "FZRA", "RA", "PL", "BR", "GS", "VCSH"})
    EXPECT_FALSE(of(none, "M02/M03 Q1006")) << none;
  EXPECT_TRUE(of("SN", "00/M01 A2992 RMK T00041011"));
  EXPECT_FALSE(of("SN", "01/M01 A2992 RMK T00051011"));
  for (const char* runway : {"R24/490150", "R24L/590250", "R24/890150", "R/SNOCLO", "SNOCLO", "88490150"})
    EXPECT_TRUE(of("BR", "05/01 Q1006 " + std::string(runway))) << runway;
  for (const char* runway : {"R24/290150", "R24/790150", "R24/CLRD70", "R24/4000", "88CLRD70", "R24///////"})
    EXPECT_FALSE(of("BR", "M05/M06 Q1006 " + std::string(runway))) << runway;
}

TEST(FromMetar, VisibilityAndHaze) {
  // Reports go by a contrast of 5 %, Weather by 2 %: the air is the same.
  const double smokeM = weatherOf("VIDP 220230Z 24004KT 1200 FU NSC 21/16 Q1019").visibilityM;
  EXPECT_NEAR(std::exp(-3.912 / smokeM * 1200.0), 0.05, 1e-4);
  const double dry = weatherOf("LSZH 211200Z 24005KT CAVOK 25/05 Q1015").visibilityM;
  const double humid = weatherOf("LSZH 211200Z 24005KT CAVOK 15/14 Q1015").visibilityM;
  EXPECT_EQ(dry, 40000.0);
  EXPECT_LT(humid, 0.6 * dry);
  EXPECT_GE(humid, 10000.0);
  EXPECT_EQ(weatherOf("KMRY 211753Z 24005KT 10SM CLR 25/05 A2992").visibilityM, 40000.0)
      << "ten miles or more";
  EXPECT_NEAR(weatherOf("CYXL 211753Z 24005KT 15SM CLR 25/05 A2992").visibilityM, 1.3057 * 24140.16, 1.0);
  // Fog that is shallow or not everywhere leaves the air its visibility.
  const auto visibilityOf = [](const std::string& what) {
    return weatherOf("LIBV 222355Z 19001KT " + what + " NSC 16/16 Q1022").visibilityM;
  };
  for (const char* fog : {"MIFG", "BR MIFG", "BCFG", "PRFG"})
    EXPECT_EQ(visibilityOf("3000 " + std::string(fog)), visibilityOf("3000 BR")) << fog;
  EXPECT_EQ(visibilityOf("0400 FG"), 10000.0);
  EXPECT_EQ(visibilityOf("0400 BCFG"), 10000.0) << "no air alone has so little";
  EXPECT_NEAR(relativeHumidity(20.0, 20.0), 1.0, 1e-12);
  EXPECT_NEAR(relativeHumidity(20.0, 9.3), 0.50, 0.01);  // psychrometric tables
}

TEST(FromMetar, WindTurnsAndGrowsWithHeight) {
  const Wind surface{270.0, 5.0};
  const Wind north = windAloft(surface, 1000.0, 50.0, 6), south = windAloft(surface, 1000.0, -50.0, 6);
  EXPECT_NEAR(north.fromDeg, 295.0, 1e-6);
  EXPECT_NEAR(south.fromDeg, 245.0, 1e-6);
  EXPECT_NEAR(north.speedMps, 5.0 * std::pow(100.0, 1.0 / 7.0), 1e-9);
  EXPECT_NEAR(windAloft(surface, 1000.0, 0.0, 6).fromDeg, 270.0, 1e-6);
  EXPECT_NEAR(windAloft(surface, 10.0, 50.0, 6).speedMps, 5.0, 1e-12);
  // A westerly jet over an easterly at the ground, stronger in winter.
  const Wind winter = windAloft({90.0, 4.0}, 11000.0, 45.0, 1),
             summer = windAloft({90.0, 4.0}, 11000.0, 45.0, 7);
  EXPECT_GT(winter.speedMps, summer.speedMps);
  EXPECT_GT(winter.fromDeg, 180.0);
  EXPECT_GT(windAloft({90.0, 4.0}, 11000.0, -45.0, 7).speedMps,
            windAloft({90.0, 4.0}, 11000.0, -45.0, 1).speedMps);
  const Weather w = weatherOf("LSZH 211200Z VRB02KT 9999 FEW030 20/10 Q1015");
  EXPECT_TRUE(anyNote(w, "direction is variable"));
}

TEST(FromMetar, SunHeatsTheGroundByDay) {
  EXPECT_TRUE(groundIsHeated(47, 6, 13));
  EXPECT_TRUE(groundIsHeated(47, 6, 17)) << "convection lags behind the sun";
  EXPECT_FALSE(groundIsHeated(47, 6, 5.5));
  EXPECT_FALSE(groundIsHeated(47, 6, 0));
  EXPECT_FALSE(groundIsHeated(70, 12, 12)) << "polar night";
  EXPECT_TRUE(groundIsHeated(-40, 12, 13)) << "southern summer";
}

TEST(FromMetar, NilSaysSo) {
  const Weather w = weatherOf("NCPL 230000Z AUTO NIL");
  EXPECT_TRUE(w.layers.empty());
  EXPECT_TRUE(anyNote(w, "NIL"));
}

TEST(Layers, EveryGenusIsValidAtEveryLatitude) {
  for (int g = 0; g < static_cast<int>(kEnumNames<Genus>.size()); ++g) {
    for (double latitudeDeg = -90.0; latitudeDeg <= 90.0; latitudeDeg += 5.0) {
      const Layer l = typicalLayer(static_cast<Genus>(g), latitudeDeg);
      EXPECT_NO_THROW(validate(l)) << g << " at " << latitudeDeg;
      EXPECT_EQ(static_cast<int>(l.genus), g);
      EXPECT_GT(l.extinctionPerM * (l.topM - l.baseM), 0.3) << "must be able to cover the sky";
    }
  }
}

TEST(Layers, OpticalDepthsFallIntoTheirIsccpClasses) {
  const auto tau = [](Genus g) {
    const Layer l = typicalLayer(g, 45.0);
    return l.extinctionPerM * (l.topM - l.baseM);
  };
  EXPECT_LT(tau(Genus::kCirrus), 3.6);
  EXPECT_LT(tau(Genus::kCirrostratus), 3.6) << "thinner than its class, so that the halo is seen";
  EXPECT_GT(tau(Genus::kAltostratus), 3.6);
  EXPECT_LT(tau(Genus::kAltostratus), 23.0);
  EXPECT_GT(tau(Genus::kStratocumulus), 3.6);
  EXPECT_LT(tau(Genus::kStratocumulus), 23.0);
  EXPECT_GT(tau(Genus::kNimbostratus), 23.0);
  EXPECT_GT(tau(Genus::kCumulonimbus), 23.0);
}

TEST(Layers, ContradictionsAreRefused) {
  Layer l;
  l.topM = l.baseM;
  EXPECT_THROW(validate(l), ParameterError);
  l.topM = l.baseM - 1.0;
  EXPECT_THROW(validate(l), ParameterError);
  l = {};
  l.oktas = 8.5;
  try {
    validate(l);
    ADD_FAILURE();
  } catch (const ParameterError& e) {
    EXPECT_STREQ(e.what(), "layer of cumulus: oktas is 8.5; expected 0 to 8 okta");
  }
  l = {};
  l.extinctionPerM = std::nan("");
  EXPECT_THROW(validate(l), ParameterError);
}

TEST(Layers, AllExamplesGiveValidWeatherTwiceTheSame) {
  std::ifstream in(std::string(WELKIN_TEST_DATA_DIR) + "/metar/examples.jsonl");
  int reports = 0;
  for (std::string line; std::getline(in, line); ++reports) {
    const std::string start = "{\"metar\": \"";
    const std::string report = line.substr(start.size(), line.find('"', start.size()) - start.size());
    SCOPED_TRACE(report);
    const Weather a = weatherOf(report), b = weatherOf(report);
    EXPECT_EQ(a.notes, b.notes);
    ASSERT_EQ(a.layers.size(), b.layers.size());
    EXPECT_LE(a.layers.size(), kMaxLayers);
    double baseM = 0.0;
    double clear = 1.0;
    for (std::size_t i = 0; i < a.layers.size(); ++i) {
      const Layer& l = a.layers[i];
      EXPECT_NO_THROW(validate(l));
      EXPECT_GE(l.baseM, baseM);
      baseM = l.baseM;
      clear *= 1.0 - l.oktas / 8.0;
      EXPECT_EQ(l.topM, b.layers[i].topM);
      EXPECT_EQ(l.windFromDeg, b.layers[i].windFromDeg);
    }
    EXPECT_NEAR(a.requestedOktas, 8.0 * (1.0 - clear), 1e-9)
        << "the layers together are the sky that is asked for";
  }
  EXPECT_EQ(reports, 328);
}

}  // namespace
}  // namespace welkin::weather
