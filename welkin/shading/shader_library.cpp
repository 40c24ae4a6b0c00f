// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/shader_library.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "welkin/core/error.h"
#include "welkin/core/params.h"
#include "welkin/shading/embedded_shaders.h"

namespace welkin::shading {
namespace {

constexpr std::string_view kPrelude = "lib/prelude.glsl";

// The folder to read from instead of the embedded files; empty: none.
std::string diskFolder() {
  const char* folder = std::getenv("WELKIN_SHADER_DIR");
  return folder ? folder : "";
}

std::optional<std::string> readFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path)) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}

std::optional<std::string> findShader(std::string_view name) {
  if (const std::string folder = diskFolder(); !folder.empty())
    return readFile(std::filesystem::path(folder) / std::string(name));
  for (const EmbeddedShader& shader : embeddedShaders())
    if (shader.name == name) return std::string(shader.text);
  return std::nullopt;
}

// ": is "lib/phase.glsl" meant?" or nothing.
std::string suggestion(std::string_view name) {
  const std::string nearest = nearestName(name, shaderNames());
  return nearest.empty() ? "" : "; is \"" + nearest + "\" meant?";
}

std::string_view trimLeft(std::string_view s) {
  s.remove_prefix(std::min(s.find_first_not_of(" \t"), s.size()));
  return s;
}

// The rest of a line after `#include`, or nothing if it is another line. Commented-out includes are other
// lines.
std::optional<std::string_view> afterInclude(std::string_view line) {
  line = trimLeft(line);
  if (!line.starts_with('#')) return std::nullopt;
  line = trimLeft(line.substr(1));
  constexpr std::string_view kWord = "include";
  if (!line.starts_with(kWord)) return std::nullopt;
  return trimLeft(line.substr(kWord.size()));
}

class Assembler {
 public:
  explicit Assembler(std::string_view entry) { source_.files.emplace_back(entry); }

  void add(std::string_view text) { source_.text += text; }

  // Adds a file's text with its includes resolved. `index` is its place in source_.files.
  void addFile(std::size_t index, std::string_view text) {
    lineDirective(1, index);
    int number = 0;
    while (!text.empty()) {
      ++number;
      const std::size_t end = text.find('\n');
      std::string_view line = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (const auto rest = afterInclude(line)) {
        addInclude(*rest, index, number);
        lineDirective(number + 1, index);
      } else {
        source_.text += line;
        source_.text += '\n';
      }
    }
  }

  // Adds a file that has not been added before, under a new index.
  void addNewFile(std::string_view name, std::string_view text) {
    source_.files.emplace_back(name);
    addFile(source_.files.size() - 1, text);
  }

  ShaderSource take() { return std::move(source_); }

 private:
  void lineDirective(int line, std::size_t index) {
    source_.text += "#line " + std::to_string(line) + ' ' + std::to_string(index) + '\n';
  }

  void addInclude(std::string_view rest, std::size_t includer, int line) {
    const std::string from = source_.files[includer];
    const std::size_t close = rest.size() > 1 ? rest.find('"', 1) : std::string_view::npos;
    if (!rest.starts_with('"') || close == std::string_view::npos)
      throw ParseError(from, line, 0, "expected #include \"lib/name.glsl\"");
    const std::string name(rest.substr(1, close - 1));
    const auto& files = source_.files;
    if (std::find(files.begin(), files.end(), name) != files.end()) return;  // once is enough
    const std::optional<std::string> text = findShader(name);
    if (!text) throw ParseError(from, line, 0, "there is no shader file \"" + name + '"' + suggestion(name));
    addNewFile(name, *text);
  }

  ShaderSource source_;
};

std::string_view versionLine(ShaderDialect dialect) {
  switch (dialect) {
    case ShaderDialect::kGl330:
      return "#version 330 core\n";
    case ShaderDialect::kEs300:
      return "#version 300 es\n";
    case ShaderDialect::kGl430Compute:
      return "#version 430 core\n";
  }
  return "";
}

}  // namespace

ShaderSource assembleShader(std::string_view name, ShaderDialect dialect,
                            std::span<const ShaderDefine> defines) {
  const std::optional<std::string> entry = findShader(name), prelude = findShader(kPrelude);
  if (!prelude)
    throw IoError("no shader files in " + diskFolder() + " (WELKIN_SHADER_DIR): lib/prelude.glsl is missing");
  if (!entry) throw Error("there is no shader file \"" + std::string(name) + '"' + suggestion(name));

  Assembler assembler(name);
  assembler.add(versionLine(dialect));
  assembler.addNewFile(kPrelude, *prelude);
  for (const ShaderDefine& define : defines)
    assembler.add("#define " + define.first + ' ' + define.second + '\n');
  assembler.addFile(0, *entry);
  return assembler.take();
}

std::vector<std::string> shaderNames() {
  std::vector<std::string> names;
  if (const std::string folder = diskFolder(); !folder.empty()) {
    std::error_code error;
    for (std::filesystem::recursive_directory_iterator it(folder, error), end; !error && it != end;
         it.increment(error))
      if (it->is_regular_file(error))
        names.push_back(std::filesystem::relative(it->path(), folder).generic_string());
  } else {
    for (const EmbeddedShader& shader : embeddedShaders()) names.emplace_back(shader.name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace welkin::shading
