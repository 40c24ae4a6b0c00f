// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>

#include "welkin/core/error.h"
#include "welkin/scene/sky_state.h"
#include "welkin/weather/from_metar.h"
#include "welkin/weather/metar.h"

namespace welkin::scene {
namespace {

constexpr double kHourS = 3600.0, kDayS = 24.0 * kHourS;

// Of the scene's time from the nearest moment with the report's day of the month, hour and minute.
double secondsFromReport(const UtcTime& time, const weather::Metar& report) {
  double least = 1e9;
  for (int days = -31; days <= 31; ++days) {
    UtcTime t =
        addSeconds({time.year, time.month, time.day, *report.hour, *report.minute, 0.0}, days * kDayS);
    if (t.day == *report.day) least = std::min(least, std::abs(secondsBetween(t, time)));
  }
  return least;
}

weather::Weather fromReport(const Scene& scene) {
  const weather::MetarResult result = weather::parseMetar(*scene.metar);
  if (!result.ok())
    throw ParseError("METAR", 0, static_cast<int>(result.errors.front().column),
                     result.errors.front().reason);
  if (result.metar.nil)
    throw ParseError("METAR", 0, 0, "the report is NIL, which says nothing about the weather");
  // Mean solar time: the equation of time is at most a quarter of an hour, which the rules do not feel.
  const UtcTime local = addSeconds(scene.time, scene.place.longitudeDeg / 15.0 * 3600.0);
  weather::Weather w = weather::weatherFromMetar(result.metar, scene.place.latitudeDeg, local.month,
                                                 local.hour + local.minute / 60.0);
  constexpr double kSameS = 2.0 * kHourS;
  if (result.metar.day && secondsFromReport(scene.time, result.metar) > kSameS) {
    std::array<char, 64> of{};
    std::snprintf(of.data(), of.size(), "day %d at %02d:%02d UTC", *result.metar.day, *result.metar.hour,
                  *result.metar.minute);
    w.notes.push_back("The report is of " + std::string(of.data()) + "; its weather is drawn for " +
                      formatUtcTime(scene.time) + ".");
  }
  return w;
}

weather::Weather byHand(const Scene& scene) {
  weather::Weather w;
  w.layers = scene.layers;
  // By all that tells two layers apart, so that their order in the file does not matter.
  const auto key = [](const weather::Layer& l) { return std::tuple(l.baseM, l.topM, l.genus, l.oktas); };
  std::sort(w.layers.begin(), w.layers.end(),
            [&](const weather::Layer& a, const weather::Layer& b) { return key(a) < key(b); });
  // Layers by hand lie over one another at random.
  double clear = 1.0;
  for (const weather::Layer& layer : w.layers) clear *= 1.0 - layer.oktas / 8.0;
  w.requestedOktas = 8.0 * (1.0 - clear);
  return w;
}

}  // namespace

weather::Weather weatherOf(const Scene& scene) {
  weather::Weather w = scene.metar ? fromReport(scene) : byHand(scene);
  if (scene.visibilityM) w.visibilityM = *scene.visibilityM;
  return w;
}

}  // namespace welkin::scene
