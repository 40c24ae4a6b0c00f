// SPDX-License-Identifier: Apache-2.0
// A moment in Coordinated Universal Time as people write it (ISO 8601, proleptic Gregorian calendar).
#pragma once

#include <string>
#include <string_view>

namespace welkin {

struct UtcTime {
  int year = 2026;    // 1900 to 2100
  int month = 6;      // 1 to 12
  int day = 21;       // 1 to 31
  int hour = 12;      // 0 to 23
  int minute = 0;     // 0 to 59
  double second = 0;  // [0, 60); leap seconds are not represented

  bool operator==(const UtcTime&) const = default;
};

// Reads "2026-06-21T18:30:00Z", "2026-06-21T18:30Z", "2026-06-21 18:30:05.25" or an offset "+02:00" in place
// of Z; without either it is taken as UTC. Throws ParseError (column, what was expected) on anything else,
// impossible dates included.
UtcTime parseUtcTime(std::string_view text);

// "2026-06-21T18:30:00Z"; fractions of a second only where there are any.
std::string formatUtcTime(const UtcTime& t);

// The moment `seconds` later (or earlier), in a calendar of 86,400-second days.
UtcTime addSeconds(const UtcTime& t, double seconds);

// Seconds from a to b in the same calendar.
double secondsBetween(const UtcTime& a, const UtcTime& b);

}  // namespace welkin
