// SPDX-License-Identifier: Apache-2.0
// Counts the programs that are linked and the textures that are made while it lives; one at a time. OpenGL's
// functions are found at their first call: something of each kind must have been made before.
#pragma once

namespace welkin::testing {

class GlCounts {
 public:
  GlCounts();
  ~GlCounts();
  GlCounts(const GlCounts&) = delete;
  GlCounts& operator=(const GlCounts&) = delete;
  int programs() const;
  int textures() const;
};

}  // namespace welkin::testing
