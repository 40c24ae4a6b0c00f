// SPDX-License-Identifier: Apache-2.0
// The tables of the clear sky on the GPU: what lib/sky_uniforms.glsl samples. Kept from sky to sky.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/key_pace.h"
#include "welkin/scene/sky_state.h"
#include "welkin/sky/atmosphere.h"
#include "welkin/sky/star_cells.h"

namespace welkin::render {

class SkyTextures {
 public:
  // Computes the tables for a sky and its eye, and uploads them.
  void update(const scene::SkyState& state);
  // The same for frame after frame: the tables of two key instants (scene::ClearSkyKey), blended. A pure
  // function of the scene and the instant as well, whatever was asked for before: blended linearly, tables of
  // an interval differ from exact ones by less than a part in a hundred at dusk.
  //
  // While time runs through an interval, the tables of the key instant after it are made a few rows at a
  // time, and with them state.clearSkyAhead, so that no frame has to wait for them. Where time jumps, or the
  // sun hands over to the moon, two key instants are made at once. Allocates nothing once it has made three.
  void updateLive(scene::SkyState& state);
  // Binds those that the program asks for.
  void bind(const gpu::Program& program) const;
  // Whether stars, planets or the Milky Way are drawn in pictures with pixels of the given size: by programs
  // with WELKIN_BEYOND, as they cost a rasteriser on the processor much by day too.
  static bool isAnythingBeyond(const scene::SkyState& state, float pixelRad);
  // Binds them, for such programs. Their textures are made then, once for pixels of one level
  // (sky/star_cells.h) and one scene time; or before, so that no frame at dusk has to wait for them.
  void bindStars(gpu::Program& program, const scene::SkyState& state, float pixelRad);
  void makeStars(const scene::SkyState& state, float pixelRad);

 private:
  struct KeyName {
    double atS = 0.0;
    bool bySun = false;  // which light the azimuths count from
    bool operator==(const KeyName&) const = default;
  };
  struct Key {
    std::optional<KeyName> name;  // none: nothing in it yet
    sky::SkyTables tables;
  };
  // The key instant that comes next, being made.
  struct Ahead {
    std::optional<KeyName> name;
    double startedAt = 0.0;  // share of the interval that had passed
    sky::SkyTablesInProgress tables;
    scene::ClearSkyKeyInProgress light;
  };
  void keep(const scene::SkyState& state, KeyName first, KeyName second);
  void make(const scene::SkyState& state, KeyName name, Key& key);
  void start(const scene::SkyState& state, KeyName name, double startedAt);
  void prepareNext(scene::SkyState& state);
  void updatePhases(const scene::SkyState& state);
  void updateLights(const scene::SkyState& state);
  void upload(const scene::SkyState& state, const sky::SkyTables& tables);

  std::shared_ptr<const sky::Atmosphere> atmosphere_;  // that the keys are of
  double eyeAltitudeM_ = 0.0;
  std::array<Key, 2> keys_;  // before and after the instant
  Ahead ahead_;
  KeyPace pace_;
  sky::SkyTables blended_;
  Image<float> lightTable_;
  std::optional<std::pair<KeyName, int>> shown_;  // first key instant and weight that are uploaded
  gpu::Texture2D transmittance_, skyView_, keyLight_, secondLight_;
  gpu::Texture3D inscatter_, through_;
  std::optional<double> mieDiameterUm_;  // that mieDroplets_ is of
  gpu::Texture2D mieDroplets_, icePhase_, rainPhase_;
  struct Stars {
    gpu::Texture2D texture;
    int cells = 0;
  };
  std::array<Stars, sky::kStarLevels> stars_;  // by level; of the time
  std::optional<UtcTime> starsTime_;
  gpu::Texture2D noStars_, milkyWay_, planets_;
  Image<float> planetTexels_;
};

}  // namespace welkin::render
