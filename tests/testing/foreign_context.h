// SPDX-License-Identifier: Apache-2.0
// An application's own EGL context, on the display without a surface that Welkin uses as well.
#pragma once

#include <memory>

namespace welkin::testing {

class ForeignContext {
 public:
  ForeignContext();  // of OpenGL, current in the calling thread; works() is false where there is none
  ~ForeignContext();
  ForeignContext(const ForeignContext&) = delete;
  ForeignContext& operator=(const ForeignContext&) = delete;

  bool works() const;
  bool isCurrent() const;
  bool makeCurrent() const;
  void release() const;  // none is current

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace welkin::testing
