// SPDX-License-Identifier: Apache-2.0
// The tables of the clear sky on the GPU: what lib/sky_uniforms.glsl samples. Kept from sky to sky.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/render/key_pace.h"
#include "welkin/render/sky_table_keys.h"
#include "welkin/scene/sky_state.h"
#include "welkin/shading/uniforms.h"
#include "welkin/sky/atmosphere.h"
#include "welkin/sky/star_cells.h"

namespace welkin::render {

class SkyTextures {
 public:
  // Computes the tables for a sky and its eye, and uploads them.
  void update(const scene::SkyState& state);
  // The same for frame after frame, with updateLive() when time moves on and lookFrom() before each view is
  // drawn: the tables of two key instants (scene::ClearSkyKey) and of two key heights (SkyTableKeys),
  // blended. A pure function of the scene, the instant and the eye's height as well, whatever was asked for
  // before; blended linearly, tables differ from exact ones by less than a part in a hundred at dusk.
  //
  // While time runs through an interval, the tables of the key instant after it are made a few rows at a
  // time, and with them state.clearSkyAhead, so that no frame has to wait for them; so are those of the next
  // key height while an eye climbs or sinks, that of view 0. Where time or the eye jumps, or the sun hands
  // over to the moon, they are made at once. Allocates nothing after the first view, unless views are at many
  // heights.
  void updateLive(scene::SkyState& state);
  // air: about the eye.
  void lookFrom(const scene::SkyState& state, const scene::EyeAir& air, double eyeM, unsigned view);
  // Binds those that the program asks for, and after lookFrom() sets the uniforms of its eye.
  void bind(gpu::Program& program) const;
  // Whether stars, planets or the Milky Way are drawn in pictures with pixels of the given size: by programs
  // with WELKIN_BEYOND, as they cost a rasteriser on the processor much by day too.
  static bool isAnythingBeyond(const scene::SkyState& state, float pixelRad, double eyeM);
  // Binds them, for such programs. Their textures are made then, once for pixels of one level
  // (sky/star_cells.h) and one scene time; or before, so that no frame at dusk has to wait for them.
  void bindStars(gpu::Program& program, const scene::SkyState& state, float pixelRad, double eyeM);
  void makeStars(const scene::SkyState& state, float pixelRad);

 private:
  void updatePhases(const scene::SkyState& state);
  void updateLights(const scene::SkyState& state);
  void prepareLight(scene::SkyState& state);
  void upload(const scene::SkyState& state, const sky::SkyTables& tables);

  SkyTableKeys keys_;
  std::optional<SkyTableKeys::Place> shown_;  // whose tables are uploaded
  sky::SkyTables blended_;
  shading::Uniforms eye_;
  std::shared_ptr<const sky::Atmosphere> atmosphere_;  // that shown_ and light_ are of
  scene::ClearSkyKeyInProgress light_;                 // of the key instant that comes next
  std::optional<double> lightAtS_;
  KeyPace pace_;
  Image<float> lightTable_;
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
