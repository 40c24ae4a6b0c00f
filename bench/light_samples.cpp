// SPDX-License-Identifier: Apache-2.0
// Examples for tools/fit_cloud_light.py: points that eyes see in the clouds of random skies, what the shader
// knows there, and what the reference says is scattered there.
//
//   light_samples OUT.f32 SKIES|SCENE.toml POINTS PATHS SEED [LIKE.toml]
//
// Rows of kColumns float32 values are appended to OUT, POINTS from each of SKIES random skies, PATHS paths
// each. No sky of bench/truth is among them. Or from each of SKIES skies like that of LIKE.toml
// (likeScene()), as its camera would see them. Or POINTS that the camera of a scene with one layer sees: to
// say where the fit is wrong; of each sky what the fit makes of it is printed. The light volume is as fine as
// in high quality for scenes, as in medium quality for random skies: the fit serves both.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/core/glsl.h"
#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/core/units.h"
#include "welkin/core/utc_time.h"
#include "welkin/gpu/context.h"
#include "welkin/reference/cloud_phases.h"
#include "welkin/reference/cloud_source.h"
#include "welkin/reference/directions.h"
#include "welkin/render/cloud_textures.h"
#include "welkin/render/light_volume_pass.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/projector.h"
#include "welkin/scene/rain_shafts.h"
#include "welkin/scene/scene_file.h"
#include "welkin/shading/fluence_layout.h"
#include "welkin/shading/uniforms.h"

namespace welkin {
namespace {

namespace shared {
using namespace welkin::glsl;
using field::CloudLayer;
#include "shaders/lib/clouds.glsl"
// After it.
#include "shaders/lib/phase.glsl"
// After the phase functions that it calls.
#include "shaders/lib/cloud_light.glsl"
// After those.
#include "shaders/lib/cloud_light_fit.glsl"
// After all.
#include "shaders/lib/cloud_scattering.glsl"
}  // namespace shared

using reference::Ray;
using reference::unit;

// What a row holds, in this order.
enum Column {
  kToSun,    // optical depths as the shader has them: towards the sun with its samples nearby,
  kFromSun,  //   back,
  kUp,       //   up and
  kDown,     //   down
  kToEye,    // and to the eye
  kCosSun,
  kViewHeight,  // sines of the elevations of the direction of view and of the sun
  kSunHeight,
  kIce,
  kCover,   // of the sky by the layer, [0, 1]
  kDirect,  // share of the sun's light that arrives straight
  kPhase,   // of the first scattering, 1/sr
  kSun,     // means over the paths: see CloudSourceSample
  kAbove,
  kBelow,
  kPaths,
  kGenus,
  kSky,
  kDistance,     // from the eye, m
  kBehindToSun,  // optical depths 300 m farther along the view (kBehindM of lib/cloud_scattering.glsl)
  kBehindFromSun,
  kBehindUp,
  kBehindDown,
  kSurface,  // cloudSurface, sd; relative height in the layer; its depth, m, and extinction, 1/m
  kHeight,
  kDepth,
  kLayerExtinction,
  kPeakShare,  // of the phase function
  kPeakG,
  kFluence,  // of the sun's light (lib/fluence.glsl): there, and kAheadM farther along the view
  kFluenceAhead,
  kColumns
};

// lib/light_volume.glsl and lib/fluence.glsl on the CPU.
struct LightVolume {
  shading::LightVolumeLayout layout;
  Volume<float> texels;
  shading::FluenceLayout cells;
  Volume<float> fluence;

  float slice(float z) const {
    float s = static_cast<float>(layout.bands[0].firstSlice);
    for (const auto& b : layout.bands)
      if (z >= b.baseM)
        s = std::lerp(static_cast<float>(b.firstSlice), static_cast<float>(b.lastSlice),
                      std::clamp((z - b.baseM) / (b.topM - b.baseM), 0.0f, 1.0f));
    return s;
  }
  // Trilinear in a cascade's part of a volume; z: in texels.
  glm::vec4 texel(const Volume<float>& volume, const glm::vec3& q, float z, int cascade) const {
    const float half = layout.kHalfM[static_cast<std::size_t>(cascade)];
    const float c[3] = {
        std::clamp(q.x / half * 0.5f + 0.5f, 0.0f, 1.0f) * static_cast<float>(volume.nx) - 0.5f,
        std::clamp(q.y / half * 0.5f + 0.5f, 0.0f, 1.0f) * static_cast<float>(volume.ny) - 0.5f, z};
    const int size[3] = {volume.nx, volume.ny, volume.nz};
    glm::vec4 sum(0.0f);
    for (int corner = 0; corner < 8; ++corner) {
      float weight = 1.0f;
      int at[3];
      for (int k = 0; k < 3; ++k) {
        const float low = std::floor(c[k]);
        const bool high = (corner >> k & 1) != 0;
        weight *= high ? c[k] - low : 1.0f - (c[k] - low);
        at[k] = std::clamp(static_cast<int>(low) + (high ? 1 : 0), 0, size[k] - 1);
      }
      for (int ch = 0; ch < volume.channels; ++ch) sum[ch] += weight * volume.at(at[0], at[1], at[2], ch);
    }
    return sum;
  }
  // The cascade, and the share of the next one.
  std::pair<int, float> cascade(const glm::vec3& q) const {
    const float reach = std::max(std::abs(q.x), std::abs(q.y));
    const int own = reach < layout.kHalfM[0] * 0.96f ? 0 : (reach < layout.kHalfM[1] * 0.96f ? 1 : 2);
    const float half = layout.kHalfM[static_cast<std::size_t>(own)];
    return {own, own == 2 ? 0.0f : std::max((reach / half - 0.77f) / 0.19f, 0.0f)};
  }
  glm::vec4 blended(const Volume<float>& volume, const glm::vec3& q, float z, int depth) const {
    const auto [own, next] = cascade(q);
    const auto of = [&](int c) { return texel(volume, q, z + static_cast<float>(c * depth), c); };
    return next > 0.0f ? glm::mix(of(own), of(own + 1), next) : of(own);
  }
  glm::vec4 at(const glm::vec3& q) const {
    return blended(texels, q, slice(q.z), static_cast<int>(layout.heightsM.size()));
  }
  float fluenceAt(const glm::vec3& q) const {
    float cell = cells.bands[0].z;
    for (std::size_t b = 0; b < layout.bands.size(); ++b) {
      const auto& band = layout.bands[b];
      const glm::vec4& of = cells.bands[b];
      if (q.z >= band.baseM)
        cell = std::clamp(std::lerp(of.x, of.y, (q.z - band.baseM) / (band.topM - band.baseM)), of.z, of.w);
    }
    return blended(fluence, q, cell - 0.5f, static_cast<int>(cells.cells.size())).x;
  }
  float cellM(const glm::vec3& q) const {
    const auto [own, next] = cascade(q);
    float half = layout.kHalfM[static_cast<std::size_t>(own)];
    if (next > 0.0f) half = std::lerp(half, layout.kHalfM[static_cast<std::size_t>(own) + 1], next);
    return 2.0f * half / static_cast<float>(texels.nx);
  }
};

// The field as the shader asks for it.
struct Clouds {
  const field::CloudField& field;
  float earthRadius;

  float extinction(const glm::vec3& q, float detailShare) const {
    const shared::sampler2D placement{&field.noise().placement, shared::Wrap::kRepeat, shared::Wrap::kRepeat};
    const shared::sampler3D shape{&field.noise().shape, shared::Wrap::kRepeat},
        detail{&field.noise().detail, shared::Wrap::kRepeat};
    float sum = 0.0f;
    for (const field::CloudLayer& layer : field.layers()) {
      if (q.z <= layer.baseM || q.z >= layer.topM) continue;
      float clear = 0.0f;
      sum += shared::cloudExtinctionFrom(layer, shape, detail, q, shared::cloudSurface(layer, placement, q),
                                         detailShare, clear);
    }
    return sum;
  }
  // Of the first layer.
  float surface(const glm::vec3& q) const {
    const shared::sampler2D placement{&field.noise().placement, shared::Wrap::kRepeat, shared::Wrap::kRepeat};
    return shared::cloudSurface(field.layers()[0], placement, q);
  }
  glm::vec3 position(const glm::dvec3& p) const { return shared::cloudPosition(glm::vec3(p), earthRadius); }
  // Along [0, end) of a ray, up to `enough`, by steps that grow.
  double depth(const Ray& ray, double end, double enough) const {
    double sum = 0.0;
    for (double t = 0.0, step = 2.0; t < end && sum < enough; t += step, step = std::min(step * 1.15, 60.0)) {
      const double length = std::min(step, end - t);
      sum += length * static_cast<double>(extinction(position(ray.at(t + 0.5 * length)), 1.0f));
    }
    return sum;
  }
};

scene::Scene randomScene(Random& random) {
  static constexpr std::array kGenera = {
      weather::Genus::kCumulus,       weather::Genus::kCumulus,      weather::Genus::kStratocumulus,
      weather::Genus::kStratocumulus, weather::Genus::kStratus,      weather::Genus::kNimbostratus,
      weather::Genus::kCumulonimbus,  weather::Genus::kCumulonimbus, weather::Genus::kAltocumulus,
      weather::Genus::kAltostratus,   weather::Genus::kCirrus,       weather::Genus::kCirrostratus};
  scene::Scene s;
  s.seed = 1000 + static_cast<std::int64_t>(random.below(1000000));
  s.time = parseUtcTime("2026-06-21T10:00:00Z");
  s.technique = scene::Technique::kVolume;
  weather::Layer layer = weather::typicalLayer(kGenera[random.below(kGenera.size())], 45.0);
  const bool deck = layer.genus == weather::Genus::kStratus || layer.genus == weather::Genus::kNimbostratus ||
                    layer.genus == weather::Genus::kAltostratus ||
                    layer.genus == weather::Genus::kCirrostratus;
  layer.oktas = deck ? 6.0 + random.below(3)
                     : 1.0 + random.below(layer.genus == weather::Genus::kStratocumulus ? 8 : 6);
  // Depth and thickness as they vary from day to day.
  const double depth = (layer.topM - layer.baseM) * std::exp2(1.4 * unit(random) - 0.7);
  layer.topM = layer.baseM + depth;
  layer.extinctionPerM *= std::exp2(1.4 * unit(random) - 0.7);
  s.layers = {layer};
  return s;
}

// A sky, and the lines of sight into it.
struct Sky {
  scene::SkyState state;
  glm::dvec3 sun{0.0};
  std::optional<scene::Projector> camera;  // none: eyes and views of all kinds

  // From an eye into the clouds; the ray ends where there is ground.
  Ray look(Random& r, double cloudTopM) const;
};

glm::dvec3 uniformDirection(Random& random) {
  const double z = 2.0 * unit(random) - 1.0, phi = 2.0 * kPi * unit(random), r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

// Of any sun.
Sky randomSky(Random& random) {
  const scene::Scene scene = randomScene(random);
  Sky sky{scene::buildSky(scene, 0.0), glm::dvec3(0.0), std::nullopt};
  // Half of the suns are low.
  const double sine =
      unit(random) < 0.5 ? 0.03 + 0.97 * unit(random) : std::sin(radians(2.0 + 28.0 * unit(random)));
  const double azimuth = 2.0 * kPi * unit(random);
  sky.sun = {std::sqrt(1.0 - sine * sine) * std::cos(azimuth),
             std::sqrt(1.0 - sine * sine) * std::sin(azimuth), sine};
  sky.state.lights[0].direction = glm::vec3(sky.sun);
  return sky;
}

// Another place of such a sky, on another day: other clouds, more or fewer and thicker or thinner ones, an
// hour earlier or later at most, seen by an eye above the ground from another height, and about as far from
// the sun.
scene::Scene likeScene(scene::Scene scene, Random& random) {
  scene.seed = 1000 + static_cast<std::int64_t>(random.below(1000000));
  scene.time = addSeconds(scene.time, std::floor(3600.0 * (2.0 * unit(random) - 1.0)));
  for (weather::Layer& layer : scene.layers) {
    layer.oktas = std::clamp(layer.oktas + 2.0 * unit(random) - 1.0, 1.0, kOktas);
    layer.extinctionPerM *= std::exp2(unit(random) - 0.5);
  }
  scene::Camera& camera = scene.camera;
  if (camera.headingDeg)
    camera.headingDeg = std::remainder(*camera.headingDeg + 60.0 * (unit(random) - 0.5), 360.0);
  if (camera.eyeM > 10.0) camera.eyeM *= std::exp2(0.6 * (unit(random) - 0.5));
  return scene;
}

// path: where it is from.
Sky skyOf(scene::Scene scene, const std::string& path) {
  scene.output.quality = scene::Quality::kHigh;
  Sky sky{scene::buildSky(scene, scene.atS), glm::dvec3(0.0), std::nullopt};
  if (sky.state.weather.layers.size() != 1)
    throw ParameterError(fmt::format("{}: {} layers; expected one", path, sky.state.weather.layers.size()));
  sky.sun = glm::normalize(glm::dvec3(sky.state.lights[0].direction));
  sky.camera = scene::projectorOf(sky.state);
  return sky;
}

Ray Sky::look(Random& r, double cloudTopM) const {
  if (camera) {
    glm::vec3 way(0.0f);
    float pixelRad = 0.0f;
    const scene::Output& out = state.scene.output;
    const glm::vec2 px(static_cast<float>(unit(r) * static_cast<double>(out.width)),
                       static_cast<float>(unit(r) * static_cast<double>(out.height)));
    if (!scene::directionAt(*camera, px, way, pixelRad)) way = {0.0f, 0.0f, -1.0f};
    return {{0.0, 0.0, state.scene.camera.eyeM}, glm::normalize(glm::dvec3(way))};
  }
  // Half of the eyes on the ground, the others up to above the clouds; a third of the looks near the sun.
  const double eye = unit(r) < 0.5 ? 2.0 : unit(r) * 1.3 * cloudTopM;
  glm::dvec3 view = uniformDirection(r);
  if (unit(r) < 0.33) view = reference::turned(sun, 1.0 - 0.3 * unit(r), 2.0 * kPi * unit(r));
  // Most look near the horizon, as cameras do.
  else if (unit(r) < 0.8)
    view = glm::normalize(glm::dvec3(view.x, view.y, 0.35 * view.z));
  return {{0.0, 0.0, eye}, view};
}

// Of the points of a sky, on average.
struct FitAgainstTruth {
  double sunBias = 0.0;  // relative
  double above = 0.0, trueAbove = 0.0;
};
FitAgainstTruth judge(const std::vector<float>& rows) {
  double sun = 0.0, trueSun = 0.0, above = 0.0, trueAbove = 0.0, count = 0.0;
  for (std::size_t i = 0; i < rows.size(); i += kColumns) {
    const float* r = &rows[i];
    if (std::isnan(r[kBelow])) continue;
    const shared::CloudScattering s =
        shared::cloudScattering({r[kToSun], r[kFromSun], r[kUp], r[kDown]},
                                {r[kCosSun],
                                 r[kViewHeight],
                                 r[kToEye],
                                 r[kDistance],
                                 {r[kBehindToSun], r[kBehindFromSun], r[kBehindUp], r[kBehindDown]},
                                 {r[kFluence], r[kFluenceAhead]}},
                                {r[kIce], r[kCover], r[kSurface], r[kHeight], r[kDepth], r[kLayerExtinction]},
                                {r[kPhase], {r[kPeakShare], r[kPeakG]}}, r[kSunHeight]);
    sun += static_cast<double>(s.sun);
    trueSun += static_cast<double>(r[kSun] + r[kDirect] * r[kPhase]);
    above += static_cast<double>(s.shares.x);
    trueAbove += static_cast<double>(r[kAbove]);
    ++count;
  }
  return {sun / std::max(trueSun, 1e-30) - 1.0, above / std::max(count, 1.0),
          trueAbove / std::max(count, 1.0)};
}

int run(int argc, char** argv) {
  if (argc != 6 && argc != 7) {
    fmt::print(stderr, "usage: light_samples OUT.f32 SKIES|SCENE.toml POINTS PATHS SEED [LIKE.toml]\n");
    return 2;
  }
  const bool ofScene = std::string_view(argv[2]).ends_with(".toml");
  const int skies = ofScene ? 1 : std::atoi(argv[2]), points = std::atoi(argv[3]), paths = std::atoi(argv[4]);
  const auto seed = static_cast<std::uint64_t>(std::atoll(argv[5]));
  constexpr int kMostSkies = 1000;  // of one seed: see kSky
  if (skies < 1 || skies > kMostSkies || points < 1 || paths < 1) {
    fmt::print(stderr,
               "light_samples: SKIES (1000 at most), POINTS and PATHS must be whole numbers from 1 on\n");
    return 2;
  }
  const std::string path = ofScene ? argv[2] : (argc == 7 ? argv[6] : "");
  std::optional<scene::Scene> seenScene;
  if (!path.empty()) seenScene = scene::readSceneFile(path).scene;
  gpu::Context context;
  render::LightVolumePass pass;
  for (int sky = 0; sky < skies; ++sky) {
    Random random(hashOf(seed, sky));
    const Sky seen = ofScene     ? skyOf(*seenScene, path)
                     : seenScene ? skyOf(likeScene(*seenScene, random), path)
                                 : randomSky(random);
    const scene::SkyState& state = seen.state;
    const glm::dvec3 sun = seen.sun;
    const weather::Layer& layer = state.weather.layers[0];
    LightVolume volume{shading::lightVolumeLayout(state), {}, {}, {}};
    volume.cells = shading::fluenceLayout(volume.layout);
    const render::CloudTextures textures(state.clouds->sharedNoise());
    pass.draw(state, volume.layout, textures);
    volume.texels = pass.volume().read();
    volume.fluence = pass.fluence().read();

    const std::vector matter{scene::matterInField(state.scene, state.weather, 0)};
    const reference::CloudMedium medium(*state.clouds, {0}, matter);
    const auto droplets =
        reference::dropletPhase(scene::dropletDiameterUm(state.weather), reference::DropletModel::kFit);
    const auto crystals = reference::snowPhase();
    const reference::CloudSource source(medium, sun, droplets, crystals);
    const shared::PhasePeak peak = shared::dropletPeak(
        shared::dropletPhase(static_cast<float>(scene::dropletDiameterUm(state.weather))));
    const Clouds clouds{*state.clouds, static_cast<float>(state.clouds->earthRadiusM())};
    const double earthTop = medium.grid()->highM();

    std::vector<float> rows(static_cast<std::size_t>(points) * kColumns, NAN);
    parallelFor(static_cast<std::size_t>(points), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Random r(hashOf(seed, sky, i, 7));
        for (int attempt = 0; attempt < 200; ++attempt) {
          const Ray ray = seen.look(r, earthTop);
          const glm::dvec3& view = ray.way;
          const double ground = medium.earth().toGround(ray, 40e3);
          const auto hit = medium.collide(ray, std::min(ground, 40e3), r);
          if (!hit) continue;
          const glm::dvec3 p = ray.at(hit->t);
          const glm::vec3 q = clouds.position(p);
          float* row = &rows[i * kColumns];
          // A sixth of the eyes are in the cloud, a free path before the point.
          double distance = hit->t;
          if (!seen.camera && i % 6 == 5) {
            Random ahead(hashOf(seed, sky, i, 8));
            if (const auto before = medium.collide({p, -view}, distance, ahead)) distance = before->t;
          }
          const auto pixelRad = static_cast<float>(4e-4 * std::exp2(4.0 * unit(r)));
          const float detail = shared::cloudDetailSeen(static_cast<float>(distance), pixelRad);
          // As cloudSource() in lib/march.glsl has it.
          constexpr int kSamples = 3;  // the qualities have 2 to 5
          const float extinction = clouds.extinction(q, detail);
          const float reach =
              std::min(kSamples * volume.cellM(q),
                       std::max((state.clouds->layers()[0].topM - q.z) / static_cast<float>(sun.z), 1.0f));
          if (extinction <= 0.0f) continue;
          float done = reach / std::pow(kSamples + 1.0f, 3.0f), near = extinction * done;
          const auto dither = static_cast<float>(unit(r));
          const glm::vec3 key(sun);
          for (int k = 1; k <= kSamples; ++k) {
            const float x = (static_cast<float>(k) + 1.0f) / (kSamples + 1.0f), to = reach * x * x * x;
            const float f = dither + 0.382f * static_cast<float>(k);
            near += (to - done) *
                    clouds.extinction(q + key * std::lerp(done, to, 0.3f + 0.4f * (f - std::floor(f))),
                                      k == 1 ? detail : 0.0f);
            done = to;
          }
          const glm::vec4 here = volume.at(q);
          row[kToSun] = near + volume.at(q + key * done).x;
          row[kFromSun] = here.z;
          row[kUp] = here.y;
          row[kDown] = here.w;
          row[kToEye] = static_cast<float>(clouds.depth({p, -view}, distance, 8.0));
          row[kCosSun] = static_cast<float>(glm::dot(view, sun));
          row[kViewHeight] = static_cast<float>(view.z);
          row[kSunHeight] = static_cast<float>(sun.z);
          const bool inIce = scene::isFrozen(hit->matter);
          row[kIce] = inIce ? 1.0f : 0.0f;
          row[kCover] = static_cast<float>(layer.oktas / kOktas);
          row[kDirect] = static_cast<float>(std::exp(-clouds.depth({p, sun}, 60e3, 30.0)));
          row[kPhase] = static_cast<float>((inIce ? crystals : droplets).density(glm::dot(view, sun)));
          const glm::vec4 behind = volume.at(q + shared::kBehindM * glm::vec3(view));
          row[kBehindToSun] = behind.x;
          row[kBehindFromSun] = behind.z;
          row[kBehindUp] = behind.y;
          row[kBehindDown] = behind.w;
          const field::CloudLayer& body = state.clouds->layers()[0];
          row[kSurface] = clouds.surface(q);
          row[kDepth] = body.topM - body.baseM;
          row[kHeight] = (q.z - body.baseM) / row[kDepth];
          row[kLayerExtinction] = body.extinction;
          row[kPeakShare] = inIce ? shared::kIcePeakShare : peak.share;
          row[kPeakG] = inIce ? shared::kIcePeakG : peak.g;
          row[kFluence] = volume.fluenceAt(q);
          row[kFluenceAhead] = volume.fluenceAt(q + shared::kAheadM * glm::vec3(view));
          double lit = 0.0;
          int above = 0, below = 0;
          for (int k = 0; k < paths; ++k) {
            const reference::CloudSourceSample s = source.trace(p, view, inIce, r);
            lit += s.sun;
            above += s.toSky ? 1 : 0;
            below += s.toGround ? 1 : 0;
          }
          row[kSun] = static_cast<float>(lit / paths);
          row[kAbove] = static_cast<float>(above) / static_cast<float>(paths);
          row[kBelow] = static_cast<float>(below) / static_cast<float>(paths);
          row[kPaths] = static_cast<float>(paths);
          row[kGenus] = static_cast<float>(layer.genus);
          row[kSky] = static_cast<float>(seed * kMostSkies + static_cast<std::uint64_t>(sky));
          row[kDistance] = static_cast<float>(distance);
          break;
        }
      }
    });
    std::ofstream out(argv[1], std::ios::binary | std::ios::app);
    for (int i = 0; i < points; ++i) {
      const float* row = &rows[static_cast<std::size_t>(i) * kColumns];
      if (!std::isnan(row[kBelow])) out.write(reinterpret_cast<const char*>(row), kColumns * sizeof(float));
    }
    if (!out.flush()) {
      fmt::print(stderr, "light_samples: {} could not be written\n", argv[1]);
      return 1;
    }
    const FitAgainstTruth fit = judge(rows);
    fmt::print(
        "{} of {}: {} {} oktas, sun {:.3f}: fit {:+.1f} % of the sun's light, {:.3f} of {:.3f} from above\n",
        sky + 1, skies, kEnumNames<weather::Genus>[static_cast<std::size_t>(layer.genus)], layer.oktas, sun.z,
        100.0 * fit.sunBias, fit.above, fit.trueAbove);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace welkin

int main(int argc, char** argv) {
  try {
    return welkin::run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "light_samples: %s\n", e.what());
    return 1;
  }
}
