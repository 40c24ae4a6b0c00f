// SPDX-License-Identifier: Apache-2.0
// One line on standard error that says how far the work is and how long it still takes; nothing when that is
// not a terminal.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace welkin::app {

// "1:02:03", "2:05", "8 s": a duration as people say it.
std::string durationText(double seconds);

class ProgressLine {
 public:
  ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine();  // wipes the line

  // Starts on a part of the work, whose time is estimated on its own: "drawing".
  void begin(std::string label);
  // The fraction of that part that is done, in [0, 1], and what else there is to say. Draws at most ten times
  // a second.
  void show(double fraction, std::string_view note = {});
  // A line of its own above it, on a terminal or not: "welkin: warning: ...".
  void warn(const std::string& what);

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool terminal_;
  bool drawn_ = false;
  Clock::time_point begin_, last_;
};

}  // namespace welkin::app
