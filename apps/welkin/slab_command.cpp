// SPDX-License-Identifier: Apache-2.0
#include "slab_command.h"

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "interrupt.h"
#include "progress_line.h"
#include "report.h"
#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/core/param_range.h"
#include "welkin/io/atomic_file.h"
#include "welkin/reference/slab_tracer.h"
#include "welkin/scene/param_json.h"

namespace welkin::app {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kDefaultNoise = 1e-3;

Json estimateJson(const reference::Estimate& e) {
  return {{"value", e.value}, {"standard_error", e.error}};
}

Json flowJson(const reference::SlabLightFlow& f) {
  return {{"reflectance", estimateJson(f.reflectance)},
          {"transmittance", estimateJson(f.transmittance)},
          {"direct_transmittance", estimateJson(f.directTransmittance)},
          {"diffuse_transmittance", estimateJson(f.diffuseTransmittance)},
          {"absorptance", estimateJson(f.absorptance)},
          {"nadir_radiance", estimateJson(f.nadirRadiance)}};
}

std::string slabJson(const RenderSettings& settings, const reference::SlabResult& r, bool complete,
                     double seconds) {
  Json j;
  j["welkin"] = WELKIN_VERSION;
  j["renderer"] = "reference";
  j["device"] = std::to_string(threadCount()) + " processor threads";
  j["seed"] = settings.scene.seed;
  j["complete"] = complete;
  j["slab"] = flowJson(r.total);
  j["columns"] = Json::array();
  for (const reference::SlabLightFlow& c : r.columns) j["columns"].push_back(flowJson(c));
  j["paths"] = r.paths;
  j["scattering_events"] = r.events;
  j["events_per_second"] = seconds > 0.0 ? static_cast<double>(r.events) / seconds : 0.0;
  j["total_ms"] = 1e3 * seconds;
  j["peak_rss_mib"] = peakRssMib();
  j["scene"] = Json::parse(scene::toJson(settings.scene));
  return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

int runSlab(const RenderSettings& settings) {
  if (settings.threads > 0) setThreadCount(settings.threads);
  const scene::Slab& slab = settings.scene.slab;
  reference::SlabSettings how;
  how.seed = static_cast<std::uint64_t>(settings.scene.seed);
  if (settings.spp) how.maxPaths = static_cast<std::uint64_t>(*settings.spp) * slab.depths().size();
  how.noise = settings.noise.value_or(settings.spp ? 0.0 : kDefaultNoise);

  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  reference::SlabResult result;
  bool complete = true;
  {
    ProgressLine progress;
    progress.begin("tracing");
    try {
      result = reference::traceSlab(slab, how, [&](const reference::SlabResult& r, double done) {
        result = r;
        const reference::Estimate& e = r.total.reflectance;
        progress.show(done, "reflectance " + numberText(e.value) + " +- " + numberText(e.error));
        throwIfInterrupted();
      });
    } catch (const Interrupted&) {
      complete = false;
    }
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  io::writeTextFile(settings.report, slabJson(settings, result, complete, seconds));
  return complete ? 0 : 130;
}

}  // namespace welkin::app
