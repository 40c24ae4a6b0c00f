// SPDX-License-Identifier: Apache-2.0
#include "fit_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "call_files.h"
#include "interrupt.h"
#include "picture_writer.h"
#include "progress_line.h"
#include "render_settings.h"
#include "report.h"
#include "stopwatch.h"
#include "texel_flags.h"
#include "welkin/core/parallel.h"
#include "welkin/fit/fit_metaballs.h"
#include "welkin/io/atomic_file.h"
#include "welkin/io/texel_file.h"
#include "welkin/scene/metaball_file.h"
#include "welkin/scene/param_json.h"

namespace welkin::app {
namespace {

using Json = nlohmann::ordered_json;
using fit::FitLevel;

constexpr std::size_t kMostBalls = 1000000;

// "30,100,1000", ascending, each once.
std::vector<std::size_t> countsOf(const std::string& text) {
  std::vector<std::size_t> counts;
  const char *at = text.data(), *const end = at + text.size();
  for (bool more = true; more;) {
    std::size_t n = 0;
    const auto [next, error] = std::from_chars(at, end, n);
    more = next != end && *next == ',';
    if (error != std::errc() || (next != end && !more) || n < 1 || n > kMostBalls)
      throw UsageError("--balls: expected whole numbers from 1 to " + std::to_string(kMostBalls) +
                       " with commas between, 30,100,1000 for instance, found \"" + text + "\"");
    counts.push_back(n);
    at = next + (more ? 1 : 0);
  }
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  return counts;
}

void checkFlags(const FitArgs& args) {
  if (args.map.empty()) throw UsageError("fit: expected a MAP, the volume to fit");
  if (!args.out) throw UsageError("fit: expected -o OUT.json, the file to write");
  if (!args.balls && !args.resume) throw UsageError("fit: expected --balls K, how many");
  if (!args.out->ends_with(".json"))
    throw UsageError("fit: " + *args.out + " is no .json; expected a name such as cloud.json");
  fileKindOf("fit", args.map, kVolumeFile);
  // Balls may take the place of those that they went on from.
  CallFiles files;
  files.readsTexels(args.map);
  files.writes("-o", *args.out);
  if (args.report) files.writes("--report", *args.report);
  if (args.resume && args.report) {
    CallFiles resumed;
    resumed.reads(*args.resume);
    resumed.writes("--report", *args.report);
  }
}

struct Map {
  Volume<float> density;
  field::VoxelFrame frame;
};

Map readMap(const std::string& path) {
  const io::Texels texels = io::readTexels(path);
  const io::TexelShape& shape = texels.shape;
  if (!shape.volume) throw ParameterError(path + " is a picture; expected a volume of density");
  if (shape.format.channelCount() != 1)
    throw ParameterError(path + " has " + std::to_string(shape.format.channelCount()) +
                         " channels; expected a volume of density, which has one");
  Map map{Volume<float>(shape.nx, shape.ny, shape.nz, 1),
          {shape.nx, shape.ny, shape.nz, texels.notes.voxelSizeM, texels.notes.firstVoxelM}};
  const std::size_t row = static_cast<std::size_t>(shape.nx);
  for (std::size_t at = 0; at < map.density.data.size(); at += row)
    io::toFloats(shape.format.type,
                 std::span(texels.bytes).subspan(at * shape.texelBytes(), shape.rowBytes()),
                 std::span(map.density.data).subspan(at, row));
  return map;
}

std::vector<FitLevel> levelsOf(const FitArgs& args) {
  std::vector<FitLevel> levels;
  if (args.balls)
    for (const std::size_t count : countsOf(*args.balls)) {
      levels.emplace_back();
      levels.back().count = count;
    }
  if (!args.resume) return levels;
  const scene::MetaballFile file = scene::readMetaballs(*args.resume);
  bool found = false;
  std::string sizes;
  for (const scene::MetaballLevel& known : file.levels) {
    sizes += (sizes.empty() ? "" : ", ") + std::to_string(known.balls.size());
    if (!args.balls) {
      levels.emplace_back();
      levels.back().count = known.balls.size();
    }
    for (FitLevel& level : levels)
      if (level.count == known.balls.size()) {
        level.balls = known.balls;
        level.relativeL2 = known.relativeL2.value_or(1.0);
        level.rmse = known.rmse.value_or(0.0);
        found = true;
      }
  }
  if (!found)
    throw UsageError("--resume: " + *args.resume + " has levels of " + sizes +
                     " balls; expected one of them in --balls");
  std::sort(levels.begin(), levels.end(),
            [](const FitLevel& a, const FitLevel& b) { return a.count < b.count; });
  return levels;
}

// The levels that have balls.
std::optional<std::string> fileText(const std::vector<FitLevel>& levels) {
  scene::MetaballFile file;
  for (const FitLevel& level : levels)
    if (!level.balls.empty()) file.levels.push_back({level.balls, level.relativeL2, level.rmse});
  if (file.levels.empty()) return std::nullopt;
  return scene::metaballText(file);
}

std::string reportText(const FitArgs& args, const fit::FitParams& params, const Map& map,
                       const std::vector<FitLevel>& levels, double ms) {
  const auto voxels =
      std::count_if(map.density.data.begin(), map.density.data.end(), [](float d) { return d != 0.0f; });
  const glm::dvec3 &size = map.frame.voxelSizeM, &first = map.frame.firstVoxelM;
  Json report = {{"welkin", WELKIN_VERSION},
                 {"map", args.map},
                 {"output", *args.out},
                 {"size", {map.frame.nx, map.frame.ny, map.frame.nz}},
                 {"voxel_size_m", {size.x, size.y, size.z}},
                 {"first_voxel_m", {first.x, first.y, first.z}},
                 {"cloud_voxels", voxels},
                 {"levels", Json::array()},
                 {"threads", threadCount()},
                 {"total_ms", ms},
                 {"peak_rss_mib", peakRssMib()},
                 {"fit", Json::parse(scene::toJson(params))}};
  for (const FitLevel& level : levels)
    report["levels"].push_back({{"k", level.count},
                                {"relative_l2", level.relativeL2},
                                {"rmse", level.rmse},
                                {"seconds", level.seconds},
                                {"complete", level.complete}});
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::vector<scene::ParamDoc> fitParamDocs() {
  return scene::documentParams<fit::FitParams>();
}

std::vector<ParamFlag> fitParamFlags() {
  return paramFlags(fitParamDocs(), {{"time_limit_s", "--time-limit"}}, {{"", "Fit"}}, {});
}

int runFit(const FitArgs& args) {
  checkFlags(args);
  if (args.threads) setThreadCount(threadsOf(*args.threads));
  fit::FitParams params;
  applyTexts(params, args.params, fitParamFlags());
  std::vector<FitLevel> levels = levelsOf(args);
  if (params.isSigned && params.method == fit::FitMethod::kMan)
    throw UsageError("fit: --signed goes with the methods refined and weights");
  checkWritable(*args.out);
  if (args.report) checkWritable(*args.report);
  catchInterrupts();
  const Stopwatch watch;
  ProgressLine progress;
  progress.begin("reading " + args.map);
  const Map map = readMap(args.map);
  std::size_t shown = levels.size();
  const auto write = [&] {
    const auto text = fileText(levels);
    if (!text) return;
    io::writeTextFile(*args.out, *text);
    if (args.report) io::writeTextFile(*args.report, reportText(args, params, map, levels, watch.ms()));
  };
  try {
    fit::fitMetaballs(map.density, map.frame, params, levels, [&](const fit::FitProgress& p) {
      throwIfInterrupted();
      if (p.level != shown) progress.begin(fmt::format("fitting {} balls", levels[p.level].count));
      shown = p.level;
      progress.show(p.fraction, fmt::format("error {:.4f}", p.relativeL2));
    });
  } catch (const Interrupted&) {
    write();
    throw;
  } catch (const ParameterError& e) {
    throw ParameterError("cannot fit " + args.map + ": " + e.what());
  }
  write();
  return 0;
}

}  // namespace welkin::app
