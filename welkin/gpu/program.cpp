// SPDX-License-Identifier: Apache-2.0
#include "welkin/gpu/program.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/gpu/gl_format.h"
#include "welkin/gpu/state_guard.h"

namespace welkin::gpu {
namespace {

// Reads digits at the front of s and removes them.
std::optional<std::size_t> takeNumber(std::string_view& s) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), value);
  if (error != std::errc() || end == s.data()) return std::nullopt;
  s.remove_prefix(static_cast<std::size_t>(end - s.data()));
  return value;
}

// One line of a log. Mesa writes "0:12(5): error: ...", NVIDIA "0(12) : error C1008: ...", ANGLE and others
// "ERROR: 0:12: ...".
std::string lineWithFileName(std::string_view line, const ShaderSource& source) {
  std::string_view rest = line;
  std::string_view kind;
  for (std::string_view word : {"ERROR: ", "WARNING: "})
    if (rest.starts_with(word)) {
      kind = word;
      rest.remove_prefix(word.size());
    }
  const std::optional<std::size_t> file = takeNumber(rest);
  if (!file || *file >= source.files.size() || rest.empty()) return std::string(line);
  const char opening = rest.front();
  if (opening != ':' && opening != '(') return std::string(line);
  rest.remove_prefix(1);
  const std::optional<std::size_t> number = takeNumber(rest);
  if (!number) return std::string(line);
  if (opening == '(') {
    if (!rest.starts_with(')')) return std::string(line);
    rest.remove_prefix(1);
    rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  }
  std::string out = source.files[*file] + ':' + std::to_string(*number);
  if (!kind.empty()) out.append(": ").append(kind.substr(0, kind.size() - 2));
  return out.append(rest);
}

struct Shader {
  GLuint id = 0;
  explicit Shader(GLuint name) : id(name) {}
  ~Shader() { glDeleteShader(id); }
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;
};

std::string nameOf(const ShaderSource& source) {
  return source.files.empty() ? "shader" : source.files.front();
}

// The first line of a log that speaks of an error, and the whole log below it when there is more.
std::string summary(const std::string& log) {
  std::size_t begin = 0;
  while (begin < log.size()) {
    const std::size_t end = std::min(log.find('\n', begin), log.size());
    const std::string line = log.substr(begin, end - begin);
    if (line.find("error") != std::string::npos || line.find("ERROR") != std::string::npos)
      return log.find_first_not_of(" \n", end) == std::string::npos && begin == 0 ? line : line + "\n" + log;
    begin = end + 1;
  }
  return log.empty() ? "the driver gives no reason" : log;
}

void compile(const Shader& shader, const ShaderSource& source) {
  const char* text = source.text.data();
  const GLint length = static_cast<GLint>(source.text.size());
  glShaderSource(shader.id, 1, &text, &length);
  glCompileShader(shader.id);
  GLint good = 0, logLength = 0;
  glGetShaderiv(shader.id, GL_COMPILE_STATUS, &good);
  if (good) return;
  glGetShaderiv(shader.id, GL_INFO_LOG_LENGTH, &logLength);
  std::string log(static_cast<std::size_t>(std::max(logLength, 1)), '\0');
  glGetShaderInfoLog(shader.id, logLength, nullptr, log.data());
  log.resize(std::min(log.find('\0'), log.size()));
  throw GpuError(nameOf(source) + " does not compile: " + summary(withFileNames(log, source)));
}

// That a shader declares, those that the preprocessor leaves out among them.
int texturesIn(std::string_view text) {
  constexpr std::string_view kDeclaration = "uniform sampler";
  int count = 0;
  for (std::size_t at = text.find(kDeclaration); at != std::string_view::npos;
       at = text.find(kDeclaration, at + kDeclaration.size()))
    ++count;
  return count;
}

bool isSampler(GLenum type) {
  switch (type) {
    case GL_SAMPLER_2D:
    case GL_SAMPLER_3D:
    case GL_SAMPLER_CUBE:
    case GL_SAMPLER_2D_ARRAY:
    case GL_SAMPLER_2D_SHADOW:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::string withFileNames(std::string_view log, const ShaderSource& source) {
  std::string out;
  while (!log.empty()) {
    const std::size_t end = log.find('\n');
    out += lineWithFileName(log.substr(0, end), source);
    if (end == std::string_view::npos) break;
    out += '\n';
    log.remove_prefix(end + 1);
  }
  while (out.ends_with('\n')) out.pop_back();
  return out;
}

Program Program::graphics(const ShaderSource& vertex, const ShaderSource& fragment) {
  const Shader vert(glCreateShader(GL_VERTEX_SHADER)), frag(glCreateShader(GL_FRAGMENT_SHADER));
  compile(vert, vertex);
  compile(frag, fragment);
  return link(std::array{vert.id, frag.id}, nameOf(vertex) + " with " + nameOf(fragment),
              std::max(texturesIn(vertex.text), texturesIn(fragment.text)));
}

Program Program::compute(const ShaderSource& source) {
  const Shader shader(glCreateShader(GL_COMPUTE_SHADER));
  compile(shader, source);
  return link(std::array{shader.id}, nameOf(source), texturesIn(source.text));
}

// textures: as many as a shader of it declares.
Program Program::link(std::span<const unsigned> shaders, std::string_view name, int textures) {
  Program program(glCreateProgram());
  for (const unsigned shader : shaders) glAttachShader(program.id_, shader);
  glLinkProgram(program.id_);
  for (const unsigned shader : shaders) glDetachShader(program.id_, shader);
  GLint good = 0, logLength = 0;
  glGetProgramiv(program.id_, GL_LINK_STATUS, &good);
  if (!good) {
    glGetProgramiv(program.id_, GL_INFO_LOG_LENGTH, &logLength);
    std::string log(static_cast<std::size_t>(std::max(logLength, 1)), '\0');
    glGetProgramInfoLog(program.id_, logLength, nullptr, log.data());
    log.resize(std::min(log.find('\0'), log.size()));
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &most);
    std::string limit;
    if (textures > most)
      limit = "it names up to " + std::to_string(textures) + " textures, and this device gives a shader " +
              std::to_string(most) + ": ";
    throw GpuError(std::string(name) + " does not link: " + limit + summary(log));
  }
  program.collectUniforms();
  return program;
}

void Program::collectUniforms() {
  glUseProgram(id_);
  GLint count = 0, longest = 0;
  glGetProgramiv(id_, GL_ACTIVE_UNIFORMS, &count);
  glGetProgramiv(id_, GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
  std::vector<char> buffer(static_cast<std::size_t>(std::max(longest, 1)));
  // Unit 0 is left for making and filling textures, so that doing so between bind() and the draw disturbs
  // nothing.
  int nextUnit = 1;
  for (GLint i = 0; i < count; ++i) {
    GLsizei length = 0;
    GLint size = 0;
    GLenum type = 0;
    glGetActiveUniform(id_, static_cast<GLuint>(i), static_cast<GLsizei>(buffer.size()), &length, &size,
                       &type, buffer.data());
    std::string name(buffer.data(), static_cast<std::size_t>(length));
    Uniform uniform;
    uniform.location = glGetUniformLocation(id_, name.c_str());
    if (uniform.location < 0) continue;  // in a block, or built in
    if (isSampler(type)) {
      // Each sampler has a unit of its own for good: two kinds of sampler on one unit are an error in GL.
      uniform.unit = nextUnit++;
      if (uniform.unit >= StateGuard::kUnits)
        throw GpuError("a program has more than " + std::to_string(StateGuard::kUnits - 1) + " textures");
      glUniform1i(uniform.location, uniform.unit);
    }
    if (name.ends_with("[0]")) name.resize(name.size() - 3);
    uniforms_.emplace(std::move(name), uniform);
  }
}

Program::~Program() {
  if (id_) glDeleteProgram(id_);
}

Program::Program(Program&& other) noexcept {
  *this = std::move(other);
}

Program& Program::operator=(Program&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(uniforms_, other.uniforms_);
  return *this;
}

void Program::use() const {
  glUseProgram(id_);
}

int Program::locate(std::string_view name) const {
  glUseProgram(id_);
  const auto it = uniforms_.find(name);
  return it == uniforms_.end() ? -1 : it->second.location;  // GL ignores location -1
}

void Program::set(std::string_view name, float value) {
  glUniform1f(locate(name), value);
}
void Program::set(std::string_view name, int value) {
  glUniform1i(locate(name), value);
}
void Program::set(std::string_view name, glm::vec2 v) {
  glUniform2f(locate(name), v.x, v.y);
}
void Program::set(std::string_view name, glm::vec3 v) {
  glUniform3f(locate(name), v.x, v.y, v.z);
}
void Program::set(std::string_view name, const glm::vec4& v) {
  glUniform4f(locate(name), v.x, v.y, v.z, v.w);
}
void Program::set(std::string_view name, glm::ivec2 v) {
  glUniform2i(locate(name), v.x, v.y);
}
void Program::set(std::string_view name, glm::ivec3 v) {
  glUniform3i(locate(name), v.x, v.y, v.z);
}
void Program::set(std::string_view name, const glm::mat3& m) {
  glUniformMatrix3fv(locate(name), 1, GL_FALSE, glm::value_ptr(m));
}
void Program::set(std::string_view name, const glm::mat4& m) {
  glUniformMatrix4fv(locate(name), 1, GL_FALSE, glm::value_ptr(m));
}
void Program::set(std::string_view name, std::span<const float> v) {
  glUniform1fv(locate(name), static_cast<GLsizei>(v.size()), v.data());
}
void Program::set(std::string_view name, std::span<const int> v) {
  glUniform1iv(locate(name), static_cast<GLsizei>(v.size()), v.data());
}
void Program::set(std::string_view name, std::span<const glm::vec2> v) {
  if (!v.empty()) glUniform2fv(locate(name), static_cast<GLsizei>(v.size()), glm::value_ptr(v.front()));
}
void Program::set(std::string_view name, std::span<const glm::vec3> v) {
  if (!v.empty()) glUniform3fv(locate(name), static_cast<GLsizei>(v.size()), glm::value_ptr(v.front()));
}
void Program::set(std::string_view name, std::span<const glm::vec4> v) {
  if (!v.empty()) glUniform4fv(locate(name), static_cast<GLsizei>(v.size()), glm::value_ptr(v.front()));
}

int Program::unitOf(std::string_view sampler) const {
  const auto it = uniforms_.find(sampler);
  return it == uniforms_.end() ? -1 : it->second.unit;
}

void Program::bind(std::string_view sampler, const Texture& texture) const {
  const int unit = unitOf(sampler);
  if (unit < 0) return;
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(texture.target(), texture.id());
  glActiveTexture(GL_TEXTURE0);
}

}  // namespace welkin::gpu
