// SPDX-License-Identifier: Apache-2.0
#include "welkin/core/image.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace welkin {
namespace {

TEST(Image, ChannelsThenXThenY) {
  Image<int> image(3, 2, 4);
  EXPECT_EQ(image.data.size(), 24u);
  EXPECT_TRUE(std::all_of(image.data.begin(), image.data.end(), [](int v) { return v == 0; }));
  EXPECT_EQ(image.index(0, 0, 1), 1u);
  EXPECT_EQ(image.index(1, 0), 4u);
  EXPECT_EQ(image.index(0, 1), 12u);
  image.at(2, 1, 3) = 7;
  EXPECT_EQ(image.data.back(), 7);
}

TEST(Volume, ChannelsThenXThenYThenZ) {
  Volume<int> volume(2, 3, 4, 1);
  EXPECT_EQ(volume.data.size(), 24u);
  EXPECT_EQ(volume.index(1, 0, 0), 1u);
  EXPECT_EQ(volume.index(0, 1, 0), 2u);
  EXPECT_EQ(volume.index(0, 0, 1), 6u);
}

}  // namespace
}  // namespace welkin
