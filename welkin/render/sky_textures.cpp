// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sky_textures.h"

#include <algorithm>
#include <cmath>

#include "welkin/optics/ice_phase.h"
#include "welkin/optics/mie_droplets.h"
#include "welkin/optics/rain_phase.h"
#include "welkin/render/programs.h"
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

double eyeAltitude(const scene::SkyState& state) {
  return state.scene.place.altitudeM + state.scene.camera.eyeM;
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
Beyond beyond(const scene::SkyState& state, float pixelRad, double eyeM) {
  if (!state.scene.output.stars) return {};
  const double sunDeg = sky::darknessElevationDeg(state.ephemeris);
  return {sky::starlightShare(sunDeg), sky::milkyWayShare(sunDeg),
          sky::planetSpots(state.ephemeris, eyeM, pixelRad)};
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

void SkyTextures::prepareLight(scene::SkyState& state) {
  pace_.moveTo(state.secondsAfter, scene::ClearSkyKey::kKeyS);
  if (lightAtS_ != pace_.next()) {
    lightAtS_ = pace_.next();
    light_.start(state, *lightAtS_);
  }
  constexpr int kParts = scene::ClearSkyKeyInProgress::kParts;
  const int upTo = static_cast<int>(std::ceil(pace_.due() * kParts));
  light_.computeTo(upTo);
  if (upTo == kParts) state.clearSkyAhead = light_.key();
}

void SkyTextures::updateLive(scene::SkyState& state) {
  updatePhases(state);
  if (atmosphere_ != state.atmosphere) {
    atmosphere_ = state.atmosphere;
    shown_.reset();
    lightAtS_.reset();
    pace_ = {};
  }
  updateLights(state);
  prepareLight(state);
}

void SkyTextures::lookFrom(const scene::SkyState& state, const scene::EyeAir& air, double eyeM,
                           unsigned view) {
  shading::eyeUniforms(air, eyeM, eye_);
  const SkyTableKeys::Place place = SkyTableKeys::placeOf(state, eyeM);
  keys_.keep(place, view);
  if (shown_ != place) {
    keys_.blend(state, place, blended_);
    upload(state, blended_);
    shown_ = place;
  }
  keys_.prepare(state, place, eyeM, view);
}

void SkyTextures::bind(gpu::Program& program) const {
  setUniforms(program, eye_);
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

bool SkyTextures::isAnythingBeyond(const scene::SkyState& state, float pixelRad, double eyeM) {
  const Beyond there = beyond(state, pixelRad, eyeM);
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

void SkyTextures::bindStars(gpu::Program& program, const scene::SkyState& state, float pixelRad,
                            double eyeM) {
  if (!program.has("uStars")) return;
  const Beyond there = beyond(state, pixelRad, eyeM);
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
