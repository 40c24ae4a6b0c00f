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
  constexpr scene::SheetPreset kLayers[] = {
      scene::SheetPreset::kThesisOvercast, scene::SheetPreset::kThesisBroken, scene::SheetPreset::kThesisFew};
  std::vector<scene::Sheet> sheets;
  for (int i = 0; i < count; ++i) {
    sheets.push_back(scene::sheetOf(kLayers[i]));
    sheets.back().surface = scene::SheetSurface::kPlane;
    sheets.back().tier = tier;
  }
  return sheets;
}

std::vector<scene::Sheet> dome(scene::SheetTier tier) {
  std::vector<scene::Sheet> sheets = {scene::sheetOf(scene::SheetPreset::kThesisDome)};
  sheets[0].tier = tier;
  return sheets;
}

struct Case {
  std::string name;
  std::optional<double> thesisFps;  // of whole frames
  std::function<void()> frame;
  std::vector<double> ms;
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
  cases.push_back({"yardstick Y",
                   {},
                   [&] {
                     yardstick.bind("uTexture", texture);
                     triangle.draw(yardstick, target, {.blend = gpu::Blend::kOver});
                   },
                   {}});
  const auto add = [&](const std::string& name, std::optional<double> thesis,
                       const std::vector<scene::Sheet>& sheets, bool backdrop) {
    skies.push_back(std::make_unique<render::LiveSky>());
    render::LiveSky* sky = skies.back().get();
    sky->update(skyWith(sheets), 0.0);
    const shading::View view = shading::viewOf(sky->state());
    cases.push_back({name,
                     thesis,
                     [=, &target] { sky->draw(view, target, {.scale = 1e-4f, .backdrop = backdrop}); },
                     {}});
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

  for (int round = 0; round <= kRounds; ++round)
    for (Case& c : cases) {
      gpu::Stopwatch watch;
      for (int i = 0; i < kFrames; ++i) c.frame();
      const double ms = watch.finishedMs() / kFrames;
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
