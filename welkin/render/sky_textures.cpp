// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sky_textures.h"

#include <cmath>

#include "welkin/shading/uniforms.h"
#include "welkin/sky/atmosphere.h"

namespace welkin::render {
namespace {

constexpr gpu::TextureOptions kHalf{.format = gpu::Format::kRgba16F}, kFull{.format = gpu::Format::kRgba32F};

constexpr int kWeights = 64;

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

}  // namespace

void SkyTextures::upload(const scene::SkyState& state, const sky::SkyTables& tables) {
  put(transmittance_, state.atmosphere->transmittance(), kHalf);
  put(skyView_, tables.skyView, kFull);
  put(inscatter_, tables.aerialInscatter, kFull);
  put(through_, tables.aerialTransmittance, kHalf);
}

void SkyTextures::update(const scene::SkyState& state) {
  upload(state, sky::makeSkyTables(*state.atmosphere, eyeAltitude(state), state.lights));
  put(keyLight_, shading::keyLightTable(state), kFull);
  shown_.reset();
}

const SkyTextures::Key& SkyTextures::keyAt(const scene::SkyState& state, double atS) {
  for (const auto& key : keys_)
    if (key && key->atS == atS) return *key;
  // The older of the two goes: time mostly runs one way, and two keys are all that an instant needs.
  auto& place = !keys_[0] || (keys_[1] && std::abs(keys_[0]->atS - atS) > std::abs(keys_[1]->atS - atS))
                    ? keys_[0]
                    : keys_[1];
  const scene::SkyLights lights = scene::lightsAt(state.scene, atS);
  place = Key{atS, lights.bySun, sky::makeSkyTables(*state.atmosphere, eyeAltitude(state), lights.lights)};
  return *place;
}

void SkyTextures::updateLive(const scene::SkyState& state) {
  if (atmosphere_ != state.atmosphere || eyeAltitudeM_ != eyeAltitude(state)) {
    keys_ = {};
    shown_.reset();
    atmosphere_ = state.atmosphere;
    eyeAltitudeM_ = eyeAltitude(state);
  }
  put(keyLight_, shading::keyLightTable(state), kFull);
  const double before = std::floor(state.secondsAfter / kKeyS) * kKeyS;
  // Whole steps of the weight, so that pictures between them upload nothing.
  const int weight = static_cast<int>((state.secondsAfter - before) / kKeyS * kWeights);
  if (shown_ == std::pair{before, weight}) return;
  const Key& first = keyAt(state, before);
  if (first.bySun != state.litBySun || keyAt(state, before + kKeyS).bySun != state.litBySun) {
    // Sun and moon change places: their tables count azimuths from different lights.
    update(state);
    return;
  }
  const Key& a = keyAt(state, before);
  const Key& b = keyAt(state, before + kKeyS);
  const float w = static_cast<float>(weight) / kWeights;
  blend(a.tables.skyView, b.tables.skyView, w, blended_.skyView);
  blend(a.tables.aerialInscatter, b.tables.aerialInscatter, w, blended_.aerialInscatter);
  blend(a.tables.aerialTransmittance, b.tables.aerialTransmittance, w, blended_.aerialTransmittance);
  upload(state, blended_);
  shown_ = {before, weight};
}

void SkyTextures::bind(const gpu::Program& program) const {
  program.bind("uTransmittance", transmittance_);
  program.bind("uSkyView", skyView_);
  program.bind("uKeyLight", keyLight_);
  program.bind("uAerialInscatter", inscatter_);
  program.bind("uAerialTransmittance", through_);
}

}  // namespace welkin::render
