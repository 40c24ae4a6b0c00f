// SPDX-License-Identifier: Apache-2.0
// Text that files, file names and arguments bring, made fit for a terminal: none of it moves the cursor, sets
// colours or titles, or makes the terminal answer. What goes to standard output and error passes here.
#pragma once

#include <string>
#include <string_view>

namespace welkin::app {

// Control characters (those of ASCII, DEL and U+0080 to U+009F) and bytes that are not UTF-8 become \n, \t or
// \xNN; all other text stays. One line.
std::string printable(std::string_view text);

// The same of text of several lines, whose line feeds stay.
std::string printableLines(std::string_view text);

// JSON whose strings have had the controls below U+0020 escaped: those that are left become \u00NN, so that
// it stays the same JSON.
std::string printableJson(std::string_view json);

}  // namespace welkin::app
