// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/light_volume_pass.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "welkin/gpu/framebuffer.h"
#include "welkin/render/programs.h"

namespace welkin::render {
namespace {

constexpr int kSide = shading::LightVolumeLayout::kColumns;
constexpr int kMostSamples = 6;  // of density along the line between two slices

}  // namespace

LightVolumePass::LightVolumePass() : down_(fullscreenProgram("pass/light_volume_down.frag")) {
  for (gpu::Texture2D& t : neighbour_) t = gpu::Texture2D(kSide, kSide, {.format = gpu::Format::kRgba32F});
}

void LightVolumePass::draw(const scene::SkyState& state, const shading::LightVolumeLayout& layout,
                           const CloudTextures& clouds) {
  const int cascades = static_cast<int>(layout.kHalfM.size());
  const int depth = std::max<int>(1, static_cast<int>(layout.heightsM.size())) * cascades;
  if (volume_.depth() != depth) {
    upward_ = gpu::Texture3D(kSide, kSide, depth, {.format = gpu::Format::kRgba16F});
    volume_ = gpu::Texture3D(kSide, kSide, depth, {.format = gpu::Format::kRgba16F});
  }
  if (layout.heightsM.empty()) return;  // a clear sky: nothing asks for the volume
  const shading::Uniforms uniforms = shading::cloudUniforms(state);
  for (int b = 0; b < static_cast<int>(layout.bands.size()); ++b) {
    gpu::Program& up = up_.with(shading::bandDefines(layout, b));
    setUniforms(up, uniforms);
    up.set("uLine", layout.line);
  }
  down_.set("uLine", layout.line);
  for (int c = 0; c < cascades; ++c) sweepCascade(layout, c, clouds);
}

void LightVolumePass::sweepCascade(const shading::LightVolumeLayout& layout, int cascade,
                                   const CloudTextures& clouds) {
  const int slices = static_cast<int>(layout.heightsM.size());
  const float halfM = layout.kHalfM[static_cast<std::size_t>(cascade)];
  const float voxelM = 2.0f * halfM / kSide;
  auto layer = [&](int slice) { return cascade * slices + slice; };
  auto texelW = [&](int slice) {
    return (static_cast<float>(layer(slice)) + 0.5f) /
           static_cast<float>(slices * static_cast<int>(layout.kHalfM.size()));
  };
  auto clearNeighbour = [&] { gpu::Framebuffer(neighbour_[0]).clear(); };

  clearNeighbour();
  int band = static_cast<int>(layout.bands.size()) - 1;
  for (int k = slices - 1; k >= 0; --k) {
    while (k < layout.bands[static_cast<std::size_t>(band)].firstSlice) --band;
    gpu::Program& up = up_.with(shading::bandDefines(layout, band));
    up.set("uHalfM", halfM);
    const float height = layout.heightsM[static_cast<std::size_t>(k)];
    const float above = k + 1 < slices ? layout.heightsM[static_cast<std::size_t>(k + 1)] : height;
    const float shiftM = (above - height) / layout.line.z;
    gpu::Framebuffer target(neighbour_[1]);
    target.attachSlice(1, upward_, layer(k));
    clouds.bind(up);
    up.bind("uAbove", neighbour_[0]);
    up.set("uHeightM", height);
    up.set("uHeightAboveM", above);
    up.set("uSamples", std::clamp(static_cast<int>(std::ceil(shiftM / voxelM)), 2, kMostSamples));
    triangle_.draw(up, target);
    std::swap(neighbour_[0], neighbour_[1]);
  }

  down_.set("uHalfM", halfM);
  clearNeighbour();
  for (int k = 0; k < slices; ++k) {
    const int below = std::max(k - 1, 0);
    gpu::Framebuffer target(neighbour_[1]);
    target.attachSlice(1, volume_, layer(k));
    down_.bind("uBelow", neighbour_[0]);
    down_.bind("uUpward", upward_);
    down_.set("uHeightM", layout.heightsM[static_cast<std::size_t>(k)]);
    down_.set("uHeightBelowM", layout.heightsM[static_cast<std::size_t>(below)]);
    down_.set("uSliceW", texelW(k));
    down_.set("uSliceBelowW", texelW(below));
    triangle_.draw(down_, target);
    std::swap(neighbour_[0], neighbour_[1]);
  }
}

}  // namespace welkin::render
