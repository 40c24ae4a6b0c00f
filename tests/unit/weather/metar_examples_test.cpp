// SPDX-License-Identifier: Apache-2.0
// Real reports: 328 whose meaning several decoders and the issuing service agree on, and 120 that made
// decoders stumble.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "welkin/core/units.h"
#include "welkin/weather/metar.h"

namespace welkin::weather {
namespace {

using Json = nlohmann::json;

std::vector<Json> readLines(const std::string& name) {
  std::ifstream in(std::string(WELKIN_TEST_DATA_DIR) + "/metar/" + name);
  std::vector<Json> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(Json::parse(line));
  return lines;
}

std::string coverName(MetarCover cover) {
  switch (cover) {
    case MetarCover::kFew:
      return "FEW";
    case MetarCover::kScattered:
      return "SCT";
    case MetarCover::kBroken:
      return "BKN";
    case MetarCover::kOvercast:
      return "OVC";
    case MetarCover::kUnknown:
      break;
  }
  return "///";
}

std::string typeName(MetarCloudType type) {
  return type == MetarCloudType::kCumulonimbus ? "CB" : type == MetarCloudType::kToweringCumulus ? "TCU" : "";
}

std::string clearName(const Metar& m) {
  if (m.cavok) return "CAVOK";
  switch (m.clear) {
    case MetarClear::kSkc:
      return "SKC";
    case MetarClear::kClr:
      return "CLR";
    case MetarClear::kNsc:
      return "NSC";
    case MetarClear::kNcd:
      return "NCD";
    case MetarClear::kNotSaid:
      break;
  }
  return "";
}

template <class T>
void expectSame(const std::optional<T>& got, const Json& want, double tolerance, const char* what) {
  EXPECT_EQ(got.has_value(), !want.is_null()) << what;
  if (got && !want.is_null()) {
    EXPECT_NEAR(static_cast<double>(*got), want.get<double>(), tolerance) << what;
  }
}

TEST(MetarExamples, EveryFieldOfAll328Agrees) {
  const auto lines = readLines("examples.jsonl");
  ASSERT_EQ(lines.size(), 328u);
  for (const Json& want : lines) {
    const auto report = want["metar"].get<std::string>();
    SCOPED_TRACE(report);
    const MetarResult got = parseMetar(report);
    const Metar& m = got.metar;
    EXPECT_TRUE(got.ok());
    for (const auto& e : got.errors) ADD_FAILURE() << e.column << ": " << e.reason;

    // The decode lists a vertical visibility among the clouds.
    std::vector<std::vector<std::string>> gotClouds, wantClouds;
    const auto feet = [](const std::optional<int>& ft) { return ft ? std::to_string(*ft) : "null"; };
    for (const auto& l : m.layers)
      gotClouds.push_back({coverName(l.cover), feet(l.baseFt), typeName(l.type)});
    if (m.skyObscured) gotClouds.push_back({"VV", feet(m.verticalVisibilityFt), ""});
    for (const Json& c : want["clouds"]) wantClouds.push_back({c["cover"], c["base_ft"].dump(), c["type"]});
    EXPECT_EQ(gotClouds, wantClouds);

    // NSC and NCD have no name of their own there: null or CLR.
    const std::string clear = want["clear_code"].is_null() ? "" : want["clear_code"].get<std::string>();
    if (clearName(m) == "NSC" || clearName(m) == "NCD") {
      EXPECT_TRUE(clear.empty() || clear == "CLR") << clear;
    } else {
      EXPECT_EQ(clearName(m), clear);
    }
    expectSame(m.visibilityM, want["vis_m"], 0.1, "visibility");
    EXPECT_EQ(m.visibilityBound == MetarBound::kAtLeast    ? ">"
              : m.visibilityBound == MetarBound::kLessThan ? "<"
                                                           : "",
              want["vis_mod"].get<std::string>());
    expectSame(m.wind.directionDeg, want["wind_dir"], 0.0, "direction");
    const auto knots = [](std::optional<double> mps) {
      return mps ? std::optional(*mps / kMpsPerKnot) : mps;
    };
    expectSame(knots(m.wind.speedMps), want["wind_kt"], 1e-3, "speed");
    expectSame(knots(m.wind.gustMps), want["gust_kt"], 1e-3, "gust");
    EXPECT_EQ(m.weather, want["wx"].get<std::vector<std::string>>());
    EXPECT_EQ(m.cavok, want["cavok"].get<bool>());
    expectSame(m.temperatureC, want["temp_c"], 1e-9, "temperature");
    expectSame(m.dewPointC, want["dew_c"], 1e-9, "dew point");
  }
}

// The outcome wanted for each was decided by reading it; `because` says why where it is not plain.
TEST(MetarExamples, MalformedReportsGiveErrorsInTheRightColumnsAndKeepTheRest) {
  const auto lines = readLines("malformed_expected.jsonl");
  ASSERT_EQ(lines.size(), 120u);
  for (const Json& want : lines) {
    const auto report = want["metar"].get<std::string>();
    SCOPED_TRACE(report + "  " + want.value("because", ""));
    const MetarResult got = parseMetar(report);
    const Metar& m = got.metar;

    std::vector<std::size_t> columns;
    for (const auto& e : got.errors) columns.push_back(e.column);
    EXPECT_EQ(columns, want["error_columns"].get<std::vector<std::size_t>>());

    expectSame(m.wind.directionDeg, want["wind"][0], 0.0, "direction");
    expectSame(m.wind.speedMps, want["wind"][1], 1e-3, "speed");
    expectSame(m.wind.gustMps, want["wind"][2], 1e-3, "gust");
    expectSame(m.visibilityM, want["vis_m"], 0.1, "visibility");
    EXPECT_EQ(m.weather, want["wx"].get<std::vector<std::string>>());
    Json layers = Json::array();
    for (const auto& l : m.layers) {
      layers.push_back({coverName(l.cover), l.baseFt ? Json(*l.baseFt) : Json(nullptr),
                        typeName(l.type).empty() ? Json(nullptr) : Json(typeName(l.type))});
    }
    EXPECT_EQ(layers, want["layers"]);
    EXPECT_EQ(m.skyObscured, want.contains("vv_ft"));
    if (want.contains("vv_ft")) expectSame(m.verticalVisibilityFt, want["vv_ft"], 0.0, "vertical visibility");
    EXPECT_EQ(clearName(m), want["clear"].is_null() ? "" : want["clear"].get<std::string>());
    expectSame(m.temperatureC, want["temp"][0], 1e-9, "temperature");
    expectSame(m.dewPointC, want["temp"][1], 1e-9, "dew point");
    expectSame(m.pressureHpa, want["hpa"], 0.06, "pressure");
  }
}

}  // namespace
}  // namespace welkin::weather
