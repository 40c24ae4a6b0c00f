// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: any bytes as a report. What is decoded must keep the promises of metar.h, and the weather
// made of it must be one that the renderers accept.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "welkin/weather/from_metar.h"
#include "welkin/weather/metar.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace welkin::weather;
  const std::string_view report(reinterpret_cast<const char*>(data), size);
  const MetarResult result = parseMetar(report);
  std::size_t column = 1;
  for (const MetarError& e : result.errors) {
    require(e.column >= column && e.column <= size + 1 && !e.reason.empty());
    for (const char c : e.reason) require(c >= ' ' && c <= '~');
    column = e.column;
  }
  require(result.errors.size() <= kMaxMetarErrors);

  // The first byte also chooses place and season.
  const double latitudeDeg = size > 0 ? data[0] * (180.0 / 255.0) - 90.0 : 0.0;
  const int month = size > 0 ? 1 + data[0] % 12 : 1;
  const Weather weather = weatherFromMetar(result.metar, latitudeDeg, month, 12.0);
  require(weather.requestedOktas >= 0.0 && weather.requestedOktas <= 8.0);
  require(weather.visibilityM > 0.0 && std::isfinite(weather.visibilityM));
  double baseM = 0.0;
  for (const Layer& layer : weather.layers) {
    validate(layer);
    require(layer.baseM >= baseM);
    baseM = layer.baseM;
  }
  return 0;
}
