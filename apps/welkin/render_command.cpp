// SPDX-License-Identifier: Apache-2.0
#include "render_command.h"

#include <chrono>
#include <cstdlib>
#include <string>

#include "interrupt.h"
#include "picture_writer.h"
#include "progress_line.h"
#include "reference_command.h"
#include "render_settings.h"
#include "report.h"
#include "slab_command.h"
#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/io/atomic_file.h"
#include "welkin/render/sky_renderer.h"
#include "welkin/scene/sky_state.h"

namespace welkin::app {
namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// Must come before the graphics context: Mesa's software renderer reads its variable once. There 0 means that
// the calling thread draws alone, and n > 0 that n others draw for it.
void setThreads(int threads) {
  setThreadCount(threads);
  if (threads > 0) setenv("LP_NUM_THREADS", std::to_string(threads == 1 ? 0 : threads).c_str(), 1);
}

render::SkyRenderer makeRenderer() {
  try {
    return render::SkyRenderer();
  } catch (const GpuError& e) {
    throw GpuError(
        std::string(e.what()) +
        "; expected EGL from a graphics driver or from Mesa's software renderer (package libgl1-mesa-dri)");
  }
}

// What a sequence holds on to from frame to frame.
class Sequence {
 public:
  explicit Sequence(const RenderSettings& settings)
      : settings_(settings), frames_(settings.scene.output.frames), writer_(settings) {}

  RenderReport draw() {
    const Clock::time_point begin = Clock::now();
    scene::weatherOf(settings_.scene);  // a report that cannot be read is said before anything heavy starts
    setThreads(settings_.threads);
    ProgressLine progress;
    progress.begin("building the sky");
    render::SkyRenderer renderer = makeRenderer();
    report_.device = renderer.deviceName();
    report_.passes.push_back({"start", msSince(begin)});
    for (std::int64_t i = 0; i < frames_; ++i) drawFrame(i, renderer, progress);
    writer_.finish();
    report_.totalMs = msSince(begin);
    return std::move(report_);
  }

 private:
  void drawFrame(std::int64_t i, render::SkyRenderer& renderer, ProgressLine& progress) {
    const Clock::time_point begin = Clock::now();
    throwIfInterrupted();
    const scene::SkyState state = stateOf(i, progress);
    const double buildMs = msSince(begin);
    if (i == 0) progress.begin("drawing");
    throwIfInterrupted();
    const render::Picture picture = renderer.draw(state, [&](double fraction) {
      throwIfInterrupted();
      progress.show((static_cast<double>(i) + fraction) / static_cast<double>(frames_));
    });
    const double exposureEv = settings_.scene.output.exposureEv.value_or(picture.autoExposureEv);
    const Clock::time_point drawn = Clock::now();
    throwIfInterrupted();
    const std::string path = writer_.write(i, picture.luminance, exposureEv, state);
    if (i == 0) {
      report_.passes.push_back({"sky", buildMs});
      report_.passes.insert(report_.passes.end(), picture.passes.begin(), picture.passes.end());
      report_.passes.push_back({"write", msSince(drawn)});
    }
    report_.frames.push_back({path, state.time, exposureEv, msSince(begin)});
  }

  // The sky of a frame.
  scene::SkyState stateOf(std::int64_t i, ProgressLine& progress) {
    const scene::Scene& s = settings_.scene;
    if (i == 0) {
      report_.state = scene::buildSky(s, s.atS);
      for (const std::string& warning : report_.state.warnings) progress.warn(warning);
      last_ = report_.state;
      return report_.state;
    }
    const double t = s.atS + static_cast<double>(i) * s.output.speed / s.output.fps;
    scene::moveSky(last_, t);
    return last_;
  }

  const RenderSettings& settings_;
  const std::int64_t frames_;
  PictureWriter writer_;
  RenderReport report_;
  scene::SkyState last_;  // whose key instants serve the next frame
};

}  // namespace

int runRender(const RenderArgs& args) {
  const RenderSettings settings = renderSettings(args);
  catchInterrupts();  // from here on there may be unfinished files
  if (!settings.report.empty()) checkWritable(settings.report);
  if (!settings.scene.slab.empty()) return runSlab(settings);
  if (settings.reference) return runReference(settings);
  const RenderReport report = Sequence(settings).draw();
  if (!settings.report.empty()) io::writeTextFile(settings.report, reportJson(settings, report));
  return 0;
}

}  // namespace welkin::app
