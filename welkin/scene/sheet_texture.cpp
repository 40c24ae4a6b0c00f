// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/sheet_texture.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/io/texel_file.h"

namespace welkin::scene {
namespace {

// The values of one channel, or the mean of the first `count`.
std::vector<float> meanOf(const std::vector<float>& values, int channels, int first, int count) {
  std::vector<float> out(values.size() / static_cast<std::size_t>(channels));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float* texel = &values[i * static_cast<std::size_t>(channels) + static_cast<std::size_t>(first)];
    float sum = 0.0f;
    for (int c = 0; c < count; ++c) sum += texel[c];
    out[i] = std::clamp(sum / static_cast<float>(count), 0.0f, 1.0f);
  }
  return out;
}

std::vector<float> patternIn(const io::Texels& texels) {
  const int channels = texels.shape.format.channelCount();
  std::vector<float> values(texels.bytes.size() / texels.shape.format.valueBytes());
  io::toFloats(texels.shape.format.type, texels.bytes, values);
  if (channels == 1) return meanOf(values, 1, 0, 1);
  if (channels != 3) {
    std::vector<float> alpha = meanOf(values, channels, channels - 1, 1);
    const auto [least, greatest] = std::minmax_element(alpha.begin(), alpha.end());
    if (*least < *greatest) return alpha;
  }
  return meanOf(values, channels, 0, channels == 2 ? 1 : 3);
}

// Throws IoError or ParameterError.
PatternTexels fromFile(const Sheet& sheet) {
  const bool dome = hasVolume(sheet.surface);
  const io::Texels texels = io::readTexels(*sheet.texture);
  const io::TexelShape& shape = texels.shape;
  if (shape.volume != dome)
    throw IoError(
        *sheet.texture + ": " +
        (dome ? "a picture; expected a volume, for a dome" : "a volume; expected a picture, for a plane"));
  const int most = dome ? kMaxVolumeSide : kMaxPictureSide;
  if (std::max({shape.nx, shape.ny, shape.nz}) > most)
    throw IoError(*sheet.texture + ": more than " + std::to_string(most) + " texels a side");
  PatternTexels pattern;
  pattern.fromFile = true;
  if (dome) {
    pattern.volume = Volume<float>(shape.nx, shape.ny, shape.nz, 1);
    pattern.volume.data = patternIn(texels);
  } else {
    pattern.flat = Image<float>(shape.nx, shape.ny, 1);
    pattern.flat.data = patternIn(texels);
  }
  return pattern;
}

}  // namespace

PatternTexels patternOf(const Sheet& sheet, std::uint64_t seed) {
  std::string problem;
  if (sheet.texture) {
    try {
      return fromFile(sheet);
    } catch (const Error& e) {
      problem = e.what();
    }
  }
  PatternTexels pattern;
  if (hasVolume(sheet.surface))
    pattern.volume = domePattern(sheet, seed);
  else
    pattern.flat = flatPattern(sheet, seed);
  // The reader names the file first.
  if (sheet.texture) pattern.warning = problem + "; a generated texture stands in for it";
  return pattern;
}

}  // namespace welkin::scene
