// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/metaballs.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "welkin/core/error.h"
#include "welkin/core/random.h"
#include "welkin/core/units.h"
#include "welkin/field/metaball_motion.h"
#include "welkin/scene/cumulus_library.h"
#include "welkin/scene/scene.h"

namespace welkin::scene {
namespace {

// A level will do whose balls are no larger in view.
constexpr double kBallRad = 0.003;
constexpr double kLayerBallRad = 0.008;  // of a layer's, which are many

}  // namespace

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

void MetaballSky::at(double secondsAfter, const glm::dvec3& eyeM, double earthRadiusM,
                     CloudBalls& out) const {
  out.balls.clear();
  out.clouds.clear();
  for (const Placed& placed : clouds_) {
    const MetaballCloud& c = placed.cloud;
    const glm::dvec2 drifted = c.windSpeedMps * windPath(drift_, windSeed_, c.windFromDeg, secondsAfter);
    const double distanceM = glm::length(placed.middleM + glm::dvec3(drifted, 0.0) - eyeM);
    std::size_t level = 0;
    while (level + 1 < placed.levels.size() && placed.radiiM[level] > kBallRad * distanceM) ++level;
    const std::size_t begin = out.balls.size();
    out.balls.insert(out.balls.end(), placed.levels[level].begin(), placed.levels[level].end());
    const std::span<field::Metaball> own = std::span(out.balls).subspan(begin);
    if (c.lifeS > 0.0) {
      const double from = radians(c.windFromDeg);
      field::MetaballMotion motion;
      motion.shearPerS = -c.shearPerS * glm::dvec3(std::sin(from), std::cos(from), 0.0);
      motion.referenceM = c.positionM.z;
      motion.lifeS = c.lifeS;
      field::move(own, motion, secondsAfter);
    }
    for (field::Metaball& b : own) {
      b.centreM += glm::dvec3(drifted, 0.0);
      b.centreM = overEarth(b.centreM, eyeM, earthRadiusM);
    }
    out.clouds.push_back({out.balls.size(), c.phase, static_cast<float>(c.albedo)});
  }
  std::vector<MetaballLayer::Cloud> clouds;
  for (const Filled& filled : layers_) {
    filled.layer.cloudsAt(secondsAfter, driftOf(filled, secondsAfter), glm::dvec2(eyeM), clouds);
    for (const MetaballLayer::Cloud& cloud : clouds) {
      const double distanceM = glm::length(cloud.baseM - eyeM);
      std::size_t level = 0;
      while (level + 1 < kLibraryLevels &&
             filled.layer.shape(cloud).radii[level] * cloud.widthM > kLayerBallRad * distanceM)
        ++level;
      for (const field::Metaball& b : filled.layer.shape(cloud).levels[level]) {
        out.balls.push_back(placed(b, cloud));
        out.balls.back().centreM = overEarth(out.balls.back().centreM, eyeM, earthRadiusM);
      }
      out.clouds.push_back({out.balls.size(), MetaballPhase::kDroplets, 1.0f});
    }
  }
}

}  // namespace welkin::scene
