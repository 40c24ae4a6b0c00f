// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/cover_warnings.h"

#include <gtest/gtest.h>

#include "tests/testing/skies.h"
#include "welkin/scene/sky_state.h"

namespace welkin::scene {
namespace {

using weather::Genus;

Scene thin(double extinctionPerM, Technique technique = Technique::kAuto) {
  Scene s = testing::cloudyScene(50.0, {Genus::kCirrus}, 6.0);
  s.layers[0].extinctionPerM = extinctionPerM;
  s.layers[0].technique = technique;
  return s;
}

void expectWarning(const SkyState& state, const std::string& begin, const std::string& part) {
  ASSERT_EQ(state.warnings.size(), 1u);
  EXPECT_TRUE(state.warnings[0].starts_with(begin)) << state.warnings[0];
  EXPECT_NE(state.warnings[0].find(part), std::string::npos) << state.warnings[0];
}

TEST(CoverWarnings, VolumesThatAreTooThinSaySo) {
  for (const double extinctionPerM : {0.0, 1e-5}) {
    const SkyState state = buildSky(thin(extinctionPerM), 0.0);
    EXPECT_LT(state.cover[0].deliveredOktas, 5.0);
    expectWarning(state, "the cirrus from ", " and not 6: it is too thin");
  }
  EXPECT_TRUE(buildSky(thin(0.001), 0.0).warnings.empty());
}

TEST(CoverWarnings, NoneWhereCoversAreMet) {
  for (const double oktas : {0.0, 1.0, 8.0})
    for (const double secondsAfter : {0.0, 3600.0}) {
      const Scene s = testing::cloudyScene(50.0, {Genus::kCumulus, Genus::kAltostratus}, oktas);
      EXPECT_TRUE(buildSky(s, secondsAfter).warnings.empty()) << oktas;
    }
}

TEST(CoverWarnings, SheetsThatHideTooLittleSaySo) {
  Scene s = testing::clearScene(50.0);
  s.sheets.resize(2);
  s.sheets[0].oktas = 2.0;
  s.sheets[1].oktas = 6.0;
  for (const double bias : {0.0, 0.25}) {
    s.sheets[1].bias = bias;
    const SkyState state = buildSky(s, 0.0);
    EXPECT_EQ(state.sheetCover[1].deliveredOktas, 0.0);
    expectWarning(state, "[[sheet]] 2 covers 0 oktas and not 6: it hides too little", "bias");
  }
  s.sheets[1].bias = 0.27;
  const SkyState state = buildSky(s, 0.0);
  EXPECT_NEAR(state.sheetCover[1].deliveredOktas, 6.0, 0.01);
  EXPECT_TRUE(state.warnings.empty());
}

TEST(CoverWarnings, SheetsOfOneVeilSaySo) {
  expectWarning(buildSky(thin(0.0, Technique::kSkyPlane), 0.0), "the cirrus from ",
                "its gaps hide as much as its clouds");
  EXPECT_TRUE(buildSky(thin(0.001, Technique::kSkyPlane), 0.0).warnings.empty());
}

}  // namespace
}  // namespace welkin::scene
