// SPDX-License-Identifier: Apache-2.0
// The one interface of writers that are fed row by row or slice by slice, so that the whole need never be in
// memory.
#pragma once

#include <cstddef>
#include <span>

namespace welkin::io {

class TexelWriter {
 public:
  virtual ~TexelWriter() = default;  // without close(): nothing is left behind
  TexelWriter() = default;
  TexelWriter(const TexelWriter&) = delete;
  TexelWriter& operator=(const TexelWriter&) = delete;

  // The next rows, any whole number of them, in the order of texels.h; slices follow one another. Throws
  // IoError when the disk is full or fails, ParameterError for values that the format cannot hold.
  virtual void write(std::span<const std::byte> rows) = 0;
  // Ends the file and puts it in its place; all rows must have been written.
  virtual void close() = 0;
};

}  // namespace welkin::io
