// SPDX-License-Identifier: Apache-2.0
// Puts shaders together from the files of shaders/: version line, prelude, defines, then the entry point with
// its includes.
//
// Files are written in the subset of GLSL 3.30 and GLSL ES 3.00 without a #version, so that one entry point
// serves desktop and web. `#include "lib/x.glsl"` on a line of its own brings in a file by its path below
// shaders/, once for each shader however often it is asked for. `#line` directives make compilers speak of
// the original files and lines.
//
// The files are embedded in the library. While developing, set the environment variable WELKIN_SHADER_DIR to
// a shaders/ folder: then they are read from there at every call, and an edited shader needs no new build.
// Makes no GL calls; safe to call from several threads.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "welkin/core/shader_source.h"

namespace welkin::shading {

enum class ShaderDialect {
  kGl330,         // desktop, core profile: vertex and fragment entry points
  kEs300,         // OpenGL ES 3.0 and WebGL 2: the same entry points
  kGl430Compute,  // desktop 4.3: .comp entry points
};

// Name and value of a macro: {"WELKIN_STEPS", "64"}. Defined before the entry point and after the prelude.
using ShaderDefine = std::pair<std::string, std::string>;

// How often a fragment or compute shader reads its uniforms: wherever it uses them, which costs a GPU
// nothing; or once, at the beginning of main(). Mesa's software rasteriser reads them number by number for
// each of eight pixels, some thirty-five instructions, at every step of a loop. For kOnce, uniforms are
// declared on lines of their own that begin with `uniform`, and main() begins a line as `void main() {`.
// Arrays are read once where WELKIN_FIXED stands before the declaration: all their indices are constants.
enum class UniformReads { kWhereUsed, kOnce };

// The complete text of an entry point, named by its path below shaders/ ("pass/sky.frag").
// Throws Error when there is no such file, ParseError (file:line) when an include in it names none or cannot
// be understood, Error when uniforms are to be read once and main() does not begin as said, IoError when
// WELKIN_SHADER_DIR cannot be read.
ShaderSource assembleShader(std::string_view name, ShaderDialect dialect,
                            std::span<const ShaderDefine> defines = {},
                            UniformReads reads = UniformReads::kWhereUsed);

// The names of all shader files, entry points and libraries, in alphabetical order.
std::vector<std::string> shaderNames();

}  // namespace welkin::shading
