// SPDX-License-Identifier: Apache-2.0
#include "welkin/weather/cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace welkin::weather {
namespace {

constexpr auto kFew = MetarCover::kFew;
constexpr auto kSct = MetarCover::kScattered;
constexpr auto kBkn = MetarCover::kBroken;
constexpr auto kOvc = MetarCover::kOvercast;

// Totals after each layer, put together again from the layers' own covers by random overlap.
std::vector<double> totals(const std::vector<MetarCover>& covers) {
  std::vector<double> result;
  double clear = 1.0;
  for (const double own : stackCover(covers).ownOktas) {
    clear *= 1.0 - own / 8.0;
    result.push_back(8.0 * (1.0 - clear));
  }
  return result;
}

void expectTotals(const std::vector<MetarCover>& covers, const std::vector<double>& wanted) {
  const auto got = totals(covers);
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], wanted[i], 1e-9) << "layer " << i;
  EXPECT_NEAR(stackCover(covers).totalOktas, wanted.empty() ? 0.0 : wanted.back(), 1e-9);
}

TEST(Cover, NoLayersNoCover) {
  expectTotals({}, {});
}

TEST(Cover, OneLayerTakesTheMiddleOfItsCategory) {
  expectTotals({kFew}, {1.5});
  expectTotals({kSct}, {3.5});
  expectTotals({kBkn}, {6.0});
  expectTotals({kOvc}, {8.0});
}

TEST(Cover, OneCategoryTwiceSpreadsOverItsRange) {
  expectTotals({kFew, kFew}, {1.0, 2.0});
  expectTotals({kSct, kSct}, {3.0, 4.0});
  expectTotals({kBkn, kBkn}, {5.0, 7.0});
  expectTotals({kBkn, kBkn, kBkn}, {5.0, 6.0, 7.0});
}

TEST(Cover, AmountsAreCumulative) {
  expectTotals({kFew, kSct, kBkn}, {1.5, 3.5, 6.0});
  expectTotals({kSct, kSct, kOvc}, {3.0, 4.0, 8.0});
  // The arithmetic by hand: (6 - 3.5) / (8 - 3.5) of the sky.
  EXPECT_NEAR(stackCover(std::vector{kSct, kBkn}).ownOktas[1], 8.0 * 2.5 / 4.5, 1e-12);
}

TEST(Cover, AnAmountNoLargerThanWhatIsBeneathKeepsTheCategory) {
  expectTotals({kSct, kFew}, {3.5, 4.0});
  const auto full = stackCover(std::vector{kBkn, kBkn, kFew});
  EXPECT_GT(full.ownOktas[2], 0.5) << "seen through the last gap it must be something";
  EXPECT_LT(full.totalOktas, 7.5) << "and still be reported as broken";
  EXPECT_GT(full.totalOktas, 7.0);
  // The layer out of order does not take part in spreading the category of those in order.
  expectTotals({kFew, kSct, kFew}, {1.5, 3.5, 4.0});
}

TEST(Cover, AboveAnOvercastNothingCanBeSeen) {
  const auto stack = stackCover(std::vector{kOvc, kBkn, kOvc});
  EXPECT_EQ(stack.ownOktas, (std::vector{8.0, 6.0, 8.0}));
  EXPECT_EQ(stack.totalOktas, 8.0);
}

TEST(Cover, EveryStackOfUpToFiveLayersIsPossible) {
  const MetarCover all[] = {kFew, kSct, kBkn, kOvc};
  for (int code = 0; code < 4 * 4 * 4 * 4 * 4; ++code) {
    std::vector<MetarCover> covers;
    for (int i = 0, rest = code; i < 5; ++i, rest /= 4) covers.push_back(all[rest % 4]);
    const auto stack = stackCover(covers);
    ASSERT_EQ(stack.ownOktas.size(), 5u);
    for (const double own : stack.ownOktas) ASSERT_TRUE(own > 0.0 && own <= 8.0);
    ASSERT_LE(stack.totalOktas, 8.0);
    // The whole is in the category of the largest amount, give or take what an observer cannot tell.
    const MetarCover largest = *std::max_element(covers.begin(), covers.end());
    const double most[] = {2.0, 4.0, 7.0, 8.0};
    ASSERT_GE(stack.totalOktas, middleOktas(largest) - 1.0);
    ASSERT_LT(stack.totalOktas, most[static_cast<int>(largest)] + 0.5);
  }
}

TEST(Cover, TwoCoversTogether) {
  EXPECT_DOUBLE_EQ(combinedOktas(0.0, 3.0), 3.0);
  EXPECT_DOUBLE_EQ(combinedOktas(4.0, 4.0), 6.0);
  EXPECT_DOUBLE_EQ(combinedOktas(8.0, 1.0), 8.0);
}

}  // namespace
}  // namespace welkin::weather
