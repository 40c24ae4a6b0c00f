// SPDX-License-Identifier: Apache-2.0
#include "welkin/core/random.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <set>

namespace welkin {
namespace {

// The sequence of the reference implementation (S. Vigna, splitmix64.c) from state 1234567.
TEST(Random, IsSplitMix64) {
  Random r(1234567);
  EXPECT_EQ(r.next(), 6457827717110365317ULL);
  EXPECT_EQ(r.next(), 3203168211198807973ULL);
  EXPECT_EQ(r.next(), 9817491932198370423ULL);
}

TEST(Random, FlippingOneBitFlipsHalf) {
  double flipped = 0;
  for (int bit = 0; bit < 64; ++bit) {
    for (std::uint64_t x = 0; x < 100; ++x) {
      flipped += std::popcount(hashOf(x) ^ hashOf(x ^ (1ULL << bit)));
    }
  }
  EXPECT_NEAR(flipped / 6400, 32.0, 0.5);
}

TEST(Random, HashDependsOnOrder) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t a = 0; a < 50; ++a) {
    for (std::uint64_t b = 0; b < 50; ++b) seen.insert(hashOf(a, b));
  }
  EXPECT_EQ(seen.size(), 2500u);
  static_assert(hashOf(1, 2, 3) != hashOf(3, 2, 1));
}

TEST(Random, UniformIsInRangeAndFlat) {
  Random r(1);
  std::array<int, 10> bins{};
  double sum = 0;
  for (int i = 0; i < 100000; ++i) {
    const float x = r.uniform();
    ASSERT_GE(x, 0.0f);
    ASSERT_LT(x, 1.0f);
    sum += x;
    ++bins[static_cast<std::size_t>(x * 10)];
  }
  EXPECT_NEAR(sum / 100000, 0.5, 0.004);
  for (int n : bins) EXPECT_NEAR(n, 10000, 400);
  EXPECT_LT(unitFloat(~0ULL), 1.0f);
}

TEST(Random, BelowCoversItsRange) {
  Random r(2);
  std::array<int, 7> bins{};
  for (int i = 0; i < 70000; ++i) ++bins[r.below(7)];
  for (int n : bins) EXPECT_NEAR(n, 10000, 400);
  EXPECT_EQ(r.below(1), 0u);
}

}  // namespace
}  // namespace welkin
