// SPDX-License-Identifier: Apache-2.0
// The names of numbered frames: "sky_%04d.png" and the number 7 make "sky_0007.png".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace welkin::io {

class FramePattern {
 public:
  // Exactly one %d, or %0Nd with N from 1 to 18; %% is a percent sign. Throws ParameterError that says what
  // is wrong.
  explicit FramePattern(std::string_view pattern);

  // number >= 0
  std::string path(std::int64_t number) const;

 private:
  std::string before_, after_;
  std::size_t digits_ = 0;  // at least so many, with leading zeros
};

// True if there is a percent sign in the file's name (not its folder): then FramePattern is to judge it.
bool isFramePattern(std::string_view path);

}  // namespace welkin::io
