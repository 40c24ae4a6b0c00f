// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/metaball_file.h"

#include <gtest/gtest.h>

#include <string>

#include "welkin/core/error.h"
#include "welkin/core/random.h"

namespace welkin::scene {
namespace {

std::vector<field::Metaball> someBalls(int count) {
  Random random(9);
  std::vector<field::Metaball> balls;
  for (int i = 0; i < count; ++i)
    balls.push_back({{random.uniform() / 3.0, -1e5 * random.uniform(), 1e-7},
                     0.1 + random.uniform(),
                     random.uniform() - 0.5});
  return balls;
}

TEST(MetaballFile, ComesBackToTheBit) {
  MetaballFile file;
  file.levels = {{someBalls(3), 0.25, std::nullopt}, {someBalls(50), 0.1, 0.012}};
  const MetaballFile again = parseMetaballs(metaballText(file), "x.json");
  ASSERT_EQ(again.levels.size(), 2U);
  EXPECT_EQ(again.levels[0].balls, file.levels[0].balls);
  EXPECT_EQ(again.balls(), file.balls());
  EXPECT_EQ(again.levels[0].relativeL2, 0.25);
  EXPECT_EQ(again.levels[0].rmse, std::nullopt);
  EXPECT_EQ(again.levels[1].rmse, 0.012);
}

TEST(MetaballFile, OthersMayWriteLessAndMore) {
  const MetaballFile file = parseMetaballs(
      R"({"made by": ["hand"], "balls": [{"density": 1, "radius_m": 2, "center_m": [0, 1, -2], "name": 3}], "welkin": "metaballs"})",
      "x.json");
  ASSERT_EQ(file.balls().size(), 1U);
  EXPECT_EQ(file.balls()[0], (field::Metaball{{0, 1, -2}, 2, 1}));
}

void refuse(const std::string& text, const std::string& message) {
  try {
    parseMetaballs(text, "x.json");
    ADD_FAILURE() << "read: " << text;
  } catch (const ParseError& e) {
    EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
  }
}

TEST(MetaballFile, WhatIsWrongIsNamed) {
  refuse("", "x.json:1:1: is no JSON");
  refuse("{\"welkin\": \"metaballs\",\n  balls}", "x.json:2:3: is no JSON");
  refuse("[]", "holds no metaballs");
  refuse("{}", "holds no metaballs");
  refuse(R"({"welkin": "scene", "balls": []})", "holds no metaballs");
  refuse(R"({"welkin": "metaballs"})", "balls: expected a list of at least one ball");
  refuse(R"({"welkin": "metaballs", "balls": []})", "balls: expected a list of at least one ball");
  const auto withBall = [](const std::string& ball) {
    return R"({"welkin": "metaballs", "balls": [{"center_m": [0,0,0], "radius_m": 1, "density": 1}, )" +
           ball + "]}";
  };
  refuse(withBall("3"), "ball 1: expected an object");
  refuse(withBall(R"({"center_m": [0,0], "radius_m": 1, "density": 1})"),
         "ball 1: center_m: expected three numbers");
  refuse(withBall(R"({"center_m": [0,0,"a"], "radius_m": 1, "density": 1})"),
         "ball 1: center_m: expected three numbers");
  refuse(withBall(R"({"center_m": [0,0,0], "density": 1})"), "ball 1: radius_m: expected a number");
  refuse(withBall(R"({"center_m": [0,0,0], "radius_m": 0, "density": 1})"), "ball 1: the radius is 0");
  refuse(withBall(R"({"center_m": [0,0,0], "radius_m": 1e999, "density": 1})"), "x.json: is no JSON");
  refuse(withBall(R"({"center_m": [0,0,0], "radius_m": 1, "density": null})"),
         "ball 1: density: expected a number");
  refuse(R"({"welkin": "metaballs", "levels": 1, "balls": []})", "levels: expected a list");
  refuse(R"({"welkin": "metaballs", "levels": [{"balls": []}], "balls": []})",
         "level 0: balls: expected a list");
  refuse(withBall(R"({"center_m": [0,1e20,0], "radius_m": 1, "density": 1})"),
         "ball 1: the centre's y is 1e+20");
  refuse(withBall(R"({"center_m": [0,0,0], "radius_m": 1, "density": 1e38})"),
         "ball 1: the density is 1e+38");
  refuse(withBall(R"({"center_m": [0,0,0], "radius_m": 1, "density": 1, "radius_m": 2})"),
         "ball 1: radius_m is there twice");
  refuse(R"({"welkin": "metaballs", "balls": [], "balls": []})", "x.json: balls is there twice");
  refuse(R"({"welkin": "metaballs", "levels": [{}, {"balls": [{}, {"density": 1, "density": 2}]}]})",
         "level 1: ball 1: density is there twice");
  EXPECT_THROW(readMetaballs("no_such_file.json"), IoError);
  // Deep nesting must not end the program.
  refuse(std::string(100000, '['), "is no JSON");
}

}  // namespace
}  // namespace welkin::scene
