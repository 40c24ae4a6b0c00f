// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "welkin/core/error.h"
#include "welkin/core/random.h"
#include "welkin/scene/param_json.h"
#include "welkin/scene/sky_state.h"

namespace welkin::scene {
namespace {

struct Problem {
  std::string what;
  int line = 0, column = 0;
};

Problem problemOf(const std::string& text) {
  try {
    parseScene(text, "s.toml");
  } catch (const ParseError& e) {
    return {e.what(), e.line(), e.column()};
  }
  return {};
}

std::string readFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(SceneFile, EmptyIsTheDefaultScene) {
  EXPECT_EQ(toJson(parseScene("", "s.toml").scene), toJson(Scene{}));
}

TEST(SceneFile, ReadsEveryKindOfValue) {
  const SceneFile f = parseScene(R"(
time = 2026-03-20T18:00:30Z
seed = 42
metar = "KMRY 211753Z 28010KT 10SM FEW012 18/12 A2992"
visibility_m = 9000
[place]
latitude_deg = 36.59
longitude_deg = -121.85
[ground]
albedo = [0.1, 0, 1]
[camera]
projection = "equirect"
heading_deg = 270
[output]
sun_disc = false
width = 640
)",
                                 "s.toml");
  const Scene& s = f.scene;
  EXPECT_EQ(s.time, (UtcTime{2026, 3, 20, 18, 0, 30}));
  EXPECT_EQ(s.seed, 42);
  EXPECT_EQ(s.metar, "KMRY 211753Z 28010KT 10SM FEW012 18/12 A2992");
  EXPECT_EQ(s.visibilityM, 9000.0);
  EXPECT_EQ(s.place.longitudeDeg, -121.85);
  EXPECT_EQ(s.ground.albedo, glm::dvec3(0.1, 0, 1));
  EXPECT_EQ(s.camera.projection, Projection::kEquirect);
  EXPECT_EQ(s.camera.headingDeg, 270.0);
  EXPECT_FALSE(s.output.sunDisc);
  EXPECT_EQ(s.output.width, 640);
  EXPECT_EQ(s.output.height, 320);  // half of that
  EXPECT_TRUE(f.gives("output.width"));
  EXPECT_FALSE(f.gives("output.height"));
}

TEST(SceneFile, PicturesHaveTheSizeOfTheirProjection) {
  const auto size = [](const std::string& camera, const std::string& output = "") {
    const Scene s =
        parseScene("[camera]\nprojection = \"" + camera + "\"\n[output]\n" + output, "s.toml").scene;
    EXPECT_EQ(parseScene(sceneToToml(s), "again.toml").scene, s);
    return std::to_string(s.output.width) + "x" + std::to_string(s.output.height);
  };
  EXPECT_EQ(size("perspective"), "1280x720");
  EXPECT_EQ(size("fisheye"), "1024x1024");
  EXPECT_EQ(size("equirect"), "2048x1024");
  EXPECT_EQ(size("cubemap"), "3072x512");
  EXPECT_EQ(size("perspective", "width = 640\n"), "640x720");
  EXPECT_EQ(size("fisheye", "height = 300\n"), "300x300");
  EXPECT_EQ(size("equirect", "width = 640\n"), "640x320");
  EXPECT_EQ(size("cubemap", "height = 64\n"), "384x64");
  EXPECT_EQ(problemOf("[camera]\nprojection = \"cubemap\"\n[output]\nheight = 4000\n").what,
            "s.toml:4:10: size 24000x4000 is too large; expected at most 16384 pixels a side");
}

TEST(SceneFile, TimeMayHaveAnOffsetOrBeText) {
  EXPECT_EQ(parseScene("time = 2026-03-20T18:00:00+02:00", "s").scene.time, (UtcTime{2026, 3, 20, 16, 0, 0}));
  EXPECT_EQ(parseScene("time = \"2026-03-20T18:00Z\"", "s").scene.time, (UtcTime{2026, 3, 20, 18, 0, 0}));
}

TEST(SceneFile, RoundTrips) {
  Scene s;
  s.time = {2031, 12, 24, 23, 59, 58.25};
  s.atS = -12.5;
  s.metar = "LSZH 211220Z 24008KT CAVOK RMK text with \"quotes\", a tab\t and a backslash \\";
  s.visibilityM = 12345.678;
  s.ground.albedo = {1.0 / 3.0, 0.2, 0.0};
  s.camera.headingDeg = 359.99;
  s.output.quality = Quality::kUltra;
  s.output.exposureEv = -3;
  s.layers.resize(3);
  s.layers[0].genus = weather::Genus::kFog;
  s.layers[1].baseM = 2345.6;
  s.layers[1].topM = 2400;
  s.layers[2].genus = weather::Genus::kCirrus;
  const std::string text = sceneToToml(s);
  const Scene back = parseScene(text, "s.toml").scene;
  EXPECT_EQ(toJson(back), toJson(s)) << text;
  EXPECT_EQ(sceneToToml(back), text);
}

TEST(SceneFile, UnknownKeysNameTheNearestAndThePlace) {
  const Problem p = problemOf("seed = 1\n[place]\n  latitude_dge = 4\n");
  EXPECT_EQ(p.what, "s.toml:3:3: unknown key \"latitude_dge\" in [place]; did you mean \"latitude_deg\"?");
  EXPECT_EQ(p.line, 3);
  EXPECT_EQ(p.column, 3);
  EXPECT_EQ(problemOf("[place]\nlatitude = 4").what,
            "s.toml:2:1: unknown key \"latitude\" in [place]; did you mean \"latitude_deg\"?");
  EXPECT_EQ(problemOf("tiem = 1").what, "s.toml:1:1: unknown key \"tiem\"; did you mean \"time\"?");
  EXPECT_EQ(problemOf("[camrea]\nfov_deg = 3").what,
            "s.toml:1:2: unknown key \"camrea\"; did you mean \"camera\"?");
  EXPECT_EQ(problemOf("latitude_deg = 3").what,
            "s.toml:1:1: unknown key \"latitude_deg\"; it belongs in [place]");
  EXPECT_EQ(
      problemOf("[output]\nseed = 3").what,
      "s.toml:2:1: unknown key \"seed\" in [output]; it belongs at the top of the file, above every [table]");
  EXPECT_EQ(problemOf("[[layer]]\ngenus = \"cirrus\"\nokats = 3").what,
            "s.toml:3:1: unknown key \"okats\" in [[layer]]; did you mean \"oktas\"?");
}

TEST(SceneFile, WrongTypesSayExpectedAndFound) {
  EXPECT_EQ(problemOf("[place]\nlatitude_deg = \"north\"").what,
            "s.toml:2:16: latitude_deg: expected a number, found text");
  EXPECT_EQ(problemOf("seed = 1.5").what, "s.toml:1:8: seed: expected a whole number, found a number");
  EXPECT_EQ(problemOf("seed = true").what, "s.toml:1:8: seed: expected a whole number, found true or false");
  EXPECT_EQ(problemOf("metar = 3").what, "s.toml:1:9: metar: expected text, found a whole number");
  EXPECT_EQ(problemOf("output = 3").what,
            "s.toml:1:10: output: expected a table [output], found a whole number");
  EXPECT_EQ(problemOf("[layer]\noktas = 3").what,
            "s.toml:1:1: layer: expected a list of tables [[layer]], found a table");
  EXPECT_EQ(problemOf("layer = [1]").what,
            "s.toml:1:10: layer: expected a list of tables [[layer]], found a whole number");
  EXPECT_EQ(problemOf("[ground]\nalbedo = [0.1, 0.2]").what,
            "s.toml:2:10: albedo: expected a list of three numbers, found a list");
  EXPECT_EQ(problemOf("time = 5").what,
            "s.toml:1:8: time: expected a date and time such as 2026-06-21T18:30:00Z, found a whole number");
  EXPECT_EQ(problemOf("time = 2026-06-21").what,
            "s.toml:1:8: time: expected a date and time such as 2026-06-21T18:30:00Z, found a date without a "
            "time");
  EXPECT_EQ(problemOf("time = 12:00:00").what,
            "s.toml:1:8: time: expected a date and time such as 2026-06-21T18:30:00Z, found a time without a "
            "date");
  EXPECT_EQ(problemOf("seed = 2026-06-21T18:30:00Z").what,
            "s.toml:1:8: seed: expected a whole number, found a date and time");
  EXPECT_EQ(problemOf("[output]\nsun_disc = 1").what,
            "s.toml:2:12: sun_disc: expected true or false, found a whole number");
}

TEST(SceneFile, ValuesOutOfRangeNameTheRange) {
  EXPECT_EQ(problemOf("[place]\nlatitude_deg = 95").what,
            "s.toml:2:16: latitude_deg is 95; expected -90 to 90 deg");
  EXPECT_EQ(problemOf("[output]\nwidth = 0").what, "s.toml:2:9: width is 0; expected 1 to 16384 pixels");
  EXPECT_EQ(problemOf("[camera]\nfov_deg = nan").what,
            "s.toml:2:11: fov_deg is nan; expected 0.1 to 170 deg");
  EXPECT_EQ(problemOf("[camera]\nfov_deg = -inf").what,
            "s.toml:2:11: fov_deg is -inf; expected 0.1 to 170 deg");
  EXPECT_EQ(problemOf("[ground]\nalbedo = [0.1, 1.5, 0]").what,
            "s.toml:2:16: albedo is 1.5; expected 0 to 1");
  EXPECT_EQ(problemOf("[output]\nquality = \"hihg\"").what,
            "s.toml:2:11: quality is \"hihg\"; expected low, medium, high or ultra; did you mean high?");
  EXPECT_EQ(problemOf("time = \"2026-13-01T00:00:00Z\"").line, 1);
}

TEST(SceneFile, BadTomlHasAPosition) {
  for (const char* text : {"seed = ", "seed = 1\nseed = 2", "[place", "x = \"open",
                           "time = 2026-02-30T00:00:00Z", "\xff\xfe", "= 1", "[[layer]]\n[layer]"}) {
    const Problem p = problemOf(text);
    EXPECT_TRUE(p.what.starts_with("s.toml:")) << text << " -> " << p.what;
    EXPECT_GT(p.line, 0) << text;
  }
  EXPECT_EQ(problemOf("seed = 1\nplace = {").line, 2);
}

// Whatever the bytes, the answer is a scene or a ParseError with a line.
TEST(SceneFile, DamagedFilesAreParseErrors) {
  const std::string whole = readFile(WELKIN_SOURCE_DIR "/examples/layers_by_hand.toml");
  Random random(5);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = whole;
    for (int changes = 1 + static_cast<int>(random.below(4)); changes > 0; --changes) {
      const std::size_t at = random.below(static_cast<std::uint32_t>(text.size()));
      switch (random.below(3)) {
        case 0:
          text[at] = static_cast<char>(random.below(256));
          break;
        case 1:
          text.erase(at, 1 + random.below(20));
          break;
        default:
          text.insert(at, text, random.below(static_cast<std::uint32_t>(text.size())), random.below(30));
          break;
      }
    }
    try {
      parseScene(text, "s.toml");
    } catch (const ParseError& e) {
      ++refused;
      EXPECT_GT(e.line(), 0) << e.what();
    }
  }
  EXPECT_GT(refused, 500);
}

TEST(SceneFile, LayersTakeWhatIsTypicalOfTheirGenus) {
  const Scene s = parseScene(R"(
[place]
latitude_deg = 10
[[layer]]
genus = "cirrus"
oktas = 3
[[layer]]
genus = "stratus"
base_m = 500
[[layer]]
genus = "cumulus"
base_m = 900
top_m = 1000
)",
                             "s.toml")
                      .scene;
  ASSERT_EQ(s.layers.size(), 3u);
  weather::Layer cirrus = weather::typicalLayer(weather::Genus::kCirrus, 10);
  EXPECT_EQ(s.layers[0].baseM, cirrus.baseM);
  EXPECT_EQ(s.layers[0].topM, cirrus.topM);
  EXPECT_EQ(s.layers[0].oktas, 3);
  const weather::Layer stratus = weather::typicalLayer(weather::Genus::kStratus, 10);
  EXPECT_EQ(s.layers[1].baseM, 500);
  EXPECT_DOUBLE_EQ(s.layers[1].topM, 500 + stratus.topM - stratus.baseM);
  EXPECT_EQ(s.layers[1].oktas, 8);
  EXPECT_EQ(s.layers[2].oktas, 3.5);
  EXPECT_EQ(s.layers[2].topM, 1000);
  // Another latitude given from outside wins over the file's.
  const Scene polar =
      parseScene("[place]\nlatitude_deg = 10\n[[layer]]\ngenus = \"cirrus\"", "s", 80.0).scene;
  EXPECT_EQ(polar.layers[0].baseM, weather::typicalLayer(weather::Genus::kCirrus, 80).baseM);
}

TEST(SceneFile, RadiiAreOfDroplets) {
  EXPECT_EQ(problemOf("[[layer]]\ngenus = \"cirrus\"\neffective_radius_um = 20\n").what,
            "s.toml:3:23: effective_radius_um is of droplets, and cirrus is of ice; expected none");
  EXPECT_EQ(problemOf("[[layer]]\neffective_radius_um = 60\n").what,
            "s.toml:2:23: effective_radius_um is 60; expected 2.5 to 25 um");
  EXPECT_EQ(parseScene("[[layer]]\neffective_radius_um = 20\n", "s").scene.layers[0].effectiveRadiusUm, 20.0);
  // What is written reads back, ice too.
  for (const std::string_view genus : kEnumNames<weather::Genus>) {
    const Scene s = parseScene("[[layer]]\ngenus = \"" + std::string(genus) + "\"\n", "s.toml").scene;
    EXPECT_EQ(parseScene(sceneToToml(s), "again.toml").scene, s) << genus;
  }
}

TEST(SceneFile, KeysAtOddsAreNamedWithTheirPlace) {
  const auto problem = [](const std::string& text) -> std::string {
    try {
      parseScene(text, "s.toml");
    } catch (const ParseError& e) {
      return e.what();
    }
    return "";
  };
  const auto expect = [&](const std::string& text, const std::string& place, const std::string& part) {
    EXPECT_TRUE(problem(text).starts_with("s.toml:" + place + ": ")) << problem(text);
    EXPECT_NE(problem(text).find(part), std::string::npos) << problem(text);
  };
  expect("[[layer]]\n[[layer]]\nbase_m = 2000\ntop_m = 1000\n", "4:9", "top_m must be above base_m");
  // Only what the file gives is named as wrong.
  expect("[[layer]]\ngenus = \"cirrus\"\nbase_m = 25000\n", "3:10", "base_m is 25000, too high");
  expect("[[layer]]\ngenus = \"cirrus\"\ntop_m = 100\n", "3:9",
         "top_m is 100; expected it above the typical base");
  expect("[[sheet]]\n[[sheet]]\ndensity = 0.9\nexponent = 0.1\n", "2:1", "density and exponent");
  expect("seed = 2\n[[metaballs]]\nscale = 2\n", "2:1", "metaballs have no file");
  expect("seed = 2\n[sky_box]\nstrip = \"a.png\"\npx = \"b.png\"\n", "2:1", "a strip and faces");
  expect("seed = 2\n[sky_box]\nturn_deg = 90\n", "2:1", "sky_box has neither a strip nor faces");
  expect("[slab]\noptical_depth = 2\n[[slab_column]]\n", "1:1", "an optical_depth and columns");
  expect("[slab]\noptical_depth = 2\nphase = \"mie\"\ndroplet_diameter_um = 45\n", "4:23",
         "droplet_diameter_um is 45; expected at most 40 um with phase mie");
  expect("seed = 2\n[slab]\nthickness_m = 300\n", "2:1",
         "slab has no optical_depth; expected one, or columns");
  for (const char* sky : {"[[layer]]\n", "[[sheet]]\n"})
    expect("[slab]\noptical_depth = 2\n" + std::string(sky), "3:1", "has no effect beside a slab");
  expect("[slab]\noptical_depth = 2\n[camera]\npitch_deg = 1\n", "4:13",
         "pitch_deg in [camera] has no effect");
  expect("[slab]\noptical_depth = 2\n[sky_box]\nstrip = \"a.png\"\n", "4:9",
         "strip in [sky_box] has no effect");
  expect("[slab]\noptical_depth = 2\n[ground]\nalbedo = [0.2, 0.2, 0.2]\n", "4:10",
         "albedo in [ground] has no effect beside a slab; did you mean ground_albedo in [slab]?");
  expect("[slab]\noptical_depth = 2\n[atmosphere]\nozone_du = 250\n", "4:12", "no effect beside a slab");
  expect("[slab]\noptical_depth = 2\n[place]\nlatitude_deg = 10\n", "4:16", "no effect beside a slab");
  expect("[slab]\noptical_depth = 2\n[drift]\nwind_deg = 10\n", "4:12", "no effect beside a slab");
  expect("[slab]\noptical_depth = 2\n[output]\nflare = 0.1\n", "4:9", "no effect beside a slab");
  expect("visibility_m = 900\n[slab]\noptical_depth = 2\n", "1:16",
         "visibility_m has no effect beside a slab");
  // With their defaults they ask for nothing, so that what is written reads back.
  const Scene slab = parseScene("seed = 7\n[slab]\noptical_depth = 2\n", "s.toml").scene;
  EXPECT_EQ(parseScene(sceneToToml(slab), "again.toml").scene, slab);
  expect("theme = \"thesis-few\"\n[[slab_column]]\n", "1:9", "theme has no effect beside a slab");
  expect("[[slab_column]]\n[slab]\nphase = \"mie\"\ndroplet_diameter_um = 45\n", "4:23", "at most 40");
  expect("seed = 2\nmetar = \"LSZH 211220Z 24008KT Q10\"\n", "2:9", "metar: column 22 of the report: 'Q10'");
  expect("metar = \"LSZH 211220Z NIL\"\n", "1:9", "NIL");
}

// What no table can tell alone.
TEST(SceneFile, WhatDoesNotFitTogetherHasAPlace) {
  const auto many = [](int count, const std::string& table) {
    std::string text = "seed = 2\n";
    for (int i = 0; i < count; ++i) text += table + "\n";
    return text;
  };
  EXPECT_EQ(problemOf(many(9, "[[layer]]")).what, "s.toml:10:1: there are 9 layers; expected at most 8");
  EXPECT_EQ(problemOf(many(9, "[[sheet]]")).what, "s.toml:10:1: there are 9 sheets; expected at most 8");
  EXPECT_EQ(problemOf("theme = \"thesis-combined\"\n" + many(6, "[[sheet]]")).what,
            "s.toml:3:1: there are 9 sheets; expected at most 8");
  EXPECT_TRUE(problemOf("[camera]\nprojection = \"cubemap\"\n[output]\nwidth = 600\nheight = 120\n")
                  .what.starts_with("s.toml:4:9: size 600x120 does not fit a cubemap"));
  EXPECT_TRUE(problemOf("[output]\nwidth = 16384\nheight = 16384\n").what.starts_with("s.toml:2:9: size "));
  EXPECT_EQ(problemOf("[output]\nflare = 0.01\n[camera]\nprojection = \"fisheye\"\n").what,
            "s.toml:2:9: output.flare is a lens's; expected projection perspective");
  const std::string cloud = "metaballs_as = \"volume\"\n[[metaballs]]\nfile = \"a.json\"\n[[metaballs]]\n";
  EXPECT_TRUE(
      problemOf(cloud + "file = \"a.json\"\nalbedo = 0.9\n").what.starts_with("s.toml:6:10: clouds of"));
  EXPECT_TRUE(problemOf("time = \"2100-12-31T23:59:59Z\"\nat_s = 60\n").what.starts_with("s.toml:2:8: the "));
  EXPECT_TRUE(problemOf("time = \"2100-12-31T23:59:59Z\"\n[output]\nframes = 99\n")
                  .what.starts_with("s.toml:3:10: the last picture is of 2101"));
}

TEST(SceneFile, DraftsNoteWhatDoesNotFitTogether) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "welkin_draft_test.toml";
  std::ofstream(path) << "[camera]\nprojection = \"equirect\"\n[output]\nwidth = 64\nheight = 64\n";
  const SceneFile draft = readSceneDraft(path.string());
  ASSERT_TRUE(draft.misfit);
  EXPECT_EQ(draft.misfit->line(), 4);
  EXPECT_EQ(draft.scene.output.height, 64);
  EXPECT_THROW(readSceneFile(path.string()), ParseError);
  std::filesystem::remove(path);
}

TEST(SceneFile, MissingFilesAndFoldersAreIoErrors) {
  EXPECT_THROW(readSceneFile("/nonexistent/scene.toml"), IoError);
  EXPECT_THROW(readSceneFile(std::filesystem::temp_directory_path().string()), IoError);
}

TEST(SceneFile, ExamplesAreValid) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(WELKIN_SOURCE_DIR "/examples")) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    EXPECT_NO_THROW(validate(readSceneFile(entry.path().string()).scene)) << entry.path();
  }
  EXPECT_GE(count, 3);
}

// docs/scene_file.md holds what `welkin help scene --markdown` prints. WELKIN_REFRESH=1 in the environment
// writes it anew.
TEST(SceneFile, DocumentationIsUpToDate) {
  const std::string path = WELKIN_SOURCE_DIR "/docs/scene_file.md", begin = "--markdown -->\n",
                    end = "<!-- end -->";
  std::string doc = readFile(path);
  const std::size_t from = doc.find(begin), to = doc.find(end);
  ASSERT_TRUE(from != std::string::npos && to != std::string::npos);
  const std::string table = "\n" + markdownTable(documentSceneFile()) + "\n";
  const std::size_t first = from + begin.size();
  if (std::getenv("WELKIN_REFRESH") != nullptr) {
    std::ofstream(path) << doc.replace(first, to - first, table);
    return;
  }
  std::istringstream documented(doc.substr(first, to - first)), described(table);
  std::string a, b;
  while (std::getline(described, b)) {
    std::getline(documented, a);
    ASSERT_EQ(a, b) << "run this test with WELKIN_REFRESH=1 in the environment";
  }
  EXPECT_FALSE(std::getline(documented, a)) << a;
}

// The TOML example inside the documentation is read as well.
TEST(SceneFile, ExampleInTheDocumentationIsValid) {
  const std::string doc = readFile(WELKIN_SOURCE_DIR "/docs/scene_file.md");
  const std::size_t begin = doc.find("```toml\n");
  ASSERT_NE(begin, std::string::npos);
  const std::size_t end = doc.find("```", begin + 8);
  EXPECT_NO_THROW(validate(parseScene(doc.substr(begin + 8, end - begin - 8), "docs").scene));
}

// The report's own time counts where nobody gives another.
TEST(SceneFile, TimeIsThatOfTheReport) {
  const auto of = [](const std::string& time, const std::string& report) {
    const std::string text = "metar = \"LSZH " + report + " 24008KT CAVOK 22/12 Q1018\"\n" + time;
    return parseScene(text, "s.toml").scene;
  };
  EXPECT_EQ(formatUtcTime(of("", "030750Z").time), "2026-06-03T07:50:00Z");
  EXPECT_EQ(formatUtcTime(of("", "301850Z").time), "2026-06-30T18:50:00Z");
  EXPECT_EQ(formatUtcTime(of("", "311850Z").time), "2026-05-31T18:50:00Z") << "June has no 31st";
  EXPECT_EQ(formatUtcTime(parseScene("seed = 2", "s.toml").scene.time), "2026-06-21T12:00:00Z");
  const auto noted = [&](const std::string& time, const std::string& report) {
    const Scene scene = of("time = " + time, report);
    EXPECT_EQ(formatUtcTime(scene.time), time);
    const auto notes = weatherOf(scene).notes;
    return std::any_of(notes.begin(), notes.end(),
                       [](const auto& n) { return n.find("The report is of day") != std::string::npos; });
  };
  EXPECT_FALSE(noted("2024-03-10T09:00:00Z", "100750Z"));
  EXPECT_TRUE(noted("2024-03-10T09:51:00Z", "100750Z"));
  EXPECT_TRUE(noted("2024-03-11T07:50:00Z", "100750Z"));
  EXPECT_FALSE(noted("2024-03-01T00:20:00Z", "292350Z")) << "over midnight";
}

}  // namespace
}  // namespace welkin::scene
