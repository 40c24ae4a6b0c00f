// SPDX-License-Identifier: Apache-2.0
#include "bench/frame_bench.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "welkin/gpu/context.h"
#include "welkin/gpu/draw.h"
#include "welkin/render/live_sky.h"
#include "welkin/render/octaves_pass.h"

namespace welkin::bench {
namespace {

constexpr int kWidth = 1280, kHeight = 1024;
constexpr int kRounds = 15, kFrames = 4;

gpu::Program yardstickProgram() {
  return gpu::Program::graphics({R"(#version 330 core
out vec2 vUv;
void main() {
  vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  vUv = p * 2.0;
  gl_Position = vec4(p, 0.0, 1.0);
}
)",
                                 {"yardstick.vert"}},
                                {R"(#version 330 core
in vec2 vUv;
uniform sampler2D uTexture;
layout(location = 0) out vec4 oColour;
void main() { oColour = texture(uTexture, vUv); }
)",
                                 {"yardstick.frag"}});
}

// A zenith view: the layer everywhere.
scene::Scene skyWith(const std::vector<scene::Sheet>& sheets) {
  scene::Scene s;
  s.technique = scene::Technique::kPlane;
  s.camera.pitchDeg = 90.0;
  s.camera.fovDeg = 60.0;
  s.output.width = kWidth;
  s.output.height = kHeight;
  s.sheets = sheets;
  return s;
}

std::vector<scene::Sheet> planes(int count, scene::SheetTier tier) {
  constexpr field::ThesisTexture kLayers[] = {field::ThesisTexture::kOvercast, field::ThesisTexture::kBroken,
                                              field::ThesisTexture::kFew};
  std::vector<scene::Sheet> sheets;
  for (int i = 0; i < count; ++i) {
    sheets.push_back(scene::sheetOf(kLayers[i]));
    sheets.back().surface = scene::SheetSurface::kPlane;
    sheets.back().tier = tier;
  }
  return sheets;
}

std::vector<scene::Sheet> dome(scene::SheetTier tier) {
  std::vector<scene::Sheet> sheets = {scene::sheetOf(field::ThesisTexture::kDome)};
  sheets[0].tier = tier;
  return sheets;
}

// A sheet of living octaves.
scene::Sheet living(int octaves, int texels, scene::OctaveKernel kernel = scene::OctaveKernel::kGradient) {
  scene::Sheet sheet;
  sheet.pattern = scene::SheetPattern::kOctaves;
  sheet.living.kernel = kernel;
  sheet.frequency = 8;
  sheet.octaves = octaves;
  sheet.texels = texels;
  sheet.oktas = 4.0;
  sheet.amplitude = 0.5;
  return sheet;
}

// Its pattern for frame after frame, a sixtieth of a second apart.
class Living {
 public:
  Living(render::OctavesPass& pass, const scene::Sheet& sheet)
      : pass_(pass),
        living_(sheet, 1),
        texture_(static_cast<int>(sheet.texels), static_cast<int>(sheet.texels),
                 {.format = gpu::Format::kR16F,
                  .filter = gpu::Filter::kMipmap,
                  .wrapX = gpu::Wrap::kRepeat,
                  .wrapY = gpu::Wrap::kRepeat}) {}
  void frame() { pass_.compose(living_, frame_++ / 60.0, texture_); }

 private:
  render::OctavesPass& pass_;
  render::LivingTexture living_;
  gpu::Texture2D texture_;
  int frame_ = 0;
};

struct Case {
  std::string name;
  std::optional<double> thesisFps;  // of whole frames
  std::function<void()> frame;
  std::vector<double> ms{};
  int frames = kFrames;  // that a time is the mean of
};

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

}  // namespace

FrameTable measureFrames() {
  gpu::Context context;
  const gpu::Texture2D colour(kWidth, kHeight, {.format = gpu::Format::kRgba8});
  const gpu::Framebuffer target(colour);
  gpu::Program yardstick = yardstickProgram();
  gpu::Texture2D texture(1024, 1024,
                         {.format = gpu::Format::kRgba8,
                          .filter = gpu::Filter::kMipmap,
                          .wrapX = gpu::Wrap::kRepeat,
                          .wrapY = gpu::Wrap::kRepeat});
  texture.upload(Image<float>(1024, 1024, 4));
  texture.makeMipmaps();
  const gpu::FullscreenTriangle triangle;

  std::vector<std::unique_ptr<render::LiveSky>> skies;
  std::vector<Case> cases;
  cases.push_back({"yardstick Y", {}, [&] {
                     yardstick.bind("uTexture", texture);
                     triangle.draw(yardstick, target, {.blend = gpu::Blend::kOver});
                   }});
  const auto add = [&](const std::string& name, std::optional<double> thesis,
                       const std::vector<scene::Sheet>& sheets, bool backdrop) {
    skies.push_back(std::make_unique<render::LiveSky>());
    render::LiveSky* sky = skies.back().get();
    sky->update(skyWith(sheets), 0.0);
    const shading::View view = shading::viewOf(sky->state());
    cases.push_back(
        {name, thesis, [=, &target] { sky->draw(view, target, {.scale = 1e-4f, .backdrop = backdrop}); }});
  };
  using scene::SheetTier;
  add("empty: sky and discs", 83.0, {}, true);
  add("one plane, lit", 70.0, planes(1, SheetTier::kLit), true);
  add("two planes, lit", 62.0, planes(2, SheetTier::kLit), true);
  add("three planes, lit", 59.0, planes(3, SheetTier::kLit), true);
  add("dome, embossed", 44.0, dome(SheetTier::kEmbossed), true);
  add("plane alone, flat", {}, planes(1, SheetTier::kFlat), false);
  add("plane alone, embossed", {}, planes(1, SheetTier::kEmbossed), false);
  add("plane alone, lit", {}, planes(1, SheetTier::kLit), false);
  add("dome alone, flat (one 3D fetch)", {}, dome(SheetTier::kFlat), false);
  add("dome alone, embossed", {}, dome(SheetTier::kEmbossed), false);

  // Living octaves, composed anew for each frame where not said otherwise: the knobs of quality.
  render::OctavesPass octavesPass;
  std::vector<std::unique_ptr<Living>> patterns;
  const auto compose = [&](const std::string& name, const scene::Sheet& sheet) {
    patterns.push_back(std::make_unique<Living>(octavesPass, sheet));
    Living* pattern = patterns.back().get();
    cases.push_back({"octaves alone, " + name, {}, [=] { pattern->frame(); }, {}, 12});
  };
  compose("4 at 256x256", living(4, 256));
  compose("2 at 256x256", living(2, 256));
  compose("6 at 256x256", living(6, 256));
  compose("4 at 128x128", living(4, 128));
  compose("4 at 512x512", living(4, 512));
  compose("4 at 256x256, kernel pallister", living(4, 256, scene::OctaveKernel::kPallister));
  compose("4 at 256x256, kernel course", living(4, 256, scene::OctaveKernel::kCourse));
  for (const double rate : {30.0, 10.0}) {
    scene::Sheet sheet = living(4, 256);
    sheet.living.updatesPerS = rate;
    compose("4 at 256x256, updated " + std::to_string(static_cast<int>(rate)) + " times a second", sheet);
  }

  // A whole frame of an application: the sky of the instant, the clear sky behind, ground and shadows.
  const gpu::Texture2D small(640, 360, {.format = gpu::Format::kRgba8});
  const gpu::Framebuffer smallTarget(small);
  const auto whole = [&](const std::string& name, scene::SheetTier tier) {
    skies.push_back(std::make_unique<render::LiveSky>());
    render::LiveSky* sky = skies.back().get();
    scene::Scene s;
    s.technique = scene::Technique::kOctaves;
    s.tier = tier;
    s.layers = {weather::typicalLayer(weather::Genus::kStratocumulus, s.place.latitudeDeg)};
    s.output.width = small.width();
    s.output.height = small.height();
    auto frame = std::make_shared<int>(0);
    cases.push_back({name,
                     {},
                     [=, &smallTarget] {
                       sky->update(s, (*frame)++ / 60.0);
                       sky->draw(shading::viewOf(sky->state()), smallTarget, {.scale = 1e-4f});
                     },
                     {},
                     12});
  };
  whole("640x360, octaves of stratocumulus, lit, whole frame", scene::SheetTier::kLit);
  whole("640x360, octaves of stratocumulus, embossed, whole frame", scene::SheetTier::kEmbossed);

  // Marched volumes: a sixteenth of the pixels, and of the light volume, a frame, while time runs.
  const auto marched = [&](const std::string& name, std::initializer_list<weather::Genus> genera, double eyeM,
                           scene::Quality quality) {
    skies.push_back(std::make_unique<render::LiveSky>());
    render::LiveSky* sky = skies.back().get();
    scene::Scene s;
    for (const weather::Genus genus : genera)
      s.layers.push_back(weather::typicalLayer(genus, s.place.latitudeDeg));
    for (weather::Layer& layer : s.layers) layer.oktas = 4.0;
    s.camera.eyeM = eyeM;
    s.camera.pitchDeg = eyeM > 100.0 ? -10.0 : 14.0;
    s.output.quality = quality;
    s.output.width = small.width();
    s.output.height = small.height();
    auto frame = std::make_shared<int>(0);
    cases.push_back({"640x360, " + name,
                     {},
                     [=, &smallTarget] {
                       sky->update(s, (*frame)++ / 10.0);
                       sky->draw(shading::viewOf(sky->state()), smallTarget, {.scale = 1e-4f});
                     },
                     {},
                     2});
  };
  using weather::Genus;
  for (const auto& [quality, word] : {std::pair{scene::Quality::kLow, "low"},
                                      {scene::Quality::kMedium, "medium"},
                                      {scene::Quality::kHigh, "high"}}) {
    marched(std::string("cumulus marched from the ground, ") + word, {Genus::kCumulus}, 2.0, quality);
    marched(std::string("cumulus marched from 3.5 km, ") + word, {Genus::kCumulus}, 3500.0, quality);
  }
  marched("cumulonimbus marched from the ground, medium", {Genus::kCumulonimbus}, 2.0,
          scene::Quality::kMedium);

  for (int round = 0; round <= kRounds; ++round)
    for (Case& c : cases) {
      gpu::Stopwatch watch;
      for (int i = 0; i < c.frames; ++i) c.frame();
      const double ms = watch.finishedMs() / c.frames;
      if (round > 0) c.ms.push_back(ms);  // the first compiles
    }

  FrameTable table{context.deviceName(), kWidth, kHeight, kRounds, {}};
  const double y = median(cases[0].ms), empty = median(cases[1].ms);
  for (const Case& c : cases) {
    const double ms = median(c.ms);
    table.rows.push_back({c.name, ms, ms / y, {}, c.thesisFps});
    if (c.thesisFps) table.rows.back().share = empty / ms;
  }
  return table;
}

}  // namespace welkin::bench
