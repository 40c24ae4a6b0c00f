// SPDX-License-Identifier: Apache-2.0
// Lets C++ compile the files of shaders/lib, so that each formula is written once and runs on CPU and GPU
// alike.
//
// The shared subset: float literals with an f suffix; functions marked WELKIN_FN; out parameters as
// WELKIN_OUT(type) and WELKIN_INOUT(type); constants as WELKIN_CONST float kName = ...; no swizzles (write
// p.x, vec2(p.x, p.y), vec3(v4)); no arrays of opaque types; textures are read with textureLod(s, uv, 0.0f)
// or texelFetch(s, xy, 0) only; structs of float, int, vec2, vec3, vec4. The GLSL side of the same macros
// stands in shaders/lib/prelude.glsl.
//
// Include such a file once in a .cpp:
//   namespace { using namespace welkin::glsl;
//   #include "shaders/lib/atmosphere.glsl"
//   }
#pragma once

#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "welkin/core/image.h"

#define WELKIN_FN [[maybe_unused]] inline
#define WELKIN_CONST [[maybe_unused]] inline constexpr
#define WELKIN_OUT(type) type&
#define WELKIN_INOUT(type) type&

namespace welkin::glsl {

using glm::abs, glm::acos, glm::asin, glm::cos, glm::sin, glm::tan, glm::inversesqrt, glm::reflect;
using glm::clamp, glm::cross, glm::dot, glm::exp, glm::exp2, glm::floor, glm::fract, glm::length, glm::log,
    glm::log2;
using glm::ivec2, glm::ivec3, glm::vec2, glm::vec3, glm::vec4, glm::mat3, glm::mat4;
using glm::max, glm::min, glm::mix, glm::mod, glm::normalize, glm::pow, glm::sign, glm::smoothstep, glm::sqrt,
    glm::step;
inline float atan(float y, float x) {
  return std::atan2(y, x);
}
inline float atan(float x) {
  return std::atan(x);
}

enum class Wrap { kRepeat, kClamp };

// A texture of 1 to 4 float channels, read as GL does with LINEAR filtering: texel centres at (i + 0.5) / n;
// missing channels read 0, missing alpha 1. Refers to the picture; does not own it.
struct sampler2D {
  const Image<float>* image = nullptr;
  Wrap wrapX = Wrap::kClamp, wrapY = Wrap::kClamp;
};
struct sampler3D {
  const Volume<float>* volume = nullptr;
  Wrap wrap = Wrap::kRepeat;
};

namespace detail {
// The two texels beside coordinate u (0..1 over n texels) and the weight of the second.
struct Tap {
  int i0, i1;
  float w;
};
inline Tap tap(float u, int n, Wrap wrap) {
  const float x = u * static_cast<float>(n) - 0.5f;
  if (wrap == Wrap::kClamp) {  // no floor() nor fmin(), which are calls on plain x86-64
    const float top = static_cast<float>(n - 1);
    const float inside = x > 0.0f ? (x < top ? x : top) : 0.0f;
    const int i = static_cast<int>(inside);
    return {i, i + 1 < n ? i + 1 : i, inside - static_cast<float>(i)};
  }
  // Rounded towards zero, then down: no floor() here either. |x| < 2^31.
  int i = static_cast<int>(x);
  i -= static_cast<float>(i) > x;
  const float w = x - static_cast<float>(i);
  if ((n & (n - 1)) == 0) {  // a power of two: the usual size
    i &= n - 1;
  } else {
    i %= n;
    if (i < 0) i += n;
  }
  return {i, i + 1 == n ? 0 : i + 1, w};
}
inline vec4 load(const float* p, int channels) {
  vec4 v(0.0f, 0.0f, 0.0f, 1.0f);
  for (int c = 0; c < channels; ++c) v[c] = p[c];
  return v;
}
}  // namespace detail

inline vec4 textureLod(const sampler2D& s, vec2 uv, float) {
  const Image<float>& im = *s.image;
  const detail::Tap tx = detail::tap(uv.x, im.width, s.wrapX), ty = detail::tap(uv.y, im.height, s.wrapY);
  if (im.channels == 3) {  // the atmosphere's tables
    const float* p = im.data.data();
    const float *a = p + im.index(tx.i0, ty.i0), *b = p + im.index(tx.i1, ty.i0);
    const float *c = p + im.index(tx.i0, ty.i1), *d = p + im.index(tx.i1, ty.i1);
    vec4 v(0.0f, 0.0f, 0.0f, 1.0f);
    for (int k = 0; k < 3; ++k) {
      const float lo = a[k] + (b[k] - a[k]) * tx.w, hi = c[k] + (d[k] - c[k]) * tx.w;
      v[k] = lo + (hi - lo) * ty.w;
    }
    return v;
  }
  auto texel = [&](int x, int y) { return detail::load(&im.data[im.index(x, y)], im.channels); };
  const vec4 a = mix(texel(tx.i0, ty.i0), texel(tx.i1, ty.i0), tx.w);
  const vec4 b = mix(texel(tx.i0, ty.i1), texel(tx.i1, ty.i1), tx.w);
  return mix(a, b, ty.w);
}

inline vec4 texelFetch(const sampler2D& s, ivec2 at, int) {
  return detail::load(&s.image->data[s.image->index(at.x, at.y)], s.image->channels);
}

inline vec4 textureLod(const sampler3D& s, vec3 uvw, float) {
  const Volume<float>& v = *s.volume;
  const detail::Tap tx = detail::tap(uvw.x, v.nx, s.wrap), ty = detail::tap(uvw.y, v.ny, s.wrap),
                    tz = detail::tap(uvw.z, v.nz, s.wrap);
  if (v.channels == 1) {  // the density hot path
    auto row = [&](int y, int z) {
      const float* p = &v.data[v.index(0, y, z)];
      return p[tx.i0] + (p[tx.i1] - p[tx.i0]) * tx.w;
    };
    const float a = row(ty.i0, tz.i0), b = row(ty.i1, tz.i0), c = row(ty.i0, tz.i1), d = row(ty.i1, tz.i1);
    const float lo = a + (b - a) * ty.w, hi = c + (d - c) * ty.w;
    return vec4(lo + (hi - lo) * tz.w, 0.0f, 0.0f, 1.0f);
  }
  auto texel = [&](int x, int y, int z) { return detail::load(&v.data[v.index(x, y, z)], v.channels); };
  auto slice = [&](int z) {
    const vec4 a = mix(texel(tx.i0, ty.i0, z), texel(tx.i1, ty.i0, z), tx.w);
    const vec4 b = mix(texel(tx.i0, ty.i1, z), texel(tx.i1, ty.i1, z), tx.w);
    return mix(a, b, ty.w);
  };
  return mix(slice(tz.i0), slice(tz.i1), tz.w);
}

}  // namespace welkin::glsl
