// SPDX-License-Identifier: Apache-2.0
// The only file that includes CLI11 (it is heavy to compile).
#include "command_line.h"

#include <CLI/CLI.hpp>
#include <sstream>

#include "cloud_command.h"
#include "fit_command.h"
#include "noise_command.h"
#include "param_flags.h"
#include "usage_error.h"
#include "welkin/core/params.h"
#include "welkin/field/noise_texture.h"
#include "welkin/scene/param_docs.h"
#include "welkin/scene/scene.h"

namespace welkin::app {
namespace {

using Docs = std::vector<scene::ParamDoc>;

// The help of a flag that stands for one described parameter.
std::string helpOf(const Docs& docs, std::string_view path) {
  const scene::ParamDoc& d = scene::docOf(docs, path);
  std::string facts = d.range;
  if (d.type.find('|') != std::string::npos) facts = d.type;
  if (!d.unit.empty()) facts += (facts.empty() ? "" : " ") + d.unit;
  if (d.defaultValue != "absent") facts += (facts.empty() ? "default " : "; default ") + d.defaultValue;
  return facts.empty() ? d.meaning : d.meaning + " (" + facts + ")";
}

std::string helpOfSeveral(const Docs& docs, std::initializer_list<std::string_view> paths) {
  std::string help;
  for (const std::string_view path : paths) {
    const scene::ParamDoc& d = scene::docOf(docs, path);
    help += (help.empty() ? "" : "; ") + d.meaning;
    if (!d.range.empty()) help += " (" + d.range + (d.unit.empty() ? "" : " " + d.unit) + ")";
  }
  return help;
}

// Help in lines that fit a terminal beside the names of the flags.
constexpr std::size_t kNameColumns = 34, kHelpColumns = 76;
std::string wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string out, word;
  std::size_t column = 0;
  while (words >> word) {
    if (column > 0 && column + 1 + word.size() > kHelpColumns) {
      out += '\n';
      column = 0;
    }
    if (column > 0) out += ' ', ++column;
    out += word;
    column += word.size();
  }
  return out;
}

CLI::Option* add(CLI::App* app, const std::string& name, Flag& value, const char* typeName,
                 const std::string& help) {
  return app
      ->add_option_function<std::string>(
          name, [&value](const std::string& text) { value = text; }, wrapped(help))
      ->type_name(typeName);
}

void describeRender(CLI::App* app, RenderArgs& a) {
  const Docs docs = scene::documentParams<scene::Scene>();
  const auto one = [&docs](const char* path) { return helpOf(docs, path); };
  add(app, "scene", a.scene, "SCENE.toml|CLOUD.json",
      "scene file, of which `welkin help scene` lists the keys; or metaballs, a cloud before a clear sky");
  add(app, "-o,--output", a.out, "OUT",
      "picture .png .exr .hdr, video .mp4 .webm, or frames as name_%04d.png; .exr and .hdr hold luminance in "
      "cd/m2");
  add(app, "--metar", a.metar, "REPORT", one("metar"))->group("Sky");
  add(app, "--place", a.place, "LAT,LON[,ALT_M]",
      helpOfSeveral(docs, {"place.latitude_deg", "place.longitude_deg", "place.altitude_m"}))
      ->group("Sky");
  add(app, "--time", a.time, "UTC", one("time"))->group("Sky");
  add(app, "--at", a.at, "SECONDS", one("at_s"))->group("Sky");
  add(app, "--seed", a.seed, "N", one("seed"))->group("Sky");
  add(app, "--theme", a.theme, "NAME|FILE", "in the place of the scene file's theme: " + one("theme"))
      ->group("Sky");
  add(app, "--eye", a.eye, "M", one("camera.eye_m"))->group("Eye");
  add(app, "--look", a.look, "HEADING,PITCH[,FOV]",
      helpOfSeveral(docs, {"camera.heading_deg", "camera.pitch_deg", "camera.fov_deg"}))
      ->group("Eye");
  add(app, "--projection", a.projection, "NAME", one("camera.projection"))->group("Eye");
  add(app, "--size", a.size, "WxH",
      helpOfSeveral(docs, {"output.width", "output.height"}) +
          "; default 1280x720, fisheye 1024x1024, equirect 2048x1024, cubemap 3072x512")
      ->group("Picture");
  add(app, "--technique", a.technique, "NAME", one("technique"))->group("Picture");
  add(app, "--metaballs-as", a.metaballsAs, "NAME", one("metaballs_as"))->group("Picture");
  add(app, "--droplets", a.droplets, "NAME", one("droplets"))->group("Picture");
  add(app, "--quality", a.quality, "NAME", one("output.quality"))->group("Picture");
  add(app, "--exposure", a.exposure, "auto|EV", one("output.exposure_ev"))->group("Picture");
  app->add_flag(
         "--no-sun-disc", a.noSunDisc,
         wrapped(
             "leave out the discs of sun and moon, to light a scene with a lamp of your own in their place"))
      ->group("Picture");
  add(app, "--bits", a.bits, "8|16", "bits a channel of PNG (default 8)")->group("Picture");
  add(app, "--renderer", a.renderer, "gpu|reference",
      "gpu: OpenGL, on the processor where there is no GPU (default); reference: path tracing, "
      "without bias, on the processor")
      ->group("Picture");
  add(app, "--spp", a.spp, "N",
      "paths of the reference renderer, for each pixel, or column of a slab (default: until --noise)")
      ->group("Picture");
  add(app, "--noise", a.noise, "X",
      "relative standard error at which the reference renderer stops, of a picture the mean over it (default "
      "without --spp 0.02, of a slab 0.001)")
      ->group("Picture");
  add(app, "--resume", a.resume, "FILE.exr",
      "what the reference renderer has done so far: it goes on from there if the file exists, and keeps it "
      "up "
      "to date")
      ->group("Running");
  add(app, "--frames", a.frames, "N", one("output.frames"))->group("Sequences");
  add(app, "--fps", a.fps, "F", one("output.fps"))->group("Sequences");
  add(app, "--speed", a.speed, "S", one("output.speed"))->group("Sequences");
  add(app, "--report", a.report, "FILE.json", "what was asked, what was delivered, time for each pass")
      ->group("Running");
  add(app, "--threads", a.threads, "N", "processor threads; the picture does not depend on it (default: all)")
      ->group("Running");
}

const char* typeNameOf(const scene::ParamDoc& doc) {
  if (doc.type == "whole number") return "N";
  if (doc.type == "number") return "X";
  if (doc.type == "3 numbers") return "X,Y,Z";
  return doc.type == "true or false" ? "true|false" : "NAME";
}

// A flag for each described parameter.
void addParams(CLI::App* app, const Docs& docs, const std::vector<ParamFlag>& flags, ParamTexts& texts) {
  for (const ParamFlag& flag : flags) {
    const scene::ParamDoc& doc = scene::docOf(docs, flag.path);
    // What is false unless told may be told without a value.
    if (doc.type == "true or false" && doc.defaultValue == "false") {
      app->add_flag_callback(
             flag.name, [&texts, path = flag.path] { texts[path] = "true"; },
             wrapped(helpOf(docs, flag.path)))
          ->group(flag.group);
      continue;
    }
    app->add_option_function<std::string>(
           flag.name, [&texts, path = flag.path](const std::string& text) { texts[path] = text; },
           wrapped(helpOf(docs, flag.path)))
        ->type_name(typeNameOf(doc))
        ->group(flag.group);
  }
}

void addTexelFile(CLI::App* app, TexelFileFlags& f, const std::string& formatDefault,
                  const std::string& edgesDefault) {
  add(app, "--format", f.format, "FORMAT",
      "a, l, r, la, rgb or rgba and then 8, 16 (integers), 16f (halves) or 32f (floats), as in a8 or rgba16f "
      "(default: " +
          formatDefault + ")")
      ->group("File");
  add(app, "--mipmaps", f.mipmaps, "none|box|kaiser", "of .dds (default none)")->group("File");
  add(app, "--edges", f.edges, "clamp|repeat",
      "what mipmaps find beyond the border: the border itself, or for textures that tile the other side "
      "(default " +
          edgesDefault + ")")
      ->group("File");
  add(app, "--header", f.header, "auto|dx10",
      "of .dds; auto: the old kind, which most programs read, unless only DX10 has the format")
      ->group("File");
}

void describeOutput(CLI::App* app, OutputArgs& a, const char* files) {
  add(app, "-o,--output", a.out, "OUT", files);
  addTexelFile(app, a.file, "a8 in .dds, l8 in .png, floats in others", "repeat for textures that tile");
  add(app, "--preview", a.preview, "FILE.png", "a picture to look at; of a volume, a sheet of slices")
      ->group("File");
  add(app, "--tile", a.tile, "CxR", "repeat the preview in columns and rows, to see whether it tiles")
      ->group("File");
  add(app, "--report", a.report, "FILE.json", "what was asked, what the values are like, a histogram")
      ->group("Running");
  add(app, "--threads", a.threads, "N", "processor threads; the result does not depend on it (default: all)")
      ->group("Running");
}

void describeNoise(CLI::App* app, NoiseArgs& a) {
  describeOutput(app, a.output, "picture or volume .dds .raw, picture .png .exr .hdr, volume .vdb");
  add(app, "--size", a.size, "WxH[xD]", "texels; three numbers make a volume");
  std::string presets;
  for (const std::string_view name : kEnumNames<field::ThesisTexture>)
    presets += (presets.empty() ? "" : " | ") + std::string(name);
  add(app, "--preset", a.preset, "NAME",
      "all parameters and the size of one of Tarantilis's textures, which other flags then change (" +
          presets + ")");
  addParams(app, noiseParamDocs(), noiseParamFlags(), a.params);
}

void describeCloud(CLI::App* app, CloudArgs& a) {
  describeOutput(app, a.output, "volume .vdb .dds .raw; with --cumulus metaballs .json, grown without a map");
  add(app, "--size", a.size, "WxHxD",
      "voxels east, north and up (default 48x36x24, or what holds the tower or the ellipsoids)");
  add(app, "--ellipsoids", a.ellipsoids, "FILE.toml", "many ellipsoids, [[ellipsoid]] each");
  add(app, "--metaballs", a.metaballs, "FILE.json",
      "the balls of such a file, where their sum is above 0; no noise");
  app->add_flag("--cumulus", a.cumulus,
                wrapped("a tower of cumulus, built from many ellipsoids by rule; Perlin noise of 5 octaves, "
                        "shifted, with cells of a sixth of the width, and a threshold of 0.25, unless told"));
  addParams(app, cloudParamDocs(), cloudParamFlags(), a.params);
}

void describeFit(CLI::App* app, FitArgs& a) {
  app->add_option("map", a.map, "volume of density .vdb .dds .raw")->type_name("MAP");
  add(app, "-o,--output", a.out, "OUT.json", "the balls; `welkin info` says what such a file holds");
  add(app, "--balls", a.balls, "K[,K2,...]", "how many; several make levels of detail in one file");
  add(app, "--resume", a.resume, "FILE.json", "go on from the balls of such a file where it has as many");
  const std::vector<ParamFlag> flags = fitParamFlags();
  addParams(app, fitParamDocs(), flags, a.params);
  add(app, "--report", a.report, "FILE.json", "the error of each level and the time it took")
      ->group("Running");
  add(app, "--threads", a.threads, "N", "processor threads; the result does not depend on it (default: all)")
      ->group("Running");
}

void describeConvert(CLI::App* app, ConvertArgs& a) {
  app->add_option("in", a.in, "picture .png .exr .hdr, picture or volume .dds .raw, volume .vdb")
      ->type_name("IN");
  app->add_option("out", a.out, "the same")->type_name("OUT");
  add(app, "--grid", a.grid, "NAME",
      "which grid of a .vdb to read, density[1] for the second of a name (default density, else the first of "
      "floats)");
  addTexelFile(app, a.file, "what loses nothing", "clamp");
}

void describeCompare(CLI::App* app, CompareArgs& a) {
  app->add_option("picture", a.picture, "two .png, or two of .exr and .hdr, of one size")
      ->type_name("PICTURE");
  app->add_option("truth", a.truth, wrapped("the same: what the first is measured by"))->type_name("TRUTH");
  add(app, "--bias", a.biasMap, "FILE.png",
      "map of relative errors of luminance: blue where PICTURE is too dark, red where it is too bright");
  add(app, "--range", a.range, "X", "relative error at which --bias has its full colours (default 0.5)");
  add(app, "--flip", a.flipMap, "FILE.png", "map of FLIP, from black for 0 to pale yellow for 1");
  add(app, "--exposure", a.exposure, "auto|EV",
      "at which FLIP sees pictures of luminance (default auto: TRUTH's own)");
  app->add_flag("--json", a.json, "as JSON");
}

// Names that one may have meant: "--flag" of this command, or commands.
std::vector<std::string> flagNames(const CLI::App* app) {
  std::vector<std::string> names;
  for (const CLI::Option* o : app->get_options())
    for (const std::string& name : o->get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> commandNames(const CLI::App* root) {
  std::vector<std::string> names;
  for (const CLI::App* sub : root->get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

// CLI11 collects what it does not know (allow_extras); the first such word is the mistake to report.
void refuseExtras(const CLI::App* app, const std::string& command) {
  const std::vector<std::string> extras = app->remaining();
  if (extras.empty()) return;
  const std::string& word = extras.front();
  const std::string where = command.empty() ? "" : command + ": ";
  if (word.size() > 1 && word[0] == '-') {
    const std::string flag = word.substr(0, word.find('='));
    throw UsageError(where + "unknown flag " + flag + didYouMean(flag, flagNames(app)));
  }
  if (!command.empty()) throw UsageError(where + "unexpected \"" + word + "\"");
  const std::string hint = didYouMean(word, commandNames(app));
  throw UsageError("unknown command \"" + word + "\"" + (hint.empty() ? "; welkin --help lists them" : hint));
}

// CLI11 says "--size: 1 required WxH missing" and "--size: At Most 1 required but received 2".
std::string problemOf(const CLI::ArgumentMismatch& e) {
  std::string text = e.what();
  const std::string flag = text.substr(0, text.find(':')), before = ": 1 required ", after = " missing";
  if (text.starts_with(flag + before) && text.ends_with(after)) {
    const std::size_t begin = flag.size() + before.size();
    return flag + ": expected " + text.substr(begin, text.size() - after.size() - begin) + " behind it";
  }
  if (text.find("but received") != std::string::npos) return flag + " is given twice; expected it once";
  return text;
}

}  // namespace

Command parseCommandLine(int argc, const char* const* argv) {
  CLI::App root("From a weather report, or a few sliders, to a sky.", "welkin");
  root.set_version_flag("--version", "welkin " WELKIN_VERSION);
  root.require_subcommand(0, 1);
  root.get_formatter()->column_width(kNameColumns);

  RenderArgs render;
  CLI::App* renderApp =
      root.add_subcommand("render", "Draw a sky as a picture, an environment map or a video");
  describeRender(renderApp, render);

  MetarArgs metar;
  CLI::App* metarApp = root.add_subcommand("metar", "Decode weather reports");
  metarApp->add_option("report", metar.reports, "METAR or SPECI reports, each in quotes")
      ->type_name("REPORT");
  add(metarApp, "--file", metar.file, "F", "read reports from a file, one a line; - is standard input");
  metarApp->add_flag("--json", metar.json, "one JSON object a line");

  SunArgs sun;
  CLI::App* sunApp = root.add_subcommand("sun", "Where sun and moon stand");
  add(sunApp, "--place", sun.place, "LAT,LON[,ALT_M]",
      "degrees, north and east positive; metres above sea level");
  add(sunApp, "--time", sun.time, "UTC", "ISO 8601, 2026-06-21T18:30:00Z for instance");
  sunApp->add_flag("--json", sun.json, "one JSON object");

  InfoArgs info;
  CLI::App* infoApp = root.add_subcommand(
      "info", "Say what a file holds: a scene file with all its defaults, a picture or volume, or metaballs");
  infoApp
      ->add_option("file", info.file,
                   "scene file .toml, picture .png .exr .hdr, picture or volume .dds .raw, volume .vdb, "
                   "metaballs .json")
      ->type_name("FILE");
  infoApp->add_flag("--json", info.json, "as JSON");
  infoApp->add_flag("--theme", info.theme,
                    wrapped("of a scene file only its sheets and how they are drawn, as a theme's file; FILE "
                            "may be a built-in theme's name"));

  NoiseArgs noise;
  CLI::App* noiseApp =
      root.add_subcommand("noise", "Make a texture or volume of noise, or of cloud condensed from it");
  describeNoise(noiseApp, noise);

  CloudArgs cloud;
  CLI::App* cloudApp = root.add_subcommand("cloud", "Make a volume of cloud density in ellipsoids");
  describeCloud(cloudApp, cloud);

  FitArgs fit;
  CLI::App* fitApp =
      root.add_subcommand("fit", "Make a cloud map into metaballs, and say how near they come");
  describeFit(fitApp, fit);

  ConvertArgs convert;
  CLI::App* convertApp = root.add_subcommand(
      "convert", "Write a picture or volume as another kind of file; nothing is lost unasked");
  describeConvert(convertApp, convert);

  CompareArgs compare;
  CLI::App* compareApp =
      root.add_subcommand("compare", "Say how far a picture is from another, in numbers and as maps");
  describeCompare(compareApp, compare);

  BenchArgs bench;
  CLI::App* benchApp = root.add_subcommand("bench", "Measure how fast Welkin is on this machine");
  benchApp
      ->add_option("name", bench.names,
                   "noise, frame, splat: all of them without a name; truth: how near the marched renderer "
                   "comes to the reference renderer; tracer: how fast that one is")
      ->type_name("NAME");
  benchApp->add_flag("--json", bench.json, "as JSON");
  add(benchApp, "--truth", bench.truth, "FOLDER",
      "of truth and tracer: scenes and what the reference renderer makes of them (default bench/truth)");
  add(benchApp, "--pictures", bench.pictures, "FOLDER",
      "of truth: a PNG of each scene: the truth, the fast picture, where it is too dark and too bright");

  Flag topic;
  HelpSceneArgs helpScene;
  CLI::App* helpApp =
      root.add_subcommand("help", "Explain a command, or the keys of a scene file: welkin help scene");
  add(helpApp, "topic", topic, "TOPIC", "a command, or scene");
  helpApp->add_flag("--markdown", helpScene.markdown, "as the tables in docs/scene_file.md");

  root.allow_extras();
  for (CLI::App* sub : root.get_subcommands([](const CLI::App*) { return true; })) sub->allow_extras();
  try {
    root.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return PrintText{root.help()};
  } catch (const CLI::CallForVersion&) {
    return PrintText{"welkin " WELKIN_VERSION "\n"};
  } catch (const CLI::ArgumentMismatch& e) {
    throw UsageError(problemOf(e));
  } catch (const CLI::ParseError& e) {
    throw UsageError(e.what());
  }

  const auto chosen = root.get_subcommands();
  refuseExtras(&root, "");
  if (chosen.empty()) {
    std::string list;
    for (const std::string& name : commandNames(&root)) list += (list.empty() ? "" : ", ") + name;
    throw UsageError("expected a command: " + list + "; welkin --help explains them");
  }
  refuseExtras(chosen[0], chosen[0]->get_name());
  if (chosen[0] == renderApp) return render;
  if (chosen[0] == metarApp) return metar;
  if (chosen[0] == sunApp) return sun;
  if (chosen[0] == infoApp) {
    if (info.file.empty()) throw UsageError("info: expected a file");
    return info;
  }
  if (chosen[0] == noiseApp) return noise;
  if (chosen[0] == cloudApp) return cloud;
  if (chosen[0] == fitApp) return fit;
  if (chosen[0] == convertApp) return convert;
  if (chosen[0] == compareApp) return compare;
  if (chosen[0] == benchApp) return bench;
  if (!topic) return PrintText{root.help("", CLI::AppFormatMode::Normal)};
  if (*topic == "scene") return helpScene;
  std::vector<std::string> topics{"scene"};
  for (const CLI::App* sub : root.get_subcommands([](const CLI::App*) { return true; })) {
    if (sub->get_name() == *topic) return PrintText{sub->help("welkin")};
    topics.push_back(sub->get_name());
  }
  throw UsageError("help: there is no topic \"" + *topic + "\"" + didYouMean(*topic, topics));
}

}  // namespace welkin::app
