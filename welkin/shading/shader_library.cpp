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

std::string_view takeWord(std::string_view& s) {
  s = trimLeft(s);
  const std::size_t end = std::min(s.find_first_of(" \t"), s.size());
  const std::string_view word = s.substr(0, end);
  s.remove_prefix(end);
  return word;
}

// A variable of the global scope.
struct Variable {
  std::string type, name, array;  // "[8]" or nothing
};

// The uniforms that a line declares and that can be read once: all but samplers, and of arrays those that are
// indexed by constants alone.
std::vector<Variable> readableOnce(std::string_view line) {
  std::string_view word = takeWord(line);
  const bool fixed = word == "WELKIN_FIXED";
  if (fixed) word = takeWord(line);
  const std::string type(word == "uniform" ? takeWord(line) : "");
  if (type.empty() || type.find("sampler") != std::string::npos) return {};
  std::vector<Variable> variables;
  line = line.substr(0, line.find(';'));
  while (!line.empty()) {
    const std::size_t comma = std::min(line.find(','), line.size());
    const std::string_view name = trimLeft(line.substr(0, comma));
    line.remove_prefix(std::min(comma + 1, line.size()));
    const std::size_t bracket = std::min(name.find('['), name.size());
    if (bracket == name.size() || fixed)
      variables.push_back(
          {type, std::string(name.substr(0, name.find_first_of(" \t["))), std::string(name.substr(bracket))});
  }
  return variables;
}

constexpr std::string_view kMain = "void main() {";

// Always true, which compilers do not know: what is assigned under it stays where it is assigned.
constexpr std::string_view kAlways = "gl_FragCoord.x >= 0.0";
constexpr std::string_view kAlwaysInCompute = "gl_NumWorkGroups.x > 0u";

class Assembler {
 public:
  // always: a condition under which main() is to read uniforms once; empty: where they are used.
  Assembler(std::string_view entry, std::string_view always) : always_(always) {
    source_.files.emplace_back(entry);
  }

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
        if (line.starts_with(kMain) && !once_.empty()) {
          source_.text += kMain;
          readOnce();
          lineDirective(number, index);
          line.remove_prefix(kMain.size());
        }
        source_.text += line;
        source_.text += '\n';
        if (!always_.empty() && declareOnce(line)) lineDirective(number + 1, index);
      }
    }
  }

  // Adds a file that has not been added before, under a new index.
  void addNewFile(std::string_view name, std::string_view text) {
    source_.files.emplace_back(name);
    addFile(source_.files.size() - 1, text);
  }

  ShaderSource take() {
    if (!once_.empty() && !filled_)
      throw Error(source_.files.front() + ": expected a line that begins with \"" + std::string(kMain) + '"');
    return std::move(source_);
  }

 private:
  void lineDirective(int line, std::size_t index) {
    source_.text += "#line " + std::to_string(line) + ' ' + std::to_string(index) + '\n';
  }

  // Behind a declaration of uniforms: variables that are used in their place. True: there are some.
  bool declareOnce(std::string_view line) {
    const std::vector<Variable> variables = readableOnce(line);
    for (const auto& [type, name, array] : variables) {
      source_.text += type + ' ' + name + '_' + array + ";\nvoid read_" + name + "() { " + name +
                      "_ = " + name + "; }\n#define " + name + ' ' + name + "_\n";
      once_.push_back(name);
    }
    return !variables.empty();
  }

  // At the beginning of main(): their values, of those whose declaration is not left out by a condition.
  void readOnce() {
    source_.text += "\nif (" + always_ + ") {\n";
    for (const std::string& name : once_)
      source_.text += "#ifdef " + name + "\nread_" + name + "();\n#endif\n";
    source_.text += "}\n";
    filled_ = true;
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
  std::string always_;
  std::vector<std::string> once_;
  bool filled_ = false;  // main() has begun with their values
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
                            std::span<const ShaderDefine> defines, UniformReads reads) {
  const std::optional<std::string> entry = findShader(name), prelude = findShader(kPrelude);
  if (!prelude)
    throw IoError("no shader files in " + diskFolder() + " (WELKIN_SHADER_DIR): lib/prelude.glsl is missing");
  if (!entry) throw Error("there is no shader file \"" + std::string(name) + '"' + suggestion(name));

  std::string_view always;
  if (reads == UniformReads::kOnce && name.ends_with(".frag")) always = kAlways;
  if (reads == UniformReads::kOnce && name.ends_with(".comp")) always = kAlwaysInCompute;
  Assembler assembler(name, always);
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
