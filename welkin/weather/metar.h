// SPDX-License-Identifier: Apache-2.0
// Reading of aviation weather reports: METAR and SPECI.
//
// The code form is FM 15 METAR / FM 16 SPECI (WMO-No. 306, Manual on Codes, Volume I.1), with the United
// States' form of it (Federal Meteorological Handbook No. 1: statute miles, inches of mercury, the T group),
// and with those national habits that thousands of reports show every day and that have one meaning only
// (Canadian `////SM`, Russian eight-figure runway states, Australian rainfall `RF00.0/000.0`, NATO colour
// states, `M` for missing, a French `///CB`).
//
// What is promised:
// - A group that cannot be read, is out of any possible range, or contradicts one read before gives an error
//   and no value; all the others are decoded as usual. There is never a guess. So weather, CB, TCU and cloud
//   below 5,000 ft are errors beside CAVOK, cloud above a vertical visibility beside that, and a dew point
//   more than a degree above the temperature.
// - Element missing in the report (solidi, or the group is not there) means an empty value, and is no error,
//   except that a report must name its station and its time.
// - The trend (NOSIG, TEMPO, BECMG, INTER, PROB, FM) is recognised and not decoded. Of the remarks
//   the T group is read, which gives temperature and dew point to a tenth of a degree, and those that name
//   genera of cloud.
// - Lower-case letters are read as upper case: the telegraph alphabet that the code was made for has one case
//   only.
// - Any bytes may come in; time is linear in their number.
//
// Units: wind in m/s, visibility in metres, temperature in degrees Celsius, pressure in hPa. Heights of
// clouds stay in feet above the aerodrome, as whole numbers of feet are what the code gives. Pure functions,
// safe on any thread.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "welkin/weather/weather.h"

namespace welkin::weather {

struct MetarWind {
  std::optional<int> directionDeg;  // true, where it comes from; 0 only for calm; absent: variable or missing
  bool variable = false;            // VRB
  std::optional<double> speedMps;   // mean of ten minutes
  bool speedAtLeast = false;        // P99KT: the speed is `speedMps` or more
  std::optional<double> gustMps;
  std::optional<int> variesFromDeg;  // 240V300: extremes, clockwise
  std::optional<int> variesToDeg;
};

// What a reported number is to the true value.
enum class MetarBound {
  kExact,
  kAtLeast,   // 9999, CAVOK, P6SM
  kLessThan,  // M1/4SM
};

enum class MetarCover {
  kFew,        // 1 to 2 oktas, counted from the ground up to this layer
  kScattered,  // 3 to 4
  kBroken,     // 5 to 7
  kOvercast,   // 8
  kUnknown,    // ///: there is cloud or there may be, the instrument cannot tell how much
};

enum class MetarCloudType {
  kNone,             // nothing said, or ///: the instrument cannot tell
  kCumulonimbus,     // CB
  kToweringCumulus,  // TCU
};

struct MetarLayer {
  MetarCover cover = MetarCover::kUnknown;
  std::optional<int> baseFt;  // above the aerodrome; absent: ///
  MetarCloudType type = MetarCloudType::kNone;
};

// A cloud as remarks name it: SC4 (Canada), 4SC040 (Japan).
struct MetarCloudRemark {
  Genus genus = Genus::kCumulus;
  MetarCloudType type = MetarCloudType::kNone;
  int oktas = 0;              // of this cloud alone
  std::optional<int> baseFt;  // above the aerodrome; absent in Canada
};

// 8/571 (United States): code figures of WMO-No. 306, tables 0513, 0515 and 0509; absent: /.
struct MetarCloudCodes {
  std::optional<int> low, middle, high;
};

// Why a report gives no layers.
enum class MetarClear {
  kNotSaid,
  kSkc,  // sky clear, said by a human
  kClr,  // no cloud below 12,000 ft (25,000 ft in Canada), said by a machine
  kNsc,  // no cloud below 5,000 ft or the highest minimum sector altitude, no CB or TCU, and not CAVOK
  kNcd,  // no cloud detected, said by a machine
};

struct Metar {
  bool special = false;    // SPECI
  std::string station;     // four characters; empty: could not be read
  std::optional<int> day;  // of the month, UTC; all three are present or none
  std::optional<int> hour;
  std::optional<int> minute;
  bool automatic = false;  // AUTO
  bool corrected = false;  // COR, CCA, CCB, ...
  bool delayed = false;    // RTD
  bool nil = false;        // NIL: there is no report, everything else is empty

  MetarWind wind;
  std::optional<double> visibilityM;  // prevailing; 10,000 for 9999 and CAVOK; 0 for 0000 (under 50 m)
  MetarBound visibilityBound = MetarBound::kExact;
  bool cavok = false;
  std::vector<std::string> weather;  // groups of present weather as reported: "-RA", "VCSH", "//"
  std::vector<MetarLayer> layers;    // in the order of the report, which is upwards except by mistake
  MetarClear clear = MetarClear::kNotSaid;
  bool skyObscured = false;                 // VV
  std::optional<int> verticalVisibilityFt;  // absent although skyObscured: VV///
  std::optional<double> temperatureC;       // from the T group of the remarks where there is one
  std::optional<double> dewPointC;
  std::optional<double> pressureHpa;  // reduced to mean sea level (QNH)
  std::vector<MetarCloudRemark> cloudRemarks;
  std::optional<MetarCloudCodes> cloudCodes;
  bool snowOnRunway = false;  // SNOCLO, or a runway's state has dry, wet or compacted snow
};

struct MetarError {
  std::size_t column = 1;  // of the group's first byte in the report, from 1
  std::string reason;      // a phrase without full stop: "'Q10' is not a pressure such as Q1013 or A2992"
};

struct MetarResult {
  Metar metar;                     // everything that could be read
  std::vector<MetarError> errors;  // in order of column; at most kMaxMetarErrors
  bool ok() const { return errors.empty(); }
};

inline constexpr std::size_t kMaxMetarErrors = 32;

// Decodes one report; never throws but for lack of memory.
MetarResult parseMetar(std::string_view report);

}  // namespace welkin::weather
