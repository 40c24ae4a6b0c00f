// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/ellipsoid_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "welkin/core/error.h"

namespace welkin::scene {
namespace {

class EllipsoidFileTest : public ::testing::Test {
 protected:
  std::string write(const std::string& text) const {
    std::ofstream(path_) << text;
    return path_;
  }
  void refuse(const std::string& text, const std::string& message) const {
    try {
      readEllipsoids(write(text));
      ADD_FAILURE() << "accepted: " << text;
    } catch (const ParseError& e) {
      EXPECT_EQ(std::string(e.what()), path_ + message);
    }
  }
  void TearDown() override { std::filesystem::remove(path_); }
  std::string path_ = ::testing::TempDir() + "welkin_ellipsoids_" +
                      ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml";
};

TEST_F(EllipsoidFileTest, ReadsAll) {
  const auto ellipsoids = readEllipsoids(
      write("[[ellipsoid]]\ncentre_m = [1, 2.5, 3]\nradii_m = [4, 5, 6]\nrotation_deg = [10, -20, 30]\n"
            "[[ellipsoid]]\n"));
  ASSERT_EQ(ellipsoids.size(), 2u);
  EXPECT_EQ(ellipsoids[0].centreM, glm::dvec3(1, 2.5, 3));
  EXPECT_EQ(ellipsoids[0].radiiM, glm::dvec3(4, 5, 6));
  EXPECT_EQ(ellipsoids[0].rotationDeg, glm::dvec3(10, -20, 30));
  EXPECT_EQ(ellipsoids[1].radiiM, field::Ellipsoid{}.radiiM);
}

TEST_F(EllipsoidFileTest, MistakesHaveAPlace) {
  refuse("", ": has no [[ellipsoid]]; expected at least one");
  refuse("[[ellipsoid]]\nradius = 4\n",
         ":2:1: unknown key \"radius\" in [[ellipsoid]]; did you mean \"radii_m\"?");
  refuse("[[ellipsoid]]\nradii_m = [1, 2]\n",
         ":2:11: radii_m: expected a list of three numbers, found a list");
  refuse("[[ellipsoid]]\nradii_m = [1, 2, 0]\n", ":2:18: radii_m is 0; expected 0.01 to 1000000 m");
  refuse("[[ellipsoid]]\ncentre_m = [1, nan, 0]\n", ":2:16: centre_m is nan; expected -1000000 to 1000000 m");
  EXPECT_THROW(readEllipsoids("/nonexistent/e.toml"), IoError);
}

}  // namespace
}  // namespace welkin::scene
