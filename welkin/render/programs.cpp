// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/programs.h"

#include <type_traits>

#include "welkin/gpu/draw.h"

namespace welkin::render {

namespace {

ShaderSource sourceOf(std::string_view name, shading::ShaderDialect dialect,
                      std::span<const shading::ShaderDefine> defines) {
  return shading::assembleShader(
      name, dialect, defines,
      gpu::isSoftware() ? shading::UniformReads::kOnce : shading::UniformReads::kWhereUsed);
}

}  // namespace

gpu::Program graphicsProgram(std::string_view vertex, std::string_view fragment,
                             std::span<const shading::ShaderDefine> defines) {
  constexpr auto kDialect = shading::ShaderDialect::kGl330;
  return gpu::Program::graphics(sourceOf(vertex, kDialect, defines), sourceOf(fragment, kDialect, defines));
}

gpu::Program fullscreenProgram(std::string_view fragment, std::span<const shading::ShaderDefine> defines) {
  constexpr auto kDialect = shading::ShaderDialect::kGl330;
  return gpu::Program::graphics(sourceOf("pass/fullscreen.vert", kDialect, {}),
                                sourceOf(fragment, kDialect, defines));
}

gpu::Program computeProgram(std::string_view entry, std::span<const shading::ShaderDefine> defines) {
  return gpu::Program::compute(sourceOf(entry, shading::ShaderDialect::kGl430Compute, defines));
}

gpu::Program& ProgramVariants::with(const shading::ShaderDefines& defines) {
  gpu::Program& program = programs_[defines];
  if (program.id() == 0) program = fullscreenProgram(fragment_, defines);
  return program;
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
