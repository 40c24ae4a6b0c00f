// SPDX-License-Identifier: Apache-2.0
// How passes make their programs and hand them packed uniforms.
#pragma once

#include <string_view>

#include "welkin/gpu/program.h"
#include "welkin/shading/uniforms.h"

namespace welkin::render {

// A full-screen pass: pass/fullscreen.vert with a fragment entry point. Throws GpuError.
gpu::Program fullscreenProgram(std::string_view fragment);

// Sets every uniform that the program has.
void setUniforms(gpu::Program& program, const shading::Uniforms& uniforms);

}  // namespace welkin::render
