// SPDX-License-Identifier: Apache-2.0
// How passes make their programs and hand them packed uniforms.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "welkin/gpu/program.h"
#include "welkin/shading/shader_library.h"
#include "welkin/shading/uniforms.h"

namespace welkin::render {

// A full-screen pass: pass/fullscreen.vert with a fragment entry point. Throws GpuError.
gpu::Program fullscreenProgram(std::string_view fragment, std::span<const shading::ShaderDefine> defines = {});

// A full-screen pass that depends on the number of layers; made when first asked for and kept.
class LayeredProgram {
 public:
  explicit LayeredProgram(std::string_view fragment) : fragment_(fragment) {}
  gpu::Program& forLayers(std::size_t count);

 private:
  std::string fragment_;
  std::map<std::size_t, gpu::Program> programs_;
};

// Sets every uniform that the program has.
void setUniforms(gpu::Program& program, const shading::Uniforms& uniforms);

}  // namespace welkin::render
