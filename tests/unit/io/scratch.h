// SPDX-License-Identifier: Apache-2.0
// What the tests of io share: a folder of their own, and other programs' opinions.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/testing/scratch_folder.h"
#include "welkin/core/error.h"

namespace welkin::io {

class Scratch : public ::testing::Test {
 private:
  welkin::testing::ScratchFolder scratch_;

 protected:
  int fileCount() const {
    int n = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++n;
    return n;
  }

  const std::filesystem::path folder = scratch_.path();
};

inline std::string contents(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

// What a command of the shell prints; a failure of the test unless it ends well.
inline std::string outputOf(const std::string& command) {
  std::string text;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  EXPECT_EQ(pclose(pipe), 0) << command << "\n" << text;
  return text;
}

// The message of the E that f throws; a failure of the test if it does not.
template <class E, class F>
std::string messageOf(F f) {
  try {
    f();
  } catch (const E& e) {
    return e.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

}  // namespace welkin::io
