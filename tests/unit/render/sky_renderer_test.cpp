// SPDX-License-Identifier: Apache-2.0
// Whole pictures, tiny: that they are the same every time, that no value in them is senseless, and that the
// sky behaves as skies do.
#include "welkin/render/sky_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "tests/testing/foreign_context.h"
#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/core/error.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using namespace welkin::testing;
using weather::Genus;

// That of an application that draws with EGL itself, on the same display.
TEST(SkyInAnApplication, LeavesItsContextAsItIs) {
  const ForeignContext application;
  if (!application.works()) GTEST_SKIP() << "Mesa's platform without a surface is needed";
  const scene::SkyState state = scene::buildSky(sized(clearScene(30.0), 8, 8), 0.0);
  {
    SkyRenderer renderer;
    EXPECT_TRUE(application.isCurrent());
    renderer.draw(state);
    EXPECT_TRUE(application.isCurrent());
    EXPECT_TRUE(renderer.takeErrors().empty());
    EXPECT_TRUE(application.isCurrent());
    EXPECT_THROW(renderer.draw(state, [](double) { throw Interrupted(); }), Interrupted);
    EXPECT_TRUE(application.isCurrent());
    application.release();
    renderer.draw(state);
    EXPECT_FALSE(application.isCurrent());
    EXPECT_TRUE(application.makeCurrent());
  }
  EXPECT_TRUE(application.isCurrent());
  application.release();
  EXPECT_TRUE(application.makeCurrent());
  EXPECT_TRUE(ForeignContext().works());
}

// One renderer for all: it must serve any sky after any other.
class Sky : public ::testing::Test {
 protected:
  static SkyRenderer& renderer() {
    static SkyRenderer r({.debug = true});
    return r;
  }
  static Image<float> drawn(const scene::Scene& s) {
    return renderer().draw(scene::buildSky(s, 0.0)).luminance;
  }
  void TearDown() override {
    for (const std::string& error : renderer().takeErrors()) ADD_FAILURE() << error;
  }
};

TEST_F(Sky, TheSameStateIsDrawnTheSame) {
  const scene::Scene s = cloudyScene(35.0, {Genus::kCumulus, Genus::kCirrus});
  const scene::SkyState state = scene::buildSky(s, 0.0);
  const Picture first = renderer().draw(state);
  drawn(cloudyScene(5.0, {Genus::kStratus}, 8.0));  // another sky in between
  const Picture second = renderer().draw(state);
  EXPECT_EQ(first.luminance.data, second.luminance.data);
  EXPECT_EQ(first.autoExposureEv, second.autoExposureEv);
  SkyRenderer other;
  EXPECT_EQ(first.luminance.data, other.draw(state).luminance.data);
}

// Any instant can be asked for with or without the instants before it.
TEST_F(Sky, AnInstantDoesNotDependOnItsPast) {
  const scene::Scene s = cloudyScene(35.0, {Genus::kStratocumulus, Genus::kCirrus});
  const scene::SkyState start = scene::buildSky(s, 0.0);
  const scene::SkyState between = scene::buildSky(s, 333.0, &start);
  const scene::SkyState after = scene::buildSky(s, 700.0, &between);
  const scene::SkyState direct = scene::buildSky(s, 700.0);
  const Image<float> a = renderer().draw(after).luminance, b = renderer().draw(direct).luminance;
  EXPECT_EQ(a.data, b.data);
  EXPECT_NE(a.data, renderer().draw(start).luminance.data);
}

// Whole skies, so every direction of view. The eye and the time do not touch noise and cover, which take
// long: they are kept.
void expectSensible(SkyRenderer& renderer, scene::Scene s, const scene::SkyState& kept, const char* what) {
  s = projected(s, scene::Projection::kEquirect, 16, 8);
  const Image<float> picture = renderer.draw(scene::buildSky(s, 0.0, &kept)).luminance;
  const long bad = firstBadValue(picture);
  EXPECT_EQ(bad, -1) << what << ", eye at " << s.camera.eyeM << " m, " << formatUtcTime(s.time) << ": value "
                     << (bad < 0 ? 0.0f : picture.data[static_cast<std::size_t>(bad)]) << " at " << bad;
  EXPECT_GT(luminanceOf(meanOf(picture)), 1e-6) << what;
}

// Every kind of cloud from the ground and from within, between, and above; the sun high, low, gone.
TEST_F(Sky, EveryGenusIsSensible) {
  int i = 0;
  for (const std::string_view name : kEnumNames<Genus>) {
    const Genus genus = static_cast<Genus>(i);
    // Once with a second layer far above, so that there is a between; each layer costs its calibration.
    scene::Scene s =
        genus == Genus::kCumulus ? cloudyScene(60.0, {genus, Genus::kCirrus}) : cloudyScene(60.0, {genus});
    const scene::SkyState kept = scene::buildSky(s, 0.0);
    const double inside = 0.5 * (s.layers[0].baseM + s.layers[0].topM);
    const double between = s.layers.front().topM + 1000.0;
    const double eyes[] = {between, 2.0, 12000.0, 20000.0};
    const double suns[] = {60.0, 5.0, -12.0};
    s.time = clearScene(suns[i % 3]).time;
    expectSensible(renderer(), fromHeight(s, inside), kept, name.data());
    expectSensible(renderer(), fromHeight(s, eyes[i % 4]), kept, name.data());
    ++i;
  }
}

TEST_F(Sky, EverySunIsSensible) {
  scene::Scene s = cloudyScene(60.0, {Genus::kCumulus, Genus::kAltocumulus});
  const scene::SkyState kept = scene::buildSky(s, 0.0);
  for (const double sun : {60.0, 5.0, 0.0, -4.0, -12.0, -30.0})
    for (const double eyeM : {2.0, 20000.0}) {
      if (eyeM > 2.0 && sun > 0.0) continue;  // by day the genera see to that
      s.time = clearScene(sun).time;
      expectSensible(renderer(), fromHeight(s, eyeM), kept, "sun");
    }
}

TEST_F(Sky, StraightUpAndStraightDownAreSensible) {
  const scene::Scene s = cloudyScene(60.0, {Genus::kCumulus});
  for (const double pitch : {-90.0, 90.0})
    EXPECT_EQ(firstBadValue(drawn(fromHeight(sized(looking(s, 290.0, pitch), 9, 9), 3000.0))), -1) << pitch;
}

TEST_F(Sky, PolesAndDateLineAreDrawnLikeAnyPlace) {
  for (const scene::Place place :
       {scene::Place{90.0, 0.0, 0.0}, scene::Place{-90.0, 180.0, 2800.0}, scene::Place{66.5, -180.0, 10.0}}) {
    scene::Scene s = cloudyScene(20.0, {Genus::kStratocumulus});
    s.place = place;
    EXPECT_EQ(firstBadValue(drawn(projected(s, scene::Projection::kEquirect, 16, 8))), -1)
        << place.latitudeDeg;
  }
}

// --- how skies behave
// ------------------------------------------------------------------------------------------------------------

TEST_F(Sky, DeepensUpwards) {
  // Away from the sun, which stands in the west.
  const Image<float> picture = drawn(sized(looking(clearScene(45.0), 60.0, 45.0, 60.0), 24, 36));
  const auto blueness = [&](int y0, int y1) {
    const glm::vec3 c = meanOf(picture, y0, y1);
    return c.z / c.x;
  };
  EXPECT_GT(blueness(0, 6), 1.25 * blueness(28, 34));
  EXPECT_GT(luminanceOf(meanOf(picture, 28, 34)), luminanceOf(meanOf(picture, 0, 6)));
}

TEST_F(Sky, OvercastDimsTheGround) {
  const auto ground = [&](const scene::Scene& s) {
    return luminanceOf(meanOf(drawn(sized(looking(s, 90.0, -45.0), 8, 8))));
  };
  const double clear = ground(clearScene(50.0));
  const double overcast = ground(cloudyScene(50.0, {Genus::kNimbostratus}, 8.0));
  EXPECT_LT(overcast, 0.35 * clear);
  EXPECT_GT(overcast, 0.01 * clear);
}

// The CIE overcast sky is three times brighter at the zenith than at the horizon; ours at least does not do
// the opposite.
TEST_F(Sky, ThickOvercastIsGreyAndNoBrighterAtTheHorizon) {
  const Image<float> picture =
      drawn(projected(cloudyScene(50.0, {Genus::kStratus}, 8.0), scene::Projection::kEquirect, 64, 32));
  const glm::vec3 zenith = meanOf(picture, 0, 4), low = meanOf(picture, 13, 15);
  EXPECT_GT(luminanceOf(zenith), 0.8 * luminanceOf(low));
  EXPECT_NEAR(zenith.z / zenith.x, 1.0, 0.45);
}

TEST_F(Sky, TheMoonBrightensTheNight) {
  for (const bool cloudy : {false, true}) {
    const auto night = [&](scene::Scene s) {
      if (cloudy) {
        s.layers.push_back(weather::typicalLayer(Genus::kCumulus, kTestLatitudeDeg));
        s.layers.back().oktas = 4.0;
      }
      return luminanceOf(meanOf(drawn(looking(s, 90.0, 30.0))));
    };
    const double moonlit = night(moonlitScene()), moonless = night(moonlessScene());
    EXPECT_GT(moonlit, 5.0 * moonless) << cloudy;
    EXPECT_GT(moonless, 1e-5) << cloudy;
    EXPECT_LT(moonlit, 0.1) << cloudy;
  }
}

// Opposite to the glow of dusk: clouds have light from all of the sky, and none is much bluer than the bluest
// of it.
TEST_F(Sky, CloudsAtDuskAreLittleBluerThanTheSky) {
  // Of the pixels over the horizon, red for each blue; of all but the least thousandth, which are single
  // holes in the deepest shade.
  const auto leastRed = [&](scene::Scene s) {
    const Image<float> picture = drawn(sized(looking(s, 110.0, 14.0, 60.0), 96, 54));
    std::vector<double> red;
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 96; ++x) {
        const glm::vec3 c = pixel(picture, x, y);
        red.push_back(static_cast<double>(c.x / c.z));
      }
    const auto least = red.begin() + static_cast<std::ptrdiff_t>(red.size() / 1000);
    std::nth_element(red.begin(), least, red.end());
    return *least;
  };
  const double clear = leastRed(clearScene(-3.0));
  for (const Genus genus : {Genus::kCumulus, Genus::kCumulonimbus, Genus::kAltocumulus}) {
    SCOPED_TRACE(static_cast<int>(genus));
    EXPECT_GT(leastRed(cloudyScene(-3.0, {genus})), 0.7 * clear);
  }
}

// What a picture has of fine structure that the truth lacks: the relative difference of the two less its mean
// over the four neighbours, in the median.
double grain(const Image<float>& picture, const Image<float>& truth) {
  const auto difference = [&](int x, int y) {
    return luminanceOf(pixel(picture, x, y)) / luminanceOf(pixel(truth, x, y)) - 1.0;
  };
  std::vector<double> fine;
  for (int y = 1; y + 1 < picture.height; ++y)
    for (int x = 1; x + 1 < picture.width; ++x) {
      const double around =
          difference(x - 1, y) + difference(x + 1, y) + difference(x, y - 1) + difference(x, y + 1);
      fine.push_back(std::abs(difference(x, y) - 0.25 * around));
    }
  std::ranges::nth_element(fine, fine.begin() + fine.size() / 2);
  return fine[fine.size() / 2];
}

// The sunlit side of a cumulonimbus shows every dither that is left.
TEST_F(Sky, NoGrainAtMedium) {
  scene::Scene s = sized(looking(cloudyScene(40.0, {Genus::kCumulonimbus}, 5.0), 140.0, 24.0, 16.0), 96, 54);
  s.time = parseUtcTime("2026-09-26T09:00:00Z");
  s.seed = 5;
  s.metar = "GABS 262100Z TS FEW020 SCT030CB 28/25 Q1014";
  s.layers.clear();
  s.place = {.latitudeDeg = 12.5335, .longitudeDeg = -7.9499, .altitudeM = 380};
  s.output.quality = scene::Quality::kUltra;
  const Image<float> converged = drawn(s);
  s.output.quality = scene::Quality::kMedium;
  EXPECT_LT(grain(drawn(s), converged), 0.005);
}

// A long lens sees many shadows in the air one behind the other.
TEST_F(Sky, NoGrainInTheAirOfLongLenses) {
  scene::Scene s = sized(cloudyScene(45.0, {Genus::kCumulus}, 2.0), 96, 54);
  s.time = parseUtcTime("2026-06-21T05:10:00Z");
  s.seed = 4;
  s.place = {.latitudeDeg = 45.0, .longitudeDeg = 0.0, .altitudeM = 0.0};
  s.camera.headingDeg = 71.7;
  s.camera.pitchDeg = 0.9;
  s.camera.fovDeg = 0.75;
  s.output.quality = scene::Quality::kUltra;
  const Image<float> converged = drawn(s);
  s.output.quality = scene::Quality::kMedium;
  EXPECT_LT(grain(drawn(s), converged), 0.005);
}

TEST_F(Sky, ProgressGrowsToOneAndCanStopTheDrawing) {
  const scene::Scene overcast = sized(cloudyScene(45.0, {Genus::kStratus}, 8.0), 96, 64);
  for (const scene::Scene& s : {overcast, clearScene(45.0)}) {
    double last = 0.0;
    renderer().draw(scene::buildSky(s, 0.0), [&](double fraction) {
      EXPECT_GE(fraction, last);
      last = fraction;
    });
    EXPECT_DOUBLE_EQ(last, 1.0);
  }
  const scene::SkyState state = scene::buildSky(clearScene(45.0), 0.0);
  struct Stop {};
  EXPECT_THROW(renderer().draw(state,
                               [](double fraction) {
                                 if (fraction > 0.3) throw Stop{};
                               }),
               Stop);
  EXPECT_EQ(firstBadValue(renderer().draw(state).luminance), -1);  // and is as good as new
}

}  // namespace
}  // namespace welkin::render
