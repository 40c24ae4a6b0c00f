// SPDX-License-Identifier: Apache-2.0
// A PNG to look at: of a picture itself; of a volume a sheet of slices.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "welkin/core/image.h"

namespace welkin::app {

// Of a volume up to 16 slices are shown, evenly spread from the first one on, in rows from the top left. Each
// is repeated `tiles` times along x and y, which shows whether it tiles. The first row of texels is at the
// top, or at the bottom for clouds seen from above, whose y is north.
class TexelPreview {
 public:
  // channels: 1 grey, 3 or 4 colour. Throws ParameterError for pictures of more than 2^28 pixels.
  TexelPreview(glm::ivec3 size, int channels, glm::ivec2 tiles, bool northUp);

  // All values in [0, 1] in their order, in pieces of whole rows (of a picture) or slices (of a volume).
  void add(std::span<const float> values);
  void write(const std::string& path) const;

 private:
  glm::ivec3 size_;
  int channels_;
  glm::ivec2 tiles_;
  bool northUp_;
  int step_ = 1, shown_ = 1, columns_ = 1;  // every step-th slice
  std::size_t seen_ = 0;                    // values
  std::vector<std::uint8_t> slices_;        // those that are shown
};

}  // namespace welkin::app
