// SPDX-License-Identifier: Apache-2.0
// Text, documentation and JSON of described parameters.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "welkin/core/error.h"
#include "welkin/scene/param_docs.h"
#include "welkin/scene/param_json.h"
#include "welkin/scene/param_text.h"
#include "welkin/scene/scene.h"

namespace welkin::scene {
namespace {

std::string problemOf(std::string_view path, std::string_view text) {
  Scene s;
  try {
    setParam(s, path, text);
  } catch (const ParameterError& e) {
    return e.what();
  }
  return {};
}

TEST(SetParam, SetsEachType) {
  Scene s;
  setParam(s, "seed", "7");
  setParam(s, "place.latitude_deg", "-33.9");
  setParam(s, "ground.albedo", "0.1,0.2,0.3");
  setParam(s, "time", "2026-01-02T03:04:05Z");
  setParam(s, "camera.projection", "fisheye");
  setParam(s, "output.exposure_ev", "14.5");
  setParam(s, "output.sun_disc", "false");
  setParam(s, "metar", "METAR LSZH 211720Z CAVOK");
  EXPECT_EQ(s.seed, 7);
  EXPECT_EQ(s.place.latitudeDeg, -33.9);
  EXPECT_EQ(s.ground.albedo, glm::dvec3(0.1, 0.2, 0.3));
  EXPECT_EQ(s.time, (UtcTime{2026, 1, 2, 3, 4, 5}));
  EXPECT_EQ(s.camera.projection, Projection::kFisheye);
  EXPECT_EQ(s.output.exposureEv, 14.5);
  EXPECT_FALSE(s.output.sunDisc);
  EXPECT_EQ(s.metar, "METAR LSZH 211720Z CAVOK");
  setParam(s, "output.exposure_ev", "auto");
  setParam(s, "metar", "auto");
  EXPECT_EQ(s.metar, "auto");  // a text is the text
  EXPECT_FALSE(s.output.exposureEv.has_value());
}

TEST(SetParam, SaysWhatIsWrong) {
  EXPECT_EQ(problemOf("place.latitude_deg", "95"), "latitude_deg is 95; expected -90 to 90 deg");
  EXPECT_EQ(problemOf("place.latitude_deg", "north"), "latitude_deg: expected a number, found \"north\"");
  EXPECT_EQ(problemOf("place.latitude_deg", ""), "latitude_deg: expected a number, found \"\"");
  EXPECT_EQ(problemOf("place.latitude_deg", "nan"), "latitude_deg is nan; expected -90 to 90 deg");
  EXPECT_EQ(problemOf("place.latitude_deg", "12x"), "latitude_deg: expected a number, found \"12x\"");
  EXPECT_EQ(problemOf("seed", "1.5"), "seed: expected a whole number, found \"1.5\"");
  EXPECT_EQ(problemOf("seed", "99999999999999999999"),
            "seed: expected 0 to 9007199254740991, found \"99999999999999999999\"");
  EXPECT_EQ(
      problemOf("camera.projection", "fisheey"),
      "projection is \"fisheey\"; expected perspective, fisheye, equirect or cubemap; did you mean fisheye?");
  EXPECT_EQ(problemOf("ground.albedo", "0.1,0.2"),
            "albedo: expected three numbers \"x,y,z\", found \"0.1,0.2\"");
  EXPECT_NE(problemOf("time", "2026-02-30T00:00:00Z"), "");
  EXPECT_EQ(problemOf("place.altitude", "1"), "there is no parameter \"place.altitude\"");
  EXPECT_EQ(problemOf("latitude_deg", "1"), "there is no parameter \"latitude_deg\"");
}

TEST(SetParam, LeavesTheValueWhenItFails) {
  Scene s;
  EXPECT_THROW(setParam(s, "ground.albedo", "0.5,0.5,2"), ParameterError);
  EXPECT_EQ(s.ground.albedo, Ground{}.albedo);
}

TEST(Docs, EveryParameterIsDescribedOnce) {
  std::set<std::string> paths;
  for (const ParamDoc& r : documentParams<Scene>()) {
    EXPECT_TRUE(paths.insert(r.path).second) << r.path << " twice";
    EXPECT_FALSE(r.meaning.empty()) << r.path;
    EXPECT_EQ(r.meaning.find('\n'), std::string::npos) << r.path;
    EXPECT_NE(r.meaning.back(), '.') << r.path;
  }
  for (const char* path : {"time", "at_s", "seed", "metar", "visibility_m", "place.latitude_deg",
                           "layer.genus", "layer.oktas", "ground.albedo", "camera.eye_m", "output.speed"})
    EXPECT_TRUE(paths.count(path)) << path;
}

TEST(Docs, EveryDefaultIsInsideItsRange) {
  for (const ParamDoc& r : documentParams<Scene>()) {
    if (r.range.empty() || r.defaultValue == "absent" || r.type != "number") continue;
    double low = 0, high = 0;
    if (std::sscanf(r.range.c_str(), "%lf to %lf", &low, &high) != 2) continue;
    EXPECT_GE(std::stod(r.defaultValue), low) << r.path;
    EXPECT_LE(std::stod(r.defaultValue), high) << r.path;
  }
}

TEST(Docs, TablesHaveARowForEachParameter) {
  const auto rows = documentParams<Scene>();
  const std::string markdown = markdownTable(rows), plain = "\n" + plainTable(rows, 80);
  for (const ParamDoc& r : rows) {
    EXPECT_NE(markdown.find("| `" + r.key + "` |"), std::string::npos) << r.path;
    EXPECT_NE(plain.find("\n  " + r.key + " "), std::string::npos) << r.path;
  }
  std::istringstream lines(plain);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("[")) {
      EXPECT_LE(line.size(), 130u) << line;
    }
  }
}

TEST(Json, HoldsTheWholeScene) {
  Scene s;
  s.metar = "a \"quoted\" text";
  s.layers.resize(2);
  s.sheets.resize(1);
  s.metaballs.resize(1);
  s.slab.columns.resize(1);
  s.layers[1].oktas = 2.25;
  const auto j = nlohmann::json::parse(toJson(s));
  EXPECT_EQ(j.at("metar"), "a \"quoted\" text");
  EXPECT_TRUE(j.at("visibility_m").is_null());
  EXPECT_EQ(j.at("place").at("latitude_deg"), s.place.latitudeDeg);
  EXPECT_EQ(j.at("time"), formatUtcTime(s.time));
  EXPECT_EQ(j.at("camera").at("projection"), "perspective");
  EXPECT_EQ(j.at("ground").at("albedo").size(), 3u);
  EXPECT_EQ(j.at("layer").size(), 2u);
  EXPECT_EQ(j.at("layer").at(1).at("oktas"), 2.25);
  EXPECT_EQ(j.at("layer").at(0).at("genus"), "cumulus");
  for (const ParamDoc& r : documentParams<Scene>()) {
    const std::size_t dot = r.path.find('.');
    if (dot == std::string::npos)
      EXPECT_TRUE(j.contains(r.path)) << r.path;
    else if (r.group.starts_with("[["))
      EXPECT_TRUE(j.at(r.path.substr(0, dot)).at(0).contains(r.key)) << r.path;
    else
      EXPECT_TRUE(j.at(r.path.substr(0, dot)).contains(r.key)) << r.path;
  }
}

TEST(Validate, RefusesPicturesOfOtherCenturies) {
  Scene s;
  s.time = parseUtcTime("2100-12-31T23:59:00Z");
  s.atS = 59.0;
  EXPECT_NO_THROW(validate(s));
  s.atS = 60.0;
  EXPECT_THROW(validate(s), ParameterError);
  s.atS = 0.0;
  s.output.frames = 61;
  s.output.fps = s.output.speed = 1.0;
  EXPECT_THROW(validate(s), ParameterError);
  s.output.frames = 60;
  EXPECT_NO_THROW(validate(s));
  s.time = parseUtcTime("1900-01-01T00:00:00Z");
  s.output.speed = -1.0;
  EXPECT_THROW(validate(s), ParameterError);
}

TEST(Validate, RefusesWhatNoSingleRangeCan) {
  Scene s;
  EXPECT_NO_THROW(validate(s));
  s.output.width = s.output.height = 16384;
  EXPECT_THROW(validate(s), ParameterError);
  s.output.height = 8192;
  EXPECT_NO_THROW(validate(s));
  for (const Projection p : {Projection::kFisheye, Projection::kEquirect}) {
    s.camera.projection = p;
    EXPECT_NO_THROW(validate(s));
  }
  s.camera.projection = Projection::kCubemap;
  EXPECT_THROW(validate(s), ParameterError);
  s.camera.projection = Projection::kEquirect;
  s.output.width = s.output.height;
  EXPECT_THROW(validate(s), ParameterError);
  for (const Projection p :
       {Projection::kPerspective, Projection::kFisheye, Projection::kEquirect, Projection::kCubemap}) {
    s.camera.projection = p;
    s.output.width = naturalSize(p).width;
    s.output.height = naturalSize(p).height;
    EXPECT_NO_THROW(validate(s));
  }
  s.layers.resize(1);
  s.layers[0].topM = s.layers[0].baseM;
  EXPECT_THROW(validate(s), ParameterError);
  s.layers.assign(weather::kMaxLayers, weather::Layer{});
  EXPECT_NO_THROW(validate(s));
  s.layers.emplace_back();
  EXPECT_THROW(validate(s), ParameterError);
}

}  // namespace
}  // namespace welkin::scene
