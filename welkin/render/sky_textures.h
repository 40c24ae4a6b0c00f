// SPDX-License-Identifier: Apache-2.0
// The tables of the clear sky on the GPU: what lib/sky_uniforms.glsl samples. Kept from sky to sky.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/scene/sky_state.h"
#include "welkin/sky/atmosphere.h"

namespace welkin::render {

class SkyTextures {
 public:
  // Computes the tables for a sky and its eye, and uploads them.
  void update(const scene::SkyState& state);
  // The same for frame after frame: the tables of two key instants, kKeyS apart, blended. Costs next to
  // nothing but where a key instant is passed. A pure function of the scene and the instant as well, whatever
  // was asked for before: blended linearly, tables of an interval differ from exact ones by less than a part
  // in a hundred at dusk.
  void updateLive(const scene::SkyState& state);
  static constexpr double kKeyS = 30.0;
  // Binds those that the program asks for.
  void bind(const gpu::Program& program) const;

 private:
  struct Key {
    double atS = 0.0;
    bool bySun = false;  // which light the azimuths count from
    sky::SkyTables tables;
  };
  const Key& keyAt(const scene::SkyState& state, double atS);
  void upload(const scene::SkyState& state, const sky::SkyTables& tables);

  std::shared_ptr<const sky::Atmosphere> atmosphere_;  // that the keys are of
  double eyeAltitudeM_ = 0.0;
  std::array<std::optional<Key>, 2> keys_;
  sky::SkyTables blended_;
  std::optional<std::pair<double, int>> shown_;  // key instant and weight that are uploaded
  gpu::Texture2D transmittance_, skyView_, keyLight_;
  gpu::Texture3D inscatter_, through_;
};

}  // namespace welkin::render
