// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/frame_path.h"

#include <cassert>

#include "welkin/core/error.h"

namespace welkin::io {

FramePattern::FramePattern(std::string_view pattern) {
  const auto fail = [&](const char* why) {
    throw ParameterError(std::string(pattern) + ": " + why +
                         "; expected one frame number, as in name_%04d.png");
  };
  bool found = false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    std::string& text = found ? after_ : before_;
    if (pattern[i] != '%') {
      text += pattern[i];
      continue;
    }
    ++i;
    if (i < pattern.size() && pattern[i] == '%') {
      text += '%';
      continue;
    }
    std::size_t digits = 0;
    const bool padded = i < pattern.size() && pattern[i] == '0';
    while (i < pattern.size() && pattern[i] >= '0' && pattern[i] <= '9' && digits < 100)
      digits = 10 * digits + static_cast<std::size_t>(pattern[i++] - '0');
    if (i >= pattern.size() || pattern[i] != 'd') fail("a % is not followed by d or a width such as 04d");
    if ((digits > 0 && !padded) || (padded && digits == 0)) fail("a width begins with 0, as in %04d");
    if (digits > 18) fail("more than 18 digits");
    if (found) fail("more than one frame number");
    found = true;
    digits_ = digits;
  }
  if (!found) fail("no frame number");
}

std::string FramePattern::path(std::int64_t number) const {
  assert(number >= 0);
  std::string text = std::to_string(number);
  if (text.size() < digits_) text.insert(0, digits_ - text.size(), '0');
  return before_ + text + after_;
}

bool isFramePattern(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  return path.find('%', slash == std::string_view::npos ? 0 : slash) != std::string_view::npos;
}

}  // namespace welkin::io
