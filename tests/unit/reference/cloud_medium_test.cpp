// SPDX-License-Identifier: Apache-2.0
// The clouds as a medium: bounds that hold, and null collisions that follow Beer's law along them.
#include "welkin/reference/cloud_medium.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/testing/skies.h"
#include "welkin/core/parallel.h"
#include "welkin/reference/directions.h"
#include "welkin/scene/rain_shafts.h"
#include "welkin/scene/sky_state.h"

namespace welkin::reference {
namespace {

using weather::Genus;

scene::SkyState skyOf(std::initializer_list<Genus> genera, double oktas = 4.0) {
  return scene::buildSky(testing::cloudyScene(40.0, genera, oktas), 600.0);
}

std::vector<int> allLayers(const field::CloudField& field) {
  std::vector<int> layers;
  for (std::size_t i = 0; i < field.layers().size(); ++i) layers.push_back(static_cast<int>(i));
  return layers;
}

CloudMedium mediumOf(const scene::SkyState& state) {
  std::vector<scene::CloudMatter> matter;
  for (std::size_t i = 0; i < state.clouds->layers().size(); ++i)
    matter.push_back(scene::matterInField(state.scene, state.weather, i));
  return CloudMedium(*state.clouds, allLayers(*state.clouds), matter);
}

// What bounds are compared with: the field itself, layer by layer, at a cloud position.
float fieldAt(const scene::SkyState& state, const glm::dvec3& q) {
  // Back from metres along the ground and above it.
  const double r = state.clouds->earthRadiusM(), along = std::hypot(q.x, q.y), angle = along / r;
  const double k = along > 0.0 ? (r + q.z) * std::sin(angle) / along : 1.0, sine = std::sin(0.5 * angle);
  return state.clouds->extinction(glm::vec3(k * q.x, k * q.y, q.z - 2.0 * (r + q.z) * sine * sine));
}

struct Cells {
  int looked = 0, cloudy = 0, tight = 0;  // tight: the least is more than nine tenths of the most
  // Of the bounds of cells with cloud: the largest extinction found in them over the bound.
  double used = 0.0;
};

// Looks at random places, and around them in the cell that holds them.
void look(const scene::SkyState& state, Cells& cells, std::uint64_t seed) {
  const MajorantGrid grid(*state.clouds, allLayers(*state.clouds));
  Random random(seed);
  auto within = [&](double a, double b) { return a + (b - a) * unit(random); };
  for (int i = 0; i < 600; ++i) {
    const double reach = i % 3 == 0 ? 60e3 : 6e3;
    const glm::vec3 q(within(-reach, reach), within(-reach, reach), within(grid.lowM(), grid.highM()));
    const MajorantGrid::Cell cell = grid.at(q);
    for (int k = 0; k < 3; ++k) {
      ASSERT_GE(q[k], cell.box.low[k]);
      ASSERT_LE(q[k], cell.box.high[k]);
    }
    ++cells.looked;
    float most = 0.0f;
    const glm::dvec3 low(glm::max(cell.box.low, q - 400.0f)), high(glm::min(cell.box.high, q + 400.0f));
    for (int k = 0; k < 60; ++k) {
      const glm::dvec3 p(within(low.x, high.x), within(low.y, high.y), within(low.z, high.z));
      const float sigma = fieldAt(state, p);
      most = std::max(most, sigma);
      ASSERT_LE(sigma, cell.bounds.majorant) << p.x << ' ' << p.y << ' ' << p.z;
      ASSERT_GE(sigma, cell.bounds.minorant) << p.x << ' ' << p.y << ' ' << p.z;
    }
    if (cell.bounds.majorant > 0.0f) ++cells.cloudy;
    if (cell.bounds.minorant > 0.9f * cell.bounds.majorant) ++cells.tight;
    if (most > 0.0f) cells.used += static_cast<double>(most / cell.bounds.majorant);
  }
}

TEST(MajorantGrid, BoundsTheFieldOfEveryGenus) {
  for (const Genus genus : {Genus::kCumulus, Genus::kStratocumulus, Genus::kStratus, Genus::kNimbostratus,
                            Genus::kCumulonimbus, Genus::kAltocumulus, Genus::kAltostratus, Genus::kCirrus,
                            Genus::kCirrocumulus, Genus::kCirrostratus, Genus::kFog}) {
    const int number = static_cast<int>(genus);
    SCOPED_TRACE("genus " + std::to_string(number));
    Cells cells;
    look(skyOf({genus}), cells, 7 + static_cast<std::uint64_t>(number));
    EXPECT_GT(cells.cloudy, 20);
    EXPECT_GT(cells.used, 0.05 * cells.cloudy);  // the bounds are not idle
  }
}

TEST(MajorantGrid, BoundsSeveralLayersAtOnce) {
  Cells cells;
  look(skyOf({Genus::kCumulus, Genus::kStratocumulus, Genus::kCirrus}, 5.0), cells, 3);
  EXPECT_GT(cells.cloudy, 60);
  Cells rain;
  scene::Scene storm = testing::cloudyScene(40.0, {Genus::kCumulonimbus}, 4.0);
  storm.layers[0].rainMmPerH = 25.0;
  look(scene::buildSky(storm, 600.0), rain, 5);
  EXPECT_GT(rain.cloudy, 50);
  Cells overcast;
  look(skyOf({Genus::kStratus}, 8.0), overcast, 4);
  EXPECT_GT(overcast.tight, 60);  // where only height counts
}

// A thin layer cuts what is as high as it is into thin boxes, and none of the deep cloud over it.
TEST(MajorantGrid, BoxesAreAsHighAsTheLayersAround) {
  const scene::SkyState alone = skyOf({Genus::kCumulonimbus}),
                        both = skyOf({Genus::kCumulus, Genus::kCumulonimbus});
  const auto& layers = both.clouds->layers();
  const float thinTopM = layers[0].topM, deepTopM = layers[1].topM;
  ASSERT_LT(thinTopM, 0.5f * deepTopM);
  const auto highest = [](const scene::SkyState& state, float fromM, float toM) {
    const MajorantGrid grid(*state.clouds, allLayers(*state.clouds));
    float most = 0.0f;
    for (float z = fromM + 5.0f; z < toM; z += 10.0f) {
      const CloudBox box = grid.at({900e3f, 900e3f, z}).box;
      most = std::max(most, box.high.z - box.low.z);
    }
    return most;
  };
  EXPECT_LT(highest(both, layers[0].baseM, thinTopM), 90.0f);
  EXPECT_GT(highest(both, thinTopM, deepTopM), 0.9f * highest(alone, thinTopM, deepTopM));
}

// Along lines of all kinds the cells that a walk visits follow each other, have the bounds that their places
// have, and leave out nothing that has cloud.
TEST(MajorantGrid, WalksFromCellToCell) {
  const scene::SkyState state = skyOf({Genus::kCumulus, Genus::kStratocumulus}, 5.0);
  const MajorantGrid grid(*state.clouds, allLayers(*state.clouds));
  Random random(23);
  auto within = [&](double a, double b) { return a + (b - a) * unit(random); };
  int visited = 0;
  double skipped = 0.0, cloudless = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double reach = i % 3 == 0 ? 60e3 : 5e3, middle = 0.5 * (grid.lowM() + grid.highM()),
                 half = 0.5 * (grid.highM() - grid.lowM());
    const glm::vec3 from(within(-reach, reach), within(-reach, reach), middle + 0.9 * within(-half, half)),
        to(from.x + static_cast<float>(within(-2e3, 2e3)), from.y + static_cast<float>(within(-2e3, 2e3)),
           middle + 0.9 * within(-half, half));
    const float length = glm::length(to - from);
    glm::vec3 slope = (to - from) / length;
    if (i % 7 == 0) slope[i / 7 % 3] = 0.0f;
    const CloudLine line(from, slope);
    float before = 0.0f;
    auto skip = [&](float t0, float t1) {  // no cloud in what is left out
      for (float t = t0 + 1.0f; t < t1 - 1.0f; t += 20.0f) {
        cloudless += 1.0;
        if (grid.at(from + slope * t).bounds.majorant > 0.0f) skipped += 1.0;
      }
    };
    EXPECT_FALSE(grid.walk(line, length, [&](const MajorantGrid::Bounds& b, unsigned, float t0, float t1) {
      EXPECT_GE(t0, before);
      EXPECT_GT(t1, t0);
      EXPECT_LE(t1, length);
      if (t1 - t0 > 1.0f) {
        const MajorantGrid::Cell cell = grid.at(from + slope * (0.5f * (t0 + t1)));
        EXPECT_EQ(cell.bounds.majorant, b.majorant);
        EXPECT_EQ(cell.bounds.minorant, b.minorant);
        ++visited;
      }
      skip(before, t0);
      before = t1;
      return false;
    }));
    skip(before, length);
  }
  EXPECT_EQ(skipped, 0.0);
  EXPECT_GT(cloudless, 1000.0);
  EXPECT_GT(visited, 1000);
}

// Places asked for by several threads at a time, over several chunks of memory.
TEST(CodeLines, GivesEachPlaceLinesOfItsOwn) {
  constexpr std::size_t kPlaces = 40000;
  CodeLines lines;
  std::vector<std::atomic<std::uint32_t>> places(kPlaces);
  auto size = [](std::size_t place) { return static_cast<std::uint32_t>(1 + place % 2); };
  std::vector<std::uint16_t*> asked(2 * kPlaces);
  parallelFor(asked.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t place = i / 2;
      asked[i] = lines.at(places[place], size(place));
    }
  });
  auto codes = [&](std::size_t place) {
    return std::span(asked[2 * place], size(place) * CodeLines::kCodes);
  };
  for (std::size_t place = 0; place < kPlaces; ++place) {
    ASSERT_EQ(asked[2 * place], asked[2 * place + 1]);
    for (std::uint16_t& code : codes(place)) {
      ASSERT_EQ(code, 0);  // nobody else's
      code = static_cast<std::uint16_t>(place + 1);
    }
  }
  for (std::size_t place = 0; place < kPlaces; ++place) {
    ASSERT_EQ(lines.at(places[place], size(place)), asked[2 * place]);
    for (const std::uint16_t code : codes(place)) ASSERT_EQ(code, static_cast<std::uint16_t>(place + 1));
  }
}

TEST(CloudMedium, HasTheDensityOfTheField) {
  const scene::SkyState state = skyOf({Genus::kCumulus, Genus::kStratocumulus}, 5.0);
  const CloudMedium medium = mediumOf(state);
  Random random(11);
  int cloudy = 0;
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec3 p(20e3 * (unit(random) - 0.5), 20e3 * (unit(random) - 0.5),
                       900.0 + 1200.0 * unit(random));
    const float sigma = state.clouds->extinction(glm::vec3(p));
    EXPECT_EQ(medium.extinction(p), sigma);
    if (sigma > 0.0f) ++cloudy;
  }
  EXPECT_GT(cloudy, 300);
}

// Beer's law along rays of all kinds: by quadrature, by ratio tracking, and as the chance to get through.
TEST(CloudMedium, FollowsBeersLaw) {
  const scene::SkyState state = skyOf({Genus::kCumulus}, 5.0);
  const CloudMedium medium = mediumOf(state);
  Random random(5), chance(6);
  int partial = 0;
  for (int i = 0; i < 400; ++i) {
    const double azimuth = 2.0 * kPi * unit(random), up = -0.3 + 0.8 * unit(random),
                 flat = std::sqrt(1.0 - up * up);
    const glm::dvec3 from(6e3 * (unit(random) - 0.5), 6e3 * (unit(random) - 0.5),
                          300.0 + 1800.0 * unit(random));
    const Ray ray{from, {flat * std::cos(azimuth), flat * std::sin(azimuth), up}};
    const double end =
        medium.earth().toGround(ray, 2500.0) < 2500.0 ? medium.earth().toGround(ray, 0.0) : 2500.0;
    double depth = 0.0;
    constexpr int kSteps = 2500;
    for (int k = 0; k < kSteps; ++k)
      depth += medium.extinction(ray.at(end * (k + 0.5) / kSteps)) * end / kSteps;
    const double truth = std::exp(-depth);
    if (truth < 0.02 || truth > 0.98) continue;
    ++partial;
    constexpr int kPaths = 2000;
    double ratio = 0.0, squares = 0.0, passed = 0.0;
    for (int k = 0; k < kPaths; ++k) {
      const double t = medium.transmittance(ray, end, chance);
      ratio += t / kPaths;
      squares += t * t / kPaths;
      if (const auto collision = medium.collide(ray, end, chance)) {
        EXPECT_GT(medium.extinction(ray.at(collision->t)), 0.0);
      } else {
        passed += 1.0 / kPaths;
      }
    }
    EXPECT_NEAR(ratio, truth, 4.5 * std::sqrt(std::max(squares - ratio * ratio, 0.0) / kPaths) + 1e-3);
    EXPECT_NEAR(passed, truth, 4.5 * std::sqrt(truth * (1.0 - truth) / kPaths) + 1e-3);
  }
  EXPECT_GE(partial, 8);
}

}  // namespace
}  // namespace welkin::reference
