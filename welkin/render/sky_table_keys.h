// SPDX-License-Identifier: Apache-2.0
// Tables of the clear sky (sky/atmosphere.h) at key instants and key heights, for frame loops: made ahead of
// their time a few rows at a time, kept while they are in use, and blended in between.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "welkin/render/key_pace.h"
#include "welkin/scene/sky_state.h"
#include "welkin/sky/atmosphere.h"

namespace welkin::render {

class SkyTableKeys {
 public:
  // Key heights lie an eighth of the height apart, and at least 125 m: half a free path of haze (scale height
  // 1.2 km), a sixth of the air's from 20 km on. Blended linearly, skies differ from exact ones by half a
  // hundredth in the mean.
  static double heightM(int level);       // above the ground
  static double levelOf(double heightM);  // its inverse, and 0 below the ground

  // How far an instant and a height are from one key to the next: whole steps, so that little is uploaded.
  struct Place {
    double atS = 0.0;                         // the key instant before
    int level = 0;                            // the key height below
    int instantWeight = 0, heightWeight = 0;  // of kWeights
    bool bySun = true;
    bool operator==(const Place&) const = default;
  };
  static constexpr int kWeights = 64;
  static Place placeOf(const scene::SkyState& state, double eyeM);

  // Blends the tables of a place in the state's sky into `out`; what is not known yet is made at once.
  void blend(const scene::SkyState& state, const Place& place, sky::SkyTables& out);
  // Of every frame of every view: those of the place are in use, and others no longer once view 0 has come
  // round a few times.
  void keep(const Place& place, unsigned view);
  // Of every frame of every view: makes what comes next in time, and in height for view 0, as fast as it
  // comes.
  void prepare(const scene::SkyState& state, const Place& place, double eyeM, unsigned view);

 private:
  struct Name {
    double atS = 0.0;
    int level = 0;
    bool bySun = true;  // which light the azimuths count from
    bool operator==(const Name&) const = default;
  };
  struct Key {
    std::optional<Name> name;  // none: nothing in it yet
    std::uint64_t used = 0;    // in which round last
    sky::SkyTablesInProgress tables;
  };
  Key& find(const scene::SkyState& state, const Name& name);
  void make(const scene::SkyState& state, const Name& name, double share);
  template <class Visit>
  static void forCorners(const Place& place, const Visit& visit);

  std::shared_ptr<const sky::Atmosphere> atmosphere_;  // that the keys are of
  std::vector<std::unique_ptr<Key>> keys_;
  std::uint64_t round_ = 0;
  KeyPace instants_, heights_;
};

}  // namespace welkin::render
