// SPDX-License-Identifier: Apache-2.0
// `welkin metar`: says what weather reports mean.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace welkin::app {

// One line of JSON for one report, without the newline. The fields are those of docs and design ("welkin
// metar --json"); a report with errors has what could be read, and besides `error` and `column` of its first
// error, `report`, and `errors` with all of them.
std::string metarToJson(std::string_view report);

// A readable summary of one report, several lines, each ended by a newline.
std::string metarToText(std::string_view report);

// Prints every report of `reports`, then every line of `file` ("-": standard input); empty lines and lines
// that start with # are passed over in files. Returns the exit code: 0, or 1 when any report had an error.
// Throws IoError for a file that cannot be read.
int runMetarCommand(const std::vector<std::string>& reports, const std::optional<std::string>& file,
                    bool json);

}  // namespace welkin::app
