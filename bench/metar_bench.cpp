// SPDX-License-Identifier: Apache-2.0
// Reports decoded a second on one core. The reports are the examples of the tests.
#include <benchmark/benchmark.h>

#include <fstream>
#include <string>
#include <vector>

#include "welkin/weather/metar.h"

namespace {

// The texts alone, without a JSON reader: the first member of each line is "metar".
std::vector<std::string> exampleReports() {
  std::ifstream in(WELKIN_METAR_EXAMPLES);
  std::vector<std::string> reports;
  for (std::string line; std::getline(in, line);) {
    const std::string start = "{\"metar\": \"";
    reports.push_back(line.substr(start.size(), line.find('"', start.size()) - start.size()));
  }
  return reports;
}

void parseMetars(benchmark::State& state) {
  const auto reports = exampleReports();
  if (reports.empty()) {
    state.SkipWithError("no reports");
    return;
  }
  for (auto _ : state) {
    for (const auto& report : reports) benchmark::DoNotOptimize(welkin::weather::parseMetar(report));
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * reports.size()));
}
BENCHMARK(parseMetars);

}  // namespace

BENCHMARK_MAIN();
