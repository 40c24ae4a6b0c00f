// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/toml_reader.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace welkin::scene {

std::string readText(const std::string& path, const std::string& expected) {
  if (std::filesystem::is_directory(path)) throw IoError(path + ": is a folder; expected " + expected);
  std::ifstream in(path, std::ios::binary);
  if (!in) throw IoError(path + ": cannot be opened: " + std::strerror(errno));
  std::ostringstream text;
  if (in.peek() != std::ifstream::traits_type::eof()) text << in.rdbuf();
  if (!text || in.bad()) throw IoError(path + ": cannot be read");
  return text.str();
}

toml::table parseToml(std::string_view text, const std::string& name) {
  try {
    return toml::parse(text, std::string_view(name));
  } catch (const toml::parse_error& e) {
    throw ParseError(name, static_cast<int>(e.source().begin.line), static_cast<int>(e.source().begin.column),
                     std::string(e.description()));
  }
}

ParseError errorAt(const toml::node& node, const std::string& name, const std::string& message) {
  const toml::source_position& at = node.source().begin;
  return {name, static_cast<int>(at.line), static_cast<int>(at.column), message};
}

std::string kindOf(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "text";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::table:
      return "a table";
    case toml::node_type::date:
      return "a date without a time";
    case toml::node_type::time:
      return "a time without a date";
    default:
      return "a date and time";
  }
}

}  // namespace welkin::scene
