// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/ground_light_pass.h"

#include "welkin/render/programs.h"

namespace welkin::render {
namespace {

constexpr int kSide = 128;

const shading::ShaderDefine kFromGround{"WELKIN_BANDS", "1"};

}  // namespace

GroundLightPass::Drawn::Drawn(int side, gpu::Format format)
    : texture(side, side, {.format = format}), target(texture) {}

GroundLightPass::GroundLightPass()
    : rowsProgram_(fullscreenProgram("pass/ground_light_rows.frag", {&kFromGround, 1})),
      meanProgram_(fullscreenProgram("pass/ground_light_mean.frag")),
      columnsProgram_(fullscreenProgram("pass/ground_light_columns.frag")),
      rows_(kSide, gpu::Format::kRgba32F),
      mean_(1, gpu::Format::kRgba32F),
      shares_{Drawn(kSide, gpu::Format::kRg16F), Drawn(kSide, gpu::Format::kRg16F)} {
  for (Drawn& s : shares_) s.target.clear(0, glm::vec4(1.0f));
  rowsProgram_.set("uSizePx", glm::vec2(kSide));
}

void GroundLightPass::begin(const shading::LightVolumeLayout& volume) {
  steps_ = volume.bands.empty() ? 0 : 3;
  if (steps_ == 0) shares_[front_].target.clear(0, glm::vec4(1.0f));
  if (volume.bands != bands_) {
    setUniforms(rowsProgram_, shading::lightVolumeUniforms(volume));
    bands_ = volume.bands;
  }
  rowsProgram_.set("uLine", volume.line);
  rowsProgram_.set("uLineTowardsSun", volume.towardsSun ? 1.0f : 0.0f);
  for (gpu::Program* p : {&rowsProgram_, &meanProgram_, &columnsProgram_}) {
    p->set("uSunOverSky", volume.sunOverSky);
    p->set("uSpreadM", volume.spreadM);
  }
  columnsProgram_.set("uBroken", volume.broken);
}

void GroundLightPass::step(int index, const gpu::Texture3D& lightVolume) {
  if (index == 0) {
    rowsProgram_.bind("uLightVolume", lightVolume);
    triangle_.draw(rowsProgram_, rows_.target);
  } else if (index == 1) {
    meanProgram_.bind("uRows", rows_.texture);
    triangle_.draw(meanProgram_, mean_.target);
  } else {
    columnsProgram_.bind("uRows", rows_.texture);
    columnsProgram_.bind("uMean", mean_.texture);
    triangle_.draw(columnsProgram_, shares_[1 - front_].target);
  }
}

}  // namespace welkin::render
