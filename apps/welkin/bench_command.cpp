// SPDX-License-Identifier: Apache-2.0
#include "bench_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "usage_error.h"
#ifdef WELKIN_HAS_BENCH
#include "bench/frame_bench.h"
#include "bench/noise_bench.h"
#include "bench/splat_bench.h"
#include "bench/tracer_bench.h"
#include "bench/truth_bench.h"
#endif

namespace welkin::app {
#ifdef WELKIN_HAS_BENCH
namespace {

using Json = nlohmann::ordered_json;

constexpr int kRepetitions = 9;  // of each benchmark of noise

// The processor by the name the kernel has for it, else "".
std::string processorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) {
      const std::size_t at = line.find(": ");
      if (at != std::string::npos) return line.substr(at + 2);
    }
  return {};
}

struct Machine {
  std::string processor = processorName();
  unsigned threads = std::thread::hardware_concurrency();
};

Json noiseJson(const BenchArgs& args) {
  const bool json = args.json;
  const std::vector<bench::NoiseTime> times = bench::measureNoise(kRepetitions);
  Json all = Json::array();
  if (!json) {
    fmt::print("Noise, medians of {}\n\n", kRepetitions);
    fmt::print(
        "| workload | instructions | threads | samples across | ns a sample |\n|---|---|---:|---:|---:|\n");
  }
  for (const bench::NoiseTime& t : times) {
    if (!json)
      fmt::print("| {} | {} | {} | {} | {:.3f} |\n", t.name, t.set, t.threads, t.size, t.nsPerSample);
    all.push_back({{"workload", t.name},
                   {"instructions", t.set},
                   {"threads", t.threads},
                   {"samples_across", t.size},
                   {"ns_per_sample", t.nsPerSample}});
  }
  return {{"median_of", kRepetitions}, {"times", all}};
}

Json frameJson(const BenchArgs& args) {
  const bool json = args.json;
  const bench::FrameTable table = bench::measureFrames();
  Json all = Json::array();
  if (!json) {
    fmt::print("Frames of {}x{} on {}, medians of {}\n\n", table.width, table.height, table.device,
               table.rounds);
    fmt::print("| frame | ms | in Y | frames a second | share of the empty sky's | thesis, 2004 |\n");
    fmt::print("|---|---:|---:|---:|---:|---:|\n");
  }
  constexpr double kThesisEmptyFps = 83.0;
  for (const bench::FrameTime& row : table.rows) {
    if (!json)
      fmt::print("| {} | {:.2f} | {:.2f} | {:.0f} | {} | {} |\n", row.name, row.ms, row.yardsticks,
                 1000.0 / row.ms, row.share ? fmt::format("{:.2f}", *row.share) : "",
                 row.thesisFps
                     ? fmt::format("{:.0f} ({:.2f})", *row.thesisFps, *row.thesisFps / kThesisEmptyFps)
                     : "");
    Json j = {{"frame", row.name}, {"ms", row.ms}, {"yardsticks", row.yardsticks}};
    if (row.share) j["share_of_empty"] = *row.share;
    if (row.thesisFps) j["thesis_fps"] = *row.thesisFps;
    all.push_back(j);
  }
  return {{"device", table.device},
          {"width", table.width},
          {"height", table.height},
          {"median_of", table.rounds},
          {"times", all}};
}

Json splatJson(const BenchArgs& args) {
  const bool json = args.json;
  const bench::SplatTable table = bench::measureSplats();
  Json all = Json::array();
  if (!json) {
    fmt::print("Metaballs at {}x{} on {}, light and eye pass each frame, medians of {}\n\n", table.width,
               table.height, table.device, table.rounds);
    fmt::print("| balls | ms | frames a second |\n|---:|---:|---:|\n");
  }
  for (const bench::SplatTime& row : table.rows) {
    if (!json) fmt::print("| {} | {:.1f} | {:.1f} |\n", row.balls, row.ms, 1000.0 / row.ms);
    all.push_back({{"balls", row.balls}, {"ms", row.ms}});
  }
  return {{"device", table.device},
          {"width", table.width},
          {"height", table.height},
          {"median_of", table.rounds},
          {"times", all}};
}

Json truthJson(const BenchArgs& args) {
  const bench::TruthTable table =
      bench::measureTruth(args.truth.value_or("bench/truth"), args.pictures.value_or(""));
  constexpr std::array kNames = {"single", "octaves", "welkin"};
  const auto rows = static_cast<double>(table.rows.size());
  std::array<bench::TruthError, 3> mean{}, largest{};
  std::array<double, 3> cost{};
  Json all = Json::array();
  if (!args.json) {
    fmt::print(
        "The marched renderer against the truth, on {}: of the pixels, each by the clouds' opacity in it, "
        "the "
        "mean relative error of the luminance, bias of the mean luminance, and mean of FLIP\n\n",
        table.device);
    fmt::print(
        "| scene | noise of the truth | single scattering | octaves | Welkin |\n|---|---:|---:|---:|---:|\n");
  }
  auto text = [](const bench::TruthError& e) {
    return fmt::format("{:.1f} % ({:+.1f} %), {:.3f}", 100.0 * e.relative, 100.0 * e.bias, e.flip);
  };
  for (const bench::TruthRow& row : table.rows) {
    Json j = {{"scene", row.scene}, {"noise", row.noise}};
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      const bench::TruthError& e = row.errors[i];
      j[kNames[i]] = {{"relative", e.relative}, {"bias", e.bias}, {"flip", e.flip}, {"cpu_s", e.cpuS}};
      mean[i].relative += e.relative / rows;
      mean[i].bias += e.bias / rows;
      mean[i].flip += e.flip / rows;
      largest[i].relative = std::max(largest[i].relative, e.relative);
      cost[i] += e.cpuS;
    }
    if (!args.json)
      fmt::print("| {} | {:.1f} % | {} | {} | {} |\n", row.scene, 100.0 * row.noise, text(row.errors[0]),
                 text(row.errors[1]), text(row.errors[2]));
    all.push_back(j);
  }
  Json summary;
  for (std::size_t i = 0; i < kNames.size(); ++i)
    summary[kNames[i]] = {{"relative", mean[i].relative},
                          {"bias", mean[i].bias},
                          {"flip", mean[i].flip},
                          {"largest_relative", largest[i].relative},
                          {"cost_of_octaves", cost[i] / cost[1]}};
  if (!args.json) {
    fmt::print("| **mean** | | {} | {} | {} |\n", text(mean[0]), text(mean[1]), text(mean[2]));
    fmt::print("| **largest** | | {:.1f} % | {:.1f} % | {:.1f} % |\n", 100.0 * largest[0].relative,
               100.0 * largest[1].relative, 100.0 * largest[2].relative);
    fmt::print("| **processor time, in the octaves'** | | {:.2f} | 1 | {:.2f} |\n", cost[0] / cost[1],
               cost[2] / cost[1]);
  }
  return {{"device", table.device}, {"scenes", all}, {"summary", summary}};
}

Json tracerJson(const BenchArgs& args) {
  const std::vector<bench::TracerRow> rows = bench::measureTracer(args.truth.value_or("bench/truth"), 1);
  Json all = Json::array();
  if (!args.json) {
    fmt::print(
        "The reference renderer on one thread, {} paths at every seventh pixel, processor time without what "
        "bounds of the density take once\n\n",
        bench::kTracerPaths);
    fmt::print(
        "| scene | paths a second | scatterings a second | with chains | deviation of a path "
        "| hours to 2 % at 320x180 | bounds, s | luminance, cd/m2 "
        "|\n|---|---:|---:|---:|---:|---:|---:|---:|\n");
  }
  for (const bench::TracerRow& r : rows) {
    if (!args.json)
      fmt::print("| {} | {:.0f} | {:.0f} | {:.0f} | {:.2f} | {:.1f} | {:.1f} | {:.0f} +- {:.0f} |\n", r.scene,
                 r.pathsPerS, r.eventsPerS, r.allEventsPerS, r.deviation, r.hoursTo2Percent, r.boundsS,
                 r.mean, r.error);
    all.push_back({{"scene", r.scene},
                   {"paths_per_s", r.pathsPerS},
                   {"scatterings_per_s", r.eventsPerS},
                   {"scatterings_with_chains_per_s", r.allEventsPerS},
                   {"deviation", r.deviation},
                   {"hours_to_2_percent", r.hoursTo2Percent},
                   {"bounds_s", r.boundsS},
                   {"mean_cd_m2", r.mean},
                   {"error_cd_m2", r.error}});
  }
  return {{"paths_a_pixel", bench::kTracerPaths}, {"scenes", all}};
}

struct Subject {
  const char* name;
  Json (*measure)(const BenchArgs& args);
  bool unasked;  // measured where no name is given
};
constexpr std::array<Subject, 5> kSubjects = {{{"noise", noiseJson, true},
                                               {"frame", frameJson, true},
                                               {"splat", splatJson, true},
                                               {"truth", truthJson, false},
                                               {"tracer", tracerJson, false}}};

}  // namespace

int runBench(const BenchArgs& args) {
  std::vector<std::string> names;
  names.reserve(kSubjects.size());
  for (const Subject& s : kSubjects) names.push_back(s.name);
  for (const std::string& name : args.names)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw UsageError("bench: there is no benchmark \"" + name + "\"" + didYouMean(name, names));
  auto asked = [&](const char* name) {
    return std::find(args.names.begin(), args.names.end(), name) != args.names.end();
  };
  if (args.truth && !asked("truth") && !asked("tracer"))
    throw UsageError("bench: --truth is for truth and tracer; expected welkin bench truth");
  if (args.pictures && !asked("truth"))
    throw UsageError("bench: --pictures is for truth; expected welkin bench truth");
  const Machine machine;
  Json all = {{"processor", machine.processor}, {"threads", machine.threads}};
  if (!args.json) fmt::print("{}, {} threads\n", machine.processor, machine.threads);
  for (const Subject& s : kSubjects) {
    if (args.names.empty() ? !s.unasked
                           : std::find(args.names.begin(), args.names.end(), s.name) == args.names.end())
      continue;
    if (!args.json) fmt::print("\n");
    all[s.name] = s.measure(args);
  }
  if (args.json) fmt::print("{}\n", all.dump(2));
  return 0;
}

#else

int runBench(const BenchArgs&) {
  throw UsageError("bench: this program was built without Google Benchmark");
}

#endif
}  // namespace welkin::app
