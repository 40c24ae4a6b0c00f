// SPDX-License-Identifier: Apache-2.0
#include "cloud_command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "interrupt.h"
#include "progress_line.h"
#include "render_settings.h"
#include "report.h"
#include "stopwatch.h"
#include "texel_flags.h"
#include "texel_output.h"
#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/field/cloud_map.h"
#include "welkin/field/cumulus_tower.h"
#include "welkin/field/metaball_cumulus.h"
#include "welkin/io/atomic_file.h"
#include "welkin/io/file_extension.h"
#include "welkin/scene/ellipsoid_file.h"
#include "welkin/scene/metaball_file.h"
#include "welkin/scene/param_json.h"

namespace welkin::app {

// Everything that has a flag.
struct CloudRequest {
  field::CloudMapParams map;
  double lowM = 0.0;  // height of the base of the box; 0 but for metaballs
  field::Ellipsoid ellipsoid;
  field::CumulusParams tower;
};

namespace {

glm::dvec3 firstVoxelM(const CloudRequest& r) {
  return field::firstVoxelM(r.map) + glm::dvec3(0.0, 0.0, r.lowM);
}

}  // namespace

void describe(CloudRequest& r, ParamVisitor& v) {
  describe(r.map, v);
  v.group({"ellipsoid", "", "one ellipsoid; unless told it fills 95 % of the box"}, r.ellipsoid);
  v.group({"tower", "", "a tower of cumulus"}, r.tower);
}

namespace {

using Json = nlohmann::ordered_json;

bool anyOf(const ParamTexts& texts, std::string_view group) {
  return std::any_of(texts.begin(), texts.end(), [&](const auto& t) { return t.first.starts_with(group); });
}

void applySize(const std::string& text, field::CloudMapParams& map) {
  if (!isVolume(text)) throw UsageError("--size: expected WIDTHxHEIGHTxDEPTH, found \"" + text + "\"");
  const glm::ivec3 size = sizeOf(text);
  map.nx = size.x, map.ny = size.y, map.nz = size.z;
}

void validateMap(const field::CloudMapParams& map) {
  try {
    validate(map);
  } catch (const ParameterError& e) {
    throw UsageError("cloud: " + std::string(e.what()));
  }
}

std::vector<field::Ellipsoid> ellipsoidsOf(const CloudArgs& args, CloudRequest& r) {
  const auto flags = cloudParamFlags();
  if (args.cumulus && args.ellipsoids) throw UsageError("--cumulus and --ellipsoids: expected one of them");
  if (!args.cumulus && anyOf(args.params, "tower."))
    throw UsageError("cloud: --width, --height and what else shapes a tower go with --cumulus");
  if ((args.cumulus || args.ellipsoids) && anyOf(args.params, "ellipsoid."))
    throw UsageError(
        "cloud: --centre, --radii and --rotation describe the only ellipsoid; not with --cumulus or "
        "--ellipsoids");
  applyTexts(r, args.params, flags);
  if (args.cumulus) {
    r.map = field::cumulusMap(r.tower, r.map.voxelM);
    applyTexts(r, args.params, flags);
  }
  if (args.size) applySize(*args.size, r.map);
  std::vector<field::Ellipsoid> ellipsoids;
  if (args.cumulus) {
    ellipsoids = field::cumulusTower(r.tower);
  } else if (args.ellipsoids) {
    ellipsoids = scene::readEllipsoids(*args.ellipsoids);
  } else {
    r.ellipsoid = field::centredEllipsoid(r.map);
    applyTexts(r, args.params, flags);
    return {r.ellipsoid};
  }
  if (args.ellipsoids && !args.size) field::fitBox(r.map, ellipsoids);
  return ellipsoids;
}

// The balls of a file, drawn into voxels. Unless its size is given the box holds them all, those below height
// 0 too.
Volume<float> rasterised(const CloudArgs& args, CloudRequest& r) {
  if (args.cumulus || args.ellipsoids)
    throw UsageError("--metaballs, --cumulus and --ellipsoids: expected one of them");
  for (const auto& [path, text] : args.params)
    if (path != "voxel_m" && path != "dynamics")
      throw UsageError(
          "cloud: of all that shapes a cloud, only --size, --voxel and --dynamics go with --metaballs");
  applyTexts(r, args.params, cloudParamFlags());
  std::vector<field::Metaball> balls = scene::readMetaballs(*args.metaballs).levels.back().balls;
  for (field::Metaball& b : balls) b.density *= r.map.dynamics;
  if (args.size) {
    applySize(*args.size, r.map);
  } else {
    const double below = field::boundsOf(balls).low.z / r.map.voxelM;
    r.lowM = std::min(std::floor(below), 0.0) * r.map.voxelM;
    std::vector<field::Ellipsoid> box;
    box.reserve(balls.size());
    for (const field::Metaball& b : balls)
      box.push_back({b.centreM - glm::dvec3(0.0, 0.0, r.lowM), glm::dvec3(b.radiusM), glm::dvec3(0.0)});
    field::fitBox(r.map, box);
  }
  validateMap(r.map);
  Volume<float> map =
      field::rasterise(balls, {static_cast<int>(r.map.nx), static_cast<int>(r.map.ny),
                               static_cast<int>(r.map.nz), glm::dvec3(r.map.voxelM), firstVoxelM(r)});
  bool empty = true;
  for (float& v : map.data) {
    v = std::max(v, 0.0f);
    empty = empty && v == 0.0f;
  }
  if (empty)
    throw ParameterError(*args.metaballs +
                         ": the cloud is empty: the sum of the balls is above 0 at no voxel's centre");
  return map;
}

// Names of files may be no UTF-8.
std::string dumped(const Json& j, int indent) {
  return j.dump(indent, ' ', false, Json::error_handler_t::replace);
}

// Everything that the cloud was made of.
Json cloudJson(const CloudArgs& args, const CloudRequest& r) {
  Json j = Json::parse(scene::toJson(r.map));
  if (args.metaballs) {
    for (const char* unused : {"threshold", "base_m", "noise"}) j.erase(unused);
    j["metaballs"] = *args.metaballs;
  } else if (args.ellipsoids) {
    j["ellipsoids"] = *args.ellipsoids;
  } else if (args.cumulus) {
    j["tower"] = Json::parse(scene::toJson(r.tower));
  } else {
    j["ellipsoid"] = Json::parse(scene::toJson(r.ellipsoid));
  }
  return j;
}

TexelSource sourceOf(const CloudArgs& args, const CloudRequest& r) {
  TexelSource s;
  s.command = "cloud";
  s.size = {static_cast<int>(r.map.nx), static_cast<int>(r.map.ny), static_cast<int>(r.map.nz)};
  s.volume = true;
  s.northUp = true;
  s.measures = true;
  s.format = fileKindOf(s.command, *args.output.out, ".vdb, .raw, .dds, or .json with --cumulus") ==
                     io::TexelFileKind::kDds
                 ? io::TexelFormat{io::Channels::kA, io::ValueType::kUnorm8}
                 : io::TexelFormat{io::Channels::kR, io::ValueType::kFloat};
  for (const Flag& input : {args.ellipsoids, args.metaballs})
    if (input) s.inputs.push_back(*input);
  s.notes.voxelSizeM = glm::dvec3(r.map.voxelM);
  s.notes.firstVoxelM = firstVoxelM(r);
  s.notes.name = "density";
  s.notes.metadata = {{"Software", "welkin " WELKIN_VERSION},
                      {"welkin_cloud", dumped(cloudJson(args, r), -1)}};
  return s;
}

Json reportOf(const CloudArgs& args, const CloudRequest& r, std::size_t ellipsoids, const TexelOutput& output,
              std::int64_t voxels, double ms) {
  const TexelStatistics& s = output.statistics();
  return {{"welkin", WELKIN_VERSION},
          {"size", {r.map.nx, r.map.ny, r.map.nz}},
          {"format", io::nameOf(output.shape().format)},
          {"voxel_m", r.map.voxelM},
          {"ellipsoids", ellipsoids},
          {"cloud_voxels", voxels},
          {"min", s.least()},
          {"mean", s.mean()},
          {"max", s.greatest()},
          {"deviation", s.deviation()},
          {"histogram", s.histogram()},
          {"total_ms", ms},
          {"peak_rss_mib", peakRssMib()},
          {"cloud", cloudJson(args, r)},
          {"output", *args.output.out}};
}

// A tower of metaballs, without a map between.
int growMetaballs(const CloudArgs& args) {
  const OutputArgs& o = args.output;
  if (!args.cumulus)
    throw UsageError("cloud: " + *o.out +
                     ": metaballs are grown by --cumulus; welkin fit makes them from a map");
  for (const auto& [path, text] : args.params)
    if (!path.starts_with("tower.") && path != "dynamics")
      throw UsageError(
          "cloud: " + *o.out +
          ": metaballs have neither voxels nor noise; expected only --dynamics, their density, and "
          "the flags of a tower");
  if (args.size || o.preview || o.tile || o.file.format || o.file.mipmaps || o.file.edges || o.file.header)
    throw UsageError("cloud: " + *o.out + ": --size, --preview, --tile and --format are for volumes");
  checkFiles(o, {});
  CloudRequest r;
  applyTexts(r, args.params, cloudParamFlags());
  const Stopwatch watch;
  scene::MetaballFile file;
  file.levels.push_back({field::cumulusMetaballs(r.tower, r.map.dynamics), {}, {}});
  io::writeTextFile(*o.out, scene::metaballText(file));
  if (o.report) {
    const Json report = {
        {"welkin", WELKIN_VERSION},
        {"output", *o.out},
        {"balls", file.balls().size()},
        {"integral_m3", field::integralOf(file.balls())},
        {"total_ms", watch.ms()},
        {"cloud", {{"dynamics", r.map.dynamics}, {"tower", Json::parse(scene::toJson(r.tower))}}}};
    io::writeTextFile(*o.report, dumped(report, 2) + "\n");
  }
  return 0;
}

}  // namespace

std::vector<scene::ParamDoc> cloudParamDocs() {
  std::vector<scene::ParamDoc> rows = scene::documentParams<CloudRequest>();
  // They follow from the box.
  for (scene::ParamDoc& row : rows) {
    if (row.path == "ellipsoid.centre_m") row.defaultValue = "the middle of the box";
    if (row.path == "ellipsoid.radii_m") row.defaultValue = "95 % of the box's";
  }
  return rows;
}

std::vector<ParamFlag> cloudParamFlags() {
  constexpr std::array<std::string_view, 3> kFromSize = {"nx", "ny", "nz"};
  return paramFlags(
      cloudParamDocs(), {},
      {{"", "Map"}, {"[noise]", "Noise"}, {"[ellipsoid]", "One ellipsoid"}, {"[tower]", "Cumulus"}},
      kFromSize);
}

int runCloud(const CloudArgs& args) {
  if (!args.output.out) throw UsageError("cloud: expected -o OUT, the file to write");
  if (args.output.threads) setThreadCount(threadsOf(*args.output.threads));
  const std::filesystem::path out = *args.output.out;
  if (io::lowerExtension(out) == ".json" && io::lowerExtension(out.stem()) != ".raw")
    return growMetaballs(args);
  CloudRequest request;
  catchInterrupts();
  const Stopwatch watch;
  Volume<float> map;
  std::vector<field::Ellipsoid> ellipsoids;
  if (args.metaballs) {
    map = rasterised(args, request);
  } else {
    ellipsoids = ellipsoidsOf(args, request);
    validateMap(request.map);
  }
  TexelOutput output(args.output, sourceOf(args, request));
  ProgressLine progress;
  progress.begin("filling the cloud");
  if (!args.metaballs)
    map = field::cloudMap(request.map, ellipsoids, [&](double fraction) {
      throwIfInterrupted();
      progress.show(fraction);
    });
  const auto voxels = std::count_if(map.data.begin(), map.data.end(), [](float d) { return d > 0.0f; });
  progress.begin("writing");
  const std::size_t slice = static_cast<std::size_t>(map.nx) * map.ny;
  for (int z = 0; z < map.nz; ++z) {
    throwIfInterrupted();
    progress.show(static_cast<double>(z) / map.nz);
    output.write(std::span(map.data).subspan(slice * z, slice));
  }
  output.close();
  if (args.output.report) {
    const Json report = reportOf(args, request, ellipsoids.size(), output, voxels, watch.ms());
    io::writeTextFile(*args.output.report, dumped(report, 2) + "\n");
  }
  return 0;
}

}  // namespace welkin::app
