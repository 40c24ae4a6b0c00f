// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/param_json.h"

#include <nlohmann/json.hpp>
#include <vector>

namespace welkin::scene::detail {

using Json = nlohmann::ordered_json;

// Objects under construction, the innermost last; each is put into its parent when it is complete.
struct JsonWriter::Impl {
  std::vector<Json> open{Json::object()};
  std::vector<std::string> keys;

  void set(const ParamInfo& info, Json x) { open.back()[std::string(info.key)] = std::move(x); }
  void begin(std::string_view key, Json container) {
    keys.emplace_back(key);
    open.push_back(std::move(container));
  }
  void end() {
    Json done = std::move(open.back());
    open.pop_back();
    if (open.back().is_array())
      open.back().push_back(std::move(done));
    else
      open.back()[keys.back()] = std::move(done);
    keys.pop_back();
  }
};

JsonWriter::JsonWriter() : impl_(std::make_unique<Impl>()) {}
JsonWriter::~JsonWriter() = default;
std::string JsonWriter::text(int indent) const {
  return impl_->open.front().dump(indent);
}

void JsonWriter::value(const ParamInfo& info, bool& x) {
  impl_->set(info, x);
}
void JsonWriter::value(const ParamInfo& info, std::int64_t& x) {
  impl_->set(info, x);
}
void JsonWriter::value(const ParamInfo& info, double& x) {
  impl_->set(info, x);
}
void JsonWriter::value(const ParamInfo& info, glm::dvec3& x) {
  impl_->set(info, Json::array({x.x, x.y, x.z}));
}
void JsonWriter::value(const ParamInfo& info, std::string& x) {
  impl_->set(info, x);
}
void JsonWriter::value(const ParamInfo& info, UtcTime& x) {
  impl_->set(info, formatUtcTime(x));
}
void JsonWriter::value(const ParamInfo& info, std::optional<double>& x) {
  impl_->set(info, x ? Json(*x) : Json());
}
void JsonWriter::value(const ParamInfo& info, std::optional<std::string>& x) {
  impl_->set(info, x ? Json(*x) : Json());
}
void JsonWriter::choice(const ParamInfo& info, std::span<const std::string_view> names, int& x) {
  impl_->set(info, std::string(names[static_cast<std::size_t>(x)]));
}

bool JsonWriter::beginGroup(const ParamInfo& info) {
  impl_->begin(info.key, Json::object());
  return true;
}
void JsonWriter::endGroup() {
  impl_->end();
}
std::size_t JsonWriter::beginList(const ParamInfo& info, std::size_t size) {
  impl_->begin(info.key, Json::array());
  return size;
}
void JsonWriter::beginElement(std::size_t) {
  impl_->begin({}, Json::object());
}
void JsonWriter::endElement() {
  impl_->end();
}
void JsonWriter::endList() {
  impl_->end();
}

}  // namespace welkin::scene::detail
