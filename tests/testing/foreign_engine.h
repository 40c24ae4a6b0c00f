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

  void restore() const;                              // sets its state anew
  std::map<std::string, std::string> state() const;  // all of it as it is now, by name
  unsigned framebuffer() const;                      // 16 x 8 pixels, RGBA8

 private:
  struct Objects;
  std::unique_ptr<Objects> objects_;
};

}  // namespace welkin::testing
