// SPDX-License-Identifier: Apache-2.0
#include "welkin/field/ellipsoid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "welkin/core/error.h"
#include "welkin/core/random.h"
#include "welkin/field/cumulus_tower.h"

namespace welkin::field {
namespace {

TEST(Ellipsoid, QIsOneAtTheCentreAndZeroOnTheSurface) {
  const Ellipsoid e{{10, -20, 30}, {5, 2, 1}, {30, -50, 110}};
  const EllipsoidForm form(e);
  const glm::dquat turn = frameFromEllipsoid(e);
  EXPECT_DOUBLE_EQ(form.q(e.centreM), 1.0);
  EXPECT_NEAR(form.q(e.centreM + turn * glm::dvec3(5, 0, 0)), 0.0, 1e-12);
  EXPECT_NEAR(form.q(e.centreM + turn * glm::dvec3(0, 2, 0)), 0.0, 1e-12);
  EXPECT_NEAR(form.q(e.centreM + turn * glm::dvec3(0, 0, -1)), 0.0, 1e-12);
  EXPECT_NEAR(form.q(e.centreM + turn * glm::dvec3(2.5, 0, 0)), 0.75, 1e-12);
}

// About x first: z goes to -y, which the turn about z then takes to +x.
TEST(Ellipsoid, TurnsAboutFixedAxesInOrder) {
  const glm::dquat turn = frameFromEllipsoid({{}, {1, 1, 1}, {90, 0, 90}});
  const glm::dvec3 v = turn * glm::dvec3(0, 0, 1);
  EXPECT_NEAR(v.x, 1.0, 1e-12);
  EXPECT_NEAR(v.y, 0.0, 1e-12);
  EXPECT_NEAR(v.z, 0.0, 1e-12);
}

TEST(Ellipsoid, AnglesAndQuaternionsAgree) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    glm::dvec3 deg(random.uniform() * 360 - 180, random.uniform() * 180 - 90, random.uniform() * 360 - 180);
    if (i % 10 == 0) deg.y = i % 20 == 0 ? 90 : -90;
    const glm::dquat turn = frameFromEllipsoid({{}, {1, 1, 1}, deg});
    const glm::dquat again = frameFromEllipsoid({{}, {1, 1, 1}, rotationDegOf(turn)});
    EXPECT_NEAR(std::abs(glm::dot(turn, again)), 1.0, 1e-9) << deg.x << " " << deg.y << " " << deg.z;
  }
}

TEST(Ellipsoid, LineAndExtentAgreeWithTheForm) {
  const EllipsoidForm form({{1, 2, 3}, {4, 1, 2}, {20, 40, 60}});
  for (const double y : {1.5, 2.5})
    for (const double z : {2.0, 3.3})
      for (const double x : {-1.0, 0.5, 3.0}) {
        const EllipsoidForm::Line line = form.alongX(y, z);
        const double d = x - line.xMiddle;
        EXPECT_NEAR(1.0 - line.nearest - line.curvature * d * d, form.q({x, y, z}), 1e-12);
      }
  double farthest = -1e9;
  for (int i = 0; i <= 400; ++i)
    for (int j = 0; j <= 400; ++j) {
      const double y = 2.0 - 4.5 + 9.0 * i / 400, z = 3.0 - 4.5 + 9.0 * j / 400;
      const EllipsoidForm::Line line = form.alongX(y, z);
      if (line.nearest < 1.0)
        farthest = std::max(farthest, line.xMiddle + std::sqrt((1.0 - line.nearest) / line.curvature));
    }
  EXPECT_NEAR(farthest, 1.0 + form.extentM().x, 0.001);
}

TEST(CumulusTower, HasTheSizeAskedFor) {
  for (const std::int64_t seed : {0, 1, 2, 3})
    for (const double height : {300.0, 1000.0, 4000.0}) {
      const CumulusParams p{.seed = seed, .widthM = 1500, .heightM = height, .lean = 0.2};
      const std::vector<Ellipsoid> tower = cumulusTower(p);
      const Box box = boundsOf(tower);
      EXPECT_NEAR(box.low.x, -750, 1e-6);
      EXPECT_NEAR(box.high.x, 750, 1e-6);
      EXPECT_NEAR(box.high.y - box.low.y, 1500, 1e-6);
      EXPECT_NEAR(box.high.z, height, 1e-6);
      EXPECT_GT(tower.size(), 50u);
      EXPECT_LT(tower.size(), 2000u);
    }
}

TEST(CumulusTower, IsAFunctionOfItsSeed) {
  const auto a = cumulusTower({.seed = 4}), b = cumulusTower({.seed = 4}), c = cumulusTower({.seed = 5});
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].centreM, b[i].centreM);
    EXPECT_EQ(a[i].radiiM, b[i].radiiM);
  }
  EXPECT_NE(a[0].centreM, c[0].centreM);
}

// Each generation adds bubbles, which are smaller than those of the one before.
TEST(CumulusTower, IsSelfSimilar) {
  std::size_t before = 0;
  double smallest = 1e9;
  for (std::int64_t generations = 1; generations <= 4; ++generations) {
    const auto tower = cumulusTower({.generations = generations});
    EXPECT_GT(tower.size(), before);
    double now = 1e9;
    for (const Ellipsoid& e : tower) now = std::min(now, e.radiiM.x);
    EXPECT_LT(now, smallest);
    before = tower.size(), smallest = now;
  }
}

// It stands in its box with nothing cut off but below the base, in one piece and mostly full.
TEST(CumulusTower, FillsItsMap) {
  const CumulusParams p;
  const CloudMapParams params = cumulusMap(p, 40);
  const Volume<float> map = cloudMap(params, cumulusTower(p));
  EXPECT_GE(map.nx * 40, 1200);
  EXPECT_GE(map.nz * 40, 1000);
  int sides = 0, cloud = 0, base = 0;
  for (int z = 0; z < map.nz; ++z)
    for (int y = 0; y < map.ny; ++y)
      for (int x = 0; x < map.nx; ++x) {
        if (map.at(x, y, z) <= 0) continue;
        ++cloud;
        base += z == 0;
        sides += x == 0 || y == 0 || x == map.nx - 1 || y == map.ny - 1 || z == map.nz - 1;
      }
  EXPECT_EQ(sides, 0);
  EXPECT_GT(base, 200);
  EXPECT_GT(cloud, map.nx * map.ny * map.nz / 10);
}

TEST(CumulusTower, RefusesTooMany) {
  EXPECT_THROW(cumulusTower({.bubbles = 64, .generations = 6, .children = 64}), ParameterError);
}

}  // namespace
}  // namespace welkin::field
