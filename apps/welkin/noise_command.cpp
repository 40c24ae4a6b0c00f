// SPDX-License-Identifier: Apache-2.0
#include "noise_command.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "interrupt.h"
#include "progress_line.h"
#include "render_settings.h"
#include "report.h"
#include "stopwatch.h"
#include "texel_flags.h"
#include "texel_output.h"
#include "welkin/core/parallel.h"
#include "welkin/field/noise_texture.h"
#include "welkin/io/atomic_file.h"
#include "welkin/scene/param_json.h"

namespace welkin::app {
namespace {

using Json = nlohmann::ordered_json;
using field::NoiseTexture, field::TextureParams;

struct Request {
  TextureParams params;
  glm::ivec3 size{256, 256, 1};
  bool volume = false;
};

std::ptrdiff_t commasIn(const std::string& text) {
  return std::count(text.begin(), text.end(), ',');
}

// One number for all axes, two for x and y.
std::string onAllAxes(const std::string& text) {
  const auto commas = commasIn(text);
  if (commas == 0) return text + "," + text + "," + text;
  return commas == 1 ? text + text.substr(text.find(',')) : text;
}

Request requestOf(const NoiseArgs& args) {
  Request r;
  if (args.preset) {
    constexpr auto& names = kEnumNames<field::ThesisTexture>;
    const auto it = std::find(names.begin(), names.end(), *args.preset);
    if (it == names.end())
      throw UsageError("--preset: " + scene::choiceProblem({"preset", "", ""}, names, *args.preset));
    const auto which = static_cast<field::ThesisTexture>(it - names.begin());
    r.params = field::thesisParams(which);
    r.size = field::thesisSize(which);
    r.volume = which == field::ThesisTexture::kDome;
  }
  if (args.size) {
    r.size = sizeOf(*args.size);
    r.volume = isVolume(*args.size);
  }
  ParamTexts texts = args.params;
  if (const auto it = texts.find("frequency"); it != texts.end()) it->second = onAllAxes(it->second);
  if (const auto it = texts.find("offset"); it != texts.end() && commasIn(it->second) == 1)
    it->second += ",0";
  const auto flags = noiseParamFlags();
  // A cutoff in place of a preset's cover, a density in place of its exponent, and the other way round.
  field::CondensationParams& cloud = r.params.cloud;
  if (texts.contains("cloud.cutoff") || texts.contains("cloud.cover")) cloud.cutoff = cloud.cover = {};
  for (const char* rate : {"cloud.density", "cloud.exponent", "cloud.sharpness", "cloud.scale"})
    if (texts.contains(rate)) cloud.density = cloud.exponent = cloud.sharpness = cloud.scale = {};
  applyTexts(r.params, texts, flags);
  r.params.noise.dimensions = r.volume ? 3 : 2;
  if (!r.params.noise.time && (texts.contains("time_period") || texts.contains("time_lacunarity")))
    throw UsageError("noise: --time-period and --time-lacunarity go with --time");
  return r;
}

NoiseTexture textureOf(const Request& r) {
  try {
    return NoiseTexture(r.params, r.size);
  } catch (const ParameterError& e) {
    const std::string what = e.what();
    throw UsageError("noise: " + what +
                     (what.starts_with("noise that tiles") ? "; or --seamless false" : ""));
  }
}

// What the values are and become where the flags do not say.
TexelSource sourceOf(const Request& r, const NoiseTexture& texture, const std::string& out) {
  TexelSource s;
  s.command = "noise";
  s.size = r.size;
  s.volume = r.volume;
  s.tiles = r.params.noise.tile;
  const io::TexelFileKind kind = fileKindOf(s.command, out);
  const bool dds = kind == io::TexelFileKind::kDds, png = kind == io::TexelFileKind::kPng;
  const io::Channels one = dds ? io::Channels::kA : png ? io::Channels::kL : io::Channels::kR;
  const int channels = texture.channels();
  s.format = {channels == 1   ? one
              : channels == 4 ? io::Channels::kRgba
                              : io::Channels::kRgb,
              dds || png ? io::ValueType::kUnorm8 : io::ValueType::kFloat};
  if (r.params.isPlain()) {
    const noise::Lift lift = noise::liftOf(r.params.noise);
    s.scale = lift.scale, s.bias = lift.bias;
  }
  s.notes.name = r.params.cloud.condenses() ? "density" : "noise";
  s.notes.metadata = {{"Software", "welkin " WELKIN_VERSION}, {"welkin_noise", scene::toJson(r.params, -1)}};
  return s;
}

// Where 0 of curl noise lies as it is normalised.
float curlZero(const noise::NoiseParams& params) {
  using noise::Normalisation;
  const bool lifted =
      params.normalisation == Normalisation::kThesis || params.normalisation == Normalisation::kUnitRange;
  return lifted ? 0.5f : 0.0f;
}
// Curl in the plane has two channels, files have one, three or four: a third one of zeros.
void widen(const std::vector<float>& two, float zero, std::vector<float>& three) {
  three.assign(two.size() / 2 * 3, zero);
  for (std::size_t i = 0; i < two.size() / 2; ++i) std::copy_n(&two[2 * i], 2, &three[3 * i]);
}

Json reportOf(const Request& r, const NoiseTexture& texture, const TexelOutput& output, double ms) {
  const TexelStatistics& s = output.statistics();
  Json j = {{"welkin", WELKIN_VERSION},
            {"size", {r.size.x, r.size.y, r.size.z}},
            {"format", io::nameOf(output.shape().format)},
            {"min", s.least()},
            {"mean", s.mean()},
            {"max", s.greatest()},
            {"deviation", s.deviation()}};
  if (r.params.cloud.condenses()) {
    const field::CondensationParams& cloud = r.params.cloud;
    j["cover"] = {{"requested", cloud.cover ? Json(*cloud.cover) : Json()},
                  {"delivered", s.covered()},
                  {"cutoff", texture.law().threshold}};
  }
  if (r.params.isPlain()) {
    const noise::Lift lift = noise::liftOf(r.params.noise);
    j["lift"] = {{"scale", lift.scale}, {"bias", lift.bias}};
  }
  j["histogram"] = s.histogram();
  j["total_ms"] = ms;
  j["peak_rss_mib"] = peakRssMib();
  j["noise"] = Json::parse(scene::toJson(r.params));
  return j;
}

}  // namespace

std::vector<scene::ParamDoc> noiseParamDocs() {
  return scene::documentParams<TextureParams>();
}

std::vector<ParamFlag> noiseParamFlags() {
  constexpr std::array<std::string_view, 1> kFromSize = {"dimensions"};
  return paramFlags(noiseParamDocs(), {{"normalisation", "--normalise"}, {"tile", "--seamless"}},
                    {{"", "Noise"}, {"[cloud]", "Cloud"}, {"[curve]", "Tone curve"}}, kFromSize);
}

int runNoise(const NoiseArgs& args) {
  if (!args.output.out) throw UsageError("noise: expected -o OUT, the file to write");
  if (!args.size && !args.preset) throw UsageError("noise: expected --size WxH or WxHxD, or a --preset");
  if (args.output.threads) setThreadCount(threadsOf(*args.output.threads));
  const Request request = requestOf(args);
  NoiseTexture texture = textureOf(request);
  catchInterrupts();
  const Stopwatch watch;
  TexelOutput output(args.output, sourceOf(request, texture, *args.output.out));
  ProgressLine progress;
  const auto show = [&](double fraction) {
    throwIfInterrupted();
    progress.show(fraction);
  };
  progress.begin("measuring the noise");
  try {
    texture.meetCover(visibleIn(output.shape().format.type), show);
  } catch (const ParameterError& e) {
    throw UsageError("noise: " + std::string(e.what()));
  }
  progress.begin("writing");
  std::vector<float> values, three;
  for (int done = 0; done < texture.layers(); done += texture.layersAtOnce()) {
    show(static_cast<double>(done) / texture.layers());
    const int count = std::min(texture.layersAtOnce(), texture.layers() - done);
    values.resize(texture.layerValues() * static_cast<std::size_t>(count));
    texture.fill(done, count, values);
    if (texture.channels() == 2) widen(values, curlZero(request.params.noise), three);
    output.write(texture.channels() == 2 ? three : values);
  }
  throwIfInterrupted();
  output.close();
  if (args.output.report) {
    Json report = reportOf(request, texture, output, watch.ms());
    report["output"] = *args.output.out;
    io::writeTextFile(*args.output.report, report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  }
  return 0;
}

}  // namespace welkin::app
