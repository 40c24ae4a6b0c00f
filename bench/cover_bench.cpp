// SPDX-License-Identifier: Apache-2.0
// "Cover is delivered": for every example report, the cover asked for and the cover measured on the clouds
// made from it, of each layer and of the whole sky, in the mean over several seeds. Prints one JSON line a
// report, then a summary.
//
//   cover_bench [EVERY [SEEDS [AT_S]]]      EVERY n-th report (1), SEEDS seeds (8), AT_S after its time (0)
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/field/cloud_field.h"
#include "welkin/scene/cloud_cover.h"
#include "welkin/scene/sky_state.h"
#include "welkin/weather/metar.h"

namespace {

using namespace welkin;

constexpr double kTolerance = 0.5;  // oktas

// A report and its mean delivered cover.
struct Case {
  scene::Scene scene;
  weather::Weather weather;
  std::vector<double> sums;   // a layer each, then the sky: delivered, over seeds
  std::vector<double> worst;  // largest deviation of a single seed
};

std::vector<Case> readCases(int every) {
  std::ifstream in(WELKIN_METAR_EXAMPLES);
  if (!in) throw IoError("cannot read " WELKIN_METAR_EXAMPLES);
  std::vector<Case> cases;
  int n = 0;
  for (std::string line; std::getline(in, line);) {
    if (n++ % every != 0) continue;
    Case c;
    const std::string metar = nlohmann::json::parse(line).at("metar");
    c.scene.metar = metar;
    // The report's day and hour, in a July.
    const weather::Metar decoded = weather::parseMetar(metar).metar;
    c.scene.time = {2026, 7, decoded.day.value_or(1), decoded.hour.value_or(12), decoded.minute.value_or(0),
                    0.0};
    c.scene.place = {47.0, 8.0, 0.0};
    try {
      c.weather = scene::weatherOf(c.scene);
    } catch (const std::exception&) {  // NIL says nothing about the sky
      continue;
    }
    c.sums.assign(c.weather.layers.size() + 1, 0.0);
    c.worst.assign(c.weather.layers.size() + 1, 0.0);
    cases.push_back(std::move(c));
  }
  if (in.bad()) throw IoError("cannot read all of " WELKIN_METAR_EXAMPLES);
  return cases;
}

double requestedOktas(const Case& c, std::size_t i) {
  return i < c.weather.layers.size() ? c.weather.layers[i].oktas : c.weather.requestedOktas;
}

void measure(Case& c, int seed, double atS, const std::shared_ptr<const field::CloudNoise>& noise) {
  c.scene.seed = seed;
  const auto calibration = scene::calibrationAt(c.scene, c.weather, noise, atS);
  const auto clouds = scene::cloudsAt(c.scene, c.weather, calibration, noise, atS);
  const scene::DeliveredCover cover = scene::measureCover(c.scene, c.weather, clouds, atS);
  for (std::size_t i = 0; i < c.sums.size(); ++i) {
    const double delivered =
        i < cover.layers.size() ? cover.layers[i].deliveredOktas : cover.sky.deliveredOktas;
    c.sums[i] += delivered;
    c.worst[i] = std::max(c.worst[i], std::abs(delivered - requestedOktas(c, i)));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int every = argc > 1 ? std::max(std::atoi(argv[1]), 1) : 1;
  const int seeds = argc > 2 ? std::max(std::atoi(argv[2]), 1) : 8;
  const double atS = argc > 3 ? std::atof(argv[3]) : 0.0;
  std::vector<Case> cases;
  try {
    cases = readCases(every);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "cover_bench: %s\n", e.what());
    return 1;
  }
  if (cases.empty()) {
    std::fputs("cover_bench: there are no reports\n", stderr);
    return 1;
  }
  const auto start = std::chrono::steady_clock::now();
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto noise = field::makeCloudNoise(static_cast<std::uint64_t>(seed));
    parallelFor(cases.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) measure(cases[i], seed, atS, noise);
    });
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;

  std::size_t delivered = 0, cloudy = 0, cloudyDelivered = 0, single = 0, singleAll = 0;
  double worstMean = 0.0;
  for (const Case& c : cases) {
    nlohmann::ordered_json line;
    line["metar"] = *c.scene.metar;
    bool good = true;
    for (std::size_t i = 0; i < c.sums.size(); ++i) {
      const bool isLayer = i < c.weather.layers.size();
      const double asked = requestedOktas(c, i), mean = c.sums[i] / seeds;
      good = good && std::abs(mean - asked) <= kTolerance;
      worstMean = std::max(worstMean, std::abs(mean - asked));
      ++singleAll;
      if (c.worst[i] <= kTolerance) ++single;
      nlohmann::ordered_json j;
      if (isLayer) {
        j["genus"] = kEnumNames<weather::Genus>[static_cast<std::size_t>(c.weather.layers[i].genus)];
        j["base_m"] = std::round(c.weather.layers[i].baseM);
      }
      j["requested_oktas"] = std::round(asked * 100) / 100;
      j["mean_oktas"] = std::round(mean * 100) / 100;
      j["worst_off_oktas"] = std::round(c.worst[i] * 100) / 100;
      if (isLayer)
        line["layers"].push_back(j);
      else
        line["sky"] = j;
    }
    line["delivered"] = good;
    delivered += good;
    if (!c.weather.layers.empty()) {
      ++cloudy;
      cloudyDelivered += good;
    }
    std::printf("%s\n", line.dump().c_str());
  }
  nlohmann::ordered_json summary;
  summary["reports"] = cases.size();
  summary["delivered"] = delivered;
  summary["with_cloud"] = cloudy;
  summary["with_cloud_delivered"] = cloudyDelivered;
  summary["seeds"] = seeds;
  summary["at_s"] = atS;
  summary["worst_mean_off_oktas"] = std::round(worstMean * 100) / 100;
  summary["numbers"] = singleAll;
  summary["numbers_within_for_every_seed"] = single;
  summary["seconds"] = std::round(seconds.count() * 10) / 10;
  std::printf("%s\n", summary.dump().c_str());
  return delivered * 100 >= cases.size() * 95 ? 0 : 1;
}
