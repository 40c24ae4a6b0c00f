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

Json noiseJson(bool json) {
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

Json frameJson(bool json) {
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

Json splatJson(bool json) {
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

struct Subject {
  const char* name;
  Json (*measure)(bool json);
};
constexpr std::array<Subject, 3> kSubjects = {
    {{"noise", noiseJson}, {"frame", frameJson}, {"splat", splatJson}}};

}  // namespace

int runBench(const BenchArgs& args) {
  std::vector<std::string> names;
  names.reserve(kSubjects.size());
  for (const Subject& s : kSubjects) names.push_back(s.name);
  for (const std::string& name : args.names)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw UsageError("bench: there is no benchmark \"" + name + "\"" + didYouMean(name, names));
  const Machine machine;
  Json all = {{"processor", machine.processor}, {"threads", machine.threads}};
  if (!args.json) fmt::print("{}, {} threads\n", machine.processor, machine.threads);
  for (const Subject& s : kSubjects) {
    if (!args.names.empty() && std::find(args.names.begin(), args.names.end(), s.name) == args.names.end())
      continue;
    if (!args.json) fmt::print("\n");
    all[s.name] = s.measure(args.json);
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
