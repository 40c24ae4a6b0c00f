// SPDX-License-Identifier: Apache-2.0
// Put before every shader by shader assembly, after #version. The C++ side of these macros is welkin/core/glsl.h.
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler3D;
#define WELKIN_FN
#define WELKIN_CONST const
#define WELKIN_OUT(type) out type
#define WELKIN_INOUT(type) inout type
// Before an array of uniforms: all its indices are constants.
#define WELKIN_FIXED
