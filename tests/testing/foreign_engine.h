// SPDX-License-Identifier: Apache-2.0
// Stands for an engine in whose frame Welkin draws: has OpenGL objects of its own and state unlike a fresh
// context's, and tells whether any of it was touched. Needs a current context.
#pragma once

#include <map>
#include <memory>
#include <string>

namespace welkin::testing {

class ForeignEngine {
 public:
  ForeignEngine();  // and sets its state
  ~ForeignEngine();
  ForeignEngine(const ForeignEngine&) = delete;
  ForeignEngine& operator=(const ForeignEngine&) = delete;

  void restore() const;                               // sets its state anew
  static std::map<std::string, std::string> state();  // all of the context's as it is now, by name
  unsigned framebuffer() const;                       // 16 x 8 pixels, RGBA8
  static void makeError();                            // one that is the engine's to find
  static bool hasError();                             // and takes it

 private:
  struct Objects;
  std::unique_ptr<Objects> objects_;
};

// 64 x 36 pixels of sRGB, 8 bits a channel, which are encoded while it lives.
class SrgbTarget {
 public:
  SrgbTarget();
  ~SrgbTarget();
  SrgbTarget(const SrgbTarget&) = delete;
  SrgbTarget& operator=(const SrgbTarget&) = delete;
  unsigned framebuffer() const { return framebuffer_; }
  double meanGreen() const;  // linear

 private:
  unsigned texture_ = 0, framebuffer_ = 0;
};

}  // namespace welkin::testing
