// SPDX-License-Identifier: Apache-2.0
// `welkin metar`: says what weather reports mean.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "welkin/weather/metar.h"

namespace welkin::app {

// One line of JSON for one report and what parseMetar() made of it, without the newline:
//
//   station, day, hour, minute, auto, wind {direction_deg, variable, speed_mps, gust_mps}, visibility_m,
//   cavok, layers [{cover, base_ft, type}], clear, vertical_visibility_ft, weather [...], temperature_c,
//   dewpoint_c, pressure_hpa
//
// with null for what is missing; a cover of unknown amount is "///". Besides, what these cannot tell apart:
// visibility_bound ">" (or more), "<" (less than) or null; sky_obscured (VV, also without a height); nil. A
// report with errors has `error` and `column` of the first, `report`, and `errors` with all of them, beside
// what could be read; where not even station or time could be read, the errors alone.
std::string metarToJson(std::string_view report, const weather::MetarResult& result);

// A readable summary of one report, several lines, each ended by a newline.
std::string metarToText(const weather::MetarResult& result);

// Prints every report of `reports`, then every line of `file` ("-": standard input); empty lines and lines
// that start with # are passed over in files. Throws ParameterError that names the first report with an
// error, after all have been printed; IoError for a file that cannot be read.
void runMetarCommand(const std::vector<std::string>& reports, const std::optional<std::string>& file,
                     bool json);

}  // namespace welkin::app
