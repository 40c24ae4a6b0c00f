// SPDX-License-Identifier: Apache-2.0
#include "progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "terminal_text.h"

namespace welkin::app {

std::string durationText(double seconds) {
  const long s = std::lround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
  return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
}

void ProgressLine::begin(std::string label) {
  label_ = std::move(label);
  begin_ = last_ = Clock::now();
  if (!terminal_) return;
  drawn_ = true;
  fmt::print(stderr, "\r{} ...\033[K", label_);
  std::fflush(stderr);
}

void ProgressLine::show(double fraction, std::string_view note) {
  const Clock::time_point now = Clock::now();
  if (!terminal_ || now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  const double elapsed = std::chrono::duration<double>(now - begin_).count();
  fmt::print(stderr, "\r{} {:3.0f} %", label_, 100.0 * fraction);
  // An estimate from the first moments would only be wrong.
  if (elapsed > 0.5 && fraction > 0.01)
    fmt::print(stderr, ", {} left", durationText(elapsed * (1.0 - fraction) / fraction));
  if (!note.empty()) fmt::print(stderr, ", {}", note);
  fmt::print(stderr, "\033[K");
  std::fflush(stderr);
}

void ProgressLine::warn(const std::string& what) {
  fmt::print(stderr, "{}welkin: warning: {}\n", drawn_ ? "\r\033[K" : "", printable(what));
  std::fflush(stderr);
}

}  // namespace welkin::app
