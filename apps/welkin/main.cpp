// SPDX-License-Identifier: Apache-2.0
// The program: chooses the command and turns exceptions into messages and exit codes.
// 0: done. 1: what it was given to work on is wrong, or something failed. 2: called wrongly.
// 130: interrupted.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "bench_command.h"
#include "cloud_command.h"
#include "command_line.h"
#include "compare_command.h"
#include "convert_command.h"
#include "fit_command.h"
#include "help_command.h"
#include "info_command.h"
#include "interrupt.h"
#include "metar_command.h"
#include "noise_command.h"
#include "render_command.h"
#include "render_settings.h"
#include "sun_command.h"
#include "terminal_text.h"
#include "usage_error.h"
#include "welkin/scene/param_text.h"

namespace welkin::app {
namespace {

int run(const RenderArgs& args) {
  return runRender(args);
}
int run(const InfoArgs& args) {
  return runInfo(args);
}
int run(const NoiseArgs& args) {
  return runNoise(args);
}
int run(const CloudArgs& args) {
  return runCloud(args);
}
int run(const FitArgs& args) {
  return runFit(args);
}
int run(const ConvertArgs& args) {
  return runConvert(args);
}
int run(const CompareArgs& args) {
  return runCompare(args);
}
int run(const BenchArgs& args) {
  return runBench(args);
}
int run(const HelpSceneArgs& args) {
  return runHelpScene(args);
}

int run(const PrintText& print) {
  fmt::print("{}", print.text);
  return 0;
}

int run(const MetarArgs& args) {
  if (args.reports.empty() && !args.file) throw UsageError("metar: expected a report or --file F");
  runMetarCommand(args.reports, args.file, args.json);
  return 0;
}

int run(const SunArgs& args) {
  if (!args.place) throw UsageError("sun: expected --place LAT,LON");
  if (!args.time) throw UsageError("sun: expected --time UTC");
  scene::Scene s;
  setPlace(s, "--place", *args.place);
  try {
    scene::setParam(s, "time", *args.time);
  } catch (const ParameterError& e) {
    throw UsageError(std::string("--time: ") + e.what());
  }
  return runSunCommand(s.place.latitudeDeg, s.place.longitudeDeg, s.place.altitudeM, s.time, args.json);
}

int fail(int code, const char* message) {
  fmt::print(stderr, "welkin: {}\n", printable(message));
  return code;
}

int runProgram(int argc, const char* const* argv) {
  constexpr const char* kNoOutput = "standard output cannot be written";
  try {
    const Command command = parseCommandLine(argc, argv);
    const int code = std::visit([](const auto& args) { return run(args); }, command);
    if (std::fflush(stdout) != 0) return fail(1, kNoOutput);
    return code;
  } catch (const UsageError& e) {
    return fail(2, e.what());
  } catch (const Interrupted&) {
    return fail(130, "interrupted");
  } catch (const std::bad_alloc&) {
    return fail(1, "out of memory");
  } catch (const std::system_error& e) {
    return fail(1, std::ferror(stdout) != 0 ? kNoOutput : e.what());
  } catch (const std::exception& e) {
    return fail(1, e.what());
  }
}

}  // namespace
}  // namespace welkin::app

int main(int argc, char** argv) {
  welkin::app::takeFileLimitsAsErrors();
  welkin::app::seeHowProgramsEnd();
  return welkin::app::runProgram(argc, argv);
}
