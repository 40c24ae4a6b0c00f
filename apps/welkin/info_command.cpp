// SPDX-License-Identifier: Apache-2.0
#include "info_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "usage_error.h"
#include "welkin/io/exr.h"
#include "welkin/io/hdr.h"
#include "welkin/io/png.h"
#include "welkin/io/write_image.h"
#include "welkin/scene/param_json.h"
#include "welkin/scene/scene_file.h"

namespace welkin::app {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json pictureJson(const Image<T>& image, const char* valueType, const char* meaning) {
  Json j = {{"width", image.width},
            {"height", image.height},
            {"channels", image.channels},
            {"values", valueType},
            {"meaning", meaning}};
  if (image.data.empty()) return j;
  const auto [low, high] = std::minmax_element(image.data.begin(), image.data.end());
  double sum = 0.0;
  for (const T x : image.data) sum += static_cast<double>(x);
  j["min"] = *low;
  j["mean"] = sum / static_cast<double>(image.data.size());
  j["max"] = *high;
  return j;
}

constexpr const char* kScreen = "sRGB";
constexpr const char* kLuminance = "linear Rec. 709, cd/m2";

Json pictureJson(const std::string& path) {
  switch (io::imageFormatOf(path)) {
    case io::ImageFormat::kExr: {
      const io::ExrPicture p = io::readExr(path);
      Json j = pictureJson(p.image, p.half ? "half" : "float", kLuminance);
      j["metadata"] = p.metadata;
      return j;
    }
    case io::ImageFormat::kHdr:
      return pictureJson(io::readHdr(path), "rgbe", kLuminance);
    case io::ImageFormat::kPng:
      break;
  }
  const io::PngImage image = io::readPng(path);
  if (const auto* bytes = std::get_if<Image<std::uint8_t>>(&image))
    return pictureJson(*bytes, "8 bits", kScreen);
  return pictureJson(std::get<Image<std::uint16_t>>(image), "16 bits", kScreen);
}

void printPlain(const Json& j, int indent = 0) {
  for (const auto& [key, value] : j.items()) {
    fmt::print("{:{}}{}", "", indent, key);
    if (value.is_object()) {
      fmt::print("\n");
      printPlain(value, indent + 2);
    } else {
      fmt::print(" {}\n", value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
}

}  // namespace

int runInfo(const InfoArgs& args) {
  const std::string extension = std::filesystem::path(args.file).extension().string();
  if (extension == ".toml") {
    const scene::Scene s = scene::readSceneFile(args.file).scene;
    scene::validate(s);
    fmt::print("{}", args.json ? scene::toJson(s) + "\n" : scene::sceneToToml(s));
    return 0;
  }
  try {
    io::imageFormatOf(args.file);
  } catch (const ParameterError&) {
    throw UsageError("info: " + args.file + ": unknown kind of file; expected .toml, .png, .exr or .hdr");
  }
  const Json j = pictureJson(args.file);
  if (args.json)
    fmt::print("{}\n", j.dump(2, ' ', false, Json::error_handler_t::replace));
  else
    printPlain(j);
  return 0;
}

}  // namespace welkin::app
