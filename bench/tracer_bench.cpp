// SPDX-License-Identifier: Apache-2.0
#include "bench/tracer_bench.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <span>

#include "welkin/core/colour.h"
#include "welkin/core/error.h"
#include "welkin/reference/sky_tracer.h"
#include "welkin/scene/scene_file.h"

namespace welkin::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kPixelStride = 7;  // of all pixels in rows; odd, so that columns change
constexpr std::size_t kPathsAtATime = 2048;
constexpr double kDarkest = 0.01;  // of the mean of all pixels, for relative deviations, as SkyFilm has it

double processorS() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

struct Pixel {
  double mean, variance;  // of a path
};

struct Events {
  double ofPaths = 0.0, chained = 0.0;
};

// All pixels that are measured, some hundreds of paths at a time, as a film does it.
std::vector<Pixel> trace(const reference::SkyTracer& tracer, Events& events) {
  const int width = tracer.width(), count = width * tracer.height();
  std::vector<Pixel> pixels;
  std::vector<reference::PixelPath> paths;
  for (int i = 0; i < count; i += kPixelStride) {
    for (std::uint64_t k = 0; k < kTracerPaths; ++k) paths.push_back({i % width, i / width, k});
    if (paths.size() < kPathsAtATime && i + kPixelStride < count) continue;
    std::vector<reference::SkySample> samples(paths.size());
    tracer.trace(paths, samples);
    for (std::size_t first = 0; first < samples.size(); first += kTracerPaths) {
      double sum = 0.0, squares = 0.0;
      for (const reference::SkySample& s : std::span(samples).subspan(first, kTracerPaths)) {
        const double l = luminanceOf(&s.luminance.x);
        sum += l;
        squares += l * l;
        events.ofPaths += s.events;
        events.chained += s.chained;
      }
      constexpr double n = kTracerPaths;
      pixels.push_back({sum / n, std::max(squares / n - sum * sum / (n * n), 0.0) * n / (n - 1.0)});
    }
    paths.clear();
  }
  return pixels;
}

TracerRow measure(const scene::Scene& scene, std::uint64_t seed) {
  const scene::SkyState state = scene::buildSky(scene, scene.atS);
  const reference::SkyTracer tracer(state, {.seed = seed});
  TracerRow row;
  Events bounded, events;
  const double begin = processorS();
  const std::vector<Pixel> pixels = trace(tracer, bounded);
  const double middle = processorS();
  trace(tracer, events);
  const double seconds = processorS() - middle;
  row.boundsS = std::max(middle - begin - seconds, 0.0);
  const double paths = static_cast<double>(pixels.size()) * kTracerPaths;

  const auto n = static_cast<double>(pixels.size());
  double variance = 0.0;
  for (const Pixel& p : pixels) {
    row.mean += p.mean / n;
    variance += p.variance / (n * n * kTracerPaths);
  }
  row.error = std::sqrt(variance);
  for (const Pixel& p : pixels)
    row.deviation += std::sqrt(p.variance) / std::max(p.mean, kDarkest * row.mean) / n;
  row.pathsPerS = paths / seconds;
  row.eventsPerS = events.ofPaths / seconds;
  row.allEventsPerS = (events.ofPaths + events.chained) / seconds;
  constexpr double kPixels = 320.0 * 180.0, kNoise = 0.02;
  row.hoursTo2Percent =
      kPixels * (row.deviation * row.deviation) / (kNoise * kNoise) / row.pathsPerS / 3600.0;
  return row;
}

}  // namespace

std::vector<TracerRow> measureTracer(const fs::path& folder, std::uint64_t seed) {
  std::vector<fs::path> scenes;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed))
    if (entry.path().extension() == ".toml") scenes.push_back(entry.path());
  if (scenes.empty())
    throw ParameterError(folder.string() + ": no scenes; expected a folder with scenes X.toml");
  std::ranges::sort(scenes);
  std::vector<TracerRow> rows;
  for (const fs::path& path : scenes) {
    rows.push_back(measure(scene::readSceneFile(path.string()).scene, seed));
    rows.back().scene = path.stem().string();
  }
  return rows;
}

}  // namespace welkin::bench
