// SPDX-License-Identifier: Apache-2.0
#include "info_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "report.h"
#include "terminal_text.h"
#include "usage_error.h"
#include "welkin/io/file_extension.h"
#include "welkin/io/texel_file.h"
#include "welkin/io/vdb.h"
#include "welkin/scene/metaball_file.h"
#include "welkin/scene/param_json.h"
#include "welkin/scene/scene_file.h"
#include "welkin/scene/theme.h"

namespace welkin::app {
namespace {

using Json = nlohmann::ordered_json;
using io::TexelFileKind;
using io::ValueType;

const char* valuesOf(TexelFileKind kind, ValueType type) {
  if (kind == TexelFileKind::kHdr) return "rgbe";
  switch (type) {
    case ValueType::kUnorm8:
      return "8 bits";
    case ValueType::kUnorm16:
      return "16 bits";
    case ValueType::kHalf:
      return "half";
    default:
      return "float";
  }
}

// Integers in their own range, as they stand in the file.
void addStatistics(Json& j, const io::Texels& texels) {
  const ValueType type = texels.shape.format.type;
  const double one = type == ValueType::kUnorm8 ? 255.0 : type == ValueType::kUnorm16 ? 65535.0 : 1.0;
  double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0.0;
  std::vector<float> row(texels.shape.rowBytes() / io::bytesOf(type));
  for (std::size_t at = 0; at < texels.bytes.size(); at += texels.shape.rowBytes()) {
    io::toFloats(type, std::span(texels.bytes).subspan(at, texels.shape.rowBytes()), row);
    double rowSum = 0.0;
    for (const float x : row) rowSum += one == 1.0 ? static_cast<double>(x) : std::round(one * x);
    const auto [least, most] = std::minmax_element(row.begin(), row.end());
    low = std::min(low, static_cast<double>(*least));
    high = std::max(high, static_cast<double>(*most));
    sum += rowSum;
  }
  const auto stored = [&](double x) {
    return one == 1.0 ? Json(static_cast<float>(x)) : Json(static_cast<int>(std::lround(x * one)));
  };
  j["min"] = stored(low);
  j["mean"] = sum / (static_cast<double>(texels.bytes.size()) / static_cast<double>(io::bytesOf(type)));
  j["max"] = stored(high);
}

Json shapeJson(TexelFileKind kind, const io::TexelShape& shape) {
  Json j = {{"width", shape.nx}, {"height", shape.ny}};
  if (shape.volume) j["depth"] = shape.nz;
  j["channels"] = io::countOf(shape.format.channels);
  j["values"] = valuesOf(kind, shape.format.type);
  j["format"] = io::nameOf(shape.format);
  return j;
}

void addPlace(Json& j, const io::TexelNotes& notes) {
  j["voxel_size_m"] = {notes.voxelSizeM.x, notes.voxelSizeM.y, notes.voxelSizeM.z};
  j["first_voxel_m"] = {notes.firstVoxelM.x, notes.firstVoxelM.y, notes.firstVoxelM.z};
  j["name"] = notes.name;
}

// As sparse as it is.
Json vdbJson(const std::string& path) {
  const io::VdbSummary grid = io::readVdbSummary(path);
  Json j = shapeJson(TexelFileKind::kVdb, grid.shape);
  j["active_voxels"] = grid.activeVoxels;
  j["min"] = grid.min;
  j["mean"] = grid.mean;
  j["max"] = grid.max;
  addPlace(j, grid.notes);
  for (const io::VdbGrid& g : io::readVdbGrids(path))
    j["grids"].push_back({{"name", g.name}, {"type", g.type}, {"half", g.half}});
  if (!grid.notes.leftOut.empty()) j["left_out"] = grid.notes.leftOut;
  j["metadata"] = grid.notes.metadata;
  return j;
}

Json texelsJson(const std::string& path) {
  const TexelFileKind kind = io::texelFileKindOf(path);
  if (kind == TexelFileKind::kVdb) return vdbJson(path);
  const io::Texels texels = io::readTexels(path);
  Json j = shapeJson(kind, texels.shape);
  // The kind of file alone does not say it.
  if (const auto meaning = texels.notes.metadata.find(kMeaningKey); meaning != texels.notes.metadata.end())
    j["meaning"] = meaning->second;
  if (kind == TexelFileKind::kDds) {
    const io::DdsInfo dds = io::readDdsInfo(path);
    j["layout"] = dds.layout;
    j["header"] = dds.dx10 ? "DX10" : "legacy";
    j["levels"] = dds.levels;
  }
  addStatistics(j, texels);
  if (texels.shape.volume && kind != TexelFileKind::kDds) addPlace(j, texels.notes);
  if (!texels.notes.leftOut.empty()) j["left_out"] = texels.notes.leftOut;
  if (kind != TexelFileKind::kDds && kind != TexelFileKind::kHdr) j["metadata"] = texels.notes.metadata;
  return j;
}

Json metaballsJson(const std::string& path) {
  const scene::MetaballFile file = scene::readMetaballs(path);
  const std::vector<field::Metaball>& balls = file.balls();
  const field::Box box = field::boundsOf(balls);
  const auto rangeOf = [&balls](double field::Metaball::* member) {
    const auto [low, high] = std::minmax_element(
        balls.begin(), balls.end(),
        [member](const field::Metaball& a, const field::Metaball& b) { return a.*member < b.*member; });
    return Json{{"min", (*low).*member}, {"max", (*high).*member}};
  };
  Json j = {{"holds", "metaballs"},
            {"balls", balls.size()},
            {"low_m", {box.low.x, box.low.y, box.low.z}},
            {"high_m", {box.high.x, box.high.y, box.high.z}},
            {"radius_m", rangeOf(&field::Metaball::radiusM)},
            {"density", rangeOf(&field::Metaball::density)},
            {"integral_m3", field::integralOf(balls)},
            {"levels", Json::array()}};
  for (const scene::MetaballLevel& level : file.levels) {
    Json l = {{"balls", level.balls.size()}};
    if (level.relativeL2) l["relative_l2"] = *level.relativeL2;
    if (level.rmse) l["rmse"] = *level.rmse;
    j["levels"].push_back(l);
  }
  return j;
}

void printPlain(const Json& j, int indent = 0) {
  for (const auto& [key, value] : j.items()) {
    fmt::print("{:{}}{}", "", indent, printable(key));
    if (value.is_object()) {
      fmt::print("\n");
      printPlain(value, indent + 2);
    } else {
      const std::string text = value.is_string() ? value.get<std::string>()
                                                 : value.dump(-1, ' ', false, Json::error_handler_t::replace);
      fmt::print(" {}\n", printable(text));
    }
  }
}

// Of a scene file, which a theme's file is as well, or a built-in theme.
void printTheme(const InfoArgs& args, bool isFile) {
  const scene::Theme theme = [&] {
    try {
      return isFile ? scene::themeOf(scene::readSceneFile(args.file).scene) : scene::readTheme(args.file);
    } catch (const ParameterError& e) {
      throw UsageError("info --theme: " + std::string(e.what()));
    }
  }();
  for (const scene::Sheet& sheet : theme.sheets) scene::validate(sheet);
  fmt::print("{}", args.json ? printableJson(scene::toJson(theme)) + "\n"
                             : printableLines(scene::themeToToml(theme)));
}

}  // namespace

int runInfo(const InfoArgs& args) {
  const std::string extension = io::lowerExtension(args.file);
  if (args.theme) {
    printTheme(args, extension == ".toml");
    return 0;
  }
  if (extension == ".toml") {
    const scene::Scene s = scene::readSceneFile(args.file).scene;
    fmt::print("{}",
               args.json ? printableJson(scene::toJson(s)) + "\n" : printableLines(scene::sceneToToml(s)));
    return 0;
  }
  Json j;
  try {
    io::texelFileKindOf(args.file);
  } catch (const ParameterError&) {
    if (extension == ".json")
      j = metaballsJson(args.file);
    else
      throw UsageError("info: " + args.file +
                       ": unknown kind of file; expected .toml, .png, .exr, .hdr, .dds, .raw, .vdb or .json");
  }
  if (j.is_null()) j = texelsJson(args.file);
  if (args.json)
    fmt::print("{}\n", printableJson(j.dump(2, ' ', false, Json::error_handler_t::replace)));
  else
    printPlain(j);
  return 0;
}

}  // namespace welkin::app
