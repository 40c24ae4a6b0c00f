// SPDX-License-Identifier: Apache-2.0
// Whole reports: what may stand where, and what happens to reports that are wrong.
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "welkin/weather/metar.h"

namespace welkin::weather {
namespace {

std::vector<std::size_t> errorColumns(std::string_view report) {
  std::vector<std::size_t> columns;
  for (const auto& e : parseMetar(report).errors) columns.push_back(e.column);
  return columns;
}

using Columns = std::vector<std::size_t>;

TEST(MetarReport, HeadingInAllItsForms) {
  for (const char* report :
       {"METAR KMRY 211753Z 24015KT 10SM CLR 12/M01 A2992",
        "SPECI KMRY 211753Z 24015KT 10SM CLR 12/M01 A2992",
        "METAR COR KMRY 211753Z 24015KT 10SM CLR 12/M01 A2992",
        "KMRY 211753Z COR 24015KT 10SM CLR 12/M01 A2992", "KMRY 211753Z AUTO 24015KT 10SM CLR 12/M01 A2992",
        "KMRY 211753Z CCA 24015KT 10SM CLR 12/M01 A2992",
        "KMRY 211753Z RTD 24015KT 10SM CLR 12/M01 A2992=", "kmry 211753z 24015kt 10sm clr 12/m01 a2992",
        "  KMRY 211753Z\r\n  24015KT 10SM\tCLR 12/M01 A2992 =\r\n"}) {
    SCOPED_TRACE(report);
    const MetarResult r = parseMetar(report);
    EXPECT_TRUE(r.ok());
    for (const auto& e : r.errors) ADD_FAILURE() << e.column << ": " << e.reason;
    EXPECT_EQ(r.metar.station, "KMRY");
    EXPECT_EQ(r.metar.day, 21);
    EXPECT_EQ(r.metar.hour, 17);
    EXPECT_EQ(r.metar.minute, 53);
    EXPECT_EQ(r.metar.wind.directionDeg, 240);
    EXPECT_EQ(r.metar.dewPointC, -1.0);
  }
  EXPECT_TRUE(parseMetar("SPECI KMRY 211753Z 24015KT").metar.special);
  EXPECT_TRUE(parseMetar("METAR COR KMRY 211753Z 24015KT").metar.corrected);
  EXPECT_TRUE(parseMetar("KMRY 211753Z CCA 24015KT").metar.corrected);
  EXPECT_TRUE(parseMetar("KMRY 211753Z RTD 24015KT").metar.delayed);
  EXPECT_TRUE(parseMetar("KMRY 211753Z NIL=").metar.nil);
  EXPECT_TRUE(parseMetar("KMRY 211753Z NIL=").ok());
  EXPECT_EQ(errorColumns("KMRY 211753Z NIL 24015KT"), (Columns{18}));
}

TEST(MetarReport, HeadingMistakes) {
  EXPECT_EQ(errorColumns(""), (Columns{1}));
  EXPECT_EQ(errorColumns("   "), (Columns{4}));
  EXPECT_EQ(errorColumns("METAR"), (Columns{6}));
  EXPECT_EQ(errorColumns("TAF KMRY 211753Z 2118/2218 24015KT"), (Columns{1}));
  EXPECT_EQ(parseMetar("TAF KABC 311120Z 3112/0112 24015KT").errors.front().reason,
            "'TAF' begins a forecast; only reports, METAR and SPECI, are read");
  EXPECT_EQ(errorColumns("METAR 211753Z 24015KT 10SM"), (Columns{7}));
  EXPECT_EQ(errorColumns("KMRY 24015KT 10SM CLR"), (Columns{6}));
  EXPECT_EQ(errorColumns("KMRY 211760Z 24015KT 10SM CLR"), (Columns{6}));
  EXPECT_EQ(errorColumns("KMRY 211753 24015KT 10SM CLR"), (Columns{6}));
  EXPECT_EQ(errorColumns("KMRY211753Z 24015KT"), (Columns{1}));
  // What stands behind the mistake is read.
  EXPECT_EQ(parseMetar("KMRY 24015KT 10SM CLR").metar.wind.directionDeg, 240);
  EXPECT_EQ(parseMetar("METAR 211753Z 24015KT 10SM").metar.day, 21);
  EXPECT_FALSE(parseMetar("KMRY 211760Z 24015KT").metar.minute);
}

TEST(MetarReport, WeatherThatCannotBe) {
  const auto together = parseMetar("KMRY 211753Z 24015KT 9999 MIRA BKN020 12/10 Q1010");
  ASSERT_EQ(together.errors.size(), 1u);
  EXPECT_EQ(together.errors[0].reason, "'MIRA' is weather that code table 4678 does not have");
  EXPECT_EQ(errorColumns("KMRY 211753Z 24015KT 9999 RA RA BKN020 12/10 Q1010"), (Columns{30}));
  EXPECT_EQ(errorColumns("KMRY 211753Z 24015KT 9999 RA -RA BKN020 12/10 Q1010"), (Columns{30}));
  EXPECT_EQ(errorColumns("KMRY 211753Z 24015KT 9999 SN BLSN VCFG BKN020 12/10 Q1010"), (Columns{}));
}

TEST(MetarReport, TornGroupsAreNotReadInHalves) {
  const auto miles = parseMetar("KLFI 230042Z 05010KT 1 6SM BR CLR 14/13 A3020");
  EXPECT_FALSE(miles.metar.visibilityM);
  EXPECT_EQ(miles.errors.size(), 1u);
  for (const char* half : {"1/2", "M1/4", "P6"}) {
    const auto torn = parseMetar("KJFK 211551Z 22005KT " + std::string(half) + " SM BKN010 12/11 A2990");
    ASSERT_EQ(torn.errors.size(), 1u) << half;
    EXPECT_NE(torn.errors[0].reason.find("' has a blank too many"), std::string::npos) << half;
    EXPECT_FALSE(torn.metar.visibilityM);
  }
  const auto vicinity = parseMetar("MMPS 262042Z 24006KT 10SM VC RA BKN010CB OVC070 29/25 A2992");
  EXPECT_TRUE(vicinity.metar.weather.empty());
  EXPECT_EQ(vicinity.metar.layers.size(), 2u);
  EXPECT_EQ(errorColumns("KMRY 211753Z 24015KT 9999 BKN 020 12/10 Q1010"), (Columns{27}));
  EXPECT_EQ(errorColumns("KMRY 211753Z 24015 KT 9999 12/10 Q10 10"), (Columns{14, 34}));
  const auto fraction = parseMetar("KMRY 211753Z 24015KT 1 1/2SM BR CLR 12/10 A2992");
  EXPECT_TRUE(fraction.ok());
  EXPECT_NEAR(*fraction.metar.visibilityM, 2414.016, 1e-6);
}

TEST(MetarReport, VisibilitiesBesideThePrevailingOne) {
  for (const char* report :
       {"SKPE 231100Z VRB02KT 8000 4000SW BCFG", "LFST 230030Z 00000KT 8000 0700 R23/0900D BCFG",
        "SKPE 231100Z VRB02KT 8000 R10/2000 3000N 4000SW BCFG"}) {
    EXPECT_TRUE(parseMetar(report).ok()) << report;
    EXPECT_EQ(parseMetar(report).metar.visibilityM, 8000.0) << report;
  }
  EXPECT_EQ(errorColumns("SKPE 231100Z VRB02KT 0700 8000 BCFG"), (Columns{27}));
  EXPECT_EQ(errorColumns("SKPE 231100Z VRB02KT 8000 BR 3000"), (Columns{30}));
  EXPECT_EQ(errorColumns("SKPE 231100Z VRB02KT 3000 CAVOK"), (Columns{27}));
  EXPECT_EQ(errorColumns("SKPE 231100Z VRB02KT CAVOK 3000"), (Columns{28}));
  EXPECT_EQ(errorColumns("SKPE 231100Z VRB02KT CAVOK 3000SW"), (Columns{28}));
  EXPECT_EQ(errorColumns("SKPE 231100Z VRB02KT 9999 3000SW CAVOK"), (Columns{34}));
  EXPECT_TRUE(parseMetar("SKPE 231100Z VRB02KT 9999 3000SW").ok());
}

TEST(MetarReport, ContradictionsAreErrors) {
  EXPECT_EQ(errorColumns("KMRY 211753Z 24015KT 18005KT 10SM CLR 12/10 A2992"), (Columns{22}));
  EXPECT_EQ(errorColumns("KMRY 211753Z 24015KT 10SM CLR BKN020 12/10 A2992"), (Columns{31}));
  EXPECT_EQ(errorColumns("KMRY 211753Z 24015KT 10SM BKN020 SKC 12/10 A2992"), (Columns{34}));
  EXPECT_EQ(errorColumns("KMRY 211753Z 24015KT 10SM 12/10 13/10 A2992"), (Columns{33}));
  EXPECT_EQ(errorColumns("KMRY 211753Z 24015KT 10SM 12/10 Q1013 A2902"), (Columns{39}));
  EXPECT_EQ(errorColumns("KMRY 211753Z 24015KT 10SM 12/10 A2992 RMK T02000100"), (Columns{43}));
  EXPECT_TRUE(parseMetar("EGSS 231120Z 12008KT 9999 NCD //////CB 15/14 Q1001").ok())
      << "an instrument may see none and not know of CB";
}

TEST(MetarReport, WindShearNamesRunwaysInManyWays) {
  for (const char* runway :
       {"R06", "RWY14", "RWY 14", "RWY 07L", "ALL RWY", "TKOF RWY20", "LDG RWY 02", "RWYS 14"})
    EXPECT_TRUE(
        parseMetar("EGSS 231120Z 12008KT 9999 FEW020 15/14 Q1001 WS " + std::string(runway) + " NOSIG").ok())
        << runway;
  EXPECT_EQ(errorColumns("EGSS 231120Z 12008KT 9999 FEW020 15/14 Q1001 WS RWY 14 14"), (Columns{56}));
  EXPECT_EQ(errorColumns("EGSS 231120Z 12008KT 9999 FEW020 15/14 Q1001 WS RWY 07X"), (Columns{53}));
}

TEST(MetarReport, CavokTakesNoCloudOrWeatherThatItRulesOut) {
  const auto columns = [](const std::string& sky) {
    return errorColumns("EDDM 211750Z 24010KT " + sky + " 10/05 Q1010");
  };
  EXPECT_EQ(columns("CAVOK BKN010"), (Columns{28}));
  EXPECT_EQ(columns("CAVOK TSRA OVC002CB"), (Columns{28, 33}));
  EXPECT_EQ(columns("CAVOK TSRA NSC"), (Columns{28, 33}));
  EXPECT_EQ(columns("CAVOK FEW060TCU"), (Columns{28}));
  EXPECT_EQ(columns("CAVOK VV003"), (Columns{28}));
  EXPECT_EQ(columns("TSRA CAVOK"), (Columns{27}));
  EXPECT_EQ(columns("BKN010 CAVOK"), (Columns{29}));
  EXPECT_EQ(columns("NSC CAVOK"), (Columns{26}));
  EXPECT_FALSE(parseMetar("EDDM 211750Z 24010KT BKN010 CAVOK 10/05 Q1010").metar.cavok);
  EXPECT_TRUE(parseMetar("EDDM 211750Z 24010KT CAVOK BKN010 10/05 Q1010").metar.layers.empty());
  // What it allows.
  for (const char* sky : {"CAVOK", "CAVOK //////", "CAVOK //", "CAVOK SCT050", "CAVOK FEW200", "CAVOK SKC",
                          "9999 CAVOK", "CAVOK R25/910050"})
    EXPECT_EQ(columns(sky), Columns{}) << sky;
}

TEST(MetarReport, NoCloudIsSeenAboveAVerticalVisibility) {
  const auto columns = [](const std::string& sky) {
    return errorColumns("EDDM 211750Z 24010KT 0300 FG " + sky + " 10/10 Q1010");
  };
  EXPECT_EQ(columns("BKN010 VV001"), (Columns{37}));
  EXPECT_EQ(columns("VV001 BKN010"), (Columns{36}));
  EXPECT_EQ(columns("SKC VV001"), (Columns{34}));
  for (const char* sky : {"VV001", "VV///", "FEW001 VV003", "BKN001 VV///", "///010 VV001"})
    EXPECT_EQ(columns(sky), Columns{}) << sky;
}

TEST(MetarReport, DewPointsAboveTheTemperatureAreErrors) {
  const auto r = parseMetar("EDDM 211750Z 24010KT 9999 10/12 Q1010");
  ASSERT_EQ(r.errors.size(), 1u);
  EXPECT_EQ(r.errors[0].column, 27u);
  EXPECT_FALSE(r.metar.temperatureC);
  EXPECT_FALSE(r.metar.dewPointC);
  EXPECT_TRUE(parseMetar("EDDM 211750Z 24010KT 0300 FG M06/M05 Q1010").ok()) << "two instruments, rounded";
  EXPECT_EQ(errorColumns("KMRY 211753Z 24015KT 10SM A2992 RMK T01000120"), (Columns{37}));
}

TEST(MetarReport, CloudAndWeatherBehindThePressureAreNotRead) {
  const auto r = parseMetar("SVBS 262100Z 25006KT 9999 28/24 Q1011 TS FEW020");
  EXPECT_TRUE(r.metar.weather.empty());
  EXPECT_TRUE(r.metar.layers.empty());
  EXPECT_EQ(r.errors.size(), 2u);
}

TEST(MetarReport, TrendAndRemarksAreLeftAlone) {
  const auto r = parseMetar(
      "EGSS 231120Z 12008KT 9999 FEW020 15/14 Q1001 RERA WS ALL RWY R24/590055 W15/S3 BLU TEMPO 0400 FG "
      "VV/// FOO RMK T01540141 BAR BKN001");
  EXPECT_TRUE(r.ok());
  EXPECT_EQ(r.metar.layers.size(), 1u);
  EXPECT_EQ(r.metar.visibilityM, 10000.0);
  EXPECT_TRUE(r.metar.weather.empty());
  EXPECT_FALSE(r.metar.skyObscured);
}

TEST(MetarReport, ExactTemperaturesComeFromTheRemarks) {
  const auto m = parseMetar("KMRY 211753Z 24015KT 10SM CLR 16/M01 A2992 RMK AO2 SLP132 T01561011 TSNO").metar;
  EXPECT_DOUBLE_EQ(*m.temperatureC, 15.6);
  EXPECT_DOUBLE_EQ(*m.dewPointC, -1.1);
}

TEST(MetarReport, TextBehindTheEndSignIsAnError) {
  EXPECT_EQ(errorColumns("KMRY 211753Z 24015KT 10SM CLR 12/10 A2992= KSFO"), (Columns{44}));
  EXPECT_TRUE(parseMetar("KMRY 211753Z 24015KT 10SM CLR 12/10 A2992==  \n").ok());
}

TEST(MetarReport, MessagesShowNoStrangeBytes) {
  // A literal with a zero inside: its length is its array's, less the one at the end.
  constexpr char kReport[] = "KMRY 211753Z \x01\xff\x00\x1b[31mXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXXX";
  const auto r = parseMetar(std::string_view(kReport, sizeof(kReport) - 1));
  ASSERT_EQ(r.errors.size(), 1u);
  EXPECT_EQ(r.errors[0].column, 14u);
  for (const char c : r.errors[0].reason) EXPECT_TRUE(c >= ' ' && c <= '~');
  EXPECT_LT(r.errors[0].reason.size(), 120u);
}

TEST(MetarReport, ErrorsAreLimited) {
  std::string report = "KMRY 211753Z";
  for (int i = 0; i < 1000; ++i) report += " ?";
  EXPECT_EQ(parseMetar(report).errors.size(), kMaxMetarErrors);
}

// Whatever comes in: no crash, columns inside the text and rising, values inside their ranges.
TEST(MetarReport, RandomBytesAndRandomGroups) {
  std::mt19937 random(20260621);
  const std::vector<std::string> parts = {
      "METAR",     "KMRY",   "211753Z", "AUTO",  "24015G25KT", "VRB", "KT",       "1",   "1/2SM",
      "9999",      "0400",   "R24/",    "VC",    "-RA",        "TS",  "FEW",      "020", "CB",
      "///",       "//////", "VV001",   "12/10", "M",          "Q10", "A2992",    "=",   "RMK",
      "T01561011", "TEMPO",  "NIL",     "CAVOK", "WS",         "R06", "\xc3\xa4", "5"};
  for (int i = 0; i < 100000; ++i) {
    std::string report;
    if (i % 2 == 0) {
      for (int n = static_cast<int>(random() % 60); n > 0; --n) report += static_cast<char>(random() % 256);
    } else {
      for (int n = static_cast<int>(random() % 14); n > 0; --n) {
        report += parts[random() % parts.size()];
        if (random() % 4 != 0) report += ' ';
      }
    }
    const MetarResult r = parseMetar(report);
    std::size_t last = 1;
    for (const auto& e : r.errors) {
      ASSERT_GE(e.column, last) << report;
      ASSERT_LE(e.column, report.size() + 1) << report;
      ASSERT_FALSE(e.reason.empty());
      last = e.column;
    }
    const double hpa = r.metar.pressureHpa.value_or(1000.0);
    ASSERT_TRUE(hpa >= 850.0 && hpa <= 1100.0) << report;
    const int directionDeg = r.metar.wind.directionDeg.value_or(0);
    ASSERT_TRUE(directionDeg >= 0 && directionDeg <= 360) << report;
    ASSERT_GE(r.metar.visibilityM.value_or(0.0), 0.0) << report;
  }
}

}  // namespace
}  // namespace welkin::weather
