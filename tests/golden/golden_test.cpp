// SPDX-License-Identifier: Apache-2.0
// Six skies, drawn small and compared with the pictures beside this file. Drivers and compilers differ in the
// last bits, so a picture may differ by a little everywhere and by more at a few edges; it may not shift,
// change colour or gain grain.
//
// With WELKIN_UPDATE_GOLDEN=1 the pictures are drawn anew (./dev golden). Look at them before committing
// them. A picture that differs is left as <name>.actual.png in the working folder.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <string>
#include <variant>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/io/png.h"
#include "welkin/io/quantise.h"
#include "welkin/render/display.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/sky_state.h"

namespace welkin {
namespace {

using weather::Genus;

struct Golden {
  const char* name;
  scene::Scene (*scene)();
  double mostMean = 2.5;           // of 255: mean difference that is let pass
  double mostPercentile99 = 20.0;  // of 255: the difference that 99 values of 100 keep
};
void PrintTo(const Golden& g, std::ostream* out) {
  *out << g.name;
}

scene::Scene clearNoon() {
  return testing::looking(testing::clearScene(70.0), 320.0, 14.0);
}

scene::Scene fairWeather() {
  return testing::looking(testing::cloudyScene(50.0, {Genus::kCumulus}, 3.0), 330.0, 14.0);
}

scene::Scene overcastRain() {
  scene::Scene s = testing::cloudyScene(35.0, {Genus::kStratus, Genus::kNimbostratus}, 8.0);
  s.layers[0].oktas = 4.0;
  s.visibilityM = 7000.0;
  return testing::looking(s, 200.0, 14.0);
}

scene::Scene thunderstorm() {
  scene::Scene s = testing::cloudyScene(30.0, {Genus::kCumulonimbus}, 4.0);
  return testing::looking(s, 20.0, 20.0, 90.0);
}

scene::Scene sunset() {
  scene::Scene s = testing::cloudyScene(1.5, {Genus::kAltocumulus, Genus::kCirrus}, 4.0);
  return testing::looking(s, 295.0, 14.0);
}

scene::Scene moonlitNight() {
  scene::Scene s = testing::moonlitScene();
  s.time = addSeconds(s.time, -5.0 * 3600.0);  // the moon not yet at the zenith
  s.layers.push_back(weather::typicalLayer(Genus::kStratocumulus, testing::kTestLatitudeDeg));
  s.layers.back().oktas = 3.0;
  return testing::looking(s, 75.0, 25.0, 80.0);
}

const Golden kGoldens[] = {
    {"clear_noon", clearNoon},      {"fair_weather_cumulus", fairWeather}, {"overcast_rain", overcastRain},
    {"thunderstorm", thunderstorm}, {"sunset_two_layers", sunset},         {"moonlit_night", moonlitNight},
};

Image<std::uint8_t> drawn(const Golden& golden) {
  static render::SkyRenderer renderer;
  const scene::SkyState state = scene::buildSky(testing::sized(golden.scene(), 160, 90), 0.0);
  const render::Picture picture = renderer.draw(state);
  return io::quantise8(render::toDisplay(picture.luminance, picture.autoExposureEv));
}

class GoldenPicture : public ::testing::TestWithParam<Golden> {};

TEST_P(GoldenPicture, IsAsItWas) {
  const Golden& golden = GetParam();
  const std::filesystem::path path =
      std::filesystem::path(WELKIN_GOLDEN_DIR) / (std::string(golden.name) + ".png");
  const Image<std::uint8_t> actual = drawn(golden);
  const char* update = std::getenv("WELKIN_UPDATE_GOLDEN");
  if (update && *update && std::string(update) != "0") {
    io::writePng(path, actual);
    GTEST_SKIP() << "drawn anew: " << path;
  }
  const auto expected = std::get<Image<std::uint8_t>>(io::readPng(path));
  const testing::Difference d = testing::difference(actual, expected);
  RecordProperty("mean", std::to_string(d.mean));
  EXPECT_LE(d.mean, golden.mostMean);
  EXPECT_LE(d.percentile99, golden.mostPercentile99);
  if (HasFailure()) io::writePng(std::string(golden.name) + ".actual.png", actual);
}

INSTANTIATE_TEST_SUITE_P(Golden, GoldenPicture, ::testing::ValuesIn(kGoldens),
                         [](const auto& golden) { return std::string(golden.param.name); });

}  // namespace
}  // namespace welkin
