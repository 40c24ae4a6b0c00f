// SPDX-License-Identifier: Apache-2.0
#include "welkin/weather/metar_remarks.h"

#include <algorithm>
#include <array>
#include <vector>

#include "welkin/weather/genus.h"
#include "welkin/weather/metar_groups.h"

namespace welkin::weather {
namespace {

using metar::Cursor;

struct Name {
  std::string_view code;
  std::optional<Genus> genus;  // empty: hides the sky and is no cloud
};

// The longer of two that begin alike stands first.
constexpr std::array<Name, 28> kNames = {{
    {"ACC", Genus::kAltocumulus},
    {"TCU", Genus::kCumulus},
    {"BLSN", {}},
    {"CU", Genus::kCumulus},
    {"CF", Genus::kCumulus},
    {"SC", Genus::kStratocumulus},
    {"ST", Genus::kStratus},
    {"SF", Genus::kStratus},
    {"NS", Genus::kNimbostratus},
    {"CB", Genus::kCumulonimbus},
    {"AC", Genus::kAltocumulus},
    {"AS", Genus::kAltostratus},
    {"CI", Genus::kCirrus},
    {"CC", Genus::kCirrocumulus},
    {"CS", Genus::kCirrostratus},
    {"FG", {}},
    {"BR", {}},
    {"SN", {}},
    {"SG", {}},
    {"RA", {}},
    {"DZ", {}},
    {"IC", {}},
    {"PL", {}},
    {"HZ", {}},
    {"FU", {}},
    {"DU", {}},
    {"SA", {}},
    {"VA", {}},
}};

const Name* eatName(Cursor& c) {
  for (const Name& name : kNames)
    if (c.eat(name.code)) return &name;
  return nullptr;
}

MetarCloudType typeOf(const Name& name) {
  return name.code == "TCU"  ? MetarCloudType::kToweringCumulus
         : name.code == "CB" ? MetarCloudType::kCumulonimbus
                             : MetarCloudType::kNone;
}

std::optional<int> eatOktas(Cursor& c) {
  if (c.peek() < '0' || c.peek() > '8') return {};
  return c.digits(1);
}

// 1CU030
bool readWithBase(Cursor c, Metar& metar) {
  const auto oktas = eatOktas(c);
  const Name* name = oktas ? eatName(c) : nullptr;
  const auto hundreds = name ? c.digits(3) : std::nullopt;
  if (!hundreds || !c.done() || !name->genus) return false;
  metar.cloudRemarks.push_back({*name->genus, typeOf(*name), *oktas, *hundreds * 100});
  return true;
}

// SC4AS2, FG2SC3
bool readInOrder(Cursor c, Metar& metar) {
  std::vector<MetarCloudRemark> read;
  while (!c.done()) {
    const Name* name = eatName(c);
    const auto oktas = name ? eatOktas(c) : std::nullopt;
    if (!oktas) return false;
    if (name->genus) read.push_back({*name->genus, typeOf(*name), *oktas, {}});
  }
  metar.cloudRemarks.insert(metar.cloudRemarks.end(), read.begin(), read.end());
  return true;
}

// 8/571, 8/6//
bool readCodes(Cursor c, Metar& metar) {
  if (!c.eat("8/") || c.size() != 3 || metar.cloudCodes) return false;
  MetarCloudCodes codes;
  for (auto* code : {&codes.low, &codes.middle, &codes.high}) {
    if (c.eat('/')) continue;
    *code = c.digits(1);
    if (!*code) return false;
  }
  metar.cloudCodes = codes;
  return true;
}

// WMO-No. 306, code table 0513; 8 is cumulus beneath stratocumulus.
std::optional<Genus> lowGenus(int code, bool lowest) {
  switch (code) {
    case 1:
    case 2:
      return Genus::kCumulus;
    case 3:
    case 9:
      return Genus::kCumulonimbus;
    case 4:
    case 5:
      return Genus::kStratocumulus;
    case 6:
    case 7:
      return Genus::kStratus;
    case 8:
      return lowest ? Genus::kCumulus : Genus::kStratocumulus;
    default:
      return {};
  }
}

// Table 0515: 2 is thick altostratus, or nimbostratus.
std::optional<Genus> middleGenus(int code, bool steady) {
  if (code == 0) return {};
  if (code == 1) return Genus::kAltostratus;
  if (code == 2) return steady ? Genus::kNimbostratus : Genus::kAltostratus;
  return Genus::kAltocumulus;
}

// Table 0509.
std::optional<Genus> highGenus(int code) {
  if (code == 0) return {};
  if (code <= 5) return Genus::kCirrus;
  return code == 9 ? Genus::kCirrocumulus : Genus::kCirrostratus;
}

// Whether the genus exists at the height, generously.
bool fits(Genus genus, double baseM, const Levels& levels) {
  if (isIce(genus)) return baseM >= levels.middleBaseM;
  const bool middle = genus == Genus::kAltocumulus || genus == Genus::kAltostratus;
  return baseM < (middle ? 1.3 : 1.0) * levels.highBaseM;
}

void name(NamedLayer& layer, std::optional<Genus> genus, MetarCloudType type, const Levels& levels) {
  if (!genus || layer.type != MetarCloudType::kNone || !fits(*genus, layer.baseM, levels)) return;
  layer.genus = genus;
  layer.type = *genus == Genus::kCumulonimbus ? MetarCloudType::kCumulonimbus : type;
}

void nameByCodes(const MetarCloudCodes& codes, const Levels& levels, bool steady,
                 std::span<NamedLayer> layers) {
  const auto isLow = [&](const NamedLayer& l) { return l.baseM < levels.middleBaseM; };
  const auto low = std::count_if(layers.begin(), layers.end(), isLow);
  const auto lowIsPlain = [&](int code) {
    if (code == 3 || code == 9) return low == 1;
    return code != 8 || low > 1;
  };
  for (std::size_t i = 0; i < layers.size(); ++i) {
    std::optional<Genus> genus;
    if (layers[i].baseM >= levels.highBaseM) {
      if (codes.high) genus = highGenus(*codes.high);
    } else if (!isLow(layers[i])) {
      if (codes.middle) genus = middleGenus(*codes.middle, steady);
    } else if (codes.low && lowIsPlain(*codes.low)) {
      genus = lowGenus(*codes.low, i == 0);
    }
    name(layers[i], genus, MetarCloudType::kNone, levels);
  }
}

}  // namespace

bool readCloudRemark(std::string_view group, Metar& metar) {
  const Cursor c(group);
  return readWithBase(c, metar) || readInOrder(c, metar) || readCodes(c, metar);
}

void nameByRemarks(const Metar& metar, double latitudeDeg, bool steady, std::span<NamedLayer> layers) {
  const Levels levels = levelsAt(latitudeDeg);
  const auto& remarks = metar.cloudRemarks;
  if (metar.cloudCodes) nameByCodes(*metar.cloudCodes, levels, steady, layers);
  const bool anyBase =
      std::any_of(remarks.begin(), remarks.end(), [](const auto& r) { return r.baseFt.has_value(); });
  if (!anyBase && remarks.size() == layers.size()) {
    for (std::size_t i = 0; i < layers.size(); ++i)
      name(layers[i], remarks[i].genus, remarks[i].type, levels);
    return;
  }
  std::vector<bool> taken(layers.size(), false);
  for (const MetarCloudRemark& remark : remarks) {
    for (std::size_t i = 0; i < layers.size() && remark.baseFt; ++i) {
      if (taken[i] || layers[i].baseFt != remark.baseFt) continue;
      taken[i] = true;
      name(layers[i], remark.genus, remark.type, levels);
      break;
    }
  }
}

}  // namespace welkin::weather
