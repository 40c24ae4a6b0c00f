// SPDX-License-Identifier: Apache-2.0
#include "texel_output.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "call_files.h"
#include "picture_writer.h"
#include "texel_flags.h"
#include "usage_error.h"
#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/io/file_extension.h"

namespace welkin::app {
namespace {

constexpr std::size_t kGrain = std::size_t{1} << 16;

glm::ivec2 tilesOf(const Flag& tile) {
  if (!tile) return glm::ivec2(1);
  glm::ivec2 n(0);
  int end = 0;
  const int read = std::sscanf(tile->c_str(), "%2dx%2d%n", &n.x, &n.y, &end);
  if (read != 2 || static_cast<std::size_t>(end) != tile->size() || std::min(n.x, n.y) < 1 ||
      std::max(n.x, n.y) > 16)
    throw UsageError("--tile: expected COLUMNSxROWS of 1 to 16 each, 2x2 for instance, found \"" + *tile +
                     "\"");
  return n;
}

void checkPreview(const OutputArgs& args) {
  if (args.tile && !args.preview) throw UsageError("--tile goes with --preview");
  if (!args.preview) return;
  if (io::lowerExtension(*args.preview) != ".png")
    throw UsageError("--preview: " + *args.preview + " is no .png; expected a name such as preview.png");
}

}  // namespace

void checkFiles(const OutputArgs& args, const std::vector<std::string>& inputs) {
  CallFiles files;
  for (const std::string& path : inputs) files.reads(path);
  files.writesTexels("-o", *args.out);
  if (args.preview) files.writes("--preview", *args.preview);
  if (args.report) files.writes("--report", *args.report);
  if (args.preview) checkWritable(*args.preview);
  if (args.report) checkWritable(*args.report);
}

TexelOutput::TexelOutput(const OutputArgs& args, const TexelSource& source)
    : source_(source), path_(*args.out), previewPath_(args.preview.value_or("")) {
  const io::TexelFileKind kind = fileKindOf(source.command, *args.out);
  checkPreview(args);
  const glm::ivec2 tiles = tilesOf(args.tile);
  const io::DdsOptions dds = ddsOptions(source.command, args.file, kind,
                                        source.tiles ? io::MipEdges::kRepeat : io::MipEdges::kClamp);
  shape_ = {source.format, source.size.x, source.size.y, source.size.z, source.volume};
  shape_.format = formatFor(args, kind, shape_, dds);
  statistics_.emplace(shape_.format.type);
  try {
    if (args.preview)
      preview_.emplace(source.size, io::countOf(source.format.channels), tiles, source.northUp);
  } catch (const ParameterError& e) {
    throw UsageError(e.what());
  }
  if (io::countOf(shape_.format.channels) != io::countOf(source.format.channels)) {
    io::TexelShape narrow = shape_;
    narrow.format.channels = source.format.channels;
    converter_.emplace(narrow, shape_.format);
  }
  checkFiles(args, source.inputs);
  writer_ = io::createTexelFile(*args.out, shape_, source.notes, dds);
}

void TexelOutput::requireHeld(std::span<const float> values) {
  const io::ValueType type = shape_.format.type;
  const float most = type == io::ValueType::kHalf          ? io::kLargestHalf
                     : isInteger(type) && source_.measures ? 1.0f
                                                           : HUGE_VALF;
  const auto beyond =
      std::find_if(values.begin(), values.end(), [most](float v) { return std::abs(v) > most; });
  if (beyond != values.end()) {
    io::TexelShape own = shape_;
    own.format.channels = source_.format.channels;
    io::TexelFormat floats{own.format.channels, io::ValueType::kFloat};
    if (floats.channelCount() == 1) floats.channels = io::Channels::kR;
    throw ParameterError("cannot write " + path_ + ": " +
                         io::texelPlace(own, written_ + static_cast<std::size_t>(beyond - values.begin())) +
                         " is " + io::shortest(*beyond) + ", which " + io::nameOf(shape_.format) +
                         " cannot hold; expected --format " + io::nameOf(floats));
  }
  written_ += values.size();
}

void TexelOutput::write(std::span<float> values) {
  const io::ValueType type = shape_.format.type;
  const std::size_t size = io::bytesOf(type);
  bytes_.resize(values.size() * size);
  const auto store = [&] {
    parallelFor(values.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      io::fromFloats(values.subspan(begin, end - begin), type,
                     std::span(bytes_).subspan(begin * size, (end - begin) * size));
    });
  };
  if (!isInteger(type)) {
    requireHeld(values);
    store();
  }
  if (source_.scale != 1.0f || source_.bias != 0.0f)
    parallelFor(values.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (float& v : values.subspan(begin, end - begin)) v = source_.scale * v + source_.bias;
    });
  if (isInteger(type)) {
    requireHeld(values);
    store();
  }
  statistics_->add(values);
  if (preview_) preview_->add(values);
  writer_->write(converter_ ? converter_->convert(bytes_) : std::span<const std::byte>(bytes_));
}

void TexelOutput::close() {
  writer_->close();
  if (preview_) preview_->write(previewPath_);
}

}  // namespace welkin::app
