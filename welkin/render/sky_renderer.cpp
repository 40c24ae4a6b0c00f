// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sky_renderer.h"

#include <cmath>
#include <optional>

#include "welkin/core/error.h"
#include "welkin/gpu/context.h"
#include "welkin/gpu/draw.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/render/accumulation.h"
#include "welkin/render/cloud_textures.h"
#include "welkin/render/display.h"
#include "welkin/render/light_volume_pass.h"
#include "welkin/render/programs.h"
#include "welkin/render/sky_textures.h"
#include "welkin/shading/uniforms.h"

namespace welkin::render {
namespace {

// Point i of a sequence that fills the unit square evenly from the start (M. Roberts 2018, "The Unreasonable
// Effectiveness of Quasirandom Sequences": R2, R1 in one dimension). The first is the middle: where one
// sub-frame is enough, it shows the pixels' centres.
glm::vec2 quasiRandom2(int i) {
  auto part = [i](double a) { return static_cast<float>(std::fmod(0.5 + a * i, 1.0)); };
  return {part(0.7548776662466927), part(0.5698402909980532)};
}
float quasiRandom1(int i) {
  return static_cast<float>(std::fmod(0.5 + 0.6180339887498949 * i, 1.0));
}

// The whole picture in strips, a few to a sub-frame.
std::vector<gpu::Tile> rowBands(int width, int height) {
  constexpr int kBands = 4;
  std::vector<gpu::Tile> bands;
  for (int b = 0; b < kBands; ++b) {
    const int y0 = height * b / kBands, y1 = height * (b + 1) / kBands;
    if (y1 > y0) bands.push_back({0, y0, width, y1 - y0});
  }
  return bands;
}

}  // namespace

struct SkyRenderer::Impl {
  explicit Impl(const RendererOptions& options) : context({.debug = options.debug}) {}

  gpu::Context context;
  gpu::FullscreenTriangle triangle;
  ProgramVariants sky{"pass/sky.frag"};
  SkyTextures tables;
  LightVolumePass lightVolume;
  std::optional<CloudTextures> clouds;
  gpu::Texture2D sum;  // of sub-frames
};

SkyRenderer::SkyRenderer(const RendererOptions& options) : impl_(std::make_unique<Impl>(options)) {}
SkyRenderer::~SkyRenderer() {
  // Another renderer's context may be current; what is deleted must be deleted in its own.
  try {
    impl_->context.makeCurrent();
  } catch (const GpuError&) {
    // Nothing can be deleted where nothing can be reached.
  }
}

std::string SkyRenderer::deviceName() const {
  return impl_->context.deviceName();
}
std::vector<std::string> SkyRenderer::takeErrors() {
  impl_->context.makeCurrent();
  return impl_->context.takeErrors();
}

Picture SkyRenderer::draw(const scene::SkyState& state, const Progress& progress) {
  impl_->context.makeCurrent();
  Picture picture;
  gpu::Stopwatch watch;
  auto done = [&](const char* pass) { picture.passes.push_back({pass, watch.finishedMs()}); };
  const int width = static_cast<int>(state.scene.output.width),
            height = static_cast<int>(state.scene.output.height);

  if (!impl_->clouds || impl_->clouds->noise() != state.clouds->sharedNoise())
    impl_->clouds.emplace(state.clouds->sharedNoise());
  impl_->tables.update(state);
  done("tables");

  const shading::LightVolumeLayout layout = shading::lightVolumeLayout(state);
  impl_->lightVolume.draw(state, layout, *impl_->clouds);
  done("light volume");

  const shading::MarchSettings settings = shading::marchSettings(state.scene.output.quality);
  gpu::Program& p = impl_->sky.with(shading::marchDefines(layout, state.scene.camera.eyeM));
  done("compile");
  setUniforms(p, shading::cloudUniforms(state));
  setUniforms(p, shading::skyUniforms(state));
  setUniforms(p, shading::marchUniforms(settings));
  setUniforms(p, shading::projectorUniforms(state));
  setUniforms(p, shading::lightVolumeUniforms(layout));
  impl_->clouds->bind(p);
  impl_->tables.bind(p);
  p.bind("uLightVolume", impl_->lightVolume.volume());

  if (impl_->sum.width() != width || impl_->sum.height() != height)
    impl_->sum = gpu::Texture2D(width, height, {.format = gpu::Format::kRgba32F});
  const gpu::Framebuffer target(impl_->sum);
  target.clear();
  // Sums of sub-frames, with their number in alpha. The first covers the picture, the others what it shows to
  // be rough.
  std::vector<gpu::Tile> tiles = rowBands(width, height);
  for (int i = 0; i < settings.subframes; ++i) {
    p.set("uJitterPx", quasiRandom2(i) - 0.5f);
    p.set("uJitterStep", glm::vec2(quasiRandom1(i), quasiRandom2(i + 7).x));
    for (std::size_t t = 0; t < tiles.size(); ++t) {
      impl_->triangle.draw(p, target, {.tile = tiles[t], .blend = gpu::Blend::kAdd});
      if (!progress || (tiles.size() > 16 && t % 16 != 15 && t + 1 < tiles.size())) continue;
      gpu::finish();  // so that progress is true and Ctrl-C is heard
      progress((i + static_cast<double>(t + 1) / static_cast<double>(tiles.size())) / settings.subframes);
    }
    if (i == 0) tiles = roughTiles(target.readPicture(), settings.tolerance);
  }
  if (progress) progress(1.0);  // the picture may have had enough before the last sub-frame
  done("march");

  picture.luminance = resolve(target.readPicture(), settings.noise);
  picture.autoExposureEv = automaticExposureEv(picture.luminance);
  done("read back");
  return picture;
}

}  // namespace welkin::render
