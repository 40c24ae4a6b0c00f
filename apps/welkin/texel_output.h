// SPDX-License-Identifier: Apache-2.0
// What `welkin noise` and `welkin cloud` write: texels as they are made, a preview, and what they are like.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "command_line.h"
#include "texel_preview.h"
#include "texel_statistics.h"
#include "welkin/io/convert_texels.h"
#include "welkin/io/texel_file.h"

namespace welkin::app {

struct TexelSource {
  std::string command;  // "noise", for messages
  glm::ivec3 size{1};
  bool volume = false;
  io::TexelFormat format;           // where --format does not say: usual type, and the channels of the values
  float scale = 1.0f, bias = 0.0f;  // takes values to [0, 1]; files of floats hold them as they are
  bool measures = false;            // of something: integers hold all of it or are refused, not saturated
  bool tiles = false;               // mipmaps may take the other side beyond an edge
  bool northUp = false;             // see TexelPreview
  io::TexelNotes notes;
  std::vector<std::string> inputs;  // files that were read
};

class TexelOutput {
 public:
  // Opens all files. Throws UsageError for flags that make no sense together, IoError for what cannot be
  // written.
  TexelOutput(const OutputArgs& args, const TexelSource& source);

  const io::TexelShape& shape() const { return shape_; }
  // The next whole rows of a picture or slices of a volume. Changes them. Throws ParameterError for the first
  // that the file's values cannot hold: beyond halves, or (TexelSource::measures) beyond 1 in integers.
  void write(std::span<float> values);
  // All values have come: the files appear.
  void close();
  const TexelStatistics& statistics() const { return *statistics_; }

 private:
  void requireHeld(std::span<const float> values);

  TexelSource source_;
  std::string path_, previewPath_;
  io::TexelShape shape_;
  std::unique_ptr<io::TexelWriter> writer_;
  std::optional<TexelPreview> preview_;
  std::optional<TexelStatistics> statistics_;
  std::optional<io::TexelConverter> converter_;  // where the file has more channels than the values
  std::size_t written_ = 0;                      // values
  std::vector<std::byte> bytes_;
};

// That no output is another, or one of the files that were read, and that preview and report can be written.
void checkFiles(const OutputArgs& args, const std::vector<std::string>& inputs);

}  // namespace welkin::app
