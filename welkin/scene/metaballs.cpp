// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/metaballs.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>

#include "welkin/core/error.h"
#include "welkin/core/param_range.h"
#include "welkin/core/random.h"
#include "welkin/core/units.h"
#include "welkin/field/metaball_motion.h"
#include "welkin/scene/cover_warnings.h"
#include "welkin/scene/cumulus_library.h"
#include "welkin/scene/scene.h"

namespace welkin::scene {
namespace {

// A level will do whose balls are no larger in view.
constexpr double kBallRad = 0.003;
constexpr double kLayerBallRad = 0.008;  // of a layer's, which are many
constexpr double kShadowBalls = 3.0;     // so many times as large in shadows
// A layer's cloud becomes a picture from so many of its widths on, over that share of them.
constexpr double kPictureFrom = 3.5, kPictureFade = 0.45;
constexpr double kOpaque = 4.0;  // optical depth
// Two levels fade into one another over that share of the distance at which the coarser one would do.
constexpr double kFade = 0.3;

// The coarsest level that will do at a distance, and how much of it there is: the rest is of the next finer.
struct LevelShare {
  std::size_t level = 0;
  double share = 1.0;
};
LevelShare levelAt(std::span<const double> radiiM, double ballRad, double distanceM, MetaballDetail detail) {
  const std::size_t finest = radiiM.size() - 1;
  if (detail == MetaballDetail::kFinest) return {finest, 1.0};
  if (detail == MetaballDetail::kAsShadow) ballRad *= kShadowBalls;
  for (std::size_t level = 0; level < finest; ++level) {
    const double fromM = radiiM[level] / ballRad;
    if (distanceM > fromM) return {level, glm::smoothstep(1.0, 1.0 + kFade, distanceM / fromM)};
  }
  return {finest, 1.0};
}

// A cloud of the library as what shades, with one ball as its coarsest level. That is soft: half its radius
// counts.
struct ShadeLevels {
  const LibraryCloud& cloud;
  const std::vector<field::Metaball>& operator[](std::size_t level) const {
    return level == 0 ? cloud.whole : cloud.levels[level - 1];
  }
  std::array<double, kLibraryLevels + 1> radii() const {
    std::array<double, kLibraryLevels + 1> all{0.5 * cloud.whole[0].radiusM};
    std::ranges::copy(cloud.radii, all.begin() + 1);
    return all;
  }
};

// Appends the balls of both, f(ball) each, and returns where those of the coarser one end.
template <class Levels, class F>
std::size_t append(const Levels& levels, const LevelShare& seen, F&& f, std::vector<field::Metaball>& out) {
  const auto some = [&](std::size_t level, double share) {
    for (const field::Metaball& b : levels[level]) {
      out.push_back(f(b));
      out.back().density *= share;
    }
  };
  some(seen.level, seen.share);
  const std::size_t coarseEnd = out.size();
  if (seen.share < 1.0) some(seen.level + 1, 1.0 - seen.share);
  return coarseEnd;
}

}  // namespace

// First what is dense, which little of the density makes opaque, then what is thin, evenly both.
float pictureShare(double widths, double opticalDepth) {
  const double x = (widths / kPictureFrom - 1.0) / kPictureFade;
  if (x >= 1.0) return 1.0f;
  const double depth = std::max(opticalDepth, 1e-3), opaque = std::min(depth, kOpaque);
  const double dense = -std::log(1.0 - glm::smoothstep(0.0, 0.6, x) * (1.0 - std::exp(-opaque))) / depth;
  const double thin = glm::smoothstep(0.5, 1.0, x);
  return static_cast<float>(1.0 - (1.0 - dense) * (1.0 - thin));
}

void describe(MetaballCloud& c, ParamVisitor& v) {
  v.value({"file", "", "file of metaballs, beside the scene file, as `welkin fit` and `welkin cloud` write"},
          c.file);
  v.value({"position_m", "m", "where the file's origin goes: east, north, above the ground", -200000, 200000},
          c.positionM);
  v.value({"turn_deg", "deg", "turns the cloud clockwise as seen from above", -360, 360}, c.turnDeg);
  v.value({"scale", "", "factor of its size", 0.001, 1000}, c.scale);
  v.value({"extinction_per_m", "1/m", "extinction where the file's density is 1", 0, 10}, c.extinctionPerM);
  v.value({"albedo", "", "share of the light that its cloud scatters and does not absorb", 0, 1}, c.albedo);
  v.choice({"phase", "", "how it scatters light the first time"}, c.phase);
  v.value({"wind_from_deg", "deg", "direction its wind comes from, clockwise from north", 0, 360},
          c.windFromDeg);
  v.value({"wind_speed_mps", "m/s", "speed of its wind", 0, 150}, c.windSpeedMps);
  v.value({"shear_per_s", "1/s", "wind that each metre above its origin adds, while its balls live", -1, 1},
          c.shearPerS);
  v.value({"life_s", "s", "life of a ball, which grows and decays again and again; 0: they stay", 0, 1e9},
          c.lifeS);
}

void validate(const MetaballCloud& c) {
  if (c.file.empty()) throw ParameterError("metaballs have no file; expected file = \"NAME.json\"");
}

MetaballSky::MetaballSky(const Scene& scene, const weather::Weather& weather, double earthRadiusM)
    : drift_(scene.drift), windSeed_(windSeed(scene)) {
  for (std::size_t i = 0; i < weather.layers.size(); ++i)
    if (isMetaballs(scene, weather.layers[i]))
      layers_.push_back(
          {i, MetaballLayer(weather.layers[i], hashOf(static_cast<std::uint64_t>(scene.seed), 0x6d62, i),
                            earthRadiusM)});
  for (const MetaballCloud& cloud : scene.metaballs) {
    Placed placed{cloud, {}, {}, glm::dvec3(0.0)};
    const double turn = radians(cloud.turnDeg), c = std::cos(turn), s = std::sin(turn);
    MetaballFile file = readMetaballs(cloud.file);
    for (MetaballLevel& level : file.levels) {
      for (field::Metaball& b : level.balls) {
        const glm::dvec3 p = cloud.scale * b.centreM;
        b.centreM = cloud.positionM + glm::dvec3(c * p.x + s * p.y, c * p.y - s * p.x, p.z);
        b.radiusM *= cloud.scale;
        b.density *= cloud.extinctionPerM;
      }
      placed.radiiM.push_back(field::medianRadiusOf(level.balls));
      placed.levels.push_back(std::move(level.balls));
    }
    const field::Box box = field::boundsOf(placed.levels.back());
    placed.middleM = 0.5 * (box.low + box.high);
    clouds_.push_back(std::move(placed));
  }
}

std::vector<std::string> MetaballSky::warnings() const {
  std::vector<std::string> all;
  for (const Filled& filled : layers_) {
    const weather::Layer& layer = filled.layer.layer();
    if (const std::optional<double> most = filled.layer.mostOktas())
      all.push_back(
          coversLess(layer, *most, layer.oktas) +
          ": more metaballs are too many; a thicker or a lower layer covers more, and so do volumes");
  }
  return all;
}

glm::dvec2 MetaballSky::driftOf(const Filled& filled, double secondsAfter) const {
  const weather::Layer& layer = filled.layer.layer();
  return layer.windSpeedMps * windPath(drift_, windSeed_, layer.windFromDeg, secondsAfter);
}

std::vector<float> MetaballSky::layerOpticalDepths(std::size_t layer, double secondsAfter,
                                                   int directions) const {
  const auto filled = std::ranges::find(layers_, layer, &Filled::number);
  assert(filled != layers_.end());
  return filled->layer.opticalDepths(secondsAfter, driftOf(*filled, secondsAfter), directions);
}

void MetaballSky::live(const MetaballCloud& c, double secondsAfter, std::span<field::Metaball> balls) {
  if (c.lifeS <= 0.0) return;
  const double from = radians(c.windFromDeg);
  field::MetaballMotion motion;
  motion.shearPerS = -c.shearPerS * glm::dvec3(std::sin(from), std::cos(from), 0.0);
  motion.referenceM = c.positionM.z;
  motion.lifeS = c.lifeS;
  field::move(balls, motion, secondsAfter);
}

MetaballInstances MetaballSky::instancesAt(double secondsAfter, const glm::dvec2& eyeM) const {
  MetaballInstances all;
  const auto endShape = [&](std::size_t begin) {
    all.shapes.push_back({all.balls.size(), field::boundsOf(std::span(all.balls).subspan(begin))});
  };
  for (const Placed& placed : clouds_) {
    const MetaballCloud& c = placed.cloud;
    const glm::dvec2 drifted = c.windSpeedMps * windPath(drift_, windSeed_, c.windFromDeg, secondsAfter);
    const std::size_t begin = all.balls.size();
    all.balls.insert(all.balls.end(), placed.levels.back().begin(), placed.levels.back().end());
    live(c, secondsAfter, std::span(all.balls).subspan(begin));
    // Decayed ones have no size.
    const auto gone = [](const field::Metaball& b) { return b.radiusM <= 0.0 || b.density == 0.0; };
    all.balls.erase(
        std::remove_if(all.balls.begin() + static_cast<std::ptrdiff_t>(begin), all.balls.end(), gone),
        all.balls.end());
    if (all.balls.size() == begin) continue;
    all.instances.push_back({all.shapes.size(), glm::dvec3(drifted - eyeM, 0.0), 1.0, 0.0, 1.0});
    endShape(begin);
  }
  std::vector<MetaballLayer::Cloud> clouds;
  std::array<std::size_t, 2> firstShapes{};  // of towers and of flat ones; 0: none yet
  for (const Filled& filled : layers_) {
    filled.layer.cloudsAt(secondsAfter, driftOf(filled, secondsAfter), eyeM, clouds);
    if (clouds.empty()) continue;
    std::size_t& first = firstShapes[filled.layer.isFlat() ? 1 : 0];
    if (first == 0) {
      first = all.shapes.size() + 1;
      for (const LibraryCloud& shape : filled.layer.library()) {
        const std::size_t begin = all.balls.size();
        all.balls.insert(all.balls.end(), shape.levels.back().begin(), shape.levels.back().end());
        endShape(begin);
      }
    }
    for (const MetaballLayer::Cloud& cloud : clouds)
      all.instances.push_back({first - 1 + cloud.shape, cloud.baseM - glm::dvec3(eyeM, 0.0), cloud.widthM,
                               cloud.turnRad, cloud.extinctionPerM});
  }
  return all;
}

std::vector<const LibraryCloud*> MetaballSky::shapes() const {
  std::vector<const LibraryCloud*> all;
  for (const Filled& filled : layers_)
    for (const LibraryCloud& shape : filled.layer.library()) all.push_back(&shape);
  return all;
}

void MetaballSky::at(double secondsAfter, const glm::dvec3& eyeM, double earthRadiusM, CloudBalls& out,
                     MetaballDetail detail) const {
  out.balls.clear();
  out.clouds.clear();
  for (const Placed& placed : clouds_) {
    const MetaballCloud& c = placed.cloud;
    const glm::dvec2 drifted = c.windSpeedMps * windPath(drift_, windSeed_, c.windFromDeg, secondsAfter);
    const double distanceM = glm::length(placed.middleM + glm::dvec3(drifted, 0.0) - eyeM);
    const std::size_t begin = out.balls.size();
    const LevelShare level = levelAt(placed.radiiM, kBallRad, distanceM, detail);
    const std::size_t coarseEnd =
        append(placed.levels, level, [](const field::Metaball& b) { return b; }, out.balls);
    const std::span<field::Metaball> own = std::span(out.balls).subspan(begin);
    // Each level by itself: a ball's life is that of its number there, whatever levels are beside it.
    live(c, secondsAfter, own.first(coarseEnd - begin));
    live(c, secondsAfter, own.subspan(coarseEnd - begin));
    for (field::Metaball& b : own) {
      b.centreM += glm::dvec3(drifted, 0.0);
      b.centreM = overEarth(b.centreM, eyeM, earthRadiusM);
    }
    out.clouds.push_back({out.balls.size(),
                          c.phase,
                          static_cast<float>(c.albedo),
                          coarseEnd,
                          static_cast<float>(level.share),
                          {}});
  }
  for (const Filled& filled : layers_) {
    filled.layer.cloudsAt(secondsAfter, driftOf(filled, secondsAfter), glm::dvec2(eyeM), out.filled);
    for (const MetaballLayer::Cloud& cloud : out.filled) {
      const double widths = glm::length(cloud.baseM - eyeM) / cloud.widthM;
      const LibraryCloud& shape = filled.layer.shape(cloud);
      CloudBalls::Far far;
      if (detail == MetaballDetail::kAsSeen)
        far = {&shape, cloud, pictureShare(widths, cloud.extinctionPerM * cloud.widthM)};
      if (far.share > 0.0f) far.placed.baseM = overEarth(cloud.baseM, eyeM, earthRadiusM);
      if (far.share >= 1.0f) {
        out.clouds.push_back({out.balls.size(), MetaballPhase::kDroplets, 1.0f, out.balls.size(), 1.0f, far});
        continue;
      }
      const auto inSky = [&](const field::Metaball& b) {
        field::Metaball at = placed(b, cloud);
        at.centreM = overEarth(at.centreM, eyeM, earthRadiusM);
        return at;
      };
      const auto add = [&](const auto& levels, std::span<const double> radii) {
        const LevelShare level = levelAt(radii, kLayerBallRad, widths, detail);
        const std::size_t coarseEnd = append(levels, level, inSky, out.balls);
        out.clouds.push_back({out.balls.size(), MetaballPhase::kDroplets, 1.0f, coarseEnd,
                              static_cast<float>(level.share), far});
      };
      if (detail == MetaballDetail::kAsShadow) {
        const ShadeLevels shades{shape};
        add(shades, shades.radii());
      } else {
        add(shape.levels, shape.radii);
      }
    }
  }
}

}  // namespace welkin::scene
