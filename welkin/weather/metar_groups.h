// SPDX-License-Identifier: Apache-2.0
// The groups of a METAR one by one: each function reads one kind of group, spelled in capitals and without
// blanks, and returns nothing when the text is not exactly such a group. Which group may stand where is the
// business of metar_parse.cpp.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "welkin/weather/metar.h"

namespace welkin::weather::metar {

// Walks through the characters of a group; every `eat` moves on only when it succeeds.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : rest_(text) {}
  bool done() const { return rest_.empty(); }
  std::size_t size() const { return rest_.size(); }
  char peek() const { return rest_.empty() ? '\0' : rest_.front(); }
  std::string_view rest() const { return rest_; }

  bool eat(char c) {
    if (peek() != c || rest_.empty()) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool eat(std::string_view word) {
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  void skip(std::size_t count) { rest_.remove_prefix(count); }  // count <= size()
  // Exactly `count` decimal digits.
  std::optional<int> digits(std::size_t count);
  // As many digits as follow, if they are between `least` and `most`.
  std::optional<int> digits(std::size_t least, std::size_t most);

 private:
  std::string_view rest_;
};

inline bool isDigit(char c) {
  return c >= '0' && c <= '9';
}
inline bool isLetter(char c) {
  return c >= 'A' && c <= 'Z';
}
bool isAllSolidi(std::string_view text);  // nothing but '/', at least one

// A value that may be reported as missing.
template <class T>
using Maybe = std::optional<T>;

struct TimeGroup {
  int day, hour, minute;
};
std::optional<TimeGroup> readTime(std::string_view text);  // 211753Z; also checks the ranges
std::optional<MetarWind> readWind(
    std::string_view text);  // 24015G25KT, VRB02KT, 00000MPS, ///05KT, /////KT, P49MPS
struct VariationGroup {
  Maybe<int> fromDeg, toDeg;
};
std::optional<VariationGroup> readVariation(std::string_view text);  // 240V300, ///V///

struct VisibilityGroup {
  Maybe<double> metres;
  MetarBound bound = MetarBound::kExact;
  bool directional = false;  // 1500SW
};
std::optional<VisibilityGroup> readVisibilityMetres(
    std::string_view text);  // 4000, 9999NDV, 1500SW, M0400, 2200M, 10KM, ////
// 10SM, P6SM, 1/2SM, M1/4SM, ////SM; `wholeMiles` is the group before it: "1" of "1 1/2SM", which only a
// fraction may follow.
std::optional<VisibilityGroup> readVisibilityMiles(std::string_view text, std::optional<int> wholeMiles = {});

bool isRunwayGroup(
    std::string_view text);  // runway visual range or state of a runway: R06/1200FT, R26/59//50, R/SNOCLO
bool isOldRunwayState(
    std::string_view text);  // 16090065, 1519//65, 02CLRD60: the eight figures in use before 2004
// Whether one of the two groups above, or SNOCLO, says that snow lies on a runway.
bool isRunwayWithSnow(std::string_view text);
bool isPresentWeather(std::string_view text);      // -SHRA, VCTS, +FC, //
bool isRecentWeather(std::string_view text);       // RERA, RE//
bool isColourState(std::string_view text);         // BLU, BLACKWHT, YLO1
bool isSeaState(std::string_view text);            // W15/S2, W///S4, W17/H8
bool isNationalSupplement(std::string_view text);  // RF00.0/000.0, DL-NE, RH76, QFE760, QBB090
bool isTrendStart(std::string_view text);          // TEMPO, BECMG, INTER, PROB30, FM1200

std::optional<MetarLayer> readLayer(std::string_view text);  // BKN014, FEW031///, SCT020TCU, //////CB, ///015
std::optional<MetarClear> readClear(std::string_view text);  // SKC, CLR, NSC, NCD
struct VerticalVisibilityGroup {
  Maybe<int> feet;
};
std::optional<VerticalVisibilityGroup> readVerticalVisibility(std::string_view text);  // VV002, VV///

struct TemperatureGroup {
  Maybe<double> temperatureC, dewPointC;
};
std::optional<TemperatureGroup> readTemperature(std::string_view text);       // 12/M01, 10/, ///M02, XX/XX
std::optional<TemperatureGroup> readExactTemperature(std::string_view text);  // T01561011, T0156

struct PressureGroup {
  Maybe<double> hpa;
};
// Hectopascals are rounded down to whole ones, so the same pressure in hPa and inches differs by less than
// this.
inline constexpr double kPressureRoundingHpa = 2.0;
std::optional<PressureGroup> readPressure(
    std::string_view text);  // Q1013, A2992, QNH2992INS, Q1013/2992, Q////

// What an unreadable group was most likely meant to be, as the reason of an error.
std::string explainUnreadable(std::string_view shown, std::string_view text);

}  // namespace welkin::weather::metar
