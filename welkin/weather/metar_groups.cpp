// SPDX-License-Identifier: Apache-2.0
#include "welkin/weather/metar_groups.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "welkin/core/units.h"

namespace welkin::weather::metar {
namespace {

// A number of exactly `count` figures, or as many solidi for a missing one. Returns false when neither stands
// there.
bool digitsOrSolidi(Cursor& c, std::size_t count, std::optional<int>& value) {
  if (c.size() >= count && isAllSolidi(c.rest().substr(0, count))) {
    c.skip(count);
    value.reset();
    return true;
  }
  value = c.digits(count);
  return value.has_value();
}

// As above with figures and solidi mixed, where the value does not matter to us.
bool skipDigitsOrSolidi(Cursor& c, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (!isDigit(c.peek()) && c.peek() != '/') return false;
    c.skip(1);
  }
  return true;
}

// The fastest gust on record is 113 m/s (Barrow Island, 1996); anything above this is a slip of the key.
constexpr double kMaxWindMps = 130.0;

// No cloud of the weather has its base above 18 km (high clouds of the tropics, WMO Cloud Atlas).
constexpr int kMaxHundredsOfFeet = 600;

// Signed tenths of the T group: a 1 stands for minus (FMH-1, 12.7.2.c).
bool signedTenths(Cursor& c, std::optional<double>& value) {
  const auto sign = c.digits(1);
  const auto tenths = c.digits(3);
  if (!sign || *sign > 1 || !tenths) return false;
  // Not -0.0, which would print as such.
  value = (*sign == 1 && *tenths != 0 ? -*tenths : *tenths) / 10.0;
  return true;
}

bool celsius(Cursor& c, std::optional<double>& value) {
  value.reset();
  if (c.eat("//") || c.eat("XX")) return true;
  const bool minus = c.eat('M');
  const auto degrees = c.digits(2);
  if (!degrees) return false;
  value = minus && *degrees != 0 ? -*degrees : *degrees;
  return true;
}

template <std::size_t n>
bool eatAny(Cursor& c, const std::array<std::string_view, n>& words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view w) { return c.eat(w); });
}

constexpr std::array<std::string_view, 8> kCompass = {"NE", "NW", "SE", "SW", "N", "E", "S", "W"};

// Code table 4678 of WMO-No. 306, two letters each.
constexpr std::string_view kDescriptors = "MIBCPRDRBLSHTSFZ";
constexpr std::string_view kPrecipitation = "DZRASNSGICPLGRGSUP";
constexpr std::string_view kObscurationAndOther = "BRFGFUVADUSAHZPYPOSQFCSSDS";

bool eatPair(Cursor& c, std::string_view pairs) {
  if (c.size() < 2) return false;
  const char first = c.rest()[0], second = c.rest()[1];
  for (std::size_t i = 0; i < pairs.size(); i += 2) {
    if (pairs[i] == first && pairs[i + 1] == second) {
      c.skip(2);
      return true;
    }
  }
  return false;
}

// Whether one of the pairs stands in a text of pairs.
bool holdsAny(std::string_view text, std::string_view pairs) {
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2)
    for (std::size_t k = 0; k + 1 < text.size(); k += 2)
      if (text.substr(k, 2) == pairs.substr(i, 2)) return true;
  return false;
}

// Descriptor and phenomena, without what stands before them, as code table 4678 has them together. FZUP is of
// WMO-No. 49 and BLPY of FMH-1.
bool isWeatherBody(Cursor c, bool intensity) {
  const std::string_view word = c.rest().substr(0, 2);
  const std::string_view descriptor = eatPair(c, kDescriptors) ? word : std::string_view();
  const bool showers = descriptor == "TS" || descriptor == "SH";
  const std::string_view phenomena = c.rest();
  if (phenomena.empty()) return showers;  // which need no phenomenon
  if (eatPair(c, kObscurationAndOther)) {
    if (!c.done() || (intensity && !holdsAny(phenomena, "FCDSSS"))) return false;
    if (descriptor.empty()) return true;
    if (descriptor == "BL") return holdsAny(phenomena, "DUSAPY");
    if (descriptor == "DR") return holdsAny(phenomena, "DUSA");
    return phenomena == "FG" && !showers;
  }
  std::size_t count = 0;
  while (count < 3 && eatPair(c, kPrecipitation)) {
    if (holdsAny(phenomena.substr(0, 2 * count), phenomena.substr(2 * count, 2))) return false;
    ++count;
  }
  if (count == 0 || !c.done()) return false;
  if (descriptor == "FZ") return holdsAny(phenomena, "DZRAUP");
  if (descriptor == "BL" || descriptor == "DR") return phenomena == "SN";
  return descriptor.empty() || showers;
}

bool isMadeOfWeather(Cursor c) {
  while (eatPair(c, kDescriptors) || eatPair(c, kPrecipitation) || eatPair(c, kObscurationAndOther)) {
  }
  return c.done();
}

bool eatRunway(Cursor& c) {
  if (!c.eat('R') || !c.digits(2)) return false;
  // RR and LL were in use for outer parallel runways.
  if (c.eat('L')) {
    c.eat('L');
  } else if (c.eat('R')) {
    c.eat('R');
  } else {
    c.eat('C');
  }
  return c.eat('/');
}

bool eatVisualRange(Cursor& c) {
  if (!c.eat('M')) c.eat('P');
  std::optional<int> range;
  return digitsOrSolidi(c, 4, range);
}

// 1200, M0050VP1500U, P6000FT, ////, 0600FT/D
bool isVisualRange(Cursor c) {
  if (!eatVisualRange(c)) return false;
  if (c.eat('V') && !eatVisualRange(c)) return false;
  c.eat("FT");
  c.eat('/');
  if (!c.eat('U') && !c.eat('D') && !c.eat('N')) c.eat('/');
  return c.done();
}

// Deposit, extent, depth and friction: 290050, 59//50, CLRD70, SNOCLO
bool isRunwayState(Cursor c) {
  if (c.eat("SNOCLO")) return c.done();
  if (c.eat("CLRD")) return skipDigitsOrSolidi(c, 2) && c.done();
  return skipDigitsOrSolidi(c, 6) && c.done();
}

}  // namespace

std::optional<int> Cursor::digits(std::size_t count) {
  if (rest_.size() < count) return {};
  int value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!isDigit(rest_[i])) return {};
    value = 10 * value + (rest_[i] - '0');
  }
  rest_.remove_prefix(count);
  return value;
}

std::optional<int> Cursor::digits(std::size_t least, std::size_t most) {
  std::size_t count = 0;
  while (count < rest_.size() && isDigit(rest_[count])) ++count;
  if (count < least || count > most) return {};
  return digits(count);
}

bool isAllSolidi(std::string_view text) {
  return !text.empty() && text.find_first_not_of('/') == std::string_view::npos;
}

std::optional<TimeGroup> readTime(std::string_view text) {
  if (text.size() != 7) return {};
  Cursor c(text);
  const auto day = c.digits(2), hour = c.digits(2), minute = c.digits(2);
  if (!day || !hour || !minute || !c.eat('Z')) return {};
  if (*day < 1 || *day > 31 || *hour > 23 || *minute > 59) return {};
  return TimeGroup{*day, *hour, *minute};
}

std::optional<MetarWind> readWind(std::string_view text) {
  // The cheapest thing that a wind has and the other groups have not.
  double mpsPerUnit = 0.0;
  if (text.ends_with("KT")) {
    mpsPerUnit = kMpsPerKnot;
    text.remove_suffix(2);
  } else if (text.ends_with("MPS")) {
    mpsPerUnit = 1.0;
    text.remove_suffix(3);
  } else if (text.ends_with("KMH")) {
    mpsPerUnit = kMpsPerKmh;
    text.remove_suffix(3);
  } else {
    return {};
  }
  Cursor c(text);
  MetarWind wind;
  wind.variable = c.eat("VRB");
  if (!wind.variable && !digitsOrSolidi(c, 3, wind.directionDeg)) return {};
  if (wind.directionDeg.value_or(0) > 360) return {};

  if (!c.eat("//")) {
    wind.speedAtLeast = c.eat('P');
    const auto speed = c.digits(2, 3);
    if (!speed) return {};
    wind.speedMps = *speed * mpsPerUnit;
  }
  if (c.eat('G')) {
    if (!c.eat("//")) {
      c.eat('P');
      const auto gust = c.digits(2, 3);
      if (!gust) return {};
      wind.gustMps = *gust * mpsPerUnit;
    }
  }
  if (!c.done()) return {};
  if (wind.directionDeg == 0 && wind.speedMps.value_or(0.0) > 0.0) return {};  // the north is 360
  if (std::max(wind.speedMps.value_or(0.0), wind.gustMps.value_or(0.0)) > kMaxWindMps) return {};
  if (wind.gustMps && wind.speedMps && *wind.gustMps < *wind.speedMps) return {};
  return wind;
}

std::optional<VariationGroup> readVariation(std::string_view text) {
  if (text.size() != 7 || text[3] != 'V') return {};
  Cursor c(text);
  VariationGroup v;
  if (!digitsOrSolidi(c, 3, v.fromDeg) || !c.eat('V') || !digitsOrSolidi(c, 3, v.toDeg)) return {};
  if (v.fromDeg.value_or(0) > 360 || v.toDeg.value_or(0) > 360) return {};
  return v;
}

std::optional<VisibilityGroup> readVisibilityMetres(std::string_view text) {
  if (text.size() < 3 || text.size() > 7) return {};
  Cursor c(text);
  VisibilityGroup v;
  if (text.ends_with("KM")) {
    const auto kilometres = c.digits(1, 2);
    if (!kilometres || !c.eat("KM")) return {};
    v.metres = *kilometres * 1000.0;
    return v;
  }
  if (c.eat('M')) {
    v.bound = MetarBound::kLessThan;
  } else if (c.eat('P')) {
    v.bound = MetarBound::kAtLeast;
  }
  std::optional<int> metres;
  if (!digitsOrSolidi(c, 4, metres)) return {};
  if (metres) v.metres = *metres;
  if (metres == 9999) {  // 10 km or more (WMO-No. 306, 15.6.1)
    v.metres = 10000.0;
    v.bound = MetarBound::kAtLeast;
  }
  if (c.done() || c.eat("NDV")) return c.done() ? std::optional(v) : std::nullopt;
  if (v.bound != MetarBound::kLessThan && c.eat('M')) return c.done() ? std::optional(v) : std::nullopt;
  v.directional = eatAny(c, kCompass);
  return v.directional && c.done() ? std::optional(v) : std::nullopt;
}

std::optional<VisibilityGroup> readVisibilityMiles(std::string_view text, std::optional<int> wholeMiles) {
  if (!text.ends_with("SM")) return {};
  text.remove_suffix(2);
  VisibilityGroup v;
  if (isAllSolidi(text)) return !wholeMiles && text.size() == 4 ? std::optional(v) : std::nullopt;
  Cursor c(text);
  if (!wholeMiles) {
    if (c.eat('M')) {
      v.bound = MetarBound::kLessThan;
    } else if (c.eat('P')) {
      v.bound = MetarBound::kAtLeast;
    }
  }
  const auto number = c.digits(1, 3);
  if (!number) return {};
  double miles = *number;
  if (c.eat('/')) {
    const auto parts = c.digits(1, 2);
    // Proper fractions only: 11/2SM would be 1 1/2 with its blank lost, or 5 1/2, and it is not for us to
    // choose.
    if (!parts || *number == 0 || *number >= *parts) return {};
    if (*parts != 2 && *parts != 4 && *parts != 8 && *parts != 16) return {};
    miles = wholeMiles.value_or(0) + static_cast<double>(*number) / *parts;
  } else if (wholeMiles) {
    return {};
  }
  if (!c.done()) return {};
  v.metres = miles * kMetresPerStatuteMile;
  return v;
}

bool isRunwayGroup(std::string_view text) {
  if (!text.starts_with('R')) return false;
  if (text == "R/SNOCLO") return true;
  Cursor c(text);
  return eatRunway(c) && (isVisualRange(c) || isRunwayState(c));
}

bool isOldRunwayState(std::string_view text) {
  if (text.size() != 8 || !isDigit(text[0]) || !isDigit(text[1])) return false;
  Cursor c(text.substr(2));
  if (c.eat("CLRD")) return skipDigitsOrSolidi(c, 2);
  return skipDigitsOrSolidi(c, 6);
}

bool isRunwayWithSnow(std::string_view text) {
  if (text.ends_with("SNOCLO")) return text == "SNOCLO" || isRunwayGroup(text);
  // Code table 0919: 4 dry snow, 5 wet snow, 8 compacted or rolled snow.
  const auto isSnow = [](char deposit) { return deposit == '4' || deposit == '5' || deposit == '8'; };
  if (isOldRunwayState(text)) return isSnow(text[2]);
  Cursor c(text);
  return isRunwayGroup(text) && eatRunway(c) && !isVisualRange(c) && isSnow(c.peek());
}

bool isPresentWeather(std::string_view text) {
  if (text == "//") return true;
  if (text.size() < 2 || text.size() > 11) return false;
  Cursor c(text);
  const bool light = c.eat('-'), intensity = light || c.eat('+');
  if (light && c.rest() == "FC") return false;  // + makes a tornado of it
  if (!intensity) c.eat("VC");
  return isWeatherBody(c, intensity);
}

bool isRecentWeather(std::string_view text) {
  Cursor c(text);
  return c.eat("RE") && (c.rest() == "//" || isWeatherBody(c, false));
}

bool isColourState(std::string_view text) {
  static constexpr std::array<std::string_view, 8> kColours = {"BLU",  "WHT", "GRN", "YLO1",
                                                               "YLO2", "YLO", "AMB", "RED"};
  Cursor c(text);
  int colours = c.eat("BLACK") ? 1 : 0;
  while (colours < 3 && eatAny(c, kColours)) {
    ++colours;
    c.eat('+');
  }
  return colours > 0 && c.done();
}

bool isSeaState(std::string_view text) {
  if (!text.starts_with('W')) return false;
  if (text.size() == 6 && isAllSolidi(text.substr(1))) return true;  // temperature and state both missing
  Cursor c(text.substr(1));
  c.eat('M');
  if (!skipDigitsOrSolidi(c, 2) || !c.eat('/')) return false;
  if (c.eat('S')) return skipDigitsOrSolidi(c, 1) && c.done();  // state of the sea, table 3700
  if (!c.eat('H')) return false;                                // significant wave height in decimetres
  return isAllSolidi(c.rest()) ? c.size() <= 3 : c.digits(1, 3) && c.done();
}

bool isNationalSupplement(std::string_view text) {
  Cursor c(text);
  if (c.eat("RF")) {  // Australia: rain in the last ten minutes / since nine o'clock
    return skipDigitsOrSolidi(c, 2) && c.eat('.') && skipDigitsOrSolidi(c, 1) && c.eat('/') &&
           skipDigitsOrSolidi(c, 3) && c.eat('.') && skipDigitsOrSolidi(c, 1) && c.done();
  }
  if (c.eat("DL-")) {  // Australia: distant lightning and where
    return eatAny(c, kCompass) && c.done();
  }
  if (c.eat("RH")) return c.digits(2, 3) && c.done();  // Pakistan: relative humidity
  if (c.eat("QBB")) return c.digits(3) && c.done();    // Russia: height of the lowest cloud
  if (c.eat("QFE")) {                                  // pressure at the aerodrome, mmHg or hPa, or both
    if (!c.digits(3, 4)) return false;
    return c.done() || (c.eat('/') && c.digits(1, 4) && c.done());
  }
  return false;
}

bool isTrendStart(std::string_view text) {
  if (text == "TEMPO" || text == "BECMG" || text == "INTER") return true;
  Cursor c(text);
  if (c.eat("PROB")) return c.digits(2) && c.done();
  if (c.eat("FM")) return (text.size() == 6 || text.size() == 8) && c.digits(4, 6) && c.done();
  return false;
}

std::optional<MetarLayer> readLayer(std::string_view text) {
  if (text.size() < 5 || text.size() > 9) return {};
  Cursor c(text);
  MetarLayer layer;
  if (c.eat("FEW")) {
    layer.cover = MetarCover::kFew;
  } else if (c.eat("SCT")) {
    layer.cover = MetarCover::kScattered;
  } else if (c.eat("BKN")) {
    layer.cover = MetarCover::kBroken;
  } else if (c.eat("OVC")) {
    layer.cover = MetarCover::kOvercast;
  } else if (!c.eat("///")) {
    return {};
  }
  const bool unknownCover = layer.cover == MetarCover::kUnknown;
  std::optional<int> hundredsOfFeet;
  if (digitsOrSolidi(c, 3, hundredsOfFeet)) {
    if (hundredsOfFeet.value_or(0) > kMaxHundredsOfFeet) return {};
    if (hundredsOfFeet) layer.baseFt = *hundredsOfFeet * 100;
  } else if (!unknownCover || c.done()) {
    return {};  // only an unknown amount may go without a height: the French ///CB
  }
  if (c.eat("CB")) {
    layer.type = MetarCloudType::kCumulonimbus;
  } else if (c.eat("TCU")) {
    layer.type = MetarCloudType::kToweringCumulus;
  } else {
    c.eat("///");
  }
  return c.done() ? std::optional(layer) : std::nullopt;
}

std::optional<MetarClear> readClear(std::string_view text) {
  if (text == "SKC") return MetarClear::kSkc;
  if (text == "CLR") return MetarClear::kClr;
  if (text == "NSC") return MetarClear::kNsc;
  if (text == "NCD") return MetarClear::kNcd;
  return {};
}

std::optional<VerticalVisibilityGroup> readVerticalVisibility(std::string_view text) {
  Cursor c(text);
  std::optional<int> hundredsOfFeet;
  if (!c.eat("VV") || !digitsOrSolidi(c, 3, hundredsOfFeet) || !c.done()) return {};
  if (hundredsOfFeet.value_or(0) > kMaxHundredsOfFeet) return {};
  VerticalVisibilityGroup v;
  if (hundredsOfFeet) v.feet = *hundredsOfFeet * 100;
  return v;
}

std::optional<TemperatureGroup> readTemperature(std::string_view text) {
  if (text.size() < 3 || text.size() > 7) return {};
  Cursor c(text);
  TemperatureGroup t;
  if (!celsius(c, t.temperatureC) || !c.eat('/')) return {};
  if (!c.done() && !celsius(c, t.dewPointC)) return {};
  if (!c.done()) return {};
  // 10/ leaves the dew point out; without either there is no such group: /// is a cloud or a colour.
  if (!t.temperatureC && !t.dewPointC && text != "/////" && text.front() == '/') return {};
  // The extremes of the record are 56.7 and -89.2 degrees.
  if (t.temperatureC.value_or(0.0) > 60.0 || t.temperatureC.value_or(0.0) < -95.0 ||
      t.dewPointC.value_or(0.0) > 60.0)
    return {};
  return t;
}

std::optional<TemperatureGroup> readExactTemperature(std::string_view text) {
  if (text.size() != 9 && text.size() != 5) return {};
  Cursor c(text);
  TemperatureGroup t;
  if (!c.eat('T') || !signedTenths(c, t.temperatureC)) return {};
  if (!c.done() && !signedTenths(c, t.dewPointC)) return {};
  return t;
}

std::optional<PressureGroup> readPressure(std::string_view text) {
  Cursor c(text);
  PressureGroup p;
  std::optional<int> number;
  if (c.eat("QNH")) {
    if (!digitsOrSolidi(c, 4, number) || !c.eat("INS")) return {};
    if (number) p.hpa = *number * 0.01 * kHpaPerInHg;
  } else if (c.eat('Q')) {
    if (!digitsOrSolidi(c, 4, number)) return {};
    if (number) p.hpa = *number;
    if (number && c.eat('/')) {  // the same in inches beside it: Q1013/2992, Q1003/29.62
      c.eat('A');
      const auto inches = c.digits(2);
      c.eat('.');
      const auto hundredths = c.digits(2);
      if (!inches || !hundredths) return {};
      if (std::abs((*inches + 0.01 * *hundredths) * kHpaPerInHg - *p.hpa) > kPressureRoundingHpa) return {};
    }
  } else if (c.eat('A')) {
    if (!digitsOrSolidi(c, 4, number)) return {};
    if (number) p.hpa = *number * 0.01 * kHpaPerInHg;
  } else {
    return {};
  }
  if (!c.done()) return {};
  // The record of pressure at sea level reaches from 870 to 1085 hPa.
  if (p.hpa && (*p.hpa < 850.0 || *p.hpa > 1100.0)) return {};
  return p;
}

std::string explainUnreadable(std::string_view shown, std::string_view text) {
  const auto say = [&](std::string_view what) {
    std::string s = "'";
    s += shown;
    s += "' ";
    s += what;
    return s;
  };
  const auto holds = [&](std::string_view part) { return text.find(part) != std::string_view::npos; };
  const bool digitFirst = !text.empty() && isDigit(text.front());
  const bool allDigits = !text.empty() && std::all_of(text.begin(), text.end(), isDigit);
  if (allDigits && text.size() == 5)
    return say("is neither a wind with its unit (24015KT) nor a visibility (4000, 9999)");
  if (text.ends_with("KT") || text.ends_with("MPS") || text.ends_with("KMH")) {
    return say("is not a possible wind such as 24015G25KT, VRB02KT or 05003MPS");
  }
  if (text.ends_with("SM")) return say("is not a visibility in miles such as 10SM, 1/2SM or 1 1/2SM");
  for (const std::string_view cover : {"FEW", "SCT", "BKN", "OVC"}) {
    if (text.starts_with(cover)) return say("is not a cloud group such as BKN014, FEW031/// or SCT020TCU");
  }
  if (text.starts_with("VV")) return say("is not a vertical visibility such as VV002 or VV///");
  if (text.starts_with('Q') || (text.starts_with('A') && text.size() > 1 && isDigit(text[1]))) {
    return say("is not a possible pressure such as Q1013 or A2992");
  }
  if (text.starts_with('R') && text.size() > 1 && isDigit(text[1])) {
    return say("is neither a runway visual range such as R24/0900 nor a runway state such as R24/290050");
  }
  if (digitFirst && holds("V") && text.size() == 7)
    return say("is not a possible range of wind directions such as 240V300");
  if (holds("/") && (digitFirst || text.starts_with('M') || text.starts_with('/'))) {
    return say("is not a possible temperature and dew point such as 12/M01");
  }
  if (digitFirst) return say("is not a visibility such as 4000, 9999 or 10SM");
  Cursor weather(text);
  if (!weather.eat('-') && !weather.eat('+')) weather.eat("VC");
  if (!weather.done() && isMadeOfWeather(weather))
    return say("is weather that code table 4678 does not have");
  if (text.starts_with('-') || text.starts_with('+') || text.starts_with("VC")) {
    return say("is not a group of weather such as -RA, +TSRA or VCSH");
  }
  return say("is no group of a METAR");
}

}  // namespace welkin::weather::metar
