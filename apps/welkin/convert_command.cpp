// SPDX-License-Identifier: Apache-2.0
#include "convert_command.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>

#include "call_files.h"
#include "interrupt.h"
#include "progress_line.h"
#include "texel_flags.h"
#include "usage_error.h"
#include "welkin/core/error.h"
#include "welkin/io/convert_texels.h"
#include "welkin/io/texel_file.h"
#include "welkin/io/vdb.h"

namespace welkin::app {
namespace {

using io::Channels;
using io::TexelFileKind;

constexpr std::size_t kPieceBytes = 1 << 20;  // that are converted at once

std::string whyNot(TexelFileKind kind, const io::TexelShape& shape) {
  const bool volumes =
      kind == TexelFileKind::kDds || kind == TexelFileKind::kRaw || kind == TexelFileKind::kVdb;
  if (shape.volume && !volumes) return ", which holds pictures; expected .dds, .raw or .vdb";
  if (!shape.volume && kind == TexelFileKind::kVdb) return ", which holds volumes";
  if (kind == TexelFileKind::kVdb) return ", which holds one value a voxel";
  io::TexelFormat integers = shape.format;
  if (io::countOf(integers.channels) == 1) integers.channels = Channels::kL;
  integers.type = io::ValueType::kUnorm16;
  return kind == TexelFileKind::kPng ? "; expected --format " + nameOf(integers) + ", if it is within 0 to 1"
                                     : "";
}

// What was asked for, or what loses nothing.
io::TexelFormat formatFor(const ConvertArgs& args, TexelFileKind kind, io::TexelShape shape,
                          const io::DdsOptions& dds) {
  const std::string name = shape.volume ? "volume of " : "picture of ";
  if (!args.file.format) {
    if (const auto nearest = io::nearestFormat(kind, shape, dds)) return *nearest;
    throw ParameterError("cannot convert " + args.in + " to " + args.out + ": the " + name +
                         nameOf(shape.format) + " does not fit into that kind of file" + whyNot(kind, shape));
  }
  try {
    shape.format = io::texelFormat(*args.file.format);
  } catch (const ParameterError& e) {
    throw UsageError("convert: --format: " + std::string(e.what()));
  }
  const io::TexelFormat asked = shape.format;
  if (io::holds(kind, shape, dds)) return asked;
  // One value a texel goes by the name that the kind of file has for it; in a DDS names mean something.
  if (io::countOf(asked.channels) == 1 && kind != TexelFileKind::kDds)
    for (const Channels c : {Channels::kL, Channels::kR}) {
      shape.format.channels = c;
      if (io::holds(kind, shape, dds)) return shape.format;
    }
  throw UsageError("convert: " + args.out + " cannot hold a " + name + nameOf(asked));
}

}  // namespace

int runConvert(const ConvertArgs& args) {
  if (args.in.empty() || args.out.empty()) throw UsageError("convert: expected two files, IN and OUT");
  if (fileKindOf("convert", args.in) != TexelFileKind::kVdb && args.grid)
    throw UsageError("convert: --grid is for .vdb, which " + args.in + " is not");
  const TexelFileKind kind = fileKindOf("convert", args.out);
  CallFiles files;
  files.readsTexels(args.in);
  files.writesTexels("convert", args.out);
  const io::DdsOptions dds = ddsOptions("convert", args.file, kind, io::MipEdges::kClamp);
  const io::Texels texels = args.grid ? io::readVdb(args.in, {.grid = *args.grid}) : io::readTexels(args.in);
  ProgressLine progress;
  for (const std::string& what : texels.notes.leftOut) progress.warn(args.in + ": " + what + " is left out");
  catchInterrupts();
  io::TexelShape shape = texels.shape;
  shape.format = formatFor(args, kind, shape, dds);
  const auto writer = io::createTexelFile(args.out, shape, texels.notes, dds);
  io::TexelConverter converter(texels.shape, shape.format);
  try {
    progress.begin("writing");
    const std::size_t row = texels.shape.rowBytes(),
                      piece = row * std::max<std::size_t>(kPieceBytes / row, 1);
    const std::span<const std::byte> all(texels.bytes);
    for (std::size_t at = 0; at < all.size(); at += piece) {
      throwIfInterrupted();
      progress.show(static_cast<double>(at) / static_cast<double>(all.size()));
      writer->write(converter.convert(all.subspan(at, std::min(piece, all.size() - at))));
    }
  } catch (const ParameterError& e) {
    throw ParameterError("cannot convert " + args.in + " to " + args.out + ": " + e.what());
  }
  writer->close();
  return 0;
}

}  // namespace welkin::app
