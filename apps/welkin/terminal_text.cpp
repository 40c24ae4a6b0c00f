// SPDX-License-Identifier: Apache-2.0
#include "terminal_text.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>

namespace welkin::app {
namespace {

// The character at the front: its bytes and number; 0 bytes where there is no UTF-8.
struct Character {
  std::size_t bytes = 0;
  std::uint32_t code = 0;
};

Character characterOf(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::uint32_t first = byte(0);
  if (first < 0x80) return {1, first};
  const std::size_t bytes = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < bytes) return {};
  std::uint32_t code = first & (0x7fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0u) != 0x80u) return {};
    code = code << 6 | (byte(i) & 0x3fu);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  if (code < kLeast[bytes] || code > 0x10ffff || surrogate) return {};
  return {bytes, code};
}

bool isControl(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0);
}

enum class Keep { kNothing, kLines, kJson };

std::string escaped(std::string_view text, Keep keep) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Character c = characterOf(text);
    const std::size_t bytes = c.bytes == 0 ? 1 : c.bytes;
    if (c.bytes == 0)
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
    else if (!isControl(c.code) || (keep != Keep::kNothing && c.code == '\n'))
      out += text.substr(0, bytes);
    else if (keep == Keep::kJson)
      out += fmt::format("\\u{:04x}", c.code);
    else if (c.code == '\n')
      out += "\\n";
    else if (c.code == '\t')
      out += "\\t";
    else
      out += fmt::format("\\x{:02x}", c.code);
    text.remove_prefix(bytes);
  }
  return out;
}

}  // namespace

std::string printable(std::string_view text) {
  return escaped(text, Keep::kNothing);
}

std::string printableLines(std::string_view text) {
  return escaped(text, Keep::kLines);
}

std::string printableJson(std::string_view json) {
  return escaped(json, Keep::kJson);
}

}  // namespace welkin::app
