// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/frame_path.h"

#include <gtest/gtest.h>

#include "scratch.h"

namespace welkin::io {
namespace {

TEST(FramePattern, PutsTheNumberIn) {
  EXPECT_EQ(FramePattern("sky_%04d.png").path(7), "sky_0007.png");
  EXPECT_EQ(FramePattern("sky_%04d.png").path(123456), "sky_123456.png");
  EXPECT_EQ(FramePattern("out/%d.exr").path(0), "out/0.exr");
  EXPECT_EQ(FramePattern("%010d").path(42), "0000000042");
  EXPECT_EQ(FramePattern("50%%_%02d%%.png").path(3), "50%_03%.png");
}

TEST(FramePattern, RefusesAllElse) {
  for (const char* bad : {"sky.png", "sky%%.png", "%d_%d.png", "%s.png", "%4d.png", "%0d.png", "%", "%04",
                          "%04x.png", "%-4d.png", "%099999999999999999999d.png", "%d%n"})
    EXPECT_NE(messageOf<ParameterError>([&] { FramePattern pattern(bad); }).find("name_%04d.png"),
              std::string::npos)
        << bad;
}

TEST(FramePattern, IsLookedForInTheNameOnly) {
  EXPECT_TRUE(isFramePattern("sky_%04d.png"));
  EXPECT_TRUE(isFramePattern("a/b_%d.png"));
  EXPECT_TRUE(isFramePattern("b_%q.png"));  // to be refused with a reason
  EXPECT_FALSE(isFramePattern("50%/b.png"));
  EXPECT_FALSE(isFramePattern("b.png"));
}

}  // namespace
}  // namespace welkin::io
