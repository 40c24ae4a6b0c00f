// SPDX-License-Identifier: Apache-2.0
#include "bench/truth_bench.h"

#include <algorithm>
#include <ctime>
#include <map>
#include <memory>

#include "welkin/core/colour.h"
#include "welkin/core/error.h"
#include "welkin/io/exr.h"
#include "welkin/io/write_image.h"
#include "welkin/reference/flip.h"
#include "welkin/reference/picture_error.h"
#include "welkin/render/display.h"
#include "welkin/scene/scene_file.h"

namespace welkin::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kFiner = 4;       // drawn so many times as wide and high, and averaged
constexpr int kShown = 5;       // pixels of a shown picture for one, a side
constexpr double kRange = 0.5;  // relative error of the strongest colour

struct Truth {
  Image<float> luminance;  // RGB
  std::vector<float> opacity;
  double noise = 0.0;
};

Truth readTruth(const fs::path& path) {
  const io::ExrPlanes file = io::readExrPlanes(path);
  auto plane = [&](const char* name) -> const std::vector<float>& {
    const auto found = file.planes.find(name);
    if (found == file.planes.end())
      throw ParameterError(path.string() + ": it has no channel " + name +
                           "; expected a picture by --renderer reference");
    return found->second;
  };
  Truth t{Image<float>(file.width, file.height, 3), plane("opacity")};
  for (const auto& [c, name] :
       {std::pair(std::size_t{0}, "R"), std::pair(std::size_t{1}, "G"), std::pair(std::size_t{2}, "B")})
    for (std::size_t i = 0; i < t.opacity.size(); ++i) t.luminance.data[3 * i + c] = plane(name)[i];
  double weights = 0.0;
  for (std::size_t i = 0; i < t.opacity.size(); ++i) {
    const double w = static_cast<double>(t.opacity[i]),
                 l = static_cast<double>(luminanceOf(&t.luminance.data[3 * i]));
    if (l > 0.0) t.noise += w * static_cast<double>(plane("error")[i]) / l;
    weights += w;
  }
  t.noise /= std::max(weights, 1e-9);
  return t;
}

// Means of squares of pixels.
Image<float> coarser(const Image<float>& fine) {
  Image<float> out(fine.width / kFiner, fine.height / kFiner, 3);
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x)
      for (int c = 0; c < 3; ++c)
        out.at(x / kFiner, y / kFiner, c) += fine.at(x, y, c) / static_cast<float>(kFiner * kFiner);
  return out;
}

// Side by side, enlarged.
Image<float> strip(const std::vector<Image<float>>& pictures) {
  const int w = pictures[0].width * kShown, h = pictures[0].height * kShown, gap = kShown;
  const int n = static_cast<int>(pictures.size());
  Image<float> out(n * w + (n - 1) * gap, h, 3);
  std::ranges::fill(out.data, 1.0f);
  for (int i = 0; i < n; ++i)
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        for (int c = 0; c < 3; ++c)
          out.at(i * (w + gap) + x, y, c) =
              pictures[static_cast<std::size_t>(i)].at(x / kShown, y / kShown, c);
  return out;
}

double processorS() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

TruthError errorOf(const Image<float>& picture, const Truth& truth, double exposureEv) {
  const reference::PictureError e = reference::errorOf(picture, truth.luminance, truth.opacity);
  const Image<float> flip = reference::flipOf(render::toDisplay(picture, exposureEv),
                                              render::toDisplay(truth.luminance, exposureEv));
  double sum = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < flip.data.size(); ++i) {
    sum += static_cast<double>(flip.data[i] * truth.opacity[i]);
    weights += static_cast<double>(truth.opacity[i]);
  }
  return {e.relative, e.bias, sum / weights, 0.0};
}

std::vector<fs::path> scenesOf(const fs::path& folder) {
  std::vector<fs::path> scenes;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed))
    if (entry.path().extension() == ".toml") scenes.push_back(entry.path());
  if (scenes.empty())
    throw ParameterError(folder.string() +
                         ": no scenes; expected a folder with scenes X.toml and their truths X.exr");
  std::ranges::sort(scenes);
  return scenes;
}

}  // namespace

TruthTable measureTruth(const fs::path& folder, const fs::path& pictures) {
  TruthTable table;
  std::map<render::CloudLight, std::unique_ptr<render::SkyRenderer>> renderers;
  const std::vector<fs::path> scenes = scenesOf(folder);
  for (const render::CloudLight light : kTruthLights)
    renderers[light] = std::make_unique<render::SkyRenderer>(render::RendererOptions{.cloudLight = light});
  table.device = renderers.begin()->second->deviceName();
  if (!pictures.empty()) fs::create_directories(pictures);
  for (const fs::path& path : scenes) {
    const Truth truth = readTruth(fs::path(path).replace_extension(".exr"));
    scene::Scene scene = scene::readSceneFile(path.string()).scene;
    if (scene.output.width != truth.luminance.width || scene.output.height != truth.luminance.height)
      throw ParameterError(path.string() + ": its truth has another size; expected that of the scene");
    scene.output.width *= kFiner;
    scene.output.height *= kFiner;
    scene.output.quality = scene::Quality::kHigh;
    const scene::SkyState state = scene::buildSky(scene, scene.atS);
    const double exposureEv = render::automaticExposureEv(truth.luminance);
    TruthRow row{path.stem().string(), truth.noise, {}};
    for (const render::CloudLight light : kTruthLights) {
      render::SkyRenderer& renderer = *renderers.at(light);
      renderer.draw(state);  // compiles
      const double begin = processorS();
      const Image<float> picture = coarser(renderer.draw(state).luminance);
      const double seconds = processorS() - begin;
      row.errors.push_back(errorOf(picture, truth, exposureEv));
      row.errors.back().cpuS = seconds;
      if (light == render::CloudLight::kFull && !pictures.empty())
        io::writeImage(
            pictures / (row.scene + ".png"),
            strip({render::toDisplay(truth.luminance, exposureEv), render::toDisplay(picture, exposureEv),
                   reference::biasColours(reference::biasMap(picture, truth.luminance), kRange)}));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace welkin::bench
