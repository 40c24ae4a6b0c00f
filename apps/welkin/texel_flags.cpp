// SPDX-License-Identifier: Apache-2.0
#include "texel_flags.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>

#include "usage_error.h"
#include "welkin/core/error.h"

namespace welkin::app {
namespace {

using namespace std::string_view_literals;

constexpr std::int64_t kMostAnAxis = 65536, kMostTexels = std::int64_t{1} << 36;

template <class E, std::size_t N>
E choice(const std::string& flag, const Flag& value, const std::array<std::string_view, N>& names,
         E otherwise) {
  if (!value) return otherwise;
  std::string list;
  for (std::size_t i = 0; i < N; ++i) {
    if (*value == names[i]) return static_cast<E>(i);
    list += (i == 0 ? "" : i + 1 == N ? " or " : ", ") + std::string(names[i]);
  }
  throw UsageError(flag + " is \"" + *value + "\"; expected " + list);
}

}  // namespace

glm::ivec3 sizeOf(const std::string& text) {
  glm::ivec3 size(1);
  const char *at = text.data(), *const end = text.data() + text.size();
  std::int64_t texels = 1;
  int axis = 0;
  for (bool more = true; more; ++axis) {
    std::int64_t n = 0;
    const auto [next, error] = std::from_chars(at, end, n);
    more = next != end && *next == 'x';
    if (error == std::errc::invalid_argument || (next != end && !more) || axis == 3 || (!more && axis == 0))
      throw UsageError("--size: expected WIDTHxHEIGHT or WIDTHxHEIGHTxDEPTH, found \"" + text + "\"");
    if (error != std::errc() || n < 1 || n > kMostAnAxis)
      throw UsageError("--size: \"" + text + "\" has " + std::string(at, next) +
                       " texels on an axis; expected 1 to " + std::to_string(kMostAnAxis));
    size[axis] = static_cast<int>(n);
    texels *= n;
    at = next + (more ? 1 : 0);
  }
  if (texels > kMostTexels)
    throw UsageError("--size: " + text + " has " + std::to_string(texels) + " texels; expected at most " +
                     std::to_string(kMostTexels));
  return size;
}

bool isVolume(const std::string& text) {
  return text.find('x') != text.rfind('x');
}

io::DdsOptions ddsOptions(const std::string& command, const TexelFileFlags& flags, io::TexelFileKind kind,
                          io::MipEdges edges) {
  const std::string where = command + ": ";
  if (kind != io::TexelFileKind::kDds && (flags.mipmaps || flags.edges || flags.header))
    throw UsageError(where + "--mipmaps, --edges and --header are for .dds");
  if (flags.edges && !flags.mipmaps) throw UsageError(where + "--edges goes with --mipmaps");
  io::DdsOptions dds;
  dds.mipmaps =
      choice(where + "--mipmaps", flags.mipmaps, std::array{"none"sv, "box"sv, "kaiser"sv}, dds.mipmaps);
  dds.edges = choice(where + "--edges", flags.edges, std::array{"clamp"sv, "repeat"sv}, edges);
  dds.header = choice(where + "--header", flags.header, std::array{"auto"sv, "dx10"sv}, dds.header);
  return dds;
}

io::TexelFileKind fileKindOf(const std::string& command, const std::string& path, const char* expected) {
  try {
    return io::texelFileKindOf(path);
  } catch (const ParameterError&) {
    throw UsageError(command + ": " + wrongKind(path, expected));
  }
}

io::TexelFormat formatFor(const OutputArgs& args, io::TexelFileKind kind, io::TexelShape shape,
                          const io::DdsOptions& dds) {
  const io::Channels natural = shape.format.channels;
  if (args.file.format) {
    try {
      shape.format = io::texelFormat(*args.file.format);
    } catch (const ParameterError& e) {
      throw UsageError("--format: " + std::string(e.what()));
    }
    const int has = io::countOf(shape.format.channels), needs = io::countOf(natural);
    if (has < needs)
      throw UsageError("--format: " + *args.file.format + " has " + std::to_string(has) +
                       (has == 1 ? " channel" : " channels") + " a texel; expected " +
                       (needs == 3 ? "rgb8, rgba8" : "rgba8") + " or the like, for " + std::to_string(needs));
  }
  const io::TexelFormat asked = shape.format;
  // A grid has only floats and halves.
  if (kind == io::TexelFileKind::kVdb && io::isInteger(asked.type))
    throw UsageError(*args.out + " cannot hold " + io::nameOf(asked) + "; expected --format r16f or r32f");
  if (io::holds(kind, shape, dds)) return asked;
  // A file without a name for the one value has another; more channels only where they were not chosen.
  const auto nearest = io::nearestFormat(kind, shape, dds);
  if (nearest && (!args.file.format || (io::countOf(nearest->channels) == 1 && nearest->type == asked.type)))
    return *nearest;
  std::string expected = "another --format or kind of file";
  if (nearest) expected = "--format " + io::nameOf(*nearest);
  if (kind == io::TexelFileKind::kVdb && !shape.volume) expected = "a size of three numbers";
  const bool pictures = kind == io::TexelFileKind::kPng || kind == io::TexelFileKind::kExr;
  if (pictures && shape.volume) expected = io::countOf(natural) == 1 ? kVolumeFile : ".dds or .raw";
  throw UsageError(*args.out + " cannot hold a " + (shape.volume ? "volume of " : "picture of ") +
                   io::nameOf(asked) + "; expected " + expected);
}

}  // namespace welkin::app
