// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "welkin/core/params.h"

namespace welkin {
namespace {

TEST(NearestName, FindsWhatWasMeant) {
  const std::vector<std::string> names = {"visibility_m", "seed", "time", "ground", "camera"};
  EXPECT_EQ(nearestName("visiblity_m", names), "visibility_m");  // a letter lost
  EXPECT_EQ(nearestName("sede", names), "seed");                 // neighbours swapped
  EXPECT_EQ(nearestName("cameras", names), "camera");            // a letter too many
  EXPECT_EQ(nearestName("tine", names), "time");                 // a wrong letter
  EXPECT_EQ(nearestName("seed", names), "seed");
}

TEST(NearestName, SaysNothingWhenNothingIsNear) {
  const std::vector<std::string> names = {"visibility_m", "seed"};
  EXPECT_EQ(nearestName("albedo", names), "");
  EXPECT_EQ(nearestName("xyz", std::vector<std::string>{}), "");
}

}  // namespace
}  // namespace welkin
