// SPDX-License-Identifier: Apache-2.0
#include "welkin/core/utc_time.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "welkin/core/error.h"

namespace welkin {
namespace {

constexpr double kSecondsPerDay = 86400.0;

bool isLeapYear(int y) {
  return (y % 4 == 0 && y % 100 != 0) || y % 400 == 0;
}

int daysInMonth(int year, int month) {
  constexpr std::array<int, 12> kDays = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return month == 2 && isLeapYear(year) ? 29 : kDays[static_cast<std::size_t>(month - 1)];
}

// Days from 1970-01-01, proleptic Gregorian. Counting years from March puts the leap day last
// (H. Hinnant 2013, "chrono-Compatible Low-Level Date Algorithms").
std::int64_t daysFromCivil(std::int64_t y, int m, int d) {
  y -= m <= 2;
  const std::int64_t era = (y >= 0 ? y : y - 399) / 400;
  const std::int64_t yearOfEra = y - era * 400;
  const std::int64_t dayOfYear = (153 * (m + (m > 2 ? -3 : 9)) + 2) / 5 + d - 1;
  const std::int64_t dayOfEra = yearOfEra * 365 + yearOfEra / 4 - yearOfEra / 100 + dayOfYear;
  return era * 146097 + dayOfEra - 719468;
}

void civilFromDays(std::int64_t days, int& year, int& month, int& day) {
  days += 719468;
  const std::int64_t era = (days >= 0 ? days : days - 146096) / 146097;
  const std::int64_t dayOfEra = days - era * 146097;
  const std::int64_t yearOfEra = (dayOfEra - dayOfEra / 1460 + dayOfEra / 36524 - dayOfEra / 146096) / 365;
  const std::int64_t dayOfYear = dayOfEra - (365 * yearOfEra + yearOfEra / 4 - yearOfEra / 100);
  const std::int64_t mp = (5 * dayOfYear + 2) / 153;
  day = static_cast<int>(dayOfYear - (153 * mp + 2) / 5 + 1);
  month = static_cast<int>(mp < 10 ? mp + 3 : mp - 9);
  year = static_cast<int>(yearOfEra + era * 400 + (month <= 2));
}

// A cursor over the text that knows the column for its complaints.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  bool atEnd() const { return at_ == text_.size(); }
  char peek() const { return atEnd() ? '\0' : text_[at_]; }
  bool take(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
  }
  void expect(char c, const char* what) {
    if (!take(c)) fail(at_, std::string("expected ") + what);
  }
  // Exactly `digits` digits with a value in [low, high].
  int number(int digits, int low, int high, const char* what) {
    const std::size_t start = at_;
    int n = 0;
    for (int i = 0; i < digits; ++i, ++at_) {
      if (peek() < '0' || peek() > '9') {
        fail(at_, "expected the " + std::string(what) + " as " + std::to_string(digits) + " digits");
      }
      n = n * 10 + (peek() - '0');
    }
    if (n < low || n > high) {
      fail(start, "the " + std::string(what) + " is " + std::to_string(n) + ", expected " +
                      std::to_string(low) + " to " + std::to_string(high));
    }
    return n;
  }
  // The digits after a decimal point, as a fraction of one.
  double fraction() {
    double scale = 1.0, sum = 0.0;
    const std::size_t start = at_;
    while (peek() >= '0' && peek() <= '9') {
      scale *= 0.1;
      sum += scale * (text_[at_++] - '0');
    }
    if (at_ == start) fail(at_, "expected digits after the decimal point");
    return std::fmin(sum, std::nextafter(1.0, 0.0));
  }
  std::size_t position() const { return at_; }
  [[noreturn]] void fail(std::size_t at, const std::string& message) const {
    throw ParseError(
        "", 0, static_cast<int>(at) + 1,
        message + " in the time \"" + std::string(text_.substr(0, 40)) + "\" (like 2026-06-21T18:30:00Z)");
  }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

UtcTime parseUtcTime(std::string_view text) {
  Reader r(text);
  UtcTime t;
  t.year = r.number(4, 1900, 2100, "year");
  r.expect('-', "\"-\" after the year");
  t.month = r.number(2, 1, 12, "month");
  r.expect('-', "\"-\" after the month");
  t.day = r.number(2, 1, daysInMonth(t.year, t.month), "day of this month");
  if (!r.take(' ')) r.expect('T', "\"T\" or a space after the date");
  t.hour = r.number(2, 0, 23, "hour");
  r.expect(':', "\":\" after the hour");
  t.minute = r.number(2, 0, 59, "minute");
  t.second = 0.0;
  if (r.take(':')) {
    t.second = r.number(2, 0, 59, "second");
    if (r.take('.')) t.second += r.fraction();
    if (t.second >= 60.0) t.second = std::nextafter(60.0, 0.0);
  }
  if (!r.take('Z') && (r.peek() == '+' || r.peek() == '-')) {
    const std::size_t start = r.position();
    const double sign = r.take('-') ? -1.0 : 1.0;
    if (sign > 0) r.take('+');
    const int hours = r.number(2, 0, 23, "offset's hours");
    r.expect(':', "\":\" in the offset");
    const int minutes = r.number(2, 0, 59, "offset's minutes");
    t = addSeconds(t, -sign * (hours * 3600.0 + minutes * 60.0));
    if (t.year < 1900 || t.year > 2100) r.fail(start, "the offset leads out of the years 1900 to 2100");
  }
  if (!r.atEnd()) r.fail(r.position(), "expected the end, \"Z\" or an offset like +02:00");
  return t;
}

std::string formatUtcTime(const UtcTime& t) {
  char text[80];
  const int whole = static_cast<int>(t.second);
  std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%02d", t.year, t.month, t.day, t.hour, t.minute,
                whole);
  std::string s = text;
  // Microseconds, cut rather than rounded so that 59.9999999 never becomes 60; a hair is added first because
  // most decimal fractions have no exact double.
  const double fraction = t.second - whole;
  const int micro = static_cast<int>(std::fmin(fraction * 1e6 + 1e-3, 999999.0));
  if (micro > 0) {
    std::snprintf(text, sizeof text, ".%06d", micro);
    s += text;
    s.erase(s.find_last_not_of('0') + 1);
  }
  return s + "Z";
}

UtcTime addSeconds(const UtcTime& t, double seconds) {
  // Whole days are split off first: the second keeps full precision however far the step.
  const double wholeDays = std::floor(seconds / kSecondsPerDay);
  double secondOfDay = t.hour * 3600.0 + t.minute * 60.0 + t.second + (seconds - wholeDays * kSecondsPerDay);
  std::int64_t days = daysFromCivil(t.year, t.month, t.day) + static_cast<std::int64_t>(wholeDays);
  while (secondOfDay >= kSecondsPerDay) {
    secondOfDay -= kSecondsPerDay;
    ++days;
  }
  if (secondOfDay < 0.0) secondOfDay = 0.0;
  UtcTime out;
  civilFromDays(days, out.year, out.month, out.day);
  const int wholeMinutes = static_cast<int>(secondOfDay / 60.0);
  out.hour = wholeMinutes / 60;
  out.minute = wholeMinutes % 60;
  out.second = secondOfDay - wholeMinutes * 60.0;
  return out;
}

double secondsBetween(const UtcTime& a, const UtcTime& b) {
  const auto days = daysFromCivil(b.year, b.month, b.day) - daysFromCivil(a.year, a.month, a.day);
  return static_cast<double>(days) * kSecondsPerDay + (b.hour - a.hour) * 3600.0 +
         (b.minute - a.minute) * 60.0 + (b.second - a.second);
}

}  // namespace welkin
