// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/fluence_pass.h"

#include <algorithm>
#include <string>

namespace welkin::render {
namespace {

using shading::FluenceLayout;
constexpr int kTexels = FluenceLayout::kMostCells / 4;
constexpr auto kHalfM = shading::LightVolumeLayout::kHalfM;
constexpr auto kCascades = kHalfM.size();
// Of each cascade. Wide ones have columns that are wider than their clouds. The widest begins with each
// column by itself: deep clouds lose little through sides, and so few steps would not fill them.
constexpr std::array<int, kCascades> kRelaxations = {20, 14, 8};
// What one step by itself leaves of the slowest error that is to go.
constexpr float kSlowest = 0.94f;
constexpr float kAloneM = 1e9f;  // side of columns so wide that nothing goes through it

// Of what a relaxation says, the rest being what there was two before: by Chebyshev's polynomials the errors
// of n steps fall as those of n^2 by themselves (G. H. Golub and R. S. Varga 1961, "Chebyshev semi-iterative
// methods, successive overrelaxation iterative methods, and second order Richardson iterative methods").
float weightOf(int relaxation) {
  float weight = 1.0f;
  for (int k = 1; k <= relaxation; ++k)
    weight = 1.0f / (1.0f - 0.25f * kSlowest * kSlowest * (k == 1 ? 2.0f : weight));
  return weight;
}

// What a step is, in its cascade.
enum { kDepths, kSources, kStart, kRelax };
constexpr int stepsOf(std::size_t cascade) {
  return kRelax + kRelaxations[cascade] + 1;
}

}  // namespace

FluencePass::FluencePass()
    : start_(fullscreenProgram("pass/fluence_begin.frag")),
      store_(fullscreenProgram("pass/fluence_store.frag")) {}

void FluencePass::begin(const shading::LightVolumeLayout& volume) {
  towardsSun_ = volume.towardsSun;
  if (relaxProgram_ != nullptr && volume.bands == bands_ && 2 * layout_.columns == volume.columns) return;
  bands_ = volume.bands;
  slices_ = static_cast<int>(volume.heightsM.size());
  layout_ = shading::fluenceLayout(volume);
  const int count = std::max(1, static_cast<int>(layout_.cells.size())),
            depth = count * static_cast<int>(kCascades);
  const int side = layout_.columns;
  if (depths_.cells.width() != side)
    for (Packed* p : {&depths_, &sources_, &steps_[0], &steps_[1], &steps_[2]}) {
      p->cells = gpu::Texture3D(side, side, kTexels,
                                {.format = gpu::Format::kRgba32F, .filter = gpu::Filter::kNearest});
      for (int i = 0; i < kTexels; ++i) p->target.attachSlice(i, p->cells, i);
    }
  for (gpu::Texture3D& f : fluences_)
    if (f.depth() != depth || f.width() != side)
      f = gpu::Texture3D(side, side, depth, {.format = gpu::Format::kR16F});
  if (layout_.cells.empty()) return;
  shading::ShaderDefines defines{{"WELKIN_CELLS", std::to_string(count)}};
  depthsProgram_ = &cellPrograms_.with(defines);
  relaxProgram_ = &relaxPrograms_.with(defines);
  defines.emplace_back("WELKIN_SOURCES", "1");
  sourcesProgram_ = &cellPrograms_.with(defines);
}

int FluencePass::steps() const {
  if (layout_.cells.empty()) return 0;
  int sum = 0;
  for (std::size_t c = 0; c < kCascades; ++c) sum += stepsOf(c);
  return sum;
}

void FluencePass::step(int index, const gpu::Texture3D& lightVolume) {
  std::size_t cascade = kCascades - 1;
  for (; index >= stepsOf(cascade); --cascade) index -= stepsOf(cascade);
  const int c = static_cast<int>(cascade);
  if (index == kDepths || index == kSources)
    cells(c, index == kSources, lightVolume);
  else if (index == kStart)
    start(c);
  else if (index + 1 < stepsOf(cascade))
    relax(index - kRelax, columnM(c));
  else
    store(c);
}

void FluencePass::cells(int cascade, bool sources, const gpu::Texture3D& lightVolume) {
  gpu::Program& program = sources ? *sourcesProgram_ : *depthsProgram_;
  program.bind("uLightVolume", lightVolume);
  program.set("uCells", layout_.cells);
  program.set("uSliceCount", static_cast<float>(slices_));
  program.set("uCascade", static_cast<float>(cascade));
  program.set("uCascades", static_cast<float>(kCascades));
  program.set("uLineTowardsSun", towardsSun_ ? 1.0f : 0.0f);
  triangle_.draw(program, (sources ? sources_ : depths_).target);
}

void FluencePass::start(int cascade) {
  last_ = 0;
  if (cascade + 1 == static_cast<int>(kCascades)) {
    for (int i = 0; i < kTexels; ++i) steps_[0].target.clear(i);
    relax(0, kAloneM);
    return;
  }
  const auto c = static_cast<std::size_t>(cascade);
  start_.bind("uFluence", fluences_[1 - front_]);
  start_.set("uCells", static_cast<float>(layout_.cells.size()));
  start_.set("uWider", static_cast<float>(cascade + 1));
  start_.set("uCascades", static_cast<float>(kCascades));
  start_.set("uShare", kHalfM[c] / kHalfM[c + 1]);
  triangle_.draw(start_, steps_[0].target);
}

float FluencePass::columnM(int cascade) const {
  return 2.0f * kHalfM[static_cast<std::size_t>(cascade)] / static_cast<float>(layout_.columns);
}

void FluencePass::relax(int index, float columnM) {
  const std::size_t next = (last_ + 1) % steps_.size(), before = (last_ + 2) % steps_.size();
  relaxProgram_->bind("uDepths", depths_.cells);
  relaxProgram_->bind("uSources", sources_.cells);
  relaxProgram_->bind("uFluence", steps_[last_].cells);
  relaxProgram_->bind("uBefore", steps_[index == 0 ? last_ : before].cells);
  relaxProgram_->set("uCells", layout_.cells);
  relaxProgram_->set("uColumnM", columnM);
  relaxProgram_->set("uWeight", weightOf(index));
  last_ = next;
  triangle_.draw(*relaxProgram_, steps_[last_].target);
}

void FluencePass::store(int cascade) {
  const int count = static_cast<int>(layout_.cells.size());
  store_.bind("uPacked", steps_[last_].cells);
  for (int k = 0; k < count; ++k) {
    slice_.attachSlice(0, fluences_[1 - front_], cascade * count + k);
    store_.set("uCell", k);
    triangle_.draw(store_, slice_);
  }
}

}  // namespace welkin::render
