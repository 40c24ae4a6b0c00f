// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sky_textures.h"

#include <algorithm>
#include <cmath>

#include "welkin/optics/ice_phase.h"
#include "welkin/optics/mie_droplets.h"
#include "welkin/optics/rain_phase.h"
#include "welkin/scene/cloud_shapes.h"
#include "welkin/scene/rain_shafts.h"
#include "welkin/shading/splat_lights.h"
#include "welkin/shading/uniforms.h"
#include "welkin/sky/atmosphere.h"
#include "welkin/sky/milky_way.h"

namespace welkin::render {
namespace {

constexpr gpu::TextureOptions kHalf{.format = gpu::Format::kRgba16F}, kFull{.format = gpu::Format::kRgba32F},
    kStarTexels{.format = gpu::Format::kRgba32F, .filter = gpu::Filter::kNearest};

constexpr int kWeights = 64;
constexpr double kKeyS = scene::ClearSkyKey::kKeyS;

double eyeAltitude(const scene::SkyState& state) {
  return state.scene.place.altitudeM + state.scene.camera.eyeM;
}

template <class Table>
void blend(const Table& a, const Table& b, float weight, Table& out) {
  if (out.data.size() != a.data.size()) out = a;
  for (std::size_t i = 0; i < a.data.size(); ++i) out.data[i] = a.data[i] + weight * (b.data[i] - a.data[i]);
}

template <class Texture, class Table>
void put(Texture& texture, const Table& table, const gpu::TextureOptions& options) {
  if (texture.id() == 0)
    texture = Texture(table, options);
  else
    texture.upload(table);  // tables of one kind have one size
}

// What is drawn of the stars' light, of the Milky Way's, and of planets.
struct Beyond {
  float stars = 0.0f, milkyWay = 0.0f;  // shares
  sky::PlanetSpots planets;
};
Beyond beyond(const scene::SkyState& state, float pixelRad) {
  if (!state.scene.output.stars) return {};
  const double sunDeg = sky::darknessElevationDeg(state.ephemeris);
  return {sky::starlightShare(sunDeg), sky::milkyWayShare(sunDeg),
          sky::planetSpots(state.ephemeris, state.scene.camera.eyeM, pixelRad)};
}

}  // namespace

void SkyTextures::upload(const scene::SkyState& state, const sky::SkyTables& tables) {
  put(transmittance_, state.atmosphere->transmittance(), kHalf);
  put(skyView_, tables.skyView, kFull);
  put(inscatter_, tables.aerialInscatter, kFull);
  put(through_, tables.aerialTransmittance, kHalf);
}

void SkyTextures::updatePhases(const scene::SkyState& state) {
  if (icePhase_.id() == 0 && scene::hasIce(state.scene, state.weather))
    put(icePhase_, optics::icePhase(), kFull);
  if (rainPhase_.id() == 0 && scene::hasRain(state.scene, state.weather))
    put(rainPhase_, optics::rainPhase(), kFull);
  const double diameterUm = scene::dropletDiameterUm(state.weather);
  if (state.scene.droplets != optics::DropletModel::kMie || mieDiameterUm_ == diameterUm) return;
  put(mieDroplets_, optics::mieDroplets(diameterUm), kFull);
  mieDiameterUm_ = diameterUm;
}

void SkyTextures::updateLights(const scene::SkyState& state) {
  shading::lightTable(state, state.lights[0], lightTable_);
  put(keyLight_, lightTable_, kFull);
  if (!shading::secondLightSeen(state)) return;
  shading::lightTable(state, state.lights[1], lightTable_);
  put(secondLight_, lightTable_, kFull);
}

void SkyTextures::update(const scene::SkyState& state) {
  updatePhases(state);
  upload(state, sky::makeSkyTables(*state.atmosphere, eyeAltitude(state), state.lights));
  updateLights(state);
  shown_.reset();
}

void SkyTextures::start(const scene::SkyState& state, KeyName name, double startedAt) {
  // Sun and moon in the order that the instant has, even where they have changed places by the key instant.
  const scene::SkyLights lights = scene::lightsAt(state.scene, name.atS);
  auto ordered = lights.lights;
  if (lights.bySun != name.bySun) std::swap(ordered[0], ordered[1]);
  ahead_.tables.start(*state.atmosphere, eyeAltitude(state), ordered);
  ahead_.light.start(state, name.atS);
  ahead_.name = name;
  ahead_.startedAt = startedAt;
}

// Completes the key instant, where it is not the one under way from its start.
void SkyTextures::make(const scene::SkyState& state, KeyName name, Key& key) {
  if (ahead_.name != name) start(state, name, 0.0);
  ahead_.tables.computeTo(ahead_.tables.rows());
  std::swap(key.tables, ahead_.tables.tables());
  key.name = name;
  ahead_.name.reset();
}

void SkyTextures::keep(const scene::SkyState& state, KeyName first, KeyName second) {
  if (keys_[0].name == second || keys_[1].name == first) std::swap(keys_[0], keys_[1]);
  if (keys_[0].name != first && ahead_.name == second) make(state, second, keys_[1]);  // before it is lost
  if (keys_[0].name != first) make(state, first, keys_[0]);
  if (keys_[1].name != second) make(state, second, keys_[1]);
}

void SkyTextures::prepareNext(scene::SkyState& state) {
  pace_.moveTo(state.secondsAfter, kKeyS);
  const KeyName next{pace_.next(), state.litBySun};
  if (ahead_.name != next) {
    start(state, next, pace_.share());
    return;
  }
  const int rows = ahead_.tables.rows(), all = rows + scene::ClearSkyKeyInProgress::kParts,
            upTo = static_cast<int>(std::ceil(pace_.due(ahead_.startedAt) * all));
  ahead_.tables.computeTo(std::min(upTo, rows));
  ahead_.light.computeTo(upTo - rows);
  if (upTo == all) state.clearSkyAhead = ahead_.light.key();
}

void SkyTextures::updateLive(scene::SkyState& state) {
  updatePhases(state);
  if (atmosphere_ != state.atmosphere || eyeAltitudeM_ != eyeAltitude(state)) {
    for (Key& key : keys_) key.name.reset();
    ahead_.name.reset();
    shown_.reset();
    atmosphere_ = state.atmosphere;
    eyeAltitudeM_ = eyeAltitude(state);
  }
  updateLights(state);
  const double before = std::floor(state.secondsAfter / kKeyS) * kKeyS;
  const KeyName first{before, state.litBySun}, second{before + kKeyS, state.litBySun};
  // Whole steps of the weight, so that pictures between them upload nothing.
  const int weight = static_cast<int>((state.secondsAfter - before) / kKeyS * kWeights);
  if (shown_ != std::pair{first, weight}) {
    keep(state, first, second);
    const sky::SkyTables &a = keys_[0].tables, &b = keys_[1].tables;
    const float w = static_cast<float>(weight) / kWeights;
    blend(a.skyView, b.skyView, w, blended_.skyView);
    blend(a.aerialInscatter, b.aerialInscatter, w, blended_.aerialInscatter);
    blend(a.aerialTransmittance, b.aerialTransmittance, w, blended_.aerialTransmittance);
    upload(state, blended_);
    shown_ = {first, weight};
  }
  prepareNext(state);
}

void SkyTextures::bind(const gpu::Program& program) const {
  program.bind("uTransmittance", transmittance_);
  program.bind("uSkyView", skyView_);
  program.bind("uKeyLight", keyLight_);
  if (secondLight_.id() != 0) program.bind("uSecondLight", secondLight_);
  if (mieDiameterUm_) program.bind("uMieDroplets", mieDroplets_);
  if (icePhase_.id() != 0) program.bind("uIcePhase", icePhase_);
  if (rainPhase_.id() != 0) program.bind("uRainPhase", rainPhase_);
  program.bind("uAerialInscatter", inscatter_);
  program.bind("uAerialTransmittance", through_);
}

bool SkyTextures::isAnythingBeyond(const scene::SkyState& state, float pixelRad) {
  const Beyond there = beyond(state, pixelRad);
  return there.stars > 0.0f || there.milkyWay > 0.0f || there.planets.count > 0;
}

void SkyTextures::makeStars(const scene::SkyState& state, float pixelRad) {
  if (!state.scene.output.stars) return;
  if (milkyWay_.id() == 0)
    milkyWay_ =
        gpu::Texture2D(sky::milkyWay(), {.format = gpu::Format::kRgba32F, .wrapX = gpu::Wrap::kRepeat});
  if (starsTime_ != state.scene.time) {
    for (Stars& stars : stars_) stars = {};
    starsTime_ = state.scene.time;
  }
  const int level = sky::starLevel(pixelRad);
  Stars& stars = stars_[static_cast<std::size_t>(level)];
  if (stars.cells != 0) return;
  const sky::StarCells sorted = sky::starCells(sky::starLights(state.scene.time), level);
  stars.texture = gpu::Texture2D(sorted.texels, kStarTexels);
  stars.cells = sorted.cells;
}

void SkyTextures::bindStars(gpu::Program& program, const scene::SkyState& state, float pixelRad) {
  if (!program.has("uStars")) return;
  const Beyond there = beyond(state, pixelRad);
  // What lib/background.glsl finds in uPlanets.
  Image<float>& texels = planetTexels_;
  if (texels.data.empty()) texels = Image<float>(2 * sky::kPlanetCount + 1, 1, 4);
  const auto texel = [&](int i, const glm::vec3& v, float w) {
    for (int c = 0; c < 3; ++c) texels.at(i, 0, c) = v[c];
    texels.at(i, 0, 3) = w;
  };
  texel(0, {there.stars, there.milkyWay, static_cast<float>(there.planets.count)}, 0.0f);
  for (int i = 0; i < there.planets.count; ++i) {
    const sky::PlanetSpot& spot = there.planets.spots[static_cast<std::size_t>(i)];
    texel(2 * i + 1, spot.direction, spot.leastRad);
    texel(2 * i + 2, spot.illuminance, spot.brighter);
  }
  put(planets_, texels, kStarTexels);
  program.bind("uPlanets", planets_);
  if (there.stars <= 0.0f && there.milkyWay <= 0.0f) {
    if (noStars_.id() == 0) noStars_ = gpu::Texture2D(Image<float>(1, 1, 4), kStarTexels);
    program.bind("uStars", noStars_);  // which holds none
    program.set("uStarCells", 1);
    program.bind("uMilkyWay", noStars_);
    return;
  }
  makeStars(state, pixelRad);
  const Stars& stars = stars_[static_cast<std::size_t>(sky::starLevel(pixelRad))];
  program.bind("uMilkyWay", milkyWay_);
  program.bind("uStars", stars.texture);
  program.set("uStarCells", stars.cells);
}

}  // namespace welkin::render
