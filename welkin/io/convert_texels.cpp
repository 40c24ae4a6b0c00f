// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/convert_texels.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "welkin/core/error.h"

namespace welkin::io {
namespace {

bool hasAlpha(Channels c) {
  return c == Channels::kLa || c == Channels::kRgba;
}
bool hasColour(Channels c) {
  return c == Channels::kRgb || c == Channels::kRgba;
}

}  // namespace

TexelConverter::TexelConverter(const TexelShape& from, TexelFormat to) : from_(from), to_(from) {
  validate(from);
  to_.format = to;
}

std::span<const std::byte> TexelConverter::convert(std::span<const std::byte> rows) {
  const Channels from = from_.format.channels, to = to_.format.channels;
  const std::size_t in = static_cast<std::size_t>(countOf(from)), out = static_cast<std::size_t>(countOf(to));
  const std::size_t firstValue = rowsDone_ * static_cast<std::size_t>(from_.nx) * in;
  rowsDone_ += rows.size() / from_.rowBytes();
  if (in == out && from_.format.type == to_.format.type) return rows;  // at most another name

  const auto refuse = [&](std::size_t value, const std::string& what) {
    throw ParameterError(texelPlace(from_, firstValue + value) + " " + what + ", which " +
                         nameOf(to_.format) + " cannot hold");
  };
  in_.resize(rows.size() / bytesOf(from_.format.type));
  toFloats(from_.format.type, rows, in_);

  const bool bounded = !isInteger(from_.format.type) && to_.format.type != ValueType::kFloat;
  const float low = isInteger(to_.format.type) ? 0.0f : -kLargestHalf;
  const float high = isInteger(to_.format.type) ? 1.0f : kLargestHalf;
  if (bounded)
    for (std::size_t i = 0; i < in_.size(); ++i)
      if (!(in_[i] >= low && in_[i] <= high)) refuse(i, "is " + shortest(in_[i]));

  if (in == out) {
    bytes_.resize(in_.size() * bytesOf(to_.format.type));
    fromFloats(in_, to_.format.type, bytes_);
    return bytes_;
  }
  out_.resize(in_.size() / in * out);
  const bool dropsAlpha = hasAlpha(from) && !hasAlpha(to), dropsColour = hasColour(from) && !hasColour(to);
  for (std::size_t i = 0, o = 0; i < in_.size(); i += in, o += out) {
    const float* texel = &in_[i];
    if (dropsAlpha && texel[in - 1] != 1.0f) refuse(i + in - 1, "has alpha " + shortest(texel[in - 1]));
    if (dropsColour && (texel[1] != texel[0] || texel[2] != texel[0])) refuse(i, "is not grey");
    const bool colour = hasColour(from);
    const std::size_t colours = hasColour(to) ? 3 : 1;
    for (std::size_t c = 0; c < colours; ++c) out_[o + c] = texel[colour ? c : 0];
    if (hasAlpha(to)) out_[o + out - 1] = hasAlpha(from) ? texel[in - 1] : 1.0f;
  }
  bytes_.resize(out_.size() * bytesOf(to_.format.type));
  fromFloats(out_, to_.format.type, bytes_);
  return bytes_;
}

Texels convertTexels(const Texels& texels, TexelFormat to) {
  TexelShape shape = texels.shape;
  shape.format = to;
  Texels result(shape);
  result.notes = texels.notes;
  TexelConverter converter(texels.shape, to);
  for (int z = 0; z < shape.nz; ++z)
    std::ranges::copy(converter.convert(texels.slice(z)),
                      result.bytes.begin() + static_cast<std::ptrdiff_t>(shape.sliceBytes()) * z);
  return result;
}

}  // namespace welkin::io
