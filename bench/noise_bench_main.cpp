// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "bench/noise_bench.h"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  welkin::bench::registerNoiseBenchmarks();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
