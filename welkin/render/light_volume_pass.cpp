// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/light_volume_pass.h"

#include <algorithm>
#include <cmath>

#include "welkin/render/programs.h"

namespace welkin::render {
namespace {

constexpr int kMostSamples = 6;  // of density along the line between two slices
// A slice on the way down samples density, on the way up only textures.
// A step of the fluence is about as much as the latter.
constexpr float kCostDown = 4.0f, kCostUp = 1.0f, kCostSpread = 1.0f, kCostGround = 3.0f;

}  // namespace

LightVolumePass::LightVolumePass() : down_(fullscreenProgram("pass/light_volume_down.frag")) {}

void LightVolumePass::draw(const scene::SkyState& state, const shading::LightVolumeLayout& layout,
                           const CloudTextures& clouds, Spread spread) {
  begin(shading::cloudUniforms(state), layout, spread);
  advance(kParts, clouds);
}

int LightVolumePass::sweeps() const {
  return 2 * static_cast<int>(layout_.heightsM.size() * layout_.kHalfM.size());
}

int LightVolumePass::spreads() const {
  return spread_ == Spread::kYes ? fluence_.steps() : 0;
}

int LightVolumePass::steps() const {
  return sweeps() + spreads() + ground_.steps();
}

float LightVolumePass::costOfAll() const {
  return 0.5f * (kCostDown + kCostUp) * static_cast<float>(sweeps()) +
         kCostSpread * static_cast<float>(spreads()) + kCostGround * static_cast<float>(ground_.steps());
}

float LightVolumePass::cost(int step) const {
  if (step >= sweeps()) return step < sweeps() + spreads() ? kCostSpread : kCostGround;
  const int slices = static_cast<int>(layout_.heightsM.size());
  return step % (2 * slices) < slices ? kCostDown : kCostUp;
}

void LightVolumePass::begin(const shading::Uniforms& layers, const shading::LightVolumeLayout& layout,
                            Spread spread) {
  const bool same = layout.bands == layout_.bands && upOfBand_.size() == layout.bands.size();
  layout_ = layout;
  const int cascades = static_cast<int>(layout.kHalfM.size());
  const int depth = std::max<int>(1, static_cast<int>(layout.heightsM.size())) * cascades;
  const int side = layout.columns;
  if (neighbours_[0].width() != side)
    for (std::size_t i = 0; i < neighbours_.size(); ++i) {
      neighbours_[i] = gpu::Texture2D(side, side, {.format = gpu::Format::kRgba32F});
      targets_[i].attach(0, neighbours_[i]);
    }
  if (upward_.depth() != depth || upward_.width() != side) {
    upward_ = gpu::Texture3D(side, side, depth, {.format = gpu::Format::kRgba16F});
    for (gpu::Texture3D& v : volumes_) v = {};
  }
  makeNext();
  if (!same) {
    upOfBand_.clear();
    for (int b = 0; b < static_cast<int>(layout.bands.size()); ++b)
      upOfBand_.push_back(&up_.with(shading::bandDefines(layout, b)));
  }
  for (gpu::Program* up : upOfBand_) {
    setUniforms(*up, layers);
    up->set("uLine", layout.line);
  }
  down_.set("uLine", layout.line);
  spread_ = spread;
  if (spread == Spread::kYes) fluence_.begin(layout);
  ground_.begin(layout);
  step_ = 0;
  credit_ = 0.0f;
  if (steps() == 0) front_ = 1 - front_;  // a clear sky: nothing asks for the volume
}

void LightVolumePass::makeNext() {
  if (gpu::Texture3D& next = volumes_[1 - front_]; next.id() == 0)
    next =
        gpu::Texture3D(upward_.width(), upward_.height(), upward_.depth(), {.format = gpu::Format::kRgba16F});
}

bool LightVolumePass::advance(int parts, const CloudTextures& clouds) {
  if (!inProgress()) return false;
  credit_ += static_cast<float>(parts) / kParts * costOfAll();
  for (; inProgress() && credit_ > 0.0f; ++step_) {
    step(step_, clouds);
    credit_ -= cost(step_);
  }
  if (inProgress()) return false;
  front_ = 1 - front_;
  if (spreads() > 0) fluence_.exchange();
  if (ground_.steps() > 0) ground_.exchange();
  return true;
}

void LightVolumePass::step(int step, const CloudTextures& clouds) {
  if (step < sweeps())
    sweepStep(step, clouds);
  else if (step < sweeps() + spreads())
    fluence_.step(step - sweeps(), volumes_[1 - front_]);
  else
    ground_.step(step - sweeps() - spreads(), volumes_[1 - front_]);
}

void LightVolumePass::sweepStep(int step, const CloudTextures& clouds) {
  const int slices = static_cast<int>(layout_.heightsM.size());
  const int cascades = static_cast<int>(layout_.kHalfM.size()), wide = cascades - 1;
  const int cascade = wide - step / (2 * slices), inCascade = step % (2 * slices);
  const float halfM = layout_.kHalfM[static_cast<std::size_t>(cascade)];
  const auto layer = [&](int slice) { return cascade * slices + slice; };
  const auto texelW = [&](int slice) {
    return (static_cast<float>(slice) + 0.5f) / static_cast<float>(slices * cascades);
  };
  const auto heightOf = [&](int slice) { return layout_.heightsM[static_cast<std::size_t>(slice)]; };
  if (inCascade % slices == 0) targets_[last_].clear();
  gpu::Framebuffer& target = targets_[1 - last_];
  const gpu::Texture2D& neighbour = neighbours_[last_];
  last_ = 1 - last_;

  if (inCascade < slices) {
    const int k = slices - 1 - inCascade;
    std::size_t band = layout_.bands.size() - 1;
    while (k < layout_.bands[band].firstSlice) --band;
    gpu::Program& up = *upOfBand_[band];
    const float voxelM = 2.0f * halfM / static_cast<float>(layout_.columns);
    const float height = heightOf(k), above = k + 1 < slices ? heightOf(k + 1) : height;
    const float shiftM = (above - height) / layout_.line.z;
    target.attachSlice(1, upward_, layer(k));
    clouds.bind(up);
    up.bind("uAbove", neighbour);
    up.bind("uWider", volumes_[1 - front_]);
    up.set("uWiderShare",
           cascade == wide ? 0.0f : halfM / layout_.kHalfM[static_cast<std::size_t>(cascade) + 1]);
    up.set("uWiderW", texelW((cascade + 1) * slices + std::min(k + 1, slices - 1)));
    up.set("uHalfM", halfM);
    up.set("uHeightM", height);
    up.set("uHeightAboveM", above);
    up.set("uSamples", std::clamp(static_cast<int>(std::ceil(shiftM / voxelM)), 2, kMostSamples));
    triangle_.draw(up, target);
    return;
  }
  const int k = inCascade - slices, below = std::max(k - 1, 0);
  target.attachSlice(1, volumes_[1 - front_], layer(k));
  down_.bind("uBelow", neighbour);
  down_.bind("uUpward", upward_);
  down_.set("uHalfM", halfM);
  down_.set("uHeightM", heightOf(k));
  down_.set("uHeightBelowM", heightOf(below));
  down_.set("uSliceW", texelW(layer(k)));
  down_.set("uSliceBelowW", texelW(layer(below)));
  triangle_.draw(down_, target);
}

}  // namespace welkin::render
