// SPDX-License-Identifier: Apache-2.0
#include "render_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <utility>
#include <vector>

#include "call_files.h"
#include "usage_error.h"
#include "welkin/core/units.h"
#include "welkin/field/metaballs.h"
#include "welkin/io/file_extension.h"
#include "welkin/io/frame_path.h"
#include "welkin/io/video.h"
#include "welkin/scene/metaball_file.h"
#include "welkin/scene/param_text.h"
#include "welkin/scene/scene_file.h"
#include "welkin/scene/scene_files.h"
#include "welkin/scene/theme.h"

namespace welkin::app {
namespace {

using scene::Scene;

// Scene parameter `path` from the text of a flag.
void set(Scene& s, const char* flag, std::string_view path, std::string_view text) {
  try {
    scene::setParam(s, path, text);
  } catch (const ParameterError& e) {
    throw UsageError(std::string(flag) + ": " + e.what());
  }
}

void set(Scene& s, const char* flag, std::string_view path, const Flag& text) {
  if (text) set(s, flag, path, std::string_view(*text));
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

// A text of several values, the last of which may be left out.
void setList(Scene& s, const std::string& flag, const std::string& text, char separator,
             std::string_view expected, std::initializer_list<std::string_view> paths, std::size_t least) {
  const auto parts = split(text, separator);
  if (parts.size() < least || parts.size() > paths.size())
    throw UsageError(flag + ": expected " + std::string(expected) + ", found \"" + text + "\"");
  for (std::size_t i = 0; i < parts.size(); ++i) set(s, flag.c_str(), paths.begin()[i], parts[i]);
}

scene::Theme themeOfFlag(const std::string& text) {
  try {
    return scene::readTheme(text);
  } catch (const ParameterError& e) {
    throw UsageError(std::string("--theme: ") + e.what());
  }
}

// Which renderer, and how long the reference renderer works.
void setRenderer(RenderSettings& r, const RenderArgs& a) {
  const std::string name = a.renderer.value_or("gpu");
  if (name != "gpu" && name != "reference")
    throw UsageError("--renderer is \"" + name + "\"; expected gpu or reference");
  r.reference = name == "reference";
  for (const auto& [flag, given] :
       {std::pair("--spp", a.spp.has_value()), std::pair("--noise", a.noise.has_value()),
        std::pair("--resume", a.resume.has_value())})
    if (given && !r.reference)
      throw UsageError(std::string(flag) +
                       " belongs to the reference renderer; expected --renderer reference");
  if (a.spp) r.spp = wholeNumber("--spp", *a.spp, 1, 2000000000);
  if (a.noise) r.noise = numberIn("--noise", *a.noise, 1e-5, 1.0);
  if (a.resume) r.resume = *a.resume;
}

// A slab is traced and reported; a sky is drawn.
void checkSlab(const RenderSettings& r, const RenderArgs& a) {
  const bool slab = !r.scene.slab.empty();
  if (slab && !r.reference)
    throw UsageError(
        "the scene has a [slab], which only the reference renderer traces; expected --renderer reference");
  if (!slab && r.reference && (r.video || r.numbered || r.scene.output.frames > 1))
    throw UsageError("the reference renderer draws one picture; expected a name such as sky.exr and 1 frame");
  const std::initializer_list<std::pair<const char*, bool>> ofSkies = {
      {"--metar", a.metar.has_value()},
      {"--place", a.place.has_value()},
      {"--time", a.time.has_value()},
      {"--at", a.at.has_value()},
      {"--theme", a.theme.has_value()},
      {"--eye", a.eye.has_value()},
      {"--look", a.look.has_value()},
      {"--projection", a.projection.has_value()},
      {"--size", a.size.has_value()},
      {"--technique", a.technique.has_value()},
      {"--metaballs-as", a.metaballsAs.has_value()},
      {"--quality", a.quality.has_value()},
      {"--exposure", a.exposure.has_value()},
      {"--no-sun-disc", a.noSunDisc},
      {"--fps", a.fps.has_value()},
      {"--speed", a.speed.has_value()},
      {"--resume", a.resume.has_value()},
      {"--droplets", a.droplets.has_value()}};
  for (const auto& [flag, given] : ofSkies)
    if (slab && given)
      throw UsageError(std::string(flag) + " is for pictures of skies; expected a scene without [slab]");
  if (!slab && !a.out) throw UsageError("render: expected -o OUT, the file to write");
  if (slab && a.out) throw UsageError("-o: a slab has no picture; expected --report FILE.json");
  if (slab && r.report.empty())
    throw UsageError("a slab's result is its report; expected --report FILE.json");
  if (slab && r.scene.output.frames > 1) throw UsageError("a slab does not change in time; expected 1 frame");
}

// A cloud alone: its base a kilometre up, or more if it is larger, and the eye where it fills half the width.
void frameCloud(Scene& s, bool eyeGiven, bool lookGiven) {
  constexpr double kFill = 0.55, kLeastBaseM = 1000.0;
  const field::Box box = field::boundsOf(scene::readMetaballs(s.metaballs[0].file).balls());
  const glm::dvec3 size = box.high - box.low;
  const double wide = std::max({size.x, size.y, 1.3 * size.z});
  const double baseM = std::max(kLeastBaseM, size.z);
  const double distanceM = 2.0 * wide;
  const glm::dvec3 middle = 0.5 * (box.low + box.high);
  s.metaballs[0].positionM = {-middle.x, distanceM - middle.y, baseM - box.low.z};
  if (!eyeGiven) s.camera.eyeM = std::min(baseM - 0.1 * size.z, 20000.0);
  if (lookGiven) return;
  const double up = baseM + 0.45 * size.z - s.camera.eyeM;
  s.camera.headingDeg = 0.0;
  s.camera.pitchDeg = degrees(std::atan2(up, distanceM));
  s.camera.fovDeg = 2.0 * degrees(std::atan(0.5 * wide / kFill / std::hypot(distanceM, up)));
}

// None is written over another, or over what the picture is made of.
void checkFiles(const RenderSettings& r, const RenderArgs& a, const std::optional<std::string>& themeFile) {
  CallFiles files;
  if (a.scene) files.reads(*a.scene);
  if (themeFile) files.reads(*themeFile);
  for (const std::string& path : scene::filesOf(r.scene)) files.readsTexels(path);
  if (!r.out.empty() && !r.numbered) files.writes("-o", r.out);
  if (!r.resume.empty()) files.writes("--resume", r.resume);
  if (!r.resume.empty() && io::lowerExtension(r.resume) != ".exr")
    throw UsageError("--resume: " + r.resume + " is no .exr; expected a name such as state.exr");
  if (!r.report.empty()) files.writes("--report", r.report);
  if (!r.numbered) return;
  try {
    files.writesFrames("-o", io::FramePattern(r.out), r.scene.output.frames);
  } catch (const ParameterError& e) {
    throw UsageError(e.what());
  }
}

// What the name of the output says about its kind.
void setOutput(RenderSettings& r, const std::string& out) {
  r.out = out;
  r.video = io::isVideoPath(out);
  r.numbered = io::isFramePattern(out);
  if (r.video && r.numbered)
    throw UsageError(out + ": a video has no place for a frame number; expected a name without %");
  if (r.video) return;
  try {
    r.format = io::imageFormatOf(out);
  } catch (const ParameterError&) {
    throw UsageError(wrongKind(out, ".png, .exr, .hdr, .mp4 or .webm"));
  }
}

}  // namespace

double numberIn(const char* flag, const std::string& text, double low, double high) {
  double x = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (error != std::errc() || end != text.data() + text.size() || !(x >= low && x <= high))
    throw UsageError(fmt::format("{}: expected a number from {} to {}, found \"{}\"", flag, low, high, text));
  return x;
}

int wholeNumber(const char* flag, const std::string& text, int low, int high) {
  int n = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
  if (error != std::errc() || end != text.data() + text.size() || n < low || n > high)
    throw UsageError(std::string(flag) + ": expected a whole number from " + std::to_string(low) + " to " +
                     std::to_string(high) + ", found \"" + text + "\"");
  return n;
}

int threadsOf(const std::string& text) {
  return wholeNumber("--threads", text, 1, 1024);
}

void setPlace(Scene& s, const std::string& flag, const std::string& text) {
  setList(s, flag, text, ',', "LAT,LON or LAT,LON,ALT_M",
          {"place.latitude_deg", "place.longitude_deg", "place.altitude_m"}, 2);
}

RenderSettings renderSettings(const RenderArgs& a) {
  RenderSettings r;
  setRenderer(r, a);
  if (a.out)
    setOutput(r, *a.out);
  else if (!a.scene || !r.reference)
    throw UsageError("render: expected -o OUT, the file to write");
  if (a.bits) {
    r.pngBits = wholeNumber("--bits", *a.bits, 8, 16);
    if (r.pngBits != 8 && r.pngBits != 16) throw UsageError("--bits is " + *a.bits + "; expected 8 or 16");
    if (r.video || r.format != io::ImageFormat::kPng) throw UsageError("--bits is for .png only");
  }
  if (a.threads) r.threads = threadsOf(*a.threads);
  if (a.report) r.report = *a.report;

  // The place first: what is typical of a layer in the file depends on the latitude.
  Scene flagged;
  if (a.place) setPlace(flagged, "--place", *a.place);
  bool timeGiven = a.time.has_value();
  bool widthGiven = a.size.has_value(), heightGiven = widthGiven;
  std::optional<ParseError> misfit;  // in the scene file, for flags to mend
  std::optional<std::string> themeFile;
  if (a.theme && std::filesystem::path(*a.theme).extension() == ".toml") themeFile = *a.theme;
  const std::string kind = a.scene ? io::lowerExtension(*a.scene) : "";
  const bool metaballs = kind == ".json";
  // Without an extension it may be a pipe.
  if (!metaballs && !kind.empty() && kind != ".toml")
    throw UsageError(*a.scene + " is no scene; expected a scene file .toml, or metaballs .json");
  if (metaballs) {
    if (a.theme) scene::apply(themeOfFlag(*a.theme), r.scene);
    r.scene.metaballs.push_back({.file = *a.scene});
  } else if (a.scene) {
    if (a.theme) themeOfFlag(*a.theme);  // so that a wrong name is the flag's mistake
    scene::SceneFile file = scene::readSceneDraft(
        *a.scene, a.place ? std::optional<double>(flagged.place.latitudeDeg) : std::nullopt, a.theme);
    widthGiven = widthGiven || file.gives("output.width");
    heightGiven = heightGiven || file.gives("output.height");
    timeGiven = timeGiven || file.gives("time");
    misfit = file.misfit;
    r.scene = std::move(file.scene);
    if (file.themeFile) themeFile = file.themeFile;
  } else if (a.theme) {
    scene::apply(themeOfFlag(*a.theme), r.scene);
  }
  Scene& s = r.scene;
  if (a.place) setPlace(s, "--place", *a.place);
  set(s, "--metar", "metar", a.metar);
  set(s, "--time", "time", a.time);
  if (!timeGiven) scene::setTimeOfReport(s);
  set(s, "--at", "at_s", a.at);
  set(s, "--seed", "seed", a.seed);
  set(s, "--eye", "camera.eye_m", a.eye);
  if (a.look)
    setList(s, "--look", *a.look, ',', "HEADING,PITCH or HEADING,PITCH,FOV",
            {"camera.heading_deg", "camera.pitch_deg", "camera.fov_deg"}, 2);
  set(s, "--projection", "camera.projection", a.projection);
  if (a.size)
    setList(s, "--size", *a.size, 'x', "WIDTHxHEIGHT, 1280x720 for instance",
            {"output.width", "output.height"}, 2);
  scene::setNaturalSize(s, widthGiven, heightGiven);
  if (metaballs) frameCloud(s, a.eye.has_value(), a.look.has_value());
  set(s, "--technique", "technique", a.technique);
  set(s, "--metaballs-as", "metaballs_as", a.metaballsAs);
  set(s, "--droplets", "droplets", a.droplets);
  set(s, "--quality", "output.quality", a.quality);
  set(s, "--exposure", "output.exposure_ev", a.exposure);
  if (a.noSunDisc) s.output.sunDisc = false;
  set(s, "--frames", "output.frames", a.frames);
  set(s, "--fps", "output.fps", a.fps);
  set(s, "--speed", "output.speed", a.speed);
  try {
    scene::validate(s);
  } catch (const ParameterError& e) {
    if (misfit) throw ParseError(*misfit);
    throw UsageError(e.what());
  }
  checkSlab(r, a);
  if (s.output.frames > 1 && !r.numbered && !r.video)
    throw UsageError(
        r.out + ": " + std::to_string(s.output.frames) +
        " frames need a place for their number; expected a name such as name_%04d.png, or a video");
  if (s.output.frames == 1 && !r.video && (a.fps || a.speed))
    throw UsageError(std::string(a.fps ? "--fps" : "--speed") +
                     " is for sequences and videos; expected --frames as well");
  checkFiles(r, a, themeFile);
  return r;
}

}  // namespace welkin::app
