// SPDX-License-Identifier: Apache-2.0
// Reads an engine's 2D texture in a program as it is: its own texels and no others, whatever filter,
// comparison or mipmaps the engine has set up for it. The texture itself is not changed.
#pragma once

#include <string_view>

#include "welkin/gpu/program.h"

namespace welkin::gpu {

class TexelReader {
 public:
  TexelReader();
  ~TexelReader();
  TexelReader(const TexelReader&) = delete;
  TexelReader& operator=(const TexelReader&) = delete;

  // While it lives the texture of this GL name (0: none) is what the program's sampler reads.
  class Binding {
   public:
    Binding(const TexelReader& reader, const Program& program, std::string_view sampler, unsigned texture);
    ~Binding();
    Binding(const Binding&) = delete;
    Binding& operator=(const Binding&) = delete;

   private:
    int unit_;
  };

 private:
  unsigned sampler_ = 0;
};

}  // namespace welkin::gpu
