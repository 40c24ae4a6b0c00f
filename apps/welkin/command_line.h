// SPDX-License-Identifier: Apache-2.0
// From argv to plain structs. Values stay text here: what they mean and may be is known where parameters are
// described, and is checked by whoever uses them, so that one mistake has one message.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace welkin::app {

using Flag = std::optional<std::string>;  // absent when not on the command line

struct RenderArgs {
  Flag scene, out;
  Flag metar, place, time, at, seed, theme;
  Flag eye, look, projection, size;
  Flag renderer, technique, metaballsAs, quality, spp, noise, resume, droplets, exposure;
  Flag frames, fps, speed;
  Flag bits, report, threads;
  bool noSunDisc = false;
};

struct MetarArgs {
  std::vector<std::string> reports;
  Flag file;
  bool json = false;
};

struct SunArgs {
  Flag place, time;
  bool json = false;
};

struct InfoArgs {
  std::string file;
  bool json = false, theme = false;
};

// What a file of texels is to be (texel_flags.h).
struct TexelFileFlags {
  Flag format, mipmaps, edges, header;
};

// What every command takes that makes textures or volumes.
struct OutputArgs {
  Flag out;
  TexelFileFlags file;
  Flag preview, tile, report, threads;
};

struct NoiseArgs {
  std::map<std::string, std::string> params;  // flags of described parameters: path and text (param_flags.h)
  Flag preset, size;
  OutputArgs output;
};

struct CloudArgs {
  std::map<std::string, std::string> params;
  Flag size, ellipsoids, metaballs;
  bool cumulus = false;
  OutputArgs output;
};

struct FitArgs {
  std::map<std::string, std::string> params;
  std::string map;
  Flag out, balls, resume, report, threads;
};

struct ConvertArgs {
  std::string in, out;
  Flag grid;
  TexelFileFlags file;
};

struct CompareArgs {
  std::string picture, truth;
  Flag biasMap, flipMap, range, exposure;
  bool json = false;
};

struct BenchArgs {
  std::vector<std::string> names;
  Flag truth, pictures;
  bool json = false;
};

// `welkin help scene`; help of commands is PrintText.
struct HelpSceneArgs {
  bool markdown = false;
};

struct PrintText {
  std::string text;
};

using Command = std::variant<RenderArgs, MetarArgs, SunArgs, InfoArgs, NoiseArgs, CloudArgs, FitArgs,
                             ConvertArgs, CompareArgs, BenchArgs, HelpSceneArgs, PrintText>;

// Throws UsageError, which names the nearest command or flag for one that does not exist.
Command parseCommandLine(int argc, const char* const* argv);

}  // namespace welkin::app
