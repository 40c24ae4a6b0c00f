// SPDX-License-Identifier: Apache-2.0
#include "reference_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "interrupt.h"
#include "picture_writer.h"
#include "progress_line.h"
#include "report.h"
#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/io/atomic_file.h"
#include "welkin/io/exr.h"
#include "welkin/io/input_file.h"
#include "welkin/reference/sky_film.h"
#include "welkin/render/display.h"
#include "welkin/scene/param_json.h"

namespace welkin::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kDefaultNoise = 0.02;
constexpr std::int64_t kLeastSamples = 16;  // fewer know no error
constexpr double kKeepEveryS = 60.0;        // how often the state is written

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

const char* const kSceneKey = "welkin_scene";

// Of a file's bytes, as text.
std::string contentHash(const std::string& path) {
  io::InputFile file(path);
  std::uint64_t hash = hashOf(file.size());
  while (file.left() > 0) {
    std::uint64_t word = 0;
    file.read(&word, std::min<std::uint64_t>(file.left(), sizeof word));
    hash = joinHashes(hash, word);
  }
  return fmt::format("{:016x}", hash);
}

// What paths depend on: files by what is in them, and nothing of what is done with the light afterwards.
std::string tracedScene(scene::Scene s) {
  const scene::Output unused;
  s.output.exposureEv = unused.exposureEv;
  s.output.quality = unused.quality;
  s.output.flare = unused.flare;
  s.output.fps = unused.fps;
  s.output.speed = unused.speed;
  for (scene::MetaballCloud& cloud : s.metaballs) cloud.file = contentHash(cloud.file);
  return scene::toJson(s);
}

// Goes on from a file that is there, if it is of the same scene.
reference::SkyFilm openFilm(const RenderSettings& settings, const std::string& scene) {
  const auto width = static_cast<int>(settings.scene.output.width),
             height = static_cast<int>(settings.scene.output.height);
  if (settings.resume.empty() || !std::filesystem::exists(settings.resume)) return {width, height};
  io::ExrPlanes file = io::readExrPlanes(settings.resume);
  try {
    if (const auto found = file.metadata.find(kSceneKey);
        found != file.metadata.end() && found->second != scene)
      throw ParameterError("it is of another scene, size or seed; expected the same, or another file");
    reference::SkyFilm film = reference::SkyFilm::fromState(
        {file.width, file.height, std::move(file.planes), std::move(file.metadata)});
    if (film.width() != width || film.height() != height)
      throw ParameterError("it has another size; expected the same, or another file");
    return film;
  } catch (const ParameterError& e) {
    throw ParameterError("--resume " + settings.resume + ": " + e.what());
  }
}

void keep(const std::string& path, const reference::SkyFilm& film, const std::string& scene) {
  reference::SkyFilm::State state = film.state();
  state.texts[kSceneKey] = scene;
  io::writeExrPlanes(path,
                     {state.width, state.height, std::move(state.planes), std::move(state.texts), false});
}

// Of each pixel, before the noise is looked at again: enough for many threads, and no more than half of what
// there is, so that little is traced in vain.
std::int64_t pathsAtOnce(const reference::SkyFilm& film) {
  constexpr std::int64_t kPaths = 131072;
  const std::int64_t most = std::max<std::int64_t>(kPaths / (std::int64_t{film.width()} * film.height()), 1);
  return std::clamp(film.samples() / 2, std::min(kLeastSamples, most), most);
}

// The same where a failure must not take the picture along: what went wrong, empty for nothing.
std::string tryToKeep(const std::string& path, const reference::SkyFilm& film, const std::string& scene) {
  try {
    keep(path, film, scene);
    return {};
  } catch (const IoError& e) {
    return e.what();
  }
}

// The picture; an EXR has what is known of it in further channels.
void writePicture(const RenderSettings& settings, const reference::SkyFilm& film,
                  const scene::SkyState& state, double exposureEv) {
  const Image<float> luminance = film.luminance();
  if (settings.format != io::ImageFormat::kExr) {
    PictureWriter(settings).write(0, luminance, exposureEv, state);
    return;
  }
  io::ExrPlanes file;
  file.width = luminance.width;
  file.height = luminance.height;
  for (const auto& [c, name] : {std::pair(0, "R"), std::pair(1, "G"), std::pair(2, "B")})
    for (std::size_t i = static_cast<std::size_t>(c); i < luminance.data.size(); i += 3)
      file.planes[name].push_back(luminance.data[i]);
  file.planes["opacity"] = film.opacity().data;
  file.planes["error"] = film.error().data;
  constexpr float kLargestHalf = 65504.0f;
  file.half = std::ranges::all_of(luminance.data, [](float x) { return x <= kLargestHalf; });
  file.metadata = pictureMetadata(state, exposureEv, settings.format);
  file.metadata["welkin_samples"] = std::to_string(film.samples());
  io::writeExrPlanes(settings.out, file);
}

}  // namespace

int runReference(const RenderSettings& settings) {
  if (settings.threads > 0) setThreadCount(settings.threads);
  const Clock::time_point begin = Clock::now();
  checkWritable(settings.out);
  if (!settings.resume.empty()) checkWritable(settings.resume);
  RenderReport report;
  report.device = std::to_string(threadCount()) + " processor threads";
  ProgressLine progress;
  progress.begin("building the sky");
  report.state = scene::buildSky(settings.scene, settings.scene.atS);
  report.passes.push_back({"sky", 1e3 * secondsSince(begin)});
  for (const std::string& warning : report.state.warnings) progress.warn(warning);
  const reference::SkyTracer tracer(report.state, {.seed = static_cast<std::uint64_t>(settings.scene.seed),
                                                   .droplets = settings.scene.droplets});
  const std::string scene = tracedScene(settings.scene);
  reference::SkyFilm film = openFilm(settings, scene);

  const double noise = settings.noise.value_or(settings.spp ? 0.0 : kDefaultNoise);
  const std::int64_t first = film.samples();
  const std::uint64_t firstEvents = film.events();
  double error = film.meanRelativeError();
  auto enough = [&] {
    if (settings.spp && film.samples() >= *settings.spp) return true;
    return noise > 0.0 && film.samples() >= kLeastSamples && error <= noise;
  };
  progress.begin("tracing");
  const Clock::time_point traced = Clock::now();
  Clock::time_point kept = traced;
  bool complete = true;
  std::string lost;  // why the state could not be written
  try {
    while (!enough()) {
      throwIfInterrupted();
      std::int64_t count = pathsAtOnce(film);
      if (settings.spp) count = std::min(count, *settings.spp - film.samples());
      film.addPaths(tracer, count, throwIfInterrupted);
      error = film.meanRelativeError();
      const auto samples = static_cast<double>(film.samples());
      double done = settings.spp ? samples / *settings.spp : 0.0;
      if (noise > 0.0 && film.samples() > 1) done = std::max(done, noise * noise / (error * error));
      progress.show(std::min(done, 1.0),
                    fmt::format("{} paths a pixel, noise {:.2f} %", film.samples(), 100.0 * error));
      if (!settings.resume.empty() && secondsSince(kept) > kKeepEveryS) {
        const bool wasFine = lost.empty();
        lost = tryToKeep(settings.resume, film, scene);
        if (wasFine && !lost.empty()) progress.warn(lost);
        kept = Clock::now();
      }
    }
  } catch (const Interrupted&) {
    complete = false;
  }
  const double seconds = secondsSince(traced);
  report.passes.push_back({"trace", 1e3 * seconds});
  lost.clear();
  if (!settings.resume.empty()) {
    lost = tryToKeep(settings.resume, film, scene);
  } else if (!complete && film.samples() > 0) {
    const std::string path = settings.out + ".resume.exr";
    lost = tryToKeep(path, film, scene);
    if (lost.empty()) progress.warn("interrupted; go on with --resume " + path);
  }
  if (film.samples() == 0) return 130;
  const double exposureEv =
      settings.scene.output.exposureEv.value_or(render::automaticExposureEv(film.luminance()));
  writePicture(settings, film, report.state, exposureEv);
  report.frames.push_back({settings.out, report.state.time, exposureEv, 1e3 * secondsSince(begin)});
  report.totalMs = 1e3 * secondsSince(begin);
  if (!settings.report.empty()) {
    const auto pixels = static_cast<double>(film.width()) * film.height();
    const double passes = static_cast<double>(film.samples() - first);
    report.traced = TraceReport{
        .samples = film.samples(),
        .noise = error,
        .complete = complete,
        .pathsPerSecond = seconds > 0.0 ? passes * pixels / seconds : 0.0,
        .events = film.events(),
        .eventsPerSecond = seconds > 0.0 ? static_cast<double>(film.events() - firstEvents) / seconds : 0.0};
    io::writeTextFile(settings.report, reportJson(settings, report));
  }
  if (!lost.empty()) throw IoError(lost + "; the picture is written, but cannot be gone on from");
  return complete ? 0 : 130;
}

}  // namespace welkin::app
