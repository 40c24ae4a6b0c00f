// SPDX-License-Identifier: Apache-2.0
// Each kind of group alone: what is one, what is none, and what it is worth.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "welkin/core/units.h"
#include "welkin/weather/metar_groups.h"

namespace welkin::weather::metar {
namespace {

template <class Test>
void expectAll(bool wanted, Test test, std::initializer_list<std::string_view> texts) {
  for (const auto text : texts) EXPECT_EQ(static_cast<bool>(test(text)), wanted) << text;
}

TEST(MetarGroups, Time) {
  const auto t = readTime("211753Z");
  ASSERT_TRUE(t);
  EXPECT_EQ(t->day, 21);
  EXPECT_EQ(t->hour, 17);
  EXPECT_EQ(t->minute, 53);
  expectAll(false, readTime,
            {"001753Z", "321753Z", "212453Z", "211760Z", "211753", "21175Z", "2117533Z", "2117A3Z", ""});
}

TEST(MetarGroups, Wind) {
  struct Case {
    const char* text;
    int direction;       // -1: absent
    double speed, gust;  // in the unit of the text; -1: absent
    double mpsPerUnit;
  };
  const Case cases[] = {
      {"24015G25KT", 240, 15, 25, kMpsPerKnot}, {"000//KT", 0, -1, -1, kMpsPerKnot},
      {"00000KT", 0, 0, -1, kMpsPerKnot},       {"VRB02KT", -1, 2, -1, kMpsPerKnot},
      {"25016G21MPS", 250, 16, 21, 1.0},        {"36010KMH", 360, 10, -1, kMpsPerKmh},
      {"///05KT", -1, 5, -1, kMpsPerKnot},      {"/////KT", -1, -1, -1, kMpsPerKnot},
      {"240//KT", 240, -1, -1, kMpsPerKnot},    {"270120G140KT", 270, 120, 140, kMpsPerKnot},
      {"240P49MPS", 240, 49, -1, 1.0},          {"240P99GP99KT", 240, 99, 99, kMpsPerKnot},
      {"VRB03G15KT", -1, 3, 15, kMpsPerKnot},   {"235//G15KT", 235, -1, 15, kMpsPerKnot},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    const auto w = readWind(c.text);
    ASSERT_TRUE(w);
    EXPECT_EQ(w->directionDeg.value_or(-1), c.direction);
    EXPECT_NEAR(w->speedMps.value_or(-1.0), c.speed < 0 ? -1.0 : c.speed * c.mpsPerUnit, 1e-9);
    EXPECT_NEAR(w->gustMps.value_or(-1.0), c.gust < 0 ? -1.0 : c.gust * c.mpsPerUnit, 1e-9);
  }
  EXPECT_TRUE(readWind("VRB02KT")->variable);
  EXPECT_TRUE(readWind("240P49MPS")->speedAtLeast);
  expectAll(false, readWind,
            {"36020", "24015", "2415KT", "240155KTS", "37015KT", "24015G10KT", "24015GKT", "240999KT",
             "VRBKT", "24O15KT", "24015G25", "KT", "24015KTB", "00000KTBCAVOK", "00005KT", "00010G20KT",
             "RS01011KT", "240P2KT", "24015G2KT"});
}

TEST(MetarGroups, Variation) {
  const auto v = readVariation("240V300");
  ASSERT_TRUE(v);
  EXPECT_EQ(v->fromDeg, 240);
  EXPECT_EQ(v->toDeg, 300);
  expectAll(true, readVariation, {"350V020", "///V///", "214V274"});
  expectAll(false, readVariation, {"240V30", "240V361", "24OV300", "240300", "240V3000"});
}

TEST(MetarGroups, VisibilityInMetres) {
  struct Case {
    const char* text;
    double metres;
    MetarBound bound;
    bool directional;
  };
  const Case cases[] = {
      {"4000", 4000, MetarBound::kExact, false},       {"9999", 10000, MetarBound::kAtLeast, false},
      {"9999NDV", 10000, MetarBound::kAtLeast, false}, {"0000", 0, MetarBound::kExact, false},
      {"4600NDV", 4600, MetarBound::kExact, false},    {"1500SW", 1500, MetarBound::kExact, true},
      {"0800N", 800, MetarBound::kExact, true},        {"M0400", 400, MetarBound::kLessThan, false},
      {"2200M", 2200, MetarBound::kExact, false},      {"10KM", 10000, MetarBound::kExact, false},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    const auto v = readVisibilityMetres(c.text);
    ASSERT_TRUE(v);
    EXPECT_EQ(v->metres, c.metres);
    EXPECT_EQ(v->bound, c.bound);
    EXPECT_EQ(v->directional, c.directional);
  }
  for (const char* missing : {"////", "////NDV"}) {
    ASSERT_TRUE(readVisibilityMetres(missing)) << missing;
    EXPECT_FALSE(readVisibilityMetres(missing)->metres) << missing;
  }
  expectAll(false, readVisibilityMetres,
            {"80000", "400", "4000BL", "0400/", "4OOO", "1500SSW", "KM", "M400", "///", "/////"});
}

TEST(MetarGroups, VisibilityInMiles) {
  const auto miles = [](const char* text, std::optional<int> whole = {}) {
    const auto v = readVisibilityMiles(text, whole);
    return v && v->metres ? *v->metres / kMetresPerStatuteMile : -1.0;
  };
  EXPECT_NEAR(miles("10SM"), 10.0, 1e-12);
  EXPECT_NEAR(miles("P6SM"), 6.0, 1e-12);
  EXPECT_NEAR(miles("1/2SM"), 0.5, 1e-12);
  EXPECT_NEAR(miles("M1/4SM"), 0.25, 1e-12);
  EXPECT_NEAR(miles("3/16SM"), 3.0 / 16.0, 1e-12);
  EXPECT_NEAR(miles("3/4SM", 1), 1.75, 1e-12);
  EXPECT_NEAR(miles("0SM"), 0.0, 1e-12);
  EXPECT_EQ(readVisibilityMiles("P6SM")->bound, MetarBound::kAtLeast);
  EXPECT_EQ(readVisibilityMiles("M1/4SM")->bound, MetarBound::kLessThan);
  ASSERT_TRUE(readVisibilityMiles("////SM"));
  EXPECT_FALSE(readVisibilityMiles("////SM")->metres);
  for (const char* bad : {"11/2SM", "SM", "1/0SM", "1/3SM", "4/4SM", "0/2SM", "1.5SM", "10S", "M", "1/SM",
                          "/2SM", "1000SM", "10SMX"}) {
    EXPECT_FALSE(readVisibilityMiles(bad)) << bad;
  }
  EXPECT_FALSE(readVisibilityMiles("6SM", 1));
  EXPECT_FALSE(readVisibilityMiles("M1/4SM", 1));
}

TEST(MetarGroups, Runways) {
  expectAll(true, isRunwayGroup,
            {"R06/1200FT", "R24/P2000", "R09L/M0050VP1500U", "R24//////", "R36/////", "R27R/P2000N",
             "R35R/5500VP6000FT", "R14/0600FT/D", "R21/M0050VP2000FT/U", "R06/290050", "R26/59//50",
             "R05/0///70", "R31L/CLRD80", "R88/CLRD//", "R/SNOCLO", "R13/SNOCLO", "R18C/2000D", "R25/2000"});
  expectAll(false, isRunwayGroup,
            {"R09/70D", "R6/1200", "R24/", "R24", "R24/12000", "R24/0900X", "RA", "R24/0900V", "RS01011KT"});
  expectAll(true, isOldRunwayState, {"16090065", "1519//65", "02CLRD60", "070///65", "15//99//"});
  expectAll(false, isOldRunwayState, {"1609006", "160900655", "160900A5", "/9090065", "02CLRD6"});
}

TEST(MetarGroups, Weather) {
  expectAll(true, isPresentWeather,
            {"RA",  "-RA", "+TSRA", "-SHRASN", "VCSH",  "VCTS", "TS",      "BCFG",     "MIFG", "PRFG", "FZFG",
             "+FC", "FC",  "BLSN",  "DRSN",    "-FZDZ", "TSGR", "+TSRAGR", "SHSNRAGS", "UP",   "-UP",  "FZUP",
             "BR",  "HZ",  "FU",    "DU",      "SA",    "VA",   "PY",      "PO",       "SQ",   "+SS",  "DS",
             "IC",  "-IC", "PL",    "SG",      "//",    "VCFG", "VCBLSN",  "-SHGS",    "BLDU"});
  expectAll(false, isPresentWeather,
            {"", "-", "VC", "MI", "FZ", "RARARARA", "XX", "RAX", "--RA", "RA-", "RABR", "BRRA", "NSW",
             "NOSIG", "R", "///", "+VCRA"});
  // By code table 4678: what each descriptor goes with, what has an intensity, and nothing twice.
  expectAll(false, isPresentWeather,
            {"-FG", "MIRA", "SHFG", "TSBR", "RARA", "FZTSRA", "BCBR", "DRRA", "BLHZ", "FZSN", "FZBR", "+HZ",
             "-FC", "SNRASN"});
  expectAll(true, isPresentWeather, {"BLPY", "DRSA", "FZRASN", "-TS", "+DS", "+BLSN", "TSPL", "PLRA"});
  expectAll(true, isRecentWeather, {"RERA", "RETS", "RESHRA", "REFZRA", "RETSRAGR", "RE//", "REUP"});
  expectAll(false, isRecentWeather, {"RE", "RED", "REX", "RE/", "RE-RA"});
}

TEST(MetarGroups, ThingsRecognisedAndLeftAlone) {
  expectAll(
      true, isColourState,
      {"BLU", "BLU+", "WHT", "GRN", "YLO", "YLO1", "YLO2", "AMB", "RED", "BLACK", "BLACKWHT", "BLUBLU"});
  expectAll(false, isColourState, {"BLACKX", "BL", "PINK", "BLU1", "REDD"});
  expectAll(true, isSeaState,
            {"W15/S2", "W///S4", "W17/H8", "W16/H14", "WM01/S3", "W09/H///", "W/////", "W19/S/"});
  expectAll(false, isSeaState, {"W", "WS", "W15", "W15/", "W15/X2", "W15/S", "W15/S22", "W15/H"});
  expectAll(true, isNationalSupplement,
            {"RF00.0/000.0", "RF//.//007.4", "DL-NE", "RH76", "QFE760", "QFE733/0977", "QFE764/4", "QBB090"});
  expectAll(false, isNationalSupplement,
            {"RF00/0/000/0", "DL-", "DL-X", "RH", "QFE", "QFE7", "QBB", "QFE764/"});
  expectAll(true, isTrendStart, {"TEMPO", "BECMG", "INTER", "PROB30", "FM1200", "FM231200"});
  expectAll(false, isTrendStart, {"NOSIG", "PROB", "FM", "FM12", "TEMPOX"});
}

TEST(MetarGroups, Clouds) {
  struct Case {
    const char* text;
    MetarCover cover;
    int feet;  // -1: absent
    MetarCloudType type;
  };
  const Case cases[] = {
      {"FEW000", MetarCover::kFew, 0, MetarCloudType::kNone},
      {"SCT020TCU", MetarCover::kScattered, 2000, MetarCloudType::kToweringCumulus},
      {"BKN014", MetarCover::kBroken, 1400, MetarCloudType::kNone},
      {"BKN014///", MetarCover::kBroken, 1400, MetarCloudType::kNone},
      {"OVC///", MetarCover::kOvercast, -1, MetarCloudType::kNone},
      {"OVC038CB", MetarCover::kOvercast, 3800, MetarCloudType::kCumulonimbus},
      {"FEW///CB", MetarCover::kFew, -1, MetarCloudType::kCumulonimbus},
      {"//////", MetarCover::kUnknown, -1, MetarCloudType::kNone},
      {"/////////", MetarCover::kUnknown, -1, MetarCloudType::kNone},
      {"//////CB", MetarCover::kUnknown, -1, MetarCloudType::kCumulonimbus},
      {"///TCU", MetarCover::kUnknown, -1, MetarCloudType::kToweringCumulus},
      {"///015", MetarCover::kUnknown, 1500, MetarCloudType::kNone},
      {"///014///", MetarCover::kUnknown, 1400, MetarCloudType::kNone},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    const auto l = readLayer(c.text);
    ASSERT_TRUE(l);
    EXPECT_EQ(l->cover, c.cover);
    EXPECT_EQ(l->baseFt.value_or(-1), c.feet);
    EXPECT_EQ(l->type, c.type);
  }
  expectAll(false, readLayer,
            {"FEW", "FEW2000", "SCT10000", "FEW018SCT080", "BKN0140", "BKN01O", "OVC0/0", "FEW020CI", "///",
             "////", "VV002", "CB", "SCT020TC", "OVC999", "FEW020CB/", "NSC"});
  EXPECT_EQ(readVerticalVisibility("VV002")->feet, 200);
  ASSERT_TRUE(readVerticalVisibility("VV///"));
  EXPECT_FALSE(readVerticalVisibility("VV///")->feet);
  expectAll(false, readVerticalVisibility, {"VV", "VV02", "VV0020", "VV//", "V002", "VV601", "VV999"});
  EXPECT_EQ(readClear("SKC"), MetarClear::kSkc);
  EXPECT_EQ(readClear("CLR"), MetarClear::kClr);
  EXPECT_EQ(readClear("NSC"), MetarClear::kNsc);
  EXPECT_EQ(readClear("NCD"), MetarClear::kNcd);
  expectAll(false, readClear, {"NSW", "CL", "NSC17/05", "CAVOK"});
}

TEST(MetarGroups, Temperatures) {
  struct Case {
    const char* text;
    double temperature, dewPoint;  // 99: absent
  };
  for (const Case& c :
       {Case{"12/M01", 12, -1}, Case{"M00/M01", 0, -1}, Case{"10/", 10, 99}, Case{"10///", 10, 99},
        Case{"///M02", 99, -2}, Case{"XX/XX", 99, 99}, Case{"/////", 99, 99}, Case{"M21/M26", -21, -26}}) {
    SCOPED_TRACE(c.text);
    const auto t = readTemperature(c.text);
    ASSERT_TRUE(t);
    EXPECT_EQ(t->temperatureC.value_or(99), c.temperature);
    EXPECT_EQ(t->dewPointC.value_or(99), c.dewPoint);
  }
  EXPECT_FALSE(std::signbit(*readTemperature("M00/M01")->temperatureC)) << "-0 would be printed as such";
  expectAll(
      false, readTemperature,
      {"5/3", "12/1", "12M01", "61/20", "M96/M99", "///", "//", "/", "0400/", "12/M1", "012/010", "-2/-5"});

  const auto exact = readExactTemperature("T01561011");
  ASSERT_TRUE(exact);
  EXPECT_EQ(*exact->temperatureC, 15.6);
  EXPECT_EQ(*exact->dewPointC, -1.1);
  EXPECT_FALSE(readExactTemperature("T0156")->dewPointC);
  expectAll(false, readExactTemperature, {"T015610111", "T0156101", "T21561011", "T0156X011", "TSNO", "T"});
}

TEST(MetarGroups, Pressure) {
  EXPECT_DOUBLE_EQ(*readPressure("Q1013")->hpa, 1013.0);
  EXPECT_NEAR(*readPressure("A2992")->hpa, 1013.2, 0.05);
  EXPECT_DOUBLE_EQ(*readPressure("Q1013/2992")->hpa, 1013.0);
  EXPECT_DOUBLE_EQ(*readPressure("Q1003/29.62")->hpa, 1003.0);
  EXPECT_NEAR(*readPressure("QNH2992INS")->hpa, 1013.2, 0.05);
  for (const char* missing : {"Q////", "A////"}) {
    ASSERT_TRUE(readPressure(missing)) << missing;
    EXPECT_FALSE(readPressure(missing)->hpa) << missing;
  }
  expectAll(false, readPressure,
            {"Q10", "Q.1020", "A30332", "Q10133", "Q0700", "A2497", "A3500", "Q1200", "1013", "A", "Q", "AO2",
             "Q101O", "QNH1013", "Q1013/2892", "Q1013/", "Q1013/29"});
}

}  // namespace
}  // namespace welkin::weather::metar
