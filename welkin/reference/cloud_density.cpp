// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/cloud_density.h"

#include <cstring>
#include <vector>

#include "welkin/core/glsl.h"

namespace welkin::reference {
namespace {

using namespace welkin::glsl;
using field::CloudLayer;

// Four floats in one register of any machine: GCC's and clang's.
using Four = float __attribute__((vector_size(16)));
Four load(const float* p) {
  Four v;
  std::memcpy(&v, p, sizeof v);
  return v;
}

// The formula in one piece: else the layer, which it takes by value, is copied again and again.
#undef WELKIN_FN
#define WELKIN_FN [[maybe_unused, gnu::always_inline]] inline

// All channels at a time; otherwise as welkin::glsl reads them, to the bit.
struct Placement {
  const Image<float>* image;
};
WELKIN_FN vec4 textureLod(const Placement& s, const vec2& uv, float) {
  const Image<float>& im = *s.image;
  const detail::Tap x = detail::tap(uv.x, im.width, Wrap::kRepeat),
                    y = detail::tap(uv.y, im.height, Wrap::kRepeat);
  auto row = [&](int j) {
    const float* p = im.data.data() + 4 * static_cast<std::ptrdiff_t>(j) * im.width;
    const Four a = load(p + 4 * x.i0), b = load(p + 4 * x.i1);
    return a + (b - a) * x.w;
  };
  const Four low = row(y.i0), high = row(y.i1), v = low + (high - low) * y.w;
  return vec4(v[0], v[1], v[2], v[3]);
}

// The one channel of a volume whose sides are powers of two; the same.
struct Noise {
  const Volume<float>* volume;
};
WELKIN_FN vec4 textureLod(const Noise& s, const vec3& uvw, float) {
  const Volume<float>& v = *s.volume;
  const detail::Tap x = detail::tap(uvw.x, v.nx, Wrap::kRepeat), y = detail::tap(uvw.y, v.ny, Wrap::kRepeat),
                    z = detail::tap(uvw.z, v.nz, Wrap::kRepeat);
  const float* p = v.data.data();
  const std::ptrdiff_t row = v.nx, slice = row * v.ny;
  const float *a = p + slice * z.i0 + row * y.i0, *b = p + slice * z.i0 + row * y.i1,
              *c = p + slice * z.i1 + row * y.i0, *d = p + slice * z.i1 + row * y.i1;
  const Four left = {a[x.i0], b[x.i0], c[x.i0], d[x.i0]}, right = {a[x.i1], b[x.i1], c[x.i1], d[x.i1]};
  const Four rows = left + (right - left) * x.w;
  const float low = rows[0] + (rows[1] - rows[0]) * y.w, high = rows[2] + (rows[3] - rows[2]) * y.w;
  return vec4(low + (high - low) * z.w, 0.0f, 0.0f, 1.0f);
}

// The formula reads its noises through these.
#define sampler2D Placement
#define sampler3D Noise
#include "shaders/lib/clouds.glsl"
#undef sampler2D
#undef sampler3D

}  // namespace

CloudDensity::CloudDensity(const field::CloudField& field)
    : field_(field), placement_(field.noise().placement.width, field.noise().placement.height, 4) {
  const std::vector<float>& from = field.noise().placement.data;
  for (std::size_t i = 0; 3 * i < from.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) placement_.data[4 * i + c] = from[3 * i + c];
}

float CloudDensity::extinction(std::size_t layer, const glm::vec3& q) const {
  const CloudLayer& l = field_.layers()[layer];
  if (q.z <= l.baseM || q.z >= l.topM) return 0.0f;
  float clear = 0.0f;
  return cloudExtinction(l, {&placement_}, {&field_.noise().shape}, {&field_.noise().detail}, q, clear);
}

}  // namespace welkin::reference
