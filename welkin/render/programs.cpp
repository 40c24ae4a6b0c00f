// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/programs.h"

#include <span>
#include <type_traits>

#include "welkin/shading/shader_library.h"

namespace welkin::render {

gpu::Program fullscreenProgram(std::string_view fragment) {
  return gpu::Program::graphics(shading::assembleShader("pass/fullscreen.vert", shading::ShaderDialect::kGl330),
                                shading::assembleShader(fragment, shading::ShaderDialect::kGl330));
}

void setUniforms(gpu::Program& program, const shading::Uniforms& uniforms) {
  for (const auto& [name, value] : uniforms) {
    if (!program.has(name)) continue;
    std::visit(
        [&](const auto& v) {
          using T = std::decay_t<decltype(v)>;
          if constexpr (std::is_same_v<T, std::vector<float>>)
            program.set(name, std::span<const float>(v));
          else if constexpr (std::is_same_v<T, std::vector<glm::vec4>>)
            program.set(name, std::span<const glm::vec4>(v));
          else
            program.set(name, v);
        },
        value);
  }
}

}  // namespace welkin::render
