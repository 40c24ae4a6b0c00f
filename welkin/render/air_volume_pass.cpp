// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/air_volume_pass.h"

#include "welkin/render/programs.h"

namespace welkin::render {
namespace {

constexpr int kGroup = 8;  // a side, of pass/air_volume.comp

bool byCompute(const AirVolumeOptions& options) {
  return options.compute && gpu::canCompute();
}

}  // namespace

void AirVolumePass::change(const LiveVolumes& volumes, const scene::SkyState& state) {
  volumes_ = &volumes;
  state_ = &state;
  // What draws the same layers is the same program.
  if (defines_ != volumes.defines()) {
    defines_ = volumes.defines();
    compute_ = {};
    fragments_ = {};
  }
  for (gpu::Program* p : {&compute_, &fragments_})
    if (p->id() != 0) volumes.setScene(*p, state);
}

gpu::Program& AirVolumePass::program(const AirVolumeOptions& options) {
  const bool compute = byCompute(options);
  gpu::Program& p = compute ? compute_ : fragments_;
  if (p.id() == 0) {
    p = compute ? computeProgram("pass/air_volume.comp", defines_)
                : fullscreenProgram("pass/air_volume.frag", defines_);
    volumes_->setScene(p, *state_);
  }
  return p;
}

AirVolumePass::Volume AirVolumePass::makeVolume(const AirVolumeOptions& options) {
  Volume v;
  v.colour = gpu::Texture3D(options.width, options.height, options.slices);
  v.transmittance = gpu::Texture3D(options.width, options.height, options.slices);
  v.shown.colour = v.colour.id();
  v.shown.transmittance = v.transmittance.id();
  v.shown.width = options.width;
  v.shown.height = options.height;
  v.shown.slices = options.slices;
  return v;
}

void AirVolumePass::makeTargets(Volume& v) {
  for (gpu::Texture2D& columns : v.columns)
    columns = gpu::Texture2D(v.shown.width, v.shown.height,
                             {.format = gpu::Format::kRgba32F, .filter = gpu::Filter::kNearest});
  for (int slice = 0; slice < v.shown.slices; ++slice) {
    gpu::Framebuffer& target = v.targets.emplace_back();
    target.attach(0, v.columns[static_cast<std::size_t>(slice) % 2]);
    target.attachSlice(1, v.colour, slice);
    target.attachSlice(2, v.transmittance, slice);
  }
}

AirVolumePass::Volume& AirVolumePass::volumeOf(const AirVolumeOptions& options) {
  const std::size_t view = options.view;
  if (views_.size() <= view) views_.resize(view + 1);
  std::unique_ptr<Volume>& place = views_[view];
  if (!place || place->shown.width != options.width || place->shown.height != options.height ||
      place->shown.slices != options.slices)
    place = std::make_unique<Volume>(makeVolume(options));
  place->shown.nearM = options.nearM;
  place->shown.farM = options.farM;
  return *place;
}

const AirVolume& AirVolumePass::fill(const AirVolumeOptions& options) {
  Volume& v = volumeOf(options);
  gpu::Program& p = program(options);
  p.set("uSize", glm::ivec3(options.width, options.height, options.slices));
  p.set("uNearFarM", glm::vec2(options.nearM, options.farM));
  p.set("uScale", options.scale);
  if (byCompute(options)) {
    gpu::bindImage(0, v.colour, gpu::Access::kWrite);
    gpu::bindImage(1, v.transmittance, gpu::Access::kWrite);
    gpu::dispatch(p, (options.width + kGroup - 1) / kGroup, (options.height + kGroup - 1) / kGroup);
    return v.shown;
  }
  if (v.targets.empty()) makeTargets(v);
  for (std::size_t slice = 0; slice < v.targets.size(); ++slice) {
    p.set("uSlice", static_cast<int>(slice));
    p.bind("uColumns", v.columns[(slice + 1) % 2]);
    triangle_.draw(p, v.targets[slice]);
  }
  return v.shown;
}

}  // namespace welkin::render
