// SPDX-License-Identifier: Apache-2.0
#include "welkin/core/utc_time.h"

#include <gtest/gtest.h>

#include "welkin/core/error.h"

namespace welkin {
namespace {

TEST(UtcTime, ReadsTheFormsOfIso8601) {
  const UtcTime expected{2026, 6, 21, 18, 30, 0};
  for (const char* text :
       {"2026-06-21T18:30:00Z", "2026-06-21T18:30Z", "2026-06-21 18:30:00", "2026-06-21T18:30",
        "2026-06-21T20:30:00+02:00", "2026-06-21T13:00:00-05:30", "2026-06-21T18:30:00.000Z"}) {
    EXPECT_EQ(parseUtcTime(text), expected) << text;
  }
  EXPECT_DOUBLE_EQ(parseUtcTime("2026-06-21 18:30:05.25Z").second, 5.25);
}

TEST(UtcTime, OffsetsCrossDaysAndYears) {
  EXPECT_EQ(parseUtcTime("2026-01-01T01:00:00+02:00"), (UtcTime{2025, 12, 31, 23, 0, 0}));
  EXPECT_EQ(parseUtcTime("2024-02-28T23:00:00-02:00"), (UtcTime{2024, 2, 29, 1, 0, 0}));
}

TEST(UtcTime, RejectsWithTheColumn) {
  struct Case {
    const char* text;
    int column;
  };
  for (const Case& c :
       {Case{"", 1}, Case{"soon", 1}, Case{"2026", 5}, Case{"2026-13-01T00:00Z", 6},
        Case{"2026-02-29T00:00Z", 9}, Case{"2026-06-21", 11}, Case{"2026-06-21T24:00Z", 12},
        Case{"2026-06-21T12:60Z", 15}, Case{"2026-06-21T12:00:60Z", 18}, Case{"2026-06-21T12:00:00.Z", 21},
        Case{"2026-06-21T12:00:00ZZ", 21}, Case{"2026-06-21T12:00:00+2", 22},
        Case{"2026-06-21T12:00:00 Z", 20}, Case{"1899-12-31T00:00Z", 1}, Case{"2100-12-31T23:00-02:00", 17},
        Case{" 2026-06-21T12:00Z", 1}}) {
    try {
      parseUtcTime(c.text);
      FAIL() << "accepted " << c.text;
    } catch (const ParseError& e) {
      EXPECT_EQ(e.column(), c.column) << c.text << ": " << e.what();
    }
  }
}

TEST(UtcTime, FormatsAndReadsBack) {
  EXPECT_EQ(formatUtcTime({2026, 6, 21, 18, 30, 0}), "2026-06-21T18:30:00Z");
  EXPECT_EQ(formatUtcTime({2026, 6, 21, 18, 30, 5.25}), "2026-06-21T18:30:05.25Z");
  EXPECT_EQ(formatUtcTime({2026, 6, 21, 18, 30, 0.1}), "2026-06-21T18:30:00.1Z");
  EXPECT_EQ(formatUtcTime({2026, 6, 21, 18, 30, 59.9999999}), "2026-06-21T18:30:59.999999Z");
  for (const char* text : {"1900-01-01T00:00:00Z", "2000-02-29T23:59:59.5Z", "2100-12-31T23:59:59Z"}) {
    EXPECT_EQ(formatUtcTime(parseUtcTime(text)), text);
  }
}

TEST(UtcTime, AddsSeconds) {
  const UtcTime t{2023, 12, 31, 23, 59, 59.5};
  EXPECT_EQ(addSeconds(t, 0.5), (UtcTime{2024, 1, 1, 0, 0, 0}));
  EXPECT_EQ(addSeconds(t, 0.0), t);
  EXPECT_EQ(addSeconds({2024, 3, 1, 0, 0, 0}, -86400.0), (UtcTime{2024, 2, 29, 0, 0, 0}));
  EXPECT_EQ(addSeconds({2023, 3, 1, 0, 0, 0}, -1.0), (UtcTime{2023, 2, 28, 23, 59, 59}));
  EXPECT_EQ(addSeconds({2000, 1, 1, 0, 0, 0}, 36525 * 86400.0), (UtcTime{2100, 1, 1, 0, 0, 0}));
}

TEST(UtcTime, SecondsBetweenIsTheInverse) {
  const UtcTime a{1969, 7, 20, 20, 17, 40};
  for (double s : {0.0, 1.0, -1.0, 86399.0, 1e6 + 0.25, -3e8, 1.5e9}) {
    EXPECT_DOUBLE_EQ(secondsBetween(a, addSeconds(a, s)), s);
  }
  EXPECT_DOUBLE_EQ(secondsBetween({1970, 1, 1, 0, 0, 0}, {2001, 9, 9, 1, 46, 40}), 1e9);
}

}  // namespace
}  // namespace welkin
