// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/raw.h"

#include <array>
#include <cassert>
#include <climits>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "welkin/core/error.h"
#include "welkin/io/atomic_file.h"
#include "welkin/io/file_extension.h"
#include "welkin/io/input_file.h"

namespace welkin::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 6> kChannels = {"a", "l", "r", "la", "rgb", "rgba"};
constexpr std::array<const char*, 4> kTypes = {"uint8", "uint16", "float16", "float32"};
constexpr std::uint64_t kLongestSideFile = 1 << 20;

std::string sideText(const TexelShape& shape, const TexelNotes& notes) {
  Json size = {shape.nx, shape.ny};
  if (shape.volume) size.push_back(shape.nz);
  Json j = {{"version", 1},
            {"size", size},
            {"channels", kChannels[static_cast<std::size_t>(shape.format.channels)]},
            {"type", kTypes[static_cast<std::size_t>(shape.format.type)]},
            {"byte_order", "little"}};
  if (shape.volume) {
    j["voxel_size_m"] = {notes.voxelSizeM.x, notes.voxelSizeM.y, notes.voxelSizeM.z};
    j["first_voxel_m"] = {notes.firstVoxelM.x, notes.firstVoxelM.y, notes.firstVoxelM.z};
    if (!notes.name.empty()) j["name"] = notes.name;
  }
  if (!notes.metadata.empty()) j["metadata"] = notes.metadata;
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

// Takes the keys of the side file one by one and names the one that is wrong.
class SideReader {
 public:
  SideReader(const Json& json, std::string path) : json_(json), path_(std::move(path)) {
    if (!json_.is_object()) fail("expected an object of keys and values");
  }

  [[noreturn]] void fail(const std::string& why) const { throw IoError("cannot read " + path_ + ": " + why); }

  const Json* find(const char* key) {
    known_.insert(key);
    const auto it = json_.find(key);
    return it == json_.end() ? nullptr : &*it;
  }

  const Json& need(const char* key) {
    const Json* value = find(key);
    if (!value) fail(std::string("there is no \"") + key + '"');
    return *value;
  }

  template <std::size_t N>
  std::size_t choice(const char* key, const std::array<const char*, N>& names) {
    const Json& value = need(key);
    std::string list;
    for (std::size_t i = 0; i < N; ++i) {
      if (value == names[i]) return i;
      list += (i == 0 ? "" : i + 1 == N ? " or " : ", ") + std::string(names[i]);
    }
    fail(std::string(key) + ": expected " + list + ", found " + brief(value));
  }

  int count(const Json& value) const {
    if (!value.is_number_integer() || value < 1 || value > INT_MAX)
      fail("size: expected whole numbers of at least 1, found " + brief(value));
    return value.get<int>();
  }

  glm::dvec3 vector(const char* key, glm::dvec3 otherwise, bool positive) {
    const Json* value = find(key);
    if (!value) return otherwise;
    if (!value->is_array() || value->size() != 3) fail(std::string(key) + ": expected three numbers");
    glm::dvec3 v;
    for (int i = 0; i < 3; ++i) {
      const Json& x = (*value)[static_cast<std::size_t>(i)];
      if (!x.is_number() || !std::isfinite(x.get<double>()) || (positive && !(x.get<double>() > 0.0)))
        fail(std::string(key) + ": expected three " + (positive ? "positive " : "") + "numbers, found " +
             brief(x));
      v[i] = x.get<double>();
    }
    return v;
  }

  std::string text(const Json& value, const char* key) const {
    if (!value.is_string()) fail(std::string(key) + ": expected text, found " + brief(value));
    return value.get<std::string>();
  }

  void refuseUnknown() const {
    for (const auto& [key, value] : json_.items())
      if (!known_.contains(key)) fail("unknown key \"" + key + '"');
  }

 private:
  static std::string brief(const Json& value) {
    if (value.is_structured())
      return value.is_array() ? "a list" : "an object";  // may be deep: do not descend
    const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    return text.size() <= 40 ? text : text.substr(0, 40) + "...";
  }

  const Json& json_;
  std::string path_;
  std::set<std::string> known_;
};

// The shape and the notes; the texels stay empty.
Texels readSide(const std::filesystem::path& path) {
  InputFile file(path);
  if (file.size() > kLongestSideFile) file.fail("a side file of more than 1 MiB");
  std::string bytes(file.size(), '\0');
  file.read(bytes.data(), bytes.size());
  Json json;
  try {
    json = Json::parse(bytes);
  } catch (const Json::parse_error& e) {
    file.fail("no JSON", e.byte > 0 ? e.byte - 1 : 0);
  } catch (const Json::exception& e) {  // a number that is out of range
    file.fail(std::string("no JSON: ") + e.what());
  }
  SideReader side(json, path.string());
  if (side.need("version") != 1) side.fail("version: expected 1");
  if (side.need("byte_order") != "little") side.fail("byte_order: expected little");
  const Json& size = side.need("size");
  if (!size.is_array() || (size.size() != 2 && size.size() != 3))
    side.fail("size: expected two or three numbers");

  Texels texels;
  TexelShape& shape = texels.shape;
  shape.format = {static_cast<Channels>(side.choice("channels", kChannels)),
                  static_cast<ValueType>(side.choice("type", kTypes))};
  shape.nx = side.count(size[0]);
  shape.ny = side.count(size[1]);
  shape.volume = size.size() == 3;
  if (shape.volume) shape.nz = side.count(size[2]);
  texels.notes.voxelSizeM = side.vector("voxel_size_m", texels.notes.voxelSizeM, true);
  texels.notes.firstVoxelM = side.vector("first_voxel_m", texels.notes.firstVoxelM, false);
  if (const Json* name = side.find("name")) texels.notes.name = side.text(*name, "name");
  if (const Json* metadata = side.find("metadata")) {
    if (!metadata->is_object()) side.fail("metadata: expected keys and texts");
    for (const auto& [key, value] : metadata->items())
      texels.notes.metadata[key] = side.text(value, "metadata");
  }
  side.refuseUnknown();
  try {
    validate(shape);
  } catch (const ParameterError& e) {
    side.fail(e.what());
  }
  return texels;
}

}  // namespace

std::filesystem::path rawTexelPath(std::filesystem::path path) {
  return lowerExtension(path) == ".json" ? path.replace_extension() : path;
}
std::filesystem::path rawSidePath(const std::filesystem::path& path) {
  return lowerExtension(path) == ".json" ? path : std::filesystem::path(path.string() + ".json");
}

struct RawWriter::Impl {
  Impl(const std::filesystem::path& path, const TexelShape& s, const TexelNotes& notes)
      : shape(s), texels(rawTexelPath(path)), side(rawSidePath(path)) {
    const std::string text = sideText(shape, notes);
    if (text.size() > kLongestSideFile)
      throw ParameterError("cannot write " + side.path().string() + ": metadata of more than 1 MiB");
    side.write(text);
  }
  TexelShape shape;
  AtomicFile texels, side;
};

RawWriter::RawWriter(const std::filesystem::path& path, const TexelShape& shape, const TexelNotes& notes) {
  validate(shape);
  impl_ = std::make_unique<Impl>(path, shape, notes);
}

RawWriter::~RawWriter() = default;

void RawWriter::write(std::span<const std::byte> rows) {
  assert(rows.size() % impl_->shape.rowBytes() == 0);
  impl_->texels.write(rows.data(), rows.size());
}

void RawWriter::close() {
  assert(impl_->texels.position() == impl_->shape.bytes());
  impl_->texels.commit();
  impl_->side.commit();
}

void writeRaw(const std::filesystem::path& path, const Texels& texels) {
  RawWriter writer(path, texels.shape, texels.notes);
  writer.write(texels.bytes);
  writer.close();
}

Texels readRaw(const std::filesystem::path& path) {
  const std::filesystem::path texelPath = rawTexelPath(path), sidePath = rawSidePath(path);
  Texels texels = readSide(sidePath);
  InputFile file(texelPath);
  if (file.size() != texels.shape.bytes())
    file.fail("the file has " + std::to_string(file.size()) + " bytes; " + sidePath.string() + " says " +
              std::to_string(texels.shape.bytes()));
  texels.bytes.resize(texels.shape.bytes());
  file.read(texels.bytes.data(), texels.bytes.size());
  requireFinite(texels, texelPath, 0);
  return texels;
}

}  // namespace welkin::io
