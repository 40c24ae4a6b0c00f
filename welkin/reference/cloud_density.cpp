// SPDX-License-Identifier: Apache-2.0
#include "welkin/reference/cloud_density.h"

// This file once for each target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "welkin/reference/cloud_density.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h.
#include <hwy/highway.h>

#include "welkin/reference/cloud_density-inl.h"

HWY_BEFORE_NAMESPACE();
namespace welkin::reference::HWY_NAMESPACE {

void extinctionsOf(const CloudTextures& textures, const CloudLayerFactors& layer,
                   std::span<const glm::vec3> q, float* extinctions) {
  const Floats df;
  const std::size_t n = hn::Lanes(df);
  alignas(64) float x[16] = {}, y[16] = {}, z[16] = {}, sigma[16];
  for (std::size_t o = 0; o < q.size(); o += n) {
    const std::size_t count = std::min(n, q.size() - o);
    for (std::size_t i = 0; i < count; ++i) x[i] = q[o + i].x, y[i] = q[o + i].y, z[i] = q[o + i].z;
    hn::Store(extinctionAt(textures, layer, {hn::Load(df, x), hn::Load(df, y), hn::Load(df, z)},
                           hn::FirstN(df, count)),
              df, sigma);
    std::copy_n(sigma, count, extinctions + o);
  }
}

}  // namespace welkin::reference::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <algorithm>
#include <cmath>
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

// `channels` of `values` as `width` of them, in rows of nx texels and `more` that are the first again.
CloudTexture textureOf(const std::vector<float>& values, int channels, int nx, int ny, int nz, int width,
                       int more, std::vector<std::int16_t>& texels) {
  float most = 1e-6f;
  for (const float v : values) most = std::max(most, std::abs(v));
  CloudTexture texture{nullptr, nx, ny, nz, nx + more, most / 32767.0f};
  for (int row = 0; row < ny * nz; ++row)
    for (int x = 0; x < nx + more; ++x)
      for (int c = 0; c < width; ++c)
        texels.push_back(
            c < channels
                ? static_cast<std::int16_t>(std::lround(
                      values[static_cast<std::size_t>((row * nx + x % nx) * channels + c)] / texture.step))
                : std::int16_t{0});
  texture.texels = texels.data();
  return texture;
}

}  // namespace

CloudLayerFactors::CloudLayerFactors(const CloudLayer& l)
    : layer(l),
      perDepth(1.0f / (l.topM - l.baseM)),
      perStretch(1.0f / l.stretch),
      patchCosine(kPatchCosine / l.patchM),
      patchSine(kPatchSine / l.patchM),
      perCell(1.0f / l.cellM),
      perShapeStretch(1.0f / l.shapeStretch),
      perShapeTall(1.0f / l.shapeTall),
      perShape(1.0f / l.shapeM),
      perDetail(1.0f / l.detailM),
      perShapeAmount(1.0f / (1.6f * l.shapeAmount)),
      perBottomSoft(1.0f / l.bottomSoft),
      perTopSoft(1.0f / l.topSoft),
      anvilFrom(kAnvilFrom),
      perAnvil(1.0f / (kAnvilTo - kAnvilFrom)),
      anvilShape(kAnvilShape),
      anvilEdge(kAnvilEdge),
      anvilExtinction(kAnvilExtinction) {}

CloudDensity::CloudDensity(const field::CloudField& field)
    : field_(field), placement_(field.noise().placement.width, field.noise().placement.height, 4) {
  const std::vector<float>& from = field.noise().placement.data;
  for (std::size_t i = 0; 3 * i < from.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) placement_.data[4 * i + c] = from[3 * i + c];
  const field::CloudNoise& n = field.noise();
  textures_.placement = textureOf(n.placement.data, n.placement.channels, n.placement.width,
                                  n.placement.height, 1, 4, 0, texels_[0]);
  textures_.shape = textureOf(n.shape.data, 1, n.shape.nx, n.shape.ny, n.shape.nz, 1, 1, texels_[1]);
  textures_.detail = textureOf(n.detail.data, 1, n.detail.nx, n.detail.ny, n.detail.nz, 1, 1, texels_[2]);
  for (const CloudLayer& l : field.layers()) layers_.emplace_back(l);
}

HWY_EXPORT(extinctionsOf);

void CloudDensity::extinctions(std::size_t layer, std::span<const glm::vec3> q, float* to) const {
  HWY_DYNAMIC_DISPATCH(extinctionsOf)(textures_, layers_[layer], q, to);
}

float CloudDensity::extinction(std::size_t layer, const glm::vec3& q) const {
  const CloudLayer& l = field_.layers()[layer];
  if (q.z <= l.baseM || q.z >= l.topM) return 0.0f;
  float clear = 0.0f;
  return cloudExtinction(l, {&placement_}, {&field_.noise().shape}, {&field_.noise().detail}, q, clear);
}

}  // namespace welkin::reference

#endif
