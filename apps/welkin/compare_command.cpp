// SPDX-License-Identifier: Apache-2.0
#include "compare_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>

#include "call_files.h"
#include "render_settings.h"
#include "terminal_text.h"
#include "usage_error.h"
#include "welkin/core/colour.h"
#include "welkin/core/error.h"
#include "welkin/io/exr.h"
#include "welkin/io/hdr.h"
#include "welkin/io/png.h"
#include "welkin/io/quantise.h"
#include "welkin/io/write_image.h"
#include "welkin/reference/flip.h"
#include "welkin/reference/picture_error.h"
#include "welkin/render/display.h"

namespace welkin::app {
namespace {

// Three channels: colours, without alpha.
Image<float> coloursOf(const Image<float>& in) {
  if (in.channels == 3) return in;
  Image<float> out(in.width, in.height, 3);
  const int colours = in.channels < 3 ? 1 : 3;
  for (std::size_t i = 0; i < out.data.size(); ++i)
    out.data[i] = in.data[i / 3 * static_cast<std::size_t>(in.channels) + (colours == 3 ? i % 3 : 0)];
  return out;
}

Image<float> readScreen(const std::string& path) {
  return std::visit(
      [](const auto& png) {
        Image<float> out(png.width, png.height, png.channels);
        constexpr auto kMost = static_cast<float>(
            std::numeric_limits<typename std::decay_t<decltype(png.data)>::value_type>::max());
        for (std::size_t i = 0; i < png.data.size(); ++i)
          out.data[i] = static_cast<float>(png.data[i]) / kMost;
        return coloursOf(out);
      },
      io::readPng(path));
}

Image<float> readLinear(const std::string& path, io::ImageFormat format) {
  Image<float> picture = format == io::ImageFormat::kExr ? io::readExr(path).image : io::readHdr(path);
  try {
    io::requireFinite(picture);
  } catch (const ParameterError& e) {
    throw IoError(path + ": " + e.what());
  }
  return coloursOf(picture);
}

io::ImageFormat formatOf(const std::string& path) {
  try {
    return io::imageFormatOf(path);
  } catch (const ParameterError& e) {
    throw UsageError("compare: " + std::string(e.what()));
  }
}

struct Pictures {
  Image<float> linear[2], screen[2];
  bool luminance = false;  // in cd/m2
  double exposureEv = 0.0;
};

Pictures readBoth(const CompareArgs& args) {
  const std::string paths[2] = {args.picture, args.truth};
  const io::ImageFormat formats[2] = {formatOf(paths[0]), formatOf(paths[1])};
  Pictures p;
  p.luminance = io::holdsLuminance(formats[0]);
  if (p.luminance != io::holdsLuminance(formats[1]))
    throw UsageError(
        "compare: a picture for a screen and one of luminance have no scale in common; expected two .png "
        "or two of .exr and .hdr");
  if (args.exposure && !p.luminance)
    throw UsageError("compare: --exposure is for pictures of luminance, not for .png");
  const bool automatic = !args.exposure || *args.exposure == "auto";
  if (!automatic) p.exposureEv = numberIn("--exposure", *args.exposure, -20.0, 40.0);
  for (int i = 0; i < 2; ++i) {
    if (p.luminance) {
      p.linear[i] = readLinear(paths[i], formats[i]);
    } else {
      p.screen[i] = readScreen(paths[i]);
      p.linear[i] = p.screen[i];
      for (float& v : p.linear[i].data) v = linearOfSrgb(v);
    }
  }
  const Image<float>&a = p.linear[0], &b = p.linear[1];
  if (a.width != b.width || a.height != b.height)
    throw ParameterError(fmt::format("{} is {}x{} and {} is {}x{}; expected pictures of one size", paths[0],
                                     a.width, a.height, paths[1], b.width, b.height));
  if (p.luminance) {
    if (automatic) p.exposureEv = render::automaticExposureEv(p.linear[1]);
    for (int i = 0; i < 2; ++i) p.screen[i] = render::toDisplay(p.linear[i], p.exposureEv);
  }
  return p;
}

// The maps' names, before anything is read.
void checkMaps(const CompareArgs& args) {
  CallFiles files;
  files.reads(args.picture);
  files.reads(args.truth);
  for (const auto& [flag, path] : {std::pair("--bias", args.biasMap), std::pair("--flip", args.flipMap)}) {
    if (!path) continue;
    if (formatOf(*path) != io::ImageFormat::kPng)
      throw UsageError(
          fmt::format("compare: {}: expected a name that ends in .png, found \"{}\"", flag, *path));
    files.writes(flag, *path);
  }
}

void writeMap(const Flag& path, const Image<float>& colours) {
  if (path) io::writeImage(*path, colours);
}

}  // namespace

int runCompare(const CompareArgs& args) {
  if (args.picture.empty() || args.truth.empty())
    throw UsageError("compare: expected two pictures, PICTURE and TRUTH");
  const double range = args.range ? numberIn("--range", *args.range, 1e-6, 1e6) : 0.5;
  checkMaps(args);
  const Pictures p = readBoth(args);
  const reference::PictureError error = reference::errorOf(p.linear[0], p.linear[1]);
  const Image<float> flip = reference::flipOf(p.screen[0], p.screen[1]);
  double flipMean = 0.0;
  for (const float f : flip.data) flipMean += static_cast<double>(f) / static_cast<double>(flip.data.size());
  const double flipMost = static_cast<double>(*std::max_element(flip.data.begin(), flip.data.end()));
  writeMap(args.biasMap, reference::biasColours(reference::biasMap(p.linear[0], p.linear[1]), range));
  writeMap(args.flipMap, reference::flipColours(flip));

  nlohmann::ordered_json j = {{"picture", args.picture},
                              {"truth", args.truth},
                              {"width", flip.width},
                              {"height", flip.height},
                              {"mean_luminance", error.mean},
                              {"mean_luminance_of_truth", error.meanOfTruth},
                              {"bias", error.bias},
                              {"relative_error", error.relative},
                              {"relative_rms", error.relativeRms},
                              {"largest_relative_error", error.largest},
                              {"flip", flipMean},
                              {"largest_flip", flipMost}};
  if (p.luminance) j["exposure_ev"] = p.exposureEv;
  if (args.json) {
    fmt::print("{}\n", printableJson(j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace)));
    return 0;
  }
  const char* unit = p.luminance ? " cd/m2" : " of white";
  fmt::print("mean luminance   {:.5g}{}, of the truth {:.5g}\n", error.mean, unit, error.meanOfTruth);
  fmt::print("bias             {:+.3f} %\n", 100.0 * error.bias);
  fmt::print("relative error   {:.3f} % mean, {:.3f} % rms, {:.4g} % at most\n", 100.0 * error.relative,
             100.0 * error.relativeRms, 100.0 * error.largest);
  fmt::print("FLIP             {:.4f} mean, {:.4f} at most\n", flipMean, flipMost);
  return 0;
}

}  // namespace welkin::app
