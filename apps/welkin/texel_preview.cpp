// SPDX-License-Identifier: Apache-2.0
#include "texel_preview.h"

#include <algorithm>
#include <cmath>

#include "welkin/core/error.h"
#include "welkin/io/png.h"

namespace welkin::app {
namespace {

constexpr int kMostSlices = 16, kGap = 2;
constexpr std::uint8_t kGapGrey = 128;
constexpr double kMostPixels = 268435456.0;

}  // namespace

TexelPreview::TexelPreview(glm::ivec3 size, int channels, glm::ivec2 tiles, bool northUp)
    : size_(size), channels_(channels), tiles_(tiles), northUp_(northUp) {
  step_ = (size.z + kMostSlices - 1) / kMostSlices;
  shown_ = (size.z + step_ - 1) / step_;
  columns_ = static_cast<int>(std::ceil(std::sqrt(shown_)));
  const double pixels = static_cast<double>(size.x) * size.y * tiles.x * tiles.y * shown_;
  if (pixels > kMostPixels)
    throw ParameterError(
        "the preview would have more than 268435456 pixels; expected fewer tiles or a smaller size");
  slices_.reserve(static_cast<std::size_t>(size.x) * size.y * channels * shown_);
}

void TexelPreview::add(std::span<const float> values) {
  const std::size_t slice = static_cast<std::size_t>(size_.x) * size_.y * channels_;
  while (!values.empty()) {
    const std::size_t z = seen_ / slice;
    const std::size_t count = std::min(values.size(), (z + 1) * slice - seen_);
    if (z % static_cast<std::size_t>(step_) == 0)
      for (const float v : values.first(count))
        slices_.push_back(static_cast<std::uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f));
    values = values.subspan(count);
    seen_ += count;
  }
}

void TexelPreview::write(const std::string& path) const {
  const int width = size_.x * tiles_.x, height = size_.y * tiles_.y;
  const int rows = (shown_ + columns_ - 1) / columns_;
  Image<std::uint8_t> sheet(columns_ * (width + kGap) - kGap, rows * (height + kGap) - kGap, channels_);
  std::fill(sheet.data.begin(), sheet.data.end(), kGapGrey);
  const std::size_t rowValues = static_cast<std::size_t>(size_.x) * channels_;
  for (int s = 0; s < shown_; ++s)
    for (int y = 0; y < height; ++y) {
      const int from = northUp_ ? size_.y - 1 - y % size_.y : y % size_.y;
      const std::uint8_t* row = &slices_[(static_cast<std::size_t>(s) * size_.y + from) * rowValues];
      for (int tile = 0; tile < tiles_.x; ++tile)
        std::copy_n(
            row, rowValues,
            &sheet.at(s % columns_ * (width + kGap) + tile * size_.x, s / columns_ * (height + kGap) + y));
    }
  io::writePng(path, sheet);
}

}  // namespace welkin::app
