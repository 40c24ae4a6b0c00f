// SPDX-License-Identifier: Apache-2.0
// Many rays at once: the same density and the same law as one ray by itself, whatever goes on beside it.
#include "welkin/reference/cloud_walks.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <bit>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/testing/skies.h"
#include "tests/testing/traced.h"
#include "welkin/reference/directions.h"
#include "welkin/scene/sky_state.h"

namespace welkin::reference {
namespace {

using weather::Genus;

// With everything that a volume may be made of: droplets, ice, an anvil and rain.
scene::SkyState stormySky() {
  scene::Scene s = testing::cloudyScene(40.0, {Genus::kCumulus, Genus::kCumulonimbus, Genus::kCirrus}, 4.0);
  s.layers[1].rainMmPerH = 8.0;
  return scene::buildSky(s, 600.0);
}

struct Clouds {
  explicit Clouds(scene::SkyState s) : state(std::move(s)) {
    std::vector<int> layers;
    std::vector<scene::CloudMatter> matter;
    for (std::size_t i = 0; i < state.clouds->layers().size(); ++i) {
      layers.push_back(static_cast<int>(i));
      matter.push_back(scene::matterInField(state.scene, state.weather, i));
    }
    medium = std::make_unique<CloudMedium>(*state.clouds, layers, matter);
  }
  scene::SkyState state;
  std::unique_ptr<CloudMedium> medium;
};

// Rays from and to everywhere, some along and some beyond the ground. Braces: numbers are drawn in their
// order.
std::vector<Ray> someRays(int count, std::uint64_t seed = 5) {
  Random random(seed);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const double azimuth = 2.0 * kPi * unit(random), up = -0.5 + 1.5 * unit(random),
                 flat = std::sqrt(std::max(1.0 - up * up, 0.0));
    const glm::dvec3 from{30e3 * (unit(random) - 0.5), 30e3 * (unit(random) - 0.5), 12e3 * unit(random)};
    rays.push_back(
        {from, glm::normalize(glm::dvec3(flat * std::cos(azimuth), flat * std::sin(azimuth), up))});
  }
  return rays;
}

struct Found {
  std::optional<CloudMedium::Collision> collision;
  double transmittance = 1.0;
};

// Every ray in a lane, in order, each with a generator of its own; at most so many lanes.
std::vector<Found> walked(const CloudMedium& medium, const std::vector<Ray>& rays, bool collide, double end,
                          std::size_t lanes) {
  CloudWalks walks(medium);
  std::vector<Random> randoms;
  for (std::uint64_t i = 0; i < rays.size(); ++i) randoms.emplace_back(hashOf(i));
  std::vector<Found> found(rays.size());
  std::vector<std::size_t> at(CloudWalks::kLanes);
  std::size_t next = 0;
  auto give = [&](std::size_t lane) {
    if (next == rays.size()) return;
    const std::size_t i = at[lane] = next++;
    if (collide)
      walks.collide(lane, rays[i], end, randoms[i]);
    else
      walks.transmit(lane, rays[i], end, randoms[i]);
  };
  for (std::size_t lane = 0; lane < lanes; ++lane) give(lane);
  while (LaneBits ended = walks.run())
    for (; ended != 0; ended &= ended - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(ended));
      found[at[lane]] = {walks.collision(lane), walks.transmittance(lane)};
      give(lane);
    }
  return found;
}

TEST(RayPieces, OfManyRaysAreThoseOfEach) {
  const Clouds clouds(
      scene::buildSky(testing::cloudyScene(40.0, {Genus::kCumulus, Genus::kCirrus}, 4.0), 0.0));
  std::vector<Ray> rays = someRays(2000);
  for (std::size_t i = 0; i < rays.size(); i += 3) {
    // From above the clouds; and down past them to under their bases and up again.
    rays[i].from.z = 20e3;
    const double radius = clouds.medium->earth().radiusM(),
                 deepest = clouds.medium->grid()->lowM() * static_cast<double>(i) / 1e3,
                 share = (radius + deepest) / (radius + 20e3), down = -std::sqrt(1.0 - share * share);
    if (i % 2 == 0) rays[i].way = {std::sqrt(1.0 - down * down), 0.0, down};
  }
  int empty = 0, twice = 0;
  for (std::size_t first = 0; first < rays.size(); first += 50) {
    RayPieces pieces{};
    for (std::size_t k = 0; k < 50; ++k) {
      const Ray& ray = rays[first + k];
      pieces.end[k] = k % 4 == 0 ? 1e3 * static_cast<double>(k) : CloudMedium::kToGround;
      pieces.start[k] = 100.0 * static_cast<double>(k);
      pieces.length[k] = 2000.0f - 30.0f * static_cast<float>(k);
      pieces.add(k, ray);
    }
    findStretches(*clouds.medium, pieces);
    layLines(clouds.medium->earth(), pieces);
    for (std::size_t k = 0; k < pieces.count; ++k) {
      const Ray& ray = rays[first + k];
      const CloudMedium::Stretches stretches = clouds.medium->stretches(ray, pieces.end[k]);
      for (std::size_t s = 0; s < 2; ++s) {
        const bool any = stretches[s][0] < stretches[s][1];
        ASSERT_EQ(pieces.starts[s][k] < pieces.ends[s][k], any) << first + k;
        empty += !any;
        twice += any && s == 1;
        if (!any) continue;
        EXPECT_DOUBLE_EQ(pieces.starts[s][k], stretches[s][0]);
        EXPECT_DOUBLE_EQ(pieces.ends[s][k], stretches[s][1]);
      }
      const CloudLine line = clouds.medium->lineFrom(ray, pieces.start[k], pieces.length[k]);
      EXPECT_EQ(pieces.lane[k], k);
      EXPECT_EQ(glm::vec3(pieces.place.x[k], pieces.place.y[k], pieces.place.z[k]), line.from);
      EXPECT_EQ(glm::vec3(pieces.slope.x[k], pieces.slope.y[k], pieces.slope.z[k]), line.slope);
      EXPECT_EQ(glm::vec3(pieces.inverse.x[k], pieces.inverse.y[k], pieces.inverse.z[k]), line.inverse);
    }
  }
  EXPECT_GT(empty, 100);
  EXPECT_GT(twice, 20);
}

TEST(CloudDensity, OfManyPointsIsThatOfEach) {
  const Clouds clouds(stormySky());
  const CloudDensity density(*clouds.state.clouds);
  for (std::size_t layer = 0; layer < clouds.state.clouds->layers().size(); ++layer) {
    const field::CloudLayer& l = clouds.state.clouds->layers()[layer];
    Random random(layer);
    std::vector<glm::vec3> points;
    for (int i = 0; i < 20'001; ++i)  // no whole number of vectors
      points.push_back(
          glm::vec3(glm::dvec3{80e3 * (unit(random) - 0.5), 80e3 * (unit(random) - 0.5),
                               static_cast<double>(l.baseM) - 50.0 +
                                   (static_cast<double>(l.topM - l.baseM) + 100.0) * unit(random)}));
    std::vector<float> many(points.size());
    density.extinctions(layer, points, many.data());
    int cloudy = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float one = density.extinction(layer, points[i]);
      ASSERT_NEAR(many[i], one, 2e-3f * l.extinction) << "layer " << layer;
      cloudy += one > 0.0f;
    }
    EXPECT_GT(cloudy, 200) << "layer " << layer;
  }
}

// Beer's law on each of many rays, and what they meet, against one ray at a time.
TEST(CloudWalks, FindWhatOneRayFindsByItself) {
  const Clouds clouds(stormySky());
  const double end = 20e3;
  constexpr int kPaths = 300;
  // A ray that meets a wisp once in a while is no mistake.
  constexpr double kOnce = 3.0 / kPaths;
  int partial = 0, outside = 0;
  std::map<CloudMedium::Matter, double> met, metAlone;
  double metError = 0.0, difference = 0.0, variance = 0.0;
  Random chance(6);
  for (const Ray& ray : someRays(200)) {
    const std::vector<Ray> rays(kPaths, ray);
    const std::vector<Found> passed = walked(*clouds.medium, rays, true, end, CloudWalks::kLanes),
                             through = walked(*clouds.medium, rays, false, end, CloudWalks::kLanes);
    double a = 0.0, a2 = 0.0, b = 0.0, b2 = 0.0, free = 0.0, alone = 0.0, far = 0.0, farAlone = 0.0,
           far2 = 0.0;
    for (std::size_t i = 0; i < kPaths; ++i) {
      const double t = through[i].transmittance, s = clouds.medium->transmittance(ray, end, chance);
      a += t / kPaths, a2 += t * t / kPaths, b += s / kPaths, b2 += s * s / kPaths;
      const auto mine = passed[i].collision, other = clouds.medium->collide(ray, end, chance);
      free += mine ? 0.0 : 1.0 / kPaths;
      alone += other ? 0.0 : 1.0 / kPaths;
      if (mine) {
        ASSERT_GE(mine->t, 0.0);
        ASSERT_LT(mine->t, end);
        outside += clouds.medium->extinction(ray.at(mine->t)) > 0.0 ? 0 : 1;
        met[mine->matter] += 1.0;
        far += std::exp(-mine->t / 3e3) / kPaths, far2 += std::exp(-mine->t / 1.5e3) / kPaths;
      }
      if (other) metAlone[other->matter] += 1.0, farAlone += std::exp(-other->t / 3e3) / kPaths;
    }
    const double error = std::sqrt(std::max(a2 - a * a + b2 - b * b, 0.0) / kPaths);
    EXPECT_NEAR(a, b, 4.5 * error + kOnce);
    difference += a - b;
    variance += error * error;
    EXPECT_NEAR(free, b, 4.5 * std::sqrt(std::max(b * (1.0 - b), 0.0) / kPaths + error * error) + kOnce);
    EXPECT_NEAR(far, farAlone, 6.5 * std::sqrt(far2 / kPaths) + kOnce);
    partial += b > 0.05 && b < 0.95;
    metError += 2.0 * kPaths * alone * (1.0 - alone);
  }
  EXPECT_NEAR(difference, 0.0, 4.0 * std::sqrt(variance));
  EXPECT_GE(partial, 6);
  // Some are in the last thousandth of an edge, by noises of 16 bits.
  EXPECT_LT(outside, 5e-4 * met[CloudMedium::Matter::kDroplets]);
  for (const CloudMedium::Matter matter :
       {CloudMedium::Matter::kDroplets, CloudMedium::Matter::kIce, CloudMedium::Matter::kRain}) {
    EXPECT_GT(metAlone[matter], 100.0);
    EXPECT_NEAR(met[matter], metAlone[matter], 5.0 * std::sqrt(metError + 2.0 * metAlone[matter]));
  }
}

TEST(CloudWalks, DoNotDependOnEachOther) {
  const Clouds clouds(stormySky());
  const std::vector<Ray> rays = someRays(3000);
  for (const bool collide : {true, false}) {
    const std::vector<Found> many = walked(*clouds.medium, rays, collide, CloudMedium::kToGround,
                                           CloudWalks::kLanes),
                             few = walked(*clouds.medium, rays, collide, CloudMedium::kToGround, 5);
    int met = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(many[i].transmittance, few[i].transmittance) << i;
      ASSERT_EQ(many[i].collision.has_value(), few[i].collision.has_value()) << i;
      if (!many[i].collision) continue;
      ASSERT_EQ(many[i].collision->t, few[i].collision->t) << i;
      ASSERT_EQ(many[i].collision->matter, few[i].collision->matter) << i;
      ++met;
    }
    EXPECT_EQ(met > 500, collide);
  }
}

// But for the last bits of logarithms, by which a decision turns now and then.
TEST(CloudWalks, AreTheSameOnEveryInstructionSet) {
  const Clouds clouds(stormySky());
  const std::vector<Ray> rays = someRays(1500);
  const auto all = [&] {
    std::vector<Found> found = walked(*clouds.medium, rays, true, CloudMedium::kToGround, CloudWalks::kLanes);
    const std::vector<Found> through =
        walked(*clouds.medium, rays, false, CloudMedium::kToGround, CloudWalks::kLanes);
    found.insert(found.end(), through.begin(), through.end());
    return found;
  };
  const std::vector<Found> best = all();
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    const std::vector<Found> found = all();
    hwy::SetSupportedTargetsForTest(0);
    int other = 0;
    for (std::size_t i = 0; i < best.size(); ++i) {
      const auto &a = best[i].collision, &b = found[i].collision;
      other += std::abs(best[i].transmittance - found[i].transmittance) > 1e-4 ||
               a.has_value() != b.has_value() ||
               (a && b && (std::abs(a->t - b->t) > 0.1 || a->matter != b->matter));
    }
    EXPECT_LT(other, 30) << hwy::TargetName(target);
  }
}

TEST(CloudWalks, EndAtOnceWhereThereIsNoCloud) {
  const Clouds clouds(scene::buildSky(testing::clearScene(40.0), 0.0));
  const CloudMedium none(*clouds.state.clouds, {}, {});
  CloudWalks walks(none);
  Random random(1);
  walks.collide(0, {{0.0, 0.0, 2.0}, {0.0, 0.0, 1.0}}, CloudMedium::kToGround, random);
  walks.transmit(3, {{0.0, 0.0, 2.0}, {0.0, 0.0, 1.0}}, CloudMedium::kToGround, random);
  EXPECT_EQ(walks.run(), 0b1001u);
  EXPECT_FALSE(walks.collision(0));
  EXPECT_EQ(walks.transmittance(3), 1.0);
  EXPECT_EQ(walks.run(), 0u);
}

// A path is the same to the bit among others and alone.
TEST(SkyTracer, PathsDoNotDependOnEachOther) {
  const SkyTracer tracer(stormySky(), {});
  std::vector<glm::dvec3> ways;
  Random random(3);
  for (int i = 0; i < 150; ++i)
    ways.push_back(
        glm::normalize(glm::dvec3{unit(random) - 0.5, unit(random) - 0.5, 0.05 + 0.4 * unit(random)}));
  const std::vector<SkySample> together = testing::traced(tracer, ways);
  std::uint32_t events = 0;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    std::vector<SkySample> alone(1);
    tracer.traceDirections({&ways[i], 1}, i, alone);
    ASSERT_EQ(alone[0].luminance, together[i].luminance) << i;
    ASSERT_EQ(alone[0].events, together[i].events) << i;
    events += alone[0].events;
  }
  EXPECT_GT(events, 1000u);
}

}  // namespace
}  // namespace welkin::reference
