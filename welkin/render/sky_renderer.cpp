// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sky_renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "welkin/core/error.h"
#include "welkin/core/units.h"
#include "welkin/field/cloud_field.h"
#include "welkin/gpu/context.h"
#include "welkin/gpu/draw.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/render/accumulation.h"
#include "welkin/render/cloud_textures.h"
#include "welkin/render/display.h"
#include "welkin/render/flare_pass.h"
#include "welkin/render/jitter.h"
#include "welkin/render/light_volume_pass.h"
#include "welkin/render/programs.h"
#include "welkin/render/sky_box_texture.h"
#include "welkin/render/sky_sheets.h"
#include "welkin/render/sky_splats.h"
#include "welkin/render/sky_textures.h"
#include "welkin/scene/projector.h"
#include "welkin/shading/ball_volume.h"
#include "welkin/shading/fluence_layout.h"
#include "welkin/shading/lens_flare.h"
#include "welkin/shading/uniforms.h"
#include "welkin/shading/view.h"

namespace welkin::render {
namespace {

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

bool isAny(const Image<std::uint8_t>& mask) {
  return std::ranges::find(mask.data, 1) != mask.data.end();
}
// In both masks.
Image<std::uint8_t> bothOf(Image<std::uint8_t> a, const Image<std::uint8_t>& b) {
  for (std::size_t i = 0; i < a.data.size(); ++i) a.data[i] &= b.data[i];
  return a;
}

float pixelRadOf(const scene::SkyState& state) {
  return scene::middlePixelRad(scene::projectorOf(state));
}

shading::MarchSettings marchSettingsOf(const scene::SkyState& state) {
  const scene::Scene& s = state.scene;
  if (s.camera.projection != scene::Projection::kPerspective) return shading::marchSettings(s.output.quality);
  const scene::Projector projector = scene::projectorOf(state);
  return shading::marchSettings(
      s.output.quality, projector.halfWidthTan * glm::vec2(1.0f, projector.sizePx.y / projector.sizePx.x));
}

}  // namespace

struct SkyRenderer::Impl {
  explicit Impl(const RendererOptions& options)
      : context({.debug = options.debug}), cloudLight(options.cloudLight) {}

  gpu::Context context;
  CloudLight cloudLight;
  gpu::FullscreenTriangle triangle;
  ProgramVariants sky{"pass/sky.frag"};
  SkyTextures tables;
  LightVolumePass lightVolume;
  std::optional<CloudTextures> clouds;
  SkySheets sheets;
  SkySplats splats;
  shading::BallVolume balls;         // metaballs in the place of splats
  std::optional<SkyBoxTexture> box;  // in the place of the clear sky
  std::optional<FlarePass> flare;
  gpu::Texture2D sum, hidden;  // of sub-frames

  void updateBox(const scene::SkyBox& wanted);
  Picture draw(const scene::SkyState& state, const Progress& progress);
  gpu::Program& programFor(const scene::SkyState& state, const shading::LightVolumeLayout& layout,
                           const shading::MarchSettings& settings, bool transmittance);
  void bind(gpu::Program& program, const scene::SkyState& state);
  float sunArriving(const scene::SkyState& state, const shading::LightVolumeLayout& layout);
  void addFlare(const scene::SkyState& state, const shading::LightVolumeLayout& layout,
                Image<float>& picture);
};

SkyRenderer::SkyRenderer(const RendererOptions& options) {
  const gpu::CurrentGuard guard;
  impl_ = std::make_unique<Impl>(options);
}
SkyRenderer::~SkyRenderer() {
  const gpu::CurrentGuard guard;
  // What is deleted must be deleted in its own context.
  try {
    impl_->context.makeCurrent();
  } catch (const GpuError&) {
    // Nothing can be deleted where nothing can be reached.
  }
  impl_.reset();
}

std::string SkyRenderer::deviceName() const {
  return impl_->context.deviceName();
}
std::vector<std::string> SkyRenderer::takeErrors() {
  const gpu::CurrentGuard guard;
  impl_->context.makeCurrent();
  return impl_->context.takeErrors();
}

Picture SkyRenderer::draw(const scene::SkyState& state, const Progress& progress) {
  const gpu::CurrentGuard guard;
  impl_->context.makeCurrent();
  impl_->updateBox(state.scene.skyBox);
  impl_->sheets.update(state);
  impl_->balls = {};
  if (state.scene.metaballsAs == scene::MetaballRender::kVolume)
    impl_->balls = shading::ballVolume(state.metaballs->instancesAt(state.secondsAfter, glm::dvec2(0.0)));
  impl_->splats.update(state);
  if (impl_->sheets.empty()) return impl_->draw(state, progress);
  scene::SkyState under = state;
  under.ambient = impl_->sheets.ambient();
  return impl_->draw(under, progress);
}

void SkyRenderer::Impl::updateBox(const scene::SkyBox& wanted) {
  if (box && box->box() == wanted) return;
  box.reset();
  if (!wanted.empty()) box.emplace(wanted);
}

// transmittance: what arrives through all clouds, and not a picture.
gpu::Program& SkyRenderer::Impl::programFor(const scene::SkyState& state,
                                            const shading::LightVolumeLayout& layout,
                                            const shading::MarchSettings& settings, bool transmittance) {
  const double eyeM = state.scene.camera.eyeM;
  shading::ShaderDefines defines =
      sheets.empty() ? shading::marchDefines(layout, eyeM) : sheets.defines(layout, eyeM);
  if (transmittance) defines.emplace_back("WELKIN_TRANSMITTANCE", "1");
  // Long lenses see so far through the air that few places on the way show as a hatching.
  if (settings.cascadesBlended) {
    defines.emplace_back("WELKIN_CASCADES_BLENDED", "1");
    defines.emplace_back("WELKIN_AIR_SAMPLES", "64");
  }
  if (box) defines.emplace_back("WELKIN_SKY_BOX", "1");
  if (!splats.empty()) SkySplats::addDefines(defines);
  shading::addPhaseDefines(state, defines);
  if (SkyTextures::isAnythingBeyond(state, pixelRadOf(state), eyeM))
    defines.emplace_back("WELKIN_BEYOND", "1");
  if (cloudLight == CloudLight::kSingle) defines.emplace_back("WELKIN_SINGLE_SCATTERING", "1");
  if (cloudLight == CloudLight::kOctaves) defines.emplace_back("WELKIN_OCTAVES_OF_SCATTERING", "1");
  gpu::Program& p = sky.with(defines);
  setUniforms(p, shading::cloudUniforms(state));
  setUniforms(p, shading::skyUniforms(state));
  setUniforms(p, shading::marchUniforms(settings));
  setUniforms(p, shading::lightVolumeUniforms(layout));
  setUniforms(p, shading::fluenceUniforms(shading::fluenceLayout(layout)));
  if (!sheets.empty()) sheets.set(p, state, layout);
  if (!splats.empty()) splats.draw(state, tables, p);
  return p;
}

void SkyRenderer::Impl::bind(gpu::Program& p, const scene::SkyState& state) {
  clouds->bind(p);
  tables.bind(p);
  tables.bindStars(p, state, pixelRadOf(state), state.scene.camera.eyeM);
  p.bind("uLightVolume", lightVolume.volume());
  p.bind("uFluence", lightVolume.fluence());
  p.bind("uGroundShares", lightVolume.groundShares());
  sheets.bind(p);
  if (!splats.empty()) splats.bind(p);
  if (box) box->bind(p);
}

Picture SkyRenderer::Impl::draw(const scene::SkyState& state, const Progress& progress) {
  Picture picture;
  gpu::Stopwatch watch;
  auto done = [&](const char* pass) { picture.passes.push_back({pass, watch.finishedMs()}); };
  const int width = static_cast<int>(state.scene.output.width),
            height = static_cast<int>(state.scene.output.height);
  const Form form = formOf(state.scene.camera.projection);

  if (!clouds || clouds->noise() != state.clouds->sharedNoise()) clouds.emplace(state.clouds->sharedNoise());
  clouds->setBalls(balls);
  tables.update(state);
  done("tables");

  std::optional<glm::vec2> ballsM;
  if (!balls.empty()) ballsM = glm::vec2(std::max(balls.lowM, 0.0f), balls.highM);
  const shading::LightVolumeLayout layout = shading::lightVolumeLayout(state, ballsM);
  lightVolume.draw(
      state, layout, *clouds,
      cloudLight == CloudLight::kFull ? LightVolumePass::Spread::kYes : LightVolumePass::Spread::kNo);
  done("light volume");

  shading::MarchSettings settings = marchSettingsOf(state);
  // Without volumes there is no grain for the resolve to take out.
  if (layout.bands.empty()) settings.noise = 1e-4f;
  gpu::Program& p = programFor(state, layout, settings, false);
  setUniforms(p, shading::projectorUniforms(state));
  bind(p, state);
  done("compile");

  if (sum.width() != width || sum.height() != height) {
    sum = gpu::Texture2D(width, height, {.format = gpu::Format::kRgba32F});
    hidden = gpu::Texture2D(width, height, {.format = gpu::Format::kR16F});
  }
  gpu::Framebuffer target(sum);
  target.attach(1, hidden);
  target.clear(0);
  target.clear(1);
  const std::vector<gpu::Tile> rows = rowBands(width, height);
  // begin, end: of all sub-frames, for the progress.
  const auto draw = [&](int subframe, const Image<std::uint8_t>& where, double begin, double end) {
    target.setMask(where);
    p.set("uJitterPx", jitterPx(subframe));
    p.set("uJitterStep", jitterStep(subframe));
    for (std::size_t r = 0; r < rows.size(); ++r) {
      triangle.draw(p, target, {.tile = rows[r], .blend = gpu::Blend::kAdd, .where = 1});
      if (!progress) continue;
      gpu::finish();  // so that progress is true and Ctrl-C is heard
      const double share = static_cast<double>(r + 1) / static_cast<double>(rows.size());
      progress(std::lerp(begin, end, share) / settings.subframes);
    }
  };
  // Sums of sub-frames, with their number in alpha. The first covers the picture, but for what is told from
  // around it; the others cover what it shows to be rough; whenever their number has doubled, what they agree
  // on is done. The first has a mask, too: software rasterisers compile a program anew for draws without one.
  Image<float> before;
  Image<std::uint8_t> wanted;
  if (layout.bands.empty()) {
    Image<std::uint8_t> everywhere(width, height, 1);
    std::ranges::fill(everywhere.data, 1);
    draw(0, everywhere, 0.0, 1.0);
    before = target.readPicture();
    wanted = roughBlocks(before, settings.tolerance, form);
  } else {
    double begin = 0.5;
    draw(0, firstHalf(width, height, form), 0.0, begin);
    Image<std::uint8_t> needed =
        secondHalf(target.readPicture(), target.readPicture(1, 1), settings.tolerance, form);
    do {
      draw(0, needed, begin, 1.0);
      begin = 1.0;
      before = target.readPicture();
      const Image<std::uint8_t> filled = fillBlocks(before, form);
      wanted = roughBlocks(before, settings.tolerance, form);
      needed = bothOf(filled, wanted);
    } while (isAny(needed));
  }
  // What has not been drawn stays as it was told.
  const auto sums = [&] {
    Image<float> now = target.readPicture();
    for (std::size_t i = 0; i < now.data.size(); i += 4)
      if (now.data[i + 3] == 0.0f) std::ranges::copy_n(&before.data[i], 4, &now.data[i]);
    return now;
  };
  for (int i = 1; i < settings.subframes && isAny(wanted); ++i) {
    draw(i, wanted, i, i + 1.0);
    const bool doubled = std::has_single_bit(static_cast<unsigned>(i + 1));
    if (!doubled || i + 1 == settings.subframes) continue;
    Image<float> now = sums();
    wanted = unsettledBlocks(before, now, settings.tolerance, form);
    before = std::move(now);
  }
  if (progress) progress(1.0);  // the picture may have had enough before the last sub-frame
  done("march");

  picture.luminance = resolve(sums(), settings.noise, form);
  if (state.scene.output.flare > 0.0) {
    addFlare(state, layout, picture.luminance);
    done("flare");
  }
  picture.autoExposureEv = automaticExposureEv(picture.luminance);
  done("read back");
  return picture;
}

// Share of the sun's light that arrives through all clouds, mean over its disc; 0 where the ground hides it.
float SkyRenderer::Impl::sunArriving(const scene::SkyState& state, const shading::LightVolumeLayout& layout) {
  constexpr int kSide = 24, kSubframes = 4;
  const sky::Body& sun = state.ephemeris.sun;
  scene::SkyState toSun = state;
  scene::Camera& camera = toSun.scene.camera;
  camera.projection = scene::Projection::kPerspective;
  camera.pitchDeg = sun.elevationDeg;
  camera.fovDeg = 2.0 * degrees(sun.angularRadiusRad);
  toSun.headingDeg = sun.azimuthDeg;
  toSun.scene.output.width = toSun.scene.output.height = kSide;

  // No picture shows the disc's grain, but steps as wide as in the picture would miss its thin clouds.
  gpu::Program& p = programFor(toSun, layout, shading::marchSettings(scene::Quality::kHigh), true);
  setUniforms(p, shading::projectorUniforms(toSun));
  bind(p, toSun);
  const gpu::Texture2D texture(kSide, kSide, {.format = gpu::Format::kRgba32F});
  const gpu::Framebuffer target(texture);
  target.clear();
  for (int i = 0; i < kSubframes; ++i) {
    p.set("uJitterPx", jitterPx(i));
    p.set("uJitterStep", jitterStep(i));
    triangle.draw(p, target, {.blend = gpu::Blend::kAdd});
  }
  const Image<float> shares = target.readPicture();
  double arriving = 0.0, count = 0.0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double u = (x + 0.5) / kSide - 0.5, v = (y + 0.5) / kSide - 0.5;
      if (u * u + v * v > 0.25) continue;
      arriving += shares.at(x, y, 0);
      count += shares.at(x, y, 3);
    }
  return static_cast<float>(arriving / count);
}

void SkyRenderer::Impl::addFlare(const scene::SkyState& state, const shading::LightVolumeLayout& layout,
                                 Image<float>& picture) {
  const double eyeM = state.scene.camera.eyeM;
  const sky::Body& sun = state.ephemeris.sun;
  const shading::ViewParts view = shading::partsOf(shading::viewOf(state), picture.height);
  const shading::LensFlare lens =
      shading::lensFlareOf(view, glm::vec3(sun.direction), static_cast<float>(sun.angularRadiusRad),
                           shading::sunlightAt(state, eyeM));
  if (lens.shown <= 0.0f) return;
  const float strength = static_cast<float>(state.scene.output.flare) * sunArriving(state, layout);
  if (strength <= 0.0f) return;
  if (!flare) flare.emplace();
  const gpu::Texture2D texture(picture.width, picture.height, {.format = gpu::Format::kRgba32F});
  const gpu::Framebuffer target(texture);
  target.clear();
  flare->draw(lens, strength, view, state.clouds->earthRadiusM(), {}, target, 1.0f);
  const Image<float> light = target.readPicture(0, 3);
  for (std::size_t i = 0; i < picture.data.size(); ++i) picture.data[i] += light.data[i];
}

}  // namespace welkin::render
