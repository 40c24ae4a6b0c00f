// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sky_renderer.h"

#include <algorithm>
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
#include "welkin/render/live_sky.h"
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
  std::optional<LiveSky> live;

  Picture drawVolumes(const scene::SkyState& state, const Progress& progress);
  Picture drawSheets(const scene::SkyState& state, const Progress& progress);
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
  if (scene::drawsSheets(state.scene.technique)) return impl_->drawSheets(state, progress);
  return impl_->drawVolumes(state, progress);
}

Picture SkyRenderer::Impl::drawSheets(const scene::SkyState& state, const Progress& progress) {
  if (state.scene.camera.projection != scene::Projection::kPerspective)
    throw ParameterError(
        "thin sheets are drawn in perspective alone; expected projection perspective, or technique volume");
  Picture picture;
  gpu::Stopwatch watch;
  auto done = [&](const char* pass) { picture.passes.push_back({pass, watch.finishedMs()}); };
  const int width = static_cast<int>(state.scene.output.width),
            height = static_cast<int>(state.scene.output.height);
  if (!live) live.emplace();
  live->update(state);
  done("tables");

  // Edges of clouds are soft and textures filtered: a few samples a pixel are enough.
  const int samples = std::min(shading::marchSettings(state.scene.output.quality).subframes, 16);
  const gpu::Texture2D texture(width, height, {.format = gpu::Format::kRgba32F});
  const gpu::Framebuffer target(texture);
  picture.luminance = Image<float>(width, height, 3);
  for (int i = 0; i < samples; ++i) {
    live->draw(shading::viewOf(state, glm::dvec2(quasiRandom2(i)) - 0.5), target,
               {.flare = static_cast<float>(state.scene.output.flare)});
    const Image<float> sample = target.readPicture(0, 3);
    for (std::size_t k = 0; k < sample.data.size(); ++k)
      picture.luminance.data[k] += sample.data[k] / static_cast<float>(samples);
    if (progress) progress((i + 1.0) / samples);
  }
  done("sheets");
  picture.autoExposureEv = automaticExposureEv(picture.luminance);
  done("exposure");
  return picture;
}

Picture SkyRenderer::Impl::drawVolumes(const scene::SkyState& state, const Progress& progress) {
  Picture picture;
  gpu::Stopwatch watch;
  auto done = [&](const char* pass) { picture.passes.push_back({pass, watch.finishedMs()}); };
  const int width = static_cast<int>(state.scene.output.width),
            height = static_cast<int>(state.scene.output.height);

  if (!clouds || clouds->noise() != state.clouds->sharedNoise()) clouds.emplace(state.clouds->sharedNoise());
  tables.update(state);
  done("tables");

  const shading::LightVolumeLayout layout = shading::lightVolumeLayout(state);
  lightVolume.draw(state, layout, *clouds);
  done("light volume");

  const shading::MarchSettings settings = shading::marchSettings(state.scene.output.quality);
  gpu::Program& p = sky.with(shading::marchDefines(layout, state.scene.camera.eyeM));
  done("compile");
  setUniforms(p, shading::cloudUniforms(state));
  setUniforms(p, shading::skyUniforms(state));
  setUniforms(p, shading::marchUniforms(settings));
  setUniforms(p, shading::projectorUniforms(state));
  setUniforms(p, shading::lightVolumeUniforms(layout));
  clouds->bind(p);
  tables.bind(p);
  p.bind("uLightVolume", lightVolume.volume());

  if (sum.width() != width || sum.height() != height)
    sum = gpu::Texture2D(width, height, {.format = gpu::Format::kRgba32F});
  const gpu::Framebuffer target(sum);
  target.clear();
  // Sums of sub-frames, with their number in alpha. The first covers the picture, the others what it shows to
  // be rough.
  std::vector<gpu::Tile> tiles = rowBands(width, height);
  for (int i = 0; i < settings.subframes; ++i) {
    p.set("uJitterPx", quasiRandom2(i) - 0.5f);
    p.set("uJitterStep", glm::vec2(quasiRandom1(i), quasiRandom2(i + 7).x));
    for (std::size_t t = 0; t < tiles.size(); ++t) {
      triangle.draw(p, target, {.tile = tiles[t], .blend = gpu::Blend::kAdd});
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
