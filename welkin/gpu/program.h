// SPDX-License-Identifier: Apache-2.0
// A linked shader program with its uniforms and samplers by name.
//
// Values stay with the program until they are set again. Textures do not: units are shared by all programs,
// so bind every texture of a program before each draw or dispatch. Setting a name that the program does not
// have does nothing, since compilers remove what is not used; has() tells.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "welkin/core/shader_source.h"
#include "welkin/gpu/texture.h"

namespace welkin::gpu {

// A compiler's log with "index:line" and "index(line)" of the common drivers turned into "file:line".
std::string withFileNames(std::string_view log, const ShaderSource& source);

class Program {
 public:
  Program() = default;  // no program: for members that are filled later
  // Throw GpuError with the first error as "file:line: message" and the whole log below it.
  static Program graphics(const ShaderSource& vertex, const ShaderSource& fragment);
  static Program compute(const ShaderSource& source);  // needs Context::hasCompute()
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  Program(Program&& other) noexcept;
  Program& operator=(Program&& other) noexcept;

  unsigned id() const { return id_; }
  bool has(std::string_view uniform) const { return uniforms_.find(uniform) != uniforms_.end(); }
  void use() const;  // makes it the current program

  // Arrays go by their bare name, structs by member: "uLayers[2].base". Matrices are column by column as in
  // glm. Each makes the program current.
  void set(std::string_view name, float value);
  void set(std::string_view name, int value);
  void set(std::string_view name, glm::vec2 value);
  void set(std::string_view name, glm::vec3 value);
  void set(std::string_view name, const glm::vec4& value);
  void set(std::string_view name, glm::ivec2 value);
  void set(std::string_view name, glm::ivec3 value);
  void set(std::string_view name, const glm::mat3& value);
  void set(std::string_view name, const glm::mat4& value);
  void set(std::string_view name, std::span<const float> values);
  void set(std::string_view name, std::span<const int> values);
  void set(std::string_view name, std::span<const glm::vec2> values);
  void set(std::string_view name, std::span<const glm::vec3> values);
  void set(std::string_view name, std::span<const glm::vec4> values);

  // Binds a texture to the unit that the program keeps for this sampler.
  void bind(std::string_view sampler, const Texture& texture) const;
  // That unit; -1 where the program has no such sampler.
  int unitOf(std::string_view sampler) const;

 private:
  struct Uniform {
    int location = -1;
    int unit = -1;  // of samplers
  };
  explicit Program(unsigned id) : id_(id) {}
  static Program link(std::span<const unsigned> shaders, std::string_view name, int textures);
  void collectUniforms();
  int locate(std::string_view name) const;  // makes the program current; -1: not in it

  unsigned id_ = 0;
  std::map<std::string, Uniform, std::less<>> uniforms_;
};

}  // namespace welkin::gpu
