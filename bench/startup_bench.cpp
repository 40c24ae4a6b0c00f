// SPDX-License-Identifier: Apache-2.0
// What a sky costs before its first pixel: noise, calibration of cover and its measurement, atmosphere.
#include <benchmark/benchmark.h>

#include "welkin/field/cloud_field.h"
#include "welkin/scene/scene.h"
#include "welkin/scene/sky_state.h"
#include "welkin/sky/atmosphere.h"

namespace {

void noise(benchmark::State& state) {
  std::uint64_t seed = 1;
  for (auto _ : state) benchmark::DoNotOptimize(welkin::field::makeCloudNoise(seed++));
}
BENCHMARK(noise)->Unit(benchmark::kMillisecond)->UseRealTime();

void atmosphere(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(
        welkin::sky::Atmosphere(welkin::sky::AtmosphereParams{}, 40e3, 0.0, glm::vec3(0.1f)));
}
BENCHMARK(atmosphere)->Unit(benchmark::kMillisecond)->UseRealTime();

void sky(benchmark::State& state, const char* metar) {
  welkin::scene::Scene scene;
  scene.metar = metar;
  scene.time = {2026, 6, 21, 11, 0, 0.0};
  for (auto _ : state) {
    benchmark::DoNotOptimize(welkin::scene::buildSky(scene, 0.0));
    ++scene.seed;
  }
}
BENCHMARK_CAPTURE(sky, clear, "LSZH 211100Z 24008KT CAVOK 24/12 Q1018")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(sky, one_layer, "LSZH 211100Z 24008KT 9999 SCT040 24/12 Q1018")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(sky, three_layers, "LSZH 211100Z 24008KT 9999 FEW020 SCT040 BKN120 24/12 Q1018")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
