// SPDX-License-Identifier: Apache-2.0
#include "bench/splat_bench.h"

#include <algorithm>
#include <cmath>

#include "welkin/core/random.h"
#include "welkin/gpu/context.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/render/splat_pass.h"
#include "welkin/scene/sky_state.h"

namespace welkin::bench {
namespace {

constexpr int kWidth = 1024, kHeight = 768, kRounds = 9;
constexpr double kEyeM = 1500.0;

std::vector<field::Metaball> cloudOf(int count) {
  std::vector<field::Metaball> balls;
  Random random(7);
  const auto within = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  const double size = std::cbrt(100.0 / count);
  for (int i = 0; i < count; ++i) {
    const double x = within(-200.0, 200.0), y = within(800.0, 1200.0), z = kEyeM + within(-150.0, 150.0);
    balls.push_back({{x, y, z}, size * within(20.0, 90.0), within(0.005, 0.03)});
  }
  return balls;
}

}  // namespace

SplatTable measureSplats() {
  gpu::Context context;
  scene::Scene s;
  s.camera.eyeM = kEyeM;
  s.camera.headingDeg = 0.0;
  s.camera.pitchDeg = 0.0;
  s.camera.fovDeg = 40.0;
  s.output.width = kWidth;
  s.output.height = kHeight;
  const scene::SkyState state = scene::buildSky(s, 0.0);
  const shading::ViewParts view = shading::partsOf(shading::viewOf(state), kHeight);
  render::SkyTextures tables;
  tables.update(state);
  render::SplatPass pass;
  pass.setSky(shading::skyUniforms(state), shading::splatLights(state));
  const gpu::Texture2D texture(kWidth, kHeight, {.format = gpu::Format::kRgba16F});
  const gpu::Framebuffer target(texture);

  SplatTable table{context.deviceName(), kWidth, kHeight, kRounds, {}};
  for (const int count : {100, 1200, 10000, 100000}) {
    std::vector<field::Metaball> balls = cloudOf(count);
    std::vector<double> ms;
    for (int round = 0; round <= kRounds; ++round) {
      for (field::Metaball& b : balls) b.centreM.x += 0.5;
      target.clear();
      gpu::Stopwatch watch;
      const render::SplatCloud cloud{balls};
      pass.draw({&cloud, 1}, view, tables, {target});
      const double took = watch.finishedMs();
      if (round > 0) ms.push_back(took);  // the first compiles
    }
    std::nth_element(ms.begin(), ms.begin() + kRounds / 2, ms.end());
    table.rows.push_back({count, ms[kRounds / 2]});
  }
  return table;
}

}  // namespace welkin::bench
