// SPDX-License-Identifier: Apache-2.0
// Where which group of a METAR may stand, and what follows when it stands elsewhere.
//
// A report is read in three parts: the heading up to the time; the body; and, from the trend or RMK on, text
// that is left alone. In the body the code form has one order, and observers keep to it less than one would
// wish, so a group is known by its spelling. From the pressure on, though, cloud or weather might be a trend
// or a remark that lost its first word: it is not read there.
#include <algorithm>
#include <array>
#include <cmath>

#include "welkin/weather/metar.h"
#include "welkin/weather/metar_groups.h"
#include "welkin/weather/metar_remarks.h"

namespace welkin::weather {
namespace {

using namespace metar;

// One group: a run of bytes between blanks.
struct Group {
  std::string_view text;  // in capitals
  std::size_t column = 1;
  explicit operator bool() const { return !text.empty(); }
};

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

// Splits a report into groups, the end sign '=' taken off.
class Groups {
 public:
  explicit Groups(std::string_view report) : report_(report) {}

  Group next() {
    const Group g = peek();
    at_ = g.column - 1 + g.text.size();
    return g;
  }
  Group peek() const {
    std::size_t begin = at_;
    while (begin < report_.size() && isBlank(report_[begin])) ++begin;
    std::size_t end = begin;
    while (end < report_.size() && !isBlank(report_[end]) && report_[end] != '=') ++end;
    return {report_.substr(begin, end - begin), begin + 1};
  }
  // What follows the '=' on which reading stopped, or an empty group at the end of the text.
  Group afterEnd() const {
    Groups tail(report_);
    tail.at_ = at_;
    while (tail.at_ < report_.size() && (isBlank(report_[tail.at_]) || report_[tail.at_] == '=')) ++tail.at_;
    return tail.peek();
  }

 private:
  std::string_view report_;
  std::size_t at_ = 0;
};

constexpr std::size_t kMaxShown = 24;

// Bytes from anywhere made fit for a message.
std::string shown(std::string_view text) {
  std::string s(text.substr(0, kMaxShown));
  for (char& c : s) {
    if (c < ' ' || c > '~') c = '?';
  }
  if (text.size() > kMaxShown) s += "...";
  return s;
}

bool isDigits(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), isDigit);
}

bool isStation(std::string_view text) {
  return text.size() == 4 && isLetter(text[0]) && text != "AUTO" &&
         std::all_of(text.begin(), text.end(), [](char c) { return isLetter(c) || isDigit(c); });
}

// CAVOK is: no such cloud below 5,000 ft, no CB or TCU at any height (WMO-No. 306, FM 15, 15.10). An amount
// that an instrument cannot tell says nothing against it.
constexpr int kCavokFeet = 5000;
constexpr double kCavokVisibilityM = 10000.0;
bool deniesCavok(const MetarLayer& l) {
  return l.type != MetarCloudType::kNone ||
         (l.cover != MetarCover::kUnknown && l.baseFt && *l.baseFt < kCavokFeet);
}

// Rounded to whole degrees by two instruments, a dew point may exceed the temperature by one.
constexpr double kDewPointRoundingC = 1.05;
bool isPossible(const TemperatureGroup& t) {
  return !t.temperatureC || !t.dewPointC || *t.dewPointC - *t.temperatureC <= kDewPointRoundingC;
}

class Reader {
 public:
  explicit Reader(std::string_view capitals) : groups_(capitals) {}

  MetarResult read() {
    if (readHeading()) readBody();
    return std::move(result_);
  }

 private:
  Metar& metar() { return result_.metar; }

  void fail(const Group& g, std::string reason) {
    if (result_.errors.size() < kMaxMetarErrors) result_.errors.push_back({g.column, std::move(reason)});
  }
  void failUnreadable(const Group& g) {
    if (result_.errors.size() < kMaxMetarErrors) fail(g, explainUnreadable(shown(g.text), g.text));
  }
  void failTwice(const Group& g, const char* what) { fail(g, "'" + shown(g.text) + "' is a second " + what); }

  void failCavok(const Group& g) { fail(g, "'" + shown(g.text) + "' contradicts the CAVOK before it"); }
  void failDewPoint(const Group& g) {
    fail(g, "'" + shown(g.text) + "' has a dew point above the temperature");
  }

  // The group after `g` belongs to it (a blank too many): one error for both, and neither is read.
  void failWithNext(const Group& g) {
    const Group second = groups_.next();
    fail(g, "'" + shown(g.text) + " " + shown(second.text) + "' has a blank too many or a figure too few");
  }

  // False: this is no METAR at all, and reading on would only heap up errors.
  bool readHeading();
  void readBody();
  void readGroup(const Group& g);
  bool readFlag(const Group& g);
  bool readSupplement(const Group& g);
  bool readBroken(const Group& g);
  bool readMissing(const Group& g);
  bool readElement(const Group& g);
  void skipWindShear();
  void readRemarks();
  void setVisibility(const Group& g, const VisibilityGroup& v);
  void setCavok(const Group& g);
  void addWeather(const Group& g);
  void addLayer(const Group& g, const MetarLayer& layer);
  void setTemperature(const Group& g, const TemperatureGroup& t);
  void setPressure(const Group& g, const PressureGroup& p);
  void setClear(const Group& g, MetarClear clear);
  void setVerticalVisibility(const Group& g, const VerticalVisibilityGroup& v);

  Groups groups_;
  MetarResult result_;
  bool windSeen_ = false;
  bool variationSeen_ = false;
  bool visibilitySeen_ = false;
  bool lessSomewhere_ = false;       // a least visibility of less than 10 km stands beside the prevailing one
  bool visibilityJustSeen_ = false;  // the group before this one was a visibility
  bool temperatureSeen_ = false;
  int pressuresSeen_ = 0;
};

bool Reader::readHeading() {
  Group g = groups_.next();
  if (!g) {
    fail(g, "the report is empty");
    return false;
  }
  if (g.text == "METAR" || g.text == "SPECI") {
    metar().special = g.text == "SPECI";
    g = groups_.next();
  }
  if (g.text == "COR") {
    metar().corrected = true;
    g = groups_.next();
  }

  if (g.text == "TAF") {
    fail(g, "'TAF' begins a forecast; only reports, METAR and SPECI, are read");
    return false;
  }

  bool timeIsNext = false;
  if (isStation(g.text)) {
    metar().station = g.text;
  } else if (readTime(g.text)) {
    fail(g, "the station is missing before '" + shown(g.text) + "'");
    timeIsNext = true;
  } else {
    fail(g, "expected a station such as KMRY" + (g ? " instead of '" + shown(g.text) + "'" : std::string()));
    if (!readTime(groups_.peek().text)) return false;
  }

  if (!timeIsNext) g = groups_.peek();
  if (const auto time = readTime(g.text)) {
    metar().day = time->day;
    metar().hour = time->hour;
    metar().minute = time->minute;
    if (!timeIsNext) groups_.next();
    return true;
  }
  fail(g, "expected a day and time such as 211753Z" +
              (g ? " instead of '" + shown(g.text) + "'" : std::string()));
  // Take the group away when it was meant to be the time.
  const bool meant =
      !g.text.empty() && isDigit(g.text.front()) &&
      ((g.text.ends_with('Z') && g.text.size() <= 9) || (g.text.size() == 6 && isDigits(g.text)));
  if (meant) groups_.next();
  return true;
}

void Reader::readBody() {
  while (const Group g = groups_.next()) {
    if (g.text == "RMK") {
      readRemarks();
      break;
    }
    if (metar().nil) {
      fail(g, "nothing may follow NIL");
      return;
    }
    if (isTrendStart(g.text)) {
      while (const Group t = groups_.next()) {
        if (t.text == "RMK") {
          readRemarks();
          break;
        }
      }
      break;
    }
    readGroup(g);
  }
  if (const Group extra = groups_.afterEnd()) {
    fail(extra, "'" + shown(extra.text) + "' stands after the end sign '='");
  }
}

void Reader::readGroup(const Group& g) {
  const bool afterVisibility = visibilityJustSeen_;
  if (readElement(g)) return;
  visibilityJustSeen_ = false;
  if (readFlag(g) || readSupplement(g) || readMissing(g)) {
    visibilityJustSeen_ = afterVisibility && isRunwayGroup(g.text);
    return;
  }
  if (!readBroken(g)) failUnreadable(g);
}

bool Reader::readFlag(const Group& g) {
  const std::string_view t = g.text;
  if (t == "AUTO") {
    metar().automatic = true;
  } else if (t == "COR" || (t.size() == 3 && t.starts_with("CC") && isLetter(t[2]))) {
    metar().corrected = true;
  } else if (t == "RTD") {
    metar().delayed = true;
  } else if (t == "NIL") {
    metar().nil = true;
  } else {
    return false;
  }
  return true;
}

// Groups that are understood and say nothing about the sky of this moment.
bool Reader::readSupplement(const Group& g) {
  if (g.text == "WS") {
    skipWindShear();
    return true;
  }
  // A pressure at the aerodrome's own level is not the one wanted, but it marks the same place in the report.
  if (g.text.starts_with("QFE") && isNationalSupplement(g.text)) {
    ++pressuresSeen_;
    return true;
  }
  metar().snowOnRunway = metar().snowOnRunway || isRunwayWithSnow(g.text);
  return g.text == "NOSIG" || g.text == "NSW" || g.text == "$" || g.text == "SNOCLO" ||
         isRunwayGroup(g.text) || isRecentWeather(g.text) || isColourState(g.text) || isSeaState(g.text) ||
         isOldRunwayState(g.text) || isNationalSupplement(g.text);
}

// WS R06, WS RWY14, WS RWY 14, WS ALL RWY, WS TKOF RWY20, WS LDG RWY02
void Reader::skipWindShear() {
  static constexpr std::array<std::string_view, 5> kWords = {"ALL", "RWY", "RWYS", "TKOF", "LDG"};
  bool afterRunway = false;  // its number may be the next group
  for (Group g = groups_.peek(); g; g = groups_.peek()) {
    const bool isWord = std::find(kWords.begin(), kWords.end(), g.text) != kWords.end();
    if (!isWord) {
      Cursor c(g.text);
      if (!c.eat("RWY") && !c.eat('R') && !afterRunway) return;
      if (!c.digits(2)) return;
      if (!c.eat('L') && !c.eat('R')) c.eat('C');
      if (!c.done()) return;
    }
    afterRunway = isWord && g.text.starts_with("RWY");
    groups_.next();
  }
}

// Solidi, or the M of North American stations, in the place of an element.
bool Reader::readMissing(const Group& g) {
  if (g.text == "M") return true;
  if (!isAllSolidi(g.text)) return false;
  switch (g.text.size()) {
    case 3:
      // Before the temperature the clouds are missing; behind the pressure, the colour state.
      if (!temperatureSeen_ && pressuresSeen_ == 0) metar().layers.push_back({});
      return true;
    case 4:
      return true;
    case 5:
      if (windSeen_ || visibilitySeen_) temperatureSeen_ = true;  // else it is a wind without its unit
      return true;
    default:
      return false;
  }
}

// Groups torn in two: the halves must not be read for themselves ("VC RA" is no rain, "1 6SM" not six miles).
bool Reader::readBroken(const Group& g) {
  const Group next = groups_.peek();
  if (!next) return false;
  const std::string_view t = g.text, n = next.text;
  const bool wind = t.size() >= 5 && isDigits(t.substr(0, 5)) && (n == "KT" || n == "MPS" || n == "KMH");
  const bool miles = (isDigits(t) && t.size() <= 2 && n.ends_with("SM")) ||
                     (n == "SM" && readVisibilityMiles(std::string(t) + "SM", std::nullopt));
  const bool weather = (t == "VC" || t == "-" || t == "+") && isPresentWeather(n);
  const bool cloud = (t == "FEW" || t == "SCT" || t == "BKN" || t == "OVC" || t == "VV") && n.size() >= 3 &&
                     (isDigits(n.substr(0, 3)) || n.starts_with("///"));
  const bool pressure = (t.starts_with('Q') || t.starts_with('A')) && t.size() <= 4 &&
                        (t.size() == 1 || isDigits(t.substr(1))) && isDigits(n);
  if (!wind && !miles && !weather && !cloud && !pressure) return false;
  failWithNext(g);
  return true;
}

bool Reader::readElement(const Group& g) {
  const std::string_view t = g.text;
  const bool afterPressure = pressuresSeen_ > 0;
  if (const auto p = readPressure(t)) {
    setPressure(g, *p);
    visibilityJustSeen_ = false;
    return true;
  }
  if (const auto temperature = readTemperature(t); temperature && t != "/////") {
    setTemperature(g, *temperature);
    visibilityJustSeen_ = false;
    return true;
  }
  if (afterPressure && (isAllSolidi(t))) return false;  // a colour state or the like

  // From here on, what is only read before the pressure.
  const auto misplaced = [&] {
    if (afterPressure) {
      fail(g,
           "'" + shown(t) + "' stands after the pressure, where it cannot be told from a trend or a remark");
    }
    return afterPressure;
  };
  if (t.size() <= 2 && isDigits(t)) {
    const Group next = groups_.peek();
    if (const auto v = readVisibilityMiles(next.text, Cursor(t).digits(t.size()))) {
      groups_.next();
      if (!misplaced()) setVisibility(g, *v);
      return true;
    }
    return false;
  }
  auto visibility = readVisibilityMetres(t);
  if (!visibility) visibility = readVisibilityMiles(t);
  if (visibility) {
    if (!misplaced()) setVisibility(g, *visibility);
    return true;
  }
  if (t == "CAVOK") {
    if (!misplaced()) setCavok(g);
    return true;
  }
  const auto handled = [&] {
    visibilityJustSeen_ = false;
    return true;
  };
  if (const auto w = readWind(t)) {
    if (misplaced()) return handled();
    if (windSeen_) {
      failTwice(g, "wind");
      return handled();
    }
    windSeen_ = true;
    metar().wind = *w;
    return handled();
  }
  if (const auto v = readVariation(t)) {
    if (misplaced()) return handled();
    if (variationSeen_) {
      failTwice(g, "range of wind directions");
      return handled();
    }
    variationSeen_ = true;
    metar().wind.variesFromDeg = v->fromDeg;
    metar().wind.variesToDeg = v->toDeg;
    return handled();
  }
  if (isPresentWeather(t)) {
    if (!misplaced()) addWeather(g);
    return handled();
  }
  if (const auto layer = readLayer(t)) {
    if (!misplaced()) addLayer(g, *layer);
    return handled();
  }
  if (const auto clear = readClear(t)) {
    if (!misplaced()) setClear(g, *clear);
    return handled();
  }
  if (const auto vv = readVerticalVisibility(t)) {
    if (!misplaced()) setVerticalVisibility(g, *vv);
    return handled();
  }
  return false;
}

void Reader::setVisibility(const Group& g, const VisibilityGroup& v) {
  const bool follows = visibilityJustSeen_;
  visibilityJustSeen_ = true;
  if (!visibilitySeen_) {
    visibilitySeen_ = true;
    metar().visibilityM = v.metres;
    metar().visibilityBound = v.bound;
    return;
  }
  if (!v.metres) return;  // solidi for some other element
  // The least visibility and where it is stand behind the prevailing one, and do not exceed it.
  const bool minimum = (follows || v.directional) && !metar().cavok && metar().visibilityM &&
                       *v.metres <= *metar().visibilityM;
  if (v.directional || minimum) {
    const bool less = *v.metres < kCavokVisibilityM;
    if (less && metar().cavok)
      failCavok(g);
    else
      lessSomewhere_ = lessSomewhere_ || less;
    return;
  }
  if (metar().cavok && g.text == "CAVOK") return;
  failTwice(g, "visibility");
}

void Reader::setCavok(const Group& g) {
  const Metar& m = metar();
  const char* denied = nullptr;
  if (lessSomewhere_ || (visibilitySeen_ && m.visibilityBound != MetarBound::kAtLeast))
    denied = "visibility";
  else if (std::any_of(m.weather.begin(), m.weather.end(), [](const auto& w) { return w != "//"; }))
    denied = "weather";
  else if (m.skyObscured || std::any_of(m.layers.begin(), m.layers.end(), deniesCavok))
    denied = "cloud";
  else if (m.clear == MetarClear::kNsc)
    denied = "NSC";
  if (denied != nullptr) {
    fail(g, "'CAVOK' contradicts the " + std::string(denied) + " before it");
    return;
  }
  metar().cavok = true;
  setVisibility(g, {.metres = kCavokVisibilityM, .bound = MetarBound::kAtLeast});
}

void Reader::addWeather(const Group& g) {
  if (metar().cavok && g.text != "//") {
    failCavok(g);
    return;
  }
  const auto what = [](std::string_view text) {
    return text.substr(text.starts_with('-') || text.starts_with('+') ? 1 : 0);
  };
  const auto same = [&](const std::string& other) { return g.text != "//" && what(other) == what(g.text); };
  if (std::any_of(metar().weather.begin(), metar().weather.end(), same)) {
    failTwice(g, "group of the same weather");
    return;
  }
  metar().weather.emplace_back(g.text);
}

// A sky that is obscured hides what is above the vertical visibility.
bool isHidden(const MetarLayer& l, const std::optional<int>& verticalVisibilityFt) {
  return l.cover != MetarCover::kUnknown && l.baseFt && verticalVisibilityFt &&
         *l.baseFt > *verticalVisibilityFt;
}

void Reader::addLayer(const Group& g, const MetarLayer& layer) {
  const Metar& m = metar();
  if (m.cavok && deniesCavok(layer))
    failCavok(g);
  else if (m.clear != MetarClear::kNotSaid && layer.cover != MetarCover::kUnknown)
    fail(g, "'" + shown(g.text) + "' contradicts the group before it that says there is no such cloud");
  else if (m.skyObscured && isHidden(layer, m.verticalVisibilityFt))
    fail(g, "'" + shown(g.text) + "' is above the vertical visibility before it, where nothing is seen");
  else
    metar().layers.push_back(layer);
}

void Reader::setVerticalVisibility(const Group& g, const VerticalVisibilityGroup& v) {
  Metar& m = metar();
  if (m.skyObscured) {
    failTwice(g, "vertical visibility");
  } else if (m.cavok) {
    failCavok(g);
  } else if (m.clear != MetarClear::kNotSaid) {
    fail(g, "'" + shown(g.text) + "' contradicts the group before it that says there is no such cloud");
  } else if (std::any_of(m.layers.begin(), m.layers.end(),
                         [&](const MetarLayer& l) { return isHidden(l, v.feet); })) {
    fail(g, "'" + shown(g.text) + "' contradicts the cloud before it, which is seen above that height");
  } else {
    m.skyObscured = true;
    m.verticalVisibilityFt = v.feet;
  }
}

void Reader::setTemperature(const Group& g, const TemperatureGroup& t) {
  if (temperatureSeen_) {
    failTwice(g, "temperature");
    return;
  }
  temperatureSeen_ = true;
  if (!isPossible(t)) {
    failDewPoint(g);
    return;
  }
  metar().temperatureC = t.temperatureC;
  metar().dewPointC = t.dewPointC;
}

void Reader::setPressure(const Group& g, const PressureGroup& p) {
  ++pressuresSeen_;
  if (!p.hpa) return;
  if (!metar().pressureHpa) {
    metar().pressureHpa = p.hpa;
    return;
  }
  if (std::abs(*p.hpa - *metar().pressureHpa) > kPressureRoundingHpa) {
    fail(g, "'" + shown(g.text) + "' contradicts the pressure before it");
  }
}

void Reader::setClear(const Group& g, MetarClear clear) {
  if (metar().cavok && clear == MetarClear::kNsc) {
    failCavok(g);  // NSC is for where CAVOK is not
    return;
  }
  if (metar().clear != MetarClear::kNotSaid && metar().clear != clear) {
    failTwice(g, "statement about a clear sky");
    return;
  }
  const bool anyLayer =
      metar().skyObscured || std::any_of(metar().layers.begin(), metar().layers.end(),
                                         [](const MetarLayer& l) { return l.cover != MetarCover::kUnknown; });
  if (anyLayer) {
    fail(g, "'" + shown(g.text) + "' contradicts the cloud before it");
    return;
  }
  metar().clear = clear;
}

// The T group gives what the body rounds to whole degrees, so the two differ by half a degree and a little
// for old instruments.
void Reader::readRemarks() {
  bool exactSeen = false;
  while (const Group g = groups_.next()) {
    Metar& m = metar();
    if (readCloudRemark(g.text, m) || exactSeen) continue;
    const auto exact = readExactTemperature(g.text);
    if (!exact) continue;
    exactSeen = true;
    const auto contradicts = [](const std::optional<double>& body, const std::optional<double>& remark) {
      return body && remark && std::abs(*body - *remark) > 1.05;
    };
    if (!isPossible(*exact))
      failDewPoint(g);
    else if (contradicts(m.temperatureC, exact->temperatureC) || contradicts(m.dewPointC, exact->dewPointC)) {
      fail(g, "'" + shown(g.text) + "' contradicts the temperatures in the body");
    } else {
      if (exact->temperatureC) m.temperatureC = exact->temperatureC;
      if (exact->dewPointC) m.dewPointC = exact->dewPointC;
    }
  }
}

}  // namespace

MetarResult parseMetar(std::string_view report) {
  const bool anySmall =
      std::any_of(report.begin(), report.end(), [](char c) { return c >= 'a' && c <= 'z'; });
  if (!anySmall) return Reader(report).read();
  std::string capitals(report);
  for (char& c : capitals) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return Reader(capitals).read();
}

}  // namespace welkin::weather
