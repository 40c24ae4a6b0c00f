// SPDX-License-Identifier: Apache-2.0
// Nightfall goes on evenly: no instant at which a sky is suddenly another.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/testing/pictures.h"
#include "tests/testing/skies.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/sky_state.h"

namespace welkin::render {
namespace {

using weather::Genus;

struct Dusk {
  const char* name;
  Genus genus;
  double oktas;
};

// Mean luminance of the sky's upper half, and how pixels differ, between suns a 200th of a degree apart.
void expectEven(const Dusk& dusk, double elevationDeg) {
  SkyRenderer renderer;
  const auto drawn = [&](double elevation, double heading) {
    const scene::Scene s = testing::sized(
        testing::looking(testing::cloudyScene(elevation, {dusk.genus}, dusk.oktas), heading, 20.0), 48, 27);
    return renderer.draw(scene::buildSky(s, 0.0)).luminance;
  };
  for (const double heading : {295.0, 115.0}) {
    const Image<float> before = drawn(elevationDeg + 0.0025, heading),
                       after = drawn(elevationDeg - 0.0025, heading);
    const double a = testing::luminanceOf(testing::meanOf(before, 0, 14)),
                 b = testing::luminanceOf(testing::meanOf(after, 0, 14));
    EXPECT_NEAR(b / a, 1.0, 0.02) << dusk.name << " at " << elevationDeg << ", " << heading;
    // The air before clouds is tabulated over directions that are dense about the light of clouds: where moon
    // and sun change places the glow of the sunset is known elsewhere.
    EXPECT_LT(testing::relativeDifference(before, after), elevationDeg < -5.0 ? 0.06 : 0.03)
        << dusk.name << " at " << elevationDeg << ", " << heading;
  }
}

TEST(Dusk, NoSkyJumps) {
  for (const Dusk& dusk :
       {Dusk{"cirrus", Genus::kCirrus, 8.0}, Dusk{"stratocumulus", Genus::kStratocumulus, 7.0},
        Dusk{"cumulus", Genus::kCumulus, 4.0}, Dusk{"altocumulus", Genus::kAltocumulus, 4.0}})
    for (const double elevation : {2.0, 0.0, -0.86, -7.0}) expectEven(dusk, elevation);
}

}  // namespace
}  // namespace welkin::render
