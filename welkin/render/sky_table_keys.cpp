// SPDX-License-Identifier: Apache-2.0
#include "welkin/render/sky_table_keys.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace welkin::render {
namespace {

constexpr double kLeastStepM = 125.0, kMostStepM = 2500.0;
constexpr double kSteps = 8.0;  // the height is so many steps
// From where on steps are the longest, and its level.
const double kFarM = kSteps * (kMostStepM - kLeastStepM),
             kFarLevel = kSteps * std::log1p(kFarM / (kSteps * kLeastStepM));

constexpr double kHighestM = 1e8;  // from where on all is one
constexpr double kKeyS = scene::ClearSkyKey::kKeyS;
// Rounds of all views that a key is kept for after its last use.
constexpr std::uint64_t kKeptFor = 2;
// Those about an eye that moves while time runs, the next in time and in height, and those of another eye.
constexpr std::size_t kAtLeast = 16;
// The least share that is made ahead: until so much is due, the memory of keys gone by is free again.
constexpr double kLeastShare = 1.0 / 8.0;

template <class Table, class Of>
void blendInto(std::span<const std::pair<const sky::SkyTables*, float>> parts, const Of& of, Table& out) {
  const Table& first = of(*parts[0].first);
  if (out.data.size() != first.data.size()) out = first;
  for (std::size_t i = 0; i < out.data.size(); ++i) out.data[i] = parts[0].second * first.data[i];
  for (const auto& [tables, weight] : parts.subspan(1)) {
    const Table& part = of(*tables);
    for (std::size_t i = 0; i < out.data.size(); ++i) out.data[i] += weight * part.data[i];
  }
}

}  // namespace

double SkyTableKeys::heightM(int level) {
  const double u = level;
  return u < kFarLevel ? kSteps * kLeastStepM * std::expm1(u / kSteps) : kFarM + (u - kFarLevel) * kMostStepM;
}

double SkyTableKeys::levelOf(double heightM) {
  const double h = std::clamp(heightM, 0.0, kHighestM);
  return h < kFarM ? kSteps * std::log1p(h / (kSteps * kLeastStepM)) : kFarLevel + (h - kFarM) / kMostStepM;
}

SkyTableKeys::Place SkyTableKeys::placeOf(const scene::SkyState& state, double eyeM) {
  Place place;
  place.bySun = state.litBySun;
  place.atS = std::floor(state.secondsAfter / kKeyS) * kKeyS;
  place.instantWeight = static_cast<int>((state.secondsAfter - place.atS) / kKeyS * kWeights);
  // By height, not by level, in which the tables are straighter.
  const double heightOfEye = std::clamp(eyeM, 0.0, kHighestM);
  place.level = static_cast<int>(levelOf(heightOfEye));
  const double below = heightM(place.level), above = heightM(place.level + 1);
  place.heightWeight =
      std::clamp(static_cast<int>((heightOfEye - below) / (above - below) * kWeights), 0, kWeights - 1);
  return place;
}

// visit(name, weight) of those of four keys that count.
template <class Visit>
void SkyTableKeys::forCorners(const Place& place, const Visit& visit) {
  const float t = static_cast<float>(place.instantWeight) / kWeights,
              h = static_cast<float>(place.heightWeight) / kWeights;
  for (int later = 0; later < 2; ++later)
    for (int higher = 0; higher < 2; ++higher) {
      const float weight = (later ? t : 1.0f - t) * (higher ? h : 1.0f - h);
      if (weight > 0.0f) visit(Name{place.atS + later * kKeyS, place.level + higher, place.bySun}, weight);
    }
}

SkyTableKeys::Key& SkyTableKeys::find(const scene::SkyState& state, const Name& name) {
  if (atmosphere_ != state.atmosphere) {
    atmosphere_ = state.atmosphere;
    for (const auto& key : keys_) key->name.reset();
  }
  const double ground = state.scene.place.altitudeM;
  const auto start = [&](Key& key, const Name& of) {
    // Sun and moon in the order that the instant has, even where they have changed places by the key instant.
    const scene::SkyLights lights = scene::lightsAt(state.scene, of.atS);
    auto ordered = lights.lights;
    if (lights.bySun != of.bySun) std::swap(ordered[0], ordered[1]);
    key.tables.start(*atmosphere_, ground + heightM(of.level), ordered);
  };
  while (keys_.size() < kAtLeast) {  // their memory, so that no later frame has to wait for it
    keys_.push_back(std::make_unique<Key>());
    start(*keys_.back(), name);
  }
  Key* place = nullptr;
  for (const auto& key : keys_) {
    if (key->name == name) {
      key->used = round_;
      return *key;
    }
    const bool free = !key->name || round_ - key->used > kKeptFor;
    if (free && (!place || (place->name && (!key->name || key->used < place->used)))) place = key.get();
  }
  if (!place) place = keys_.emplace_back(std::make_unique<Key>()).get();
  start(*place, name);
  place->name = name;
  place->used = round_;
  return *place;
}

void SkyTableKeys::make(const scene::SkyState& state, const Name& name, double share) {
  if (share < kLeastShare || name.level < 0) return;
  Key& key = find(state, name);
  key.tables.computeTo(static_cast<int>(std::ceil(share * key.tables.rows())));
}

void SkyTableKeys::blend(const scene::SkyState& state, const Place& place, sky::SkyTables& out) {
  std::array<std::pair<const sky::SkyTables*, float>, 4> parts;
  std::size_t count = 0;
  forCorners(place, [&](const Name& name, float weight) {
    make(state, name, 1.0);
    parts[count++] = {&find(state, name).tables.tables(), weight};
  });
  const std::span there(parts.data(), count);
  blendInto(there, [](const sky::SkyTables& t) -> const Image<float>& { return t.skyView; }, out.skyView);
  blendInto(
      there, [](const sky::SkyTables& t) -> const Volume<float>& { return t.aerialInscatter; },
      out.aerialInscatter);
  blendInto(
      there, [](const sky::SkyTables& t) -> const Volume<float>& { return t.aerialTransmittance; },
      out.aerialTransmittance);
}

void SkyTableKeys::keep(const Place& place, unsigned view) {
  if (view == 0) ++round_;
  forCorners(place, [&](const Name& name, float) {
    for (const auto& key : keys_)
      if (key->name == name) key->used = round_;
  });
}

void SkyTableKeys::prepare(const scene::SkyState& state, const Place& place, double eyeM, unsigned view) {
  instants_.moveTo(state.secondsAfter, kKeyS);
  const int levels = place.heightWeight > 0 ? 2 : 1, instants = place.instantWeight > 0 ? 2 : 1;
  for (int l = 0; l < levels; ++l)
    make(state, {instants_.next(), place.level + l, place.bySun}, instants_.due());
  if (view != 0) return;
  heights_.moveTo(levelOf(eyeM), 1.0);
  for (int i = 0; i < instants; ++i)
    make(state, {place.atS + i * kKeyS, static_cast<int>(heights_.next()), place.bySun}, heights_.due());
}

}  // namespace welkin::render
