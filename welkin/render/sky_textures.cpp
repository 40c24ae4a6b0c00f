// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sky_textures.h"

#include "welkin/shading/uniforms.h"
#include "welkin/sky/atmosphere.h"

namespace welkin::render {
namespace {

constexpr gpu::TextureOptions kHalf{.format = gpu::Format::kRgba16F}, kFull{.format = gpu::Format::kRgba32F};

template <class Texture, class Table>
void put(Texture& texture, const Table& table, const gpu::TextureOptions& options) {
  if (texture.id() == 0)
    texture = Texture(table, options);
  else
    texture.upload(table);  // tables of one kind have one size
}

}  // namespace

void SkyTextures::update(const scene::SkyState& state) {
  const sky::SkyTables tables = sky::makeSkyTables(
      *state.atmosphere, state.scene.place.altitudeM + state.scene.camera.eyeM, state.lights);
  put(transmittance_, state.atmosphere->transmittance(), kHalf);
  put(skyView_, tables.skyView, kFull);
  put(keyLight_, shading::keyLightTable(state), kFull);
  put(inscatter_, tables.aerialInscatter, kFull);
  put(through_, tables.aerialTransmittance, kHalf);
}

void SkyTextures::bind(const gpu::Program& program) const {
  program.bind("uTransmittance", transmittance_);
  program.bind("uSkyView", skyView_);
  program.bind("uKeyLight", keyLight_);
  program.bind("uAerialInscatter", inscatter_);
  program.bind("uAerialTransmittance", through_);
}

}  // namespace welkin::render
