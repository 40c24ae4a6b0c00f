// SPDX-License-Identifier: Apache-2.0
// How passes make their programs and hand them packed uniforms.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "welkin/gpu/program.h"
#include "welkin/shading/uniforms.h"

namespace welkin::render {

// A pass with a vertex entry point of its own. Throws GpuError.
gpu::Program graphicsProgram(std::string_view vertex, std::string_view fragment,
                             std::span<const shading::ShaderDefine> defines = {});

// A full-screen pass: pass/fullscreen.vert with a fragment entry point. Throws GpuError.
gpu::Program fullscreenProgram(std::string_view fragment,
                               std::span<const shading::ShaderDefine> defines = {});

// A compute pass, where gpu::canCompute(). Throws GpuError.
gpu::Program computeProgram(std::string_view entry, std::span<const shading::ShaderDefine> defines = {});

// A full-screen pass with variants; each is made when first asked for, and kept.
class ProgramVariants {
 public:
  explicit ProgramVariants(std::string_view fragment) : fragment_(fragment) {}
  gpu::Program& with(const shading::ShaderDefines& defines);

 private:
  std::string fragment_;
  std::map<shading::ShaderDefines, gpu::Program> programs_;
};

// Sets every uniform that the program has.
void setUniforms(gpu::Program& program, const shading::Uniforms& uniforms);

}  // namespace welkin::render
