// SPDX-License-Identifier: Apache-2.0
#include "convert_command.h"

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "usage_error.h"
#include "welkin/core/error.h"
#include "welkin/io/convert_texels.h"
#include "welkin/io/texel_file.h"

namespace welkin::app {
namespace {

using namespace std::string_view_literals;
using io::Channels;
using io::TexelFileKind;

// One of the words that a flag takes, by number.
template <class E, std::size_t N>
E choice(const char* flag, const Flag& value, const std::array<std::string_view, N>& names, E otherwise) {
  if (!value) return otherwise;
  std::string list;
  for (std::size_t i = 0; i < N; ++i) {
    if (*value == names[i]) return static_cast<E>(i);
    list += (i == 0 ? "" : i + 1 == N ? " or " : ", ") + std::string(names[i]);
  }
  throw UsageError("convert: " + std::string(flag) + " is \"" + *value + "\"; expected " + list);
}

TexelFileKind kindOf(const std::string& path) {
  try {
    return io::texelFileKindOf(path);
  } catch (const ParameterError& e) {
    throw UsageError("convert: " + std::string(e.what()));
  }
}

io::DdsOptions ddsOptions(const ConvertArgs& args, TexelFileKind kind) {
  if (kind != TexelFileKind::kDds && (args.mipmaps || args.edges || args.header))
    throw UsageError("convert: --mipmaps, --edges and --header are for .dds");
  if (args.edges && !args.mipmaps) throw UsageError("convert: --edges goes with --mipmaps");
  io::DdsOptions dds;
  dds.mipmaps = choice("--mipmaps", args.mipmaps, std::array{"none"sv, "box"sv, "kaiser"sv}, dds.mipmaps);
  dds.edges = choice("--edges", args.edges, std::array{"clamp"sv, "repeat"sv}, dds.edges);
  dds.header = choice("--header", args.header, std::array{"auto"sv, "dx10"sv}, dds.header);
  return dds;
}

// What was asked for, or what loses nothing.
io::TexelFormat formatFor(const ConvertArgs& args, TexelFileKind kind, io::TexelShape shape,
                          const io::DdsOptions& dds) {
  const std::string name = shape.volume ? "volume of " : "picture of ";
  if (!args.format) {
    if (const auto nearest = io::nearestFormat(kind, shape, dds)) return *nearest;
    throw ParameterError(
        "cannot convert " + args.in + " to " + args.out + ": the " + name + nameOf(shape.format) +
        " does not fit into that kind of file" +
        (kind == TexelFileKind::kPng && !shape.volume ? "; --format l16 or rgb8 makes it fit" : ""));
  }
  try {
    shape.format = io::texelFormat(*args.format);
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
  kindOf(args.in);
  const TexelFileKind kind = kindOf(args.out);
  const io::DdsOptions dds = ddsOptions(args, kind);
  const io::Texels texels = io::readTexels(args.in);
  io::TexelShape shape = texels.shape;
  shape.format = formatFor(args, kind, shape, dds);
  const auto writer = io::createTexelFile(args.out, shape, texels.notes, dds);
  io::TexelConverter converter(texels.shape, shape.format);
  try {
    for (int z = 0; z < shape.nz; ++z) writer->write(converter.convert(texels.slice(z)));
  } catch (const ParameterError& e) {
    throw ParameterError("cannot convert " + args.in + " to " + args.out + ": " + e.what());
  }
  writer->close();
  return 0;
}

}  // namespace welkin::app
