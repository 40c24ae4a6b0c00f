// SPDX-License-Identifier: Apache-2.0
#include "bench/noise_bench.h"

#include <benchmark/benchmark.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "welkin/core/parallel.h"
#include "welkin/noise/noise.h"

namespace welkin::bench {
namespace {

using noise::Grid;
using noise::Kind;
using noise::Noise;
using noise::NoiseParams;

// Memory by pages' own alignment, kept for the next benchmark: the first touch of fresh pages costs more than
// the noise on them.
std::byte* buffer(std::size_t bytes) {
  static std::vector<std::byte> memory;
  constexpr std::size_t kPage = 4096;
  if (memory.size() < bytes + kPage) memory.assign(bytes + kPage, std::byte{1});
  const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
  return memory.data() + (kPage - address % kPage) % kPage;
}

struct Workload {
  std::string name;
  NoiseParams params;
  int size;  // samples across
  bool bytes;

  Grid grid(int across) const {
    const glm::ivec3 samples(across, across, params.dimensions == 3 ? across : 1);
    return params.tile ? Grid::tile(samples) : Grid{samples, glm::dvec3(1.0)};
  }
};

std::vector<Workload> workloads() {
  const auto cells = [](double n) { return glm::dvec3(n); };
  const auto value = [](NoiseParams p, bool smooth) {
    p.kind = Kind::kValue;
    p.smooth = smooth;
    return p;
  };
  constexpr double kTime = 0.4;
  return {
      {"W1", {.frequency = cells(6), .octaves = 6}, 128, true},
      {"W2", {.dimensions = 2, .frequency = cells(3), .octaves = 10}, 1024, true},
      {"W3", {.tile = false, .frequency = cells(0.02), .octaves = 1}, 256, false},
      {"W4", {.tile = false, .frequency = cells(0.05), .octaves = 5}, 256, false},
      {"W5", {.kind = Kind::kCellular, .frequency = cells(8), .octaves = 1}, 128, false},
      {"W6", {.kind = Kind::kPerlinWorley, .frequency = cells(4), .octaves = 3}, 128, true},
      {"V1", value({.dimensions = 2, .frequency = cells(3), .octaves = 10}, false), 1024, false},
      {"V2", value({.dimensions = 2, .frequency = cells(3), .octaves = 10}, true), 1024, false},
      {"V3", value({.frequency = cells(6), .octaves = 6}, false), 128, false},
      {"V4", value({.frequency = cells(6), .octaves = 6}, true), 128, false},
      {"V5", value({.frequency = cells(6), .octaves = 6, .time = kTime}, false), 128, false},
      {"V6", value({.frequency = cells(6), .octaves = 6, .time = kTime}, true), 128, false},
  };
}

void setCounter(benchmark::State& state, double samples) {
  using benchmark::Counter;
  // Seconds a sample times 1e9.
  state.counters["ns_per_sample"] =
      Counter(samples * 1e-9, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

template <class T>
void fill(benchmark::State& state, const Workload& w, int across) {
  const Noise noise(w.params);
  const Grid grid = w.grid(across);
  const std::size_t samples = static_cast<std::size_t>(grid.size.x) * grid.size.y * grid.size.z;
  const std::size_t values = samples * static_cast<std::size_t>(noise.channels());
  const std::span<T> out(reinterpret_cast<T*>(buffer(values * sizeof(T))), values);
  noise.fill(grid, out);
  for (auto _ : state) {
    noise.fill(grid, out);
    benchmark::ClobberMemory();
  }
  setCounter(state, static_cast<double>(samples));
}

// What is measured, in the order of registration.
using Register = std::vector<NoiseTime>;

void add(Register& all, const Workload& w, std::int64_t target, int threads, int across) {
  const std::string set = target == HWY_AVX3 ? "AVX-512" : hwy::TargetName(target);
  all.push_back({w.name, set, threads, across, 0.0});
  auto* made =
      benchmark::RegisterBenchmark(std::to_string(all.size() - 1).c_str(), [=](benchmark::State& state) {
        hwy::SetSupportedTargetsForTest(target);
        const int before = threadCount();
        setThreadCount(threads);
        if (w.bytes)
          fill<std::uint8_t>(state, w, across);
        else
          fill<float>(state, w, across);
        setThreadCount(before);
        hwy::SetSupportedTargetsForTest(0);
      });
  // One thread is measured by its own processor time, which others on the machine do not lengthen much.
  if (threads > 1) made->UseRealTime();
}

// What writing 64 MiB of floats costs without computing any, as the C library's memset does it.
constexpr std::size_t kFloats = std::size_t{16} << 20;
void writeMemory(benchmark::State& state) {
  std::byte* out = buffer(kFloats * sizeof(float));
  int value = 0;
  for (auto _ : state) {
    std::memset(out, ++value, kFloats * sizeof(float));
    benchmark::ClobberMemory();
  }
  setCounter(state, kFloats);
}

// The same past the caches, as fills write what is larger than these.
void streamMemory(benchmark::State& state) {
  auto* out = reinterpret_cast<float*>(buffer(kFloats * sizeof(float)));
  float value = 0.0f;
  for (auto _ : state) {
    value += 1.0f;
#ifdef __SSE2__
    const __m128 four = _mm_set1_ps(value);
    for (std::size_t i = 0; i < kFloats; i += 4) _mm_stream_ps(out + i, four);
    _mm_sfence();
#else
    std::fill_n(out, kFloats, value);
#endif
    benchmark::ClobberMemory();
  }
  setCounter(state, kFloats);
}

Register registerAll() {
  Register all;
  all.push_back({"write", "", 1, 256, 0.0});
  benchmark::RegisterBenchmark("0", writeMemory);
  all.push_back({"write past caches", "", 1, 256, 0.0});
  benchmark::RegisterBenchmark("1", streamMemory);
  const std::int64_t supported = hwy::SupportedTargets();
  std::vector<std::int64_t> targets;  // best first
  for (const std::int64_t t : {std::int64_t{HWY_AVX3}, std::int64_t{HWY_AVX2}, std::int64_t{HWY_SSE4}})
    if ((supported & t) != 0) targets.push_back(t);
  if (targets.empty()) targets.push_back(supported & -supported);
  for (const Workload& w : workloads()) {
    for (const std::int64_t t : targets) add(all, w, t, 1, w.size);
    add(all, w, targets[0], 2, w.size);
  }
  for (const Workload& w : workloads())
    if (w.name == "W1" || w.name == "W3" || w.name == "W4")
      for (const int across : {64, 128, 256, 512}) {
        if (across == w.size) continue;
        add(all, w, targets[0], 1, across);
        // W3 is so fast that it is the caches and memory that are measured.
        if (w.name == "W3") add(all, w, targets[0], 2, across);
      }
  return all;
}

// Takes the medians of what Google Benchmark reports.
class Medians : public benchmark::BenchmarkReporter {
 public:
  explicit Medians(Register& all) : all_(all) {}
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Aggregate && run.aggregate_name == "median")
        all_.at(std::stoul(run.run_name.function_name)).nsPerSample = run.counters.at("ns_per_sample").value;
  }

 private:
  Register& all_;
};

}  // namespace

std::vector<NoiseTime> measureNoise(int repetitions) {
  Register all = registerAll();
  // Every argument is Google Benchmark's own. Repetitions in a random order: what others do on the machine
  // for some seconds then falls on all alike, and one thread and two can be compared.
  std::vector<std::string> flags = {"noise", "--benchmark_min_time=0.1",
                                    "--benchmark_enable_random_interleaving=true",
                                    "--benchmark_repetitions=" + std::to_string(repetitions)};
  std::vector<char*> argv;
  for (std::string& f : flags) argv.push_back(f.data());
  int argc = static_cast<int>(argv.size());
  argv.push_back(nullptr);
  benchmark::Initialize(&argc, argv.data());
  Medians medians(all);
  benchmark::RunSpecifiedBenchmarks(&medians);
  benchmark::Shutdown();
  return all;
}

}  // namespace welkin::bench
