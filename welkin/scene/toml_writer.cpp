// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/toml_writer.h"

#include "welkin/scene/param_text.h"
#include "welkin/scene/toml_reader.h"

namespace welkin::scene::detail {
namespace {

std::string tomlString(const std::string& text) {
  std::ostringstream s;
  s << toml::value<std::string>(text);
  return s.str();
}

}  // namespace

void TomlWriter::line(const ParamInfo& info, const std::string& text) {
  out_ << info.key << " = " << text << '\n';
}

void TomlWriter::value(const ParamInfo& info, bool& x) {
  line(info, x ? "true" : "false");
}
void TomlWriter::value(const ParamInfo& info, std::int64_t& x) {
  line(info, std::to_string(x));
}
void TomlWriter::value(const ParamInfo& info, double& x) {
  line(info, numberText(x));
}
void TomlWriter::value(const ParamInfo& info, glm::dvec3& x) {
  line(info, "[" + numberText(x.x) + ", " + numberText(x.y) + ", " + numberText(x.z) + "]");
}
void TomlWriter::value(const ParamInfo& info, std::string& x) {
  line(info, tomlString(x));
}
void TomlWriter::value(const ParamInfo& info, UtcTime& x) {
  line(info, formatUtcTime(x));
}
void TomlWriter::value(const ParamInfo& info, std::optional<double>& x) {
  if (x) line(info, numberText(*x));
}
void TomlWriter::value(const ParamInfo& info, std::optional<std::string>& x) {
  if (x) line(info, tomlString(*x));
}
void TomlWriter::choice(const ParamInfo& info, std::span<const std::string_view> names, int& x) {
  line(info, tomlString(std::string(names[static_cast<std::size_t>(x)])));
}

bool TomlWriter::beginGroup(const ParamInfo& info) {
  out_ << "\n[" << info.key << "]\n";
  return true;
}
std::size_t TomlWriter::beginList(const ParamInfo& info, std::size_t size) {
  list_ = info.key;
  return size;
}
void TomlWriter::beginElement(std::size_t) {
  out_ << "\n[[" << list_ << "]]\n";
}

}  // namespace welkin::scene::detail
