// SPDX-License-Identifier: Apache-2.0
#include "welkin/core/param_range.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace welkin {
namespace {

struct Inner {
  double share = 0.5;
};
void describe(Inner& p, ParamVisitor& v) {
  v.value({"share", "", "of the whole", 0, 1}, p.share);
}

struct Outer {
  std::int64_t count = 3;
  glm::dvec3 colour{0.5};
  std::optional<double> height;
  Inner inner;
  std::vector<Inner> several = std::vector<Inner>(2);
};
void describe(Outer& p, ParamVisitor& v) {
  v.value({"count", "", "how many", 1, 24}, p.count);
  v.value({"colour", "", "red, green, blue", 0, 1}, p.colour);
  v.value({"height_m", "m", "absent: any", 0, 100}, p.height);
  v.group({"inner", "", "a group"}, p.inner);
  v.list({"several", "", "a list"}, p.several);
}

TEST(NumberText, ReadsBackAsTheSameNumber) {
  for (const double x : {0.1, 1e-9, 40000.0, 1.0 / 3.0, -8.55, 1e22, 9007199254740991.0, 0.05})
    EXPECT_EQ(std::stod(numberText(x)), x) << numberText(x);
  EXPECT_EQ(numberText(100000.0), "100000");
  EXPECT_EQ(numberText(-0.25), "-0.25");
}

TEST(RangeProblem, NamesRangeAndUnit) {
  const ParamInfo latitude{"latitude_deg", "deg", "", -90, 90};
  EXPECT_EQ(rangeProblem(latitude, 95), "latitude_deg is 95; expected -90 to 90 deg");
  EXPECT_EQ(rangeProblem(latitude, 90), "");
  EXPECT_EQ(rangeProblem(latitude, -90), "");
  EXPECT_NE(rangeProblem(latitude, std::nan("")), "");
  const ParamInfo any{"x", "", ""};
  EXPECT_EQ(rangeProblem(any, 1e300), "");
  EXPECT_EQ(rangeProblem(any, std::numeric_limits<double>::infinity()), "x is inf; expected a finite number");
  EXPECT_EQ(rangeText(ParamInfo{"x", "m", "", 0}), "at least 0 m");
}

TEST(RangeProblem, NamesTheFirstOfAStruct) {
  const auto problemWith = [](auto change) {
    Outer p;
    change(p);
    return rangeProblemIn(p);
  };
  EXPECT_EQ(problemWith([](Outer&) {}), "");
  EXPECT_EQ(problemWith([](Outer& p) { p.count = 25; }), "count is 25; expected 1 to 24");
  EXPECT_EQ(problemWith([](Outer& p) { p.count = 0, p.inner.share = 2.0; }), "count is 0; expected 1 to 24");
  EXPECT_EQ(problemWith([](Outer& p) { p.colour.z = -0.5; }), "colour is -0.5; expected 0 to 1");
  EXPECT_EQ(problemWith([](Outer& p) { p.height = 101.0; }), "height_m is 101; expected 0 to 100 m");
  EXPECT_EQ(problemWith([](Outer& p) { p.inner.share = 1.5; }), "share is 1.5; expected 0 to 1");
  EXPECT_EQ(problemWith([](Outer& p) { p.several[1].share = std::nan(""); }),
            "share is nan; expected 0 to 1");
}

}  // namespace
}  // namespace welkin
