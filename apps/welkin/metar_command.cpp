// SPDX-License-Identifier: Apache-2.0
#include "metar_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "terminal_text.h"
#include "welkin/core/error.h"
#include "welkin/core/units.h"
#include "welkin/weather/metar.h"
#include "welkin/weather/present_weather.h"

namespace welkin::app {
namespace {

using weather::Metar;
using weather::MetarBound;
using weather::MetarClear;
using weather::MetarCloudType;
using weather::MetarCover;
using weather::MetarResult;
using Json = nlohmann::ordered_json;

template <class T>
Json orNull(const std::optional<T>& x) {
  return x ? Json(*x) : Json(nullptr);
}

const char* coverName(MetarCover cover) {
  switch (cover) {
    case MetarCover::kFew:
      return "FEW";
    case MetarCover::kScattered:
      return "SCT";
    case MetarCover::kBroken:
      return "BKN";
    case MetarCover::kOvercast:
      return "OVC";
    case MetarCover::kUnknown:
      return "///";
  }
  return "///";
}

Json typeName(MetarCloudType type) {
  switch (type) {
    case MetarCloudType::kCumulonimbus:
      return "CB";
    case MetarCloudType::kToweringCumulus:
      return "TCU";
    case MetarCloudType::kNone:
      break;
  }
  return nullptr;
}

Json clearName(MetarClear clear) {
  switch (clear) {
    case MetarClear::kSkc:
      return "SKC";
    case MetarClear::kClr:
      return "CLR";
    case MetarClear::kNsc:
      return "NSC";
    case MetarClear::kNcd:
      return "NCD";
    case MetarClear::kNotSaid:
      break;
  }
  return nullptr;
}

Json decoded(const Metar& m) {
  Json j;
  j["station"] = m.station.empty() ? Json(nullptr) : Json(m.station);
  j["day"] = orNull(m.day);
  j["hour"] = orNull(m.hour);
  j["minute"] = orNull(m.minute);
  j["auto"] = m.automatic;
  j["wind"] = {{"direction_deg", orNull(m.wind.directionDeg)},
               {"variable", m.wind.variable},
               {"speed_mps", orNull(m.wind.speedMps)},
               {"gust_mps", orNull(m.wind.gustMps)},
               {"varies_from_deg", orNull(m.wind.variesFromDeg)},
               {"varies_to_deg", orNull(m.wind.variesToDeg)}};
  j["visibility_m"] = orNull(m.visibilityM);
  j["cavok"] = m.cavok;
  j["layers"] = Json::array();
  for (const auto& layer : m.layers) {
    j["layers"].push_back({{"cover", coverName(layer.cover)},
                           {"base_ft", orNull(layer.baseFt)},
                           {"type", typeName(layer.type)}});
  }
  j["clear"] = clearName(m.clear);
  j["vertical_visibility_ft"] = orNull(m.verticalVisibilityFt);
  j["weather"] = m.weather;
  j["temperature_c"] = orNull(m.temperatureC);
  j["dewpoint_c"] = orNull(m.dewPointC);
  j["pressure_hpa"] = orNull(m.pressureHpa);
  // Beyond the fixed fields: what they cannot tell apart.
  j["visibility_bound"] = m.visibilityBound == MetarBound::kAtLeast    ? Json(">")
                          : m.visibilityBound == MetarBound::kLessThan ? Json("<")
                                                                       : Json(nullptr);
  j["sky_obscured"] = m.skyObscured;
  j["cloud_remarks"] = Json::array();
  for (const auto& c : m.cloudRemarks) {
    j["cloud_remarks"].push_back({{"genus", kEnumNames<weather::Genus>[static_cast<std::size_t>(c.genus)]},
                                  {"type", typeName(c.type)},
                                  {"oktas", c.oktas},
                                  {"base_ft", orNull(c.baseFt)}});
  }
  j["cloud_codes"] = nullptr;
  if (const auto& c = m.cloudCodes)
    j["cloud_codes"] = {{"low", orNull(c->low)}, {"middle", orNull(c->middle)}, {"high", orNull(c->high)}};
  j["aerosol"] = kEnumNames<weather::Aerosol>[static_cast<std::size_t>(weather::aerosolOf(m))];
  j["snow_on_ground"] = weather::snowLiesOnGround(m);
  j["nil"] = m.nil;
  j["special"] = m.special;
  j["corrected"] = m.corrected;
  j["delayed"] = m.delayed;
  return j;
}

std::string dump(const Json& j) {
  return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string windText(const weather::MetarWind& w) {
  if (!w.speedMps) return "missing";
  if (*w.speedMps == 0.0) return "calm";
  std::string s = w.variable       ? "variable"
                  : w.directionDeg ? fmt::format("from {} degrees", *w.directionDeg)
                                   : "direction missing";
  s += fmt::format(", {}{:.1f} m/s", w.speedAtLeast ? "at least " : "", *w.speedMps);
  if (w.gustMps) s += fmt::format(", gusts {:.1f} m/s", *w.gustMps);
  if (w.variesFromDeg && w.variesToDeg)
    s += fmt::format(", between {} and {} degrees", *w.variesFromDeg, *w.variesToDeg);
  return s;
}

std::string degreesText(const std::optional<double>& c) {
  return c ? fmt::format("{:.1f} C", *c) : "missing";
}

std::string visibilityText(const Metar& m) {
  if (!m.visibilityM) return "missing";
  const char* bound = m.visibilityBound == MetarBound::kAtLeast    ? "at least "
                      : m.visibilityBound == MetarBound::kLessThan ? "less than "
                                                                   : "";
  return fmt::format("{}{:.0f} m{}", bound, *m.visibilityM, m.cavok ? " (CAVOK)" : "");
}

std::string skyText(const Metar& m) {
  std::string s;
  const auto add = [&](const std::string& part) { s += (s.empty() ? "" : ", ") + part; };
  if (m.skyObscured) {
    add(m.verticalVisibilityFt
            ? fmt::format("obscured, vertical visibility {:.0f} m", *m.verticalVisibilityFt * kMetresPerFoot)
            : std::string("obscured"));
  }
  for (const auto& layer : m.layers) {
    std::string part =
        layer.cover == MetarCover::kUnknown ? "cloud of unknown amount" : coverName(layer.cover);
    if (layer.type == MetarCloudType::kCumulonimbus) part += " CB";
    if (layer.type == MetarCloudType::kToweringCumulus) part += " TCU";
    part += layer.baseFt ? fmt::format(" at {:.0f} m ({} ft)", *layer.baseFt * kMetresPerFoot, *layer.baseFt)
                         : " at unknown height";
    add(part);
  }
  if (m.clear != MetarClear::kNotSaid) add(clearName(m.clear).get<std::string>());
  return s.empty() ? "no cloud reported" : s;
}

}  // namespace

std::string metarToJson(std::string_view report, const MetarResult& r) {
  Json j;
  if (!r.ok()) {
    j["error"] = r.errors.front().reason;
    j["column"] = r.errors.front().column;
    j["report"] = report;
  }
  // Where neither station nor time could be read there is nothing to say but the error.
  if (r.ok() || !r.metar.station.empty() || r.metar.day) {
    const Json d = decoded(r.metar);
    for (const auto& [key, value] : d.items()) j[key] = value;
  }
  if (!r.ok()) {
    for (const auto& e : r.errors) j["errors"].push_back({{"column", e.column}, {"reason", e.reason}});
  }
  return dump(j);
}

std::string metarToText(const MetarResult& r) {
  const Metar& m = r.metar;
  std::string s;
  if (!m.station.empty() || m.day) {
    s += m.station.empty() ? "station missing" : m.station;
    if (m.day) s += fmt::format(", day {} at {:02}:{:02} UTC", *m.day, *m.hour, *m.minute);
    if (m.special) s += ", special";
    if (m.automatic) s += ", automatic";
    if (m.corrected) s += ", corrected";
    if (m.delayed) s += ", delayed";
    s += m.nil ? ": no report\n" : "\n";
  }
  if (!s.empty() && !m.nil) {
    s += "  wind          " + windText(m.wind) + "\n";
    s += "  visibility    " + visibilityText(m) + "\n";
    if (!m.weather.empty()) {
      s += "  weather      ";
      for (const auto& w : m.weather) s += " " + w;
      s += "\n";
    }
    if (const auto aerosol = weather::aerosolOf(m); aerosol != weather::Aerosol::kHaze)
      s += fmt::format("  air           {}\n",
                       kEnumNames<weather::Aerosol>[static_cast<std::size_t>(aerosol)]);
    if (weather::snowLiesOnGround(m)) s += "  ground        snow\n";
    s += "  sky           " + skyText(m) + "\n";
    if (m.temperatureC || m.dewPointC)
      s += "  temperature   " + degreesText(m.temperatureC) +
           (m.dewPointC ? ", dew point " + degreesText(m.dewPointC) : "") + "\n";
    if (m.pressureHpa) s += fmt::format("  pressure      {:.1f} hPa\n", *m.pressureHpa);
  }
  for (const auto& e : r.errors) s += fmt::format("  error         column {}: {}\n", e.column, e.reason);
  return s;
}

void runMetarCommand(const std::vector<std::string>& reports, const std::optional<std::string>& file,
                     bool json) {
  std::size_t count = 0, wrong = 0;
  std::string firstError;
  // `place` of the report, before its column.
  const auto show = [&](std::string_view report, const std::string& place) {
    const MetarResult r = weather::parseMetar(report);
    const std::string out =
        json ? printableJson(metarToJson(report, r)) + "\n" : printableLines(metarToText(r));
    std::fwrite(out.data(), 1, out.size(), stdout);
    ++count;
    if (r.ok() || wrong++ > 0) return;
    firstError = fmt::format("{}{}: {}", place, r.errors.front().column, r.errors.front().reason);
  };
  for (const auto& report : reports) show(report, fmt::format("report {}, column ", count + 1));
  if (file) {
    std::ifstream opened;
    if (*file != "-") {
      opened.open(*file);
      if (!opened) throw IoError("cannot read " + *file);
    }
    std::istream& in = *file == "-" ? std::cin : opened;
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // editors put it before UTF-8
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      if (number == 1 && line.starts_with(kByteOrderMark)) line.erase(0, kByteOrderMark.size());
      if (line.ends_with('\r')) line.pop_back();
      const auto first = line.find_first_not_of(" \t");
      if (first == std::string::npos || line[first] == '#') continue;
      show(line, fmt::format("{}:{}:", *file == "-" ? "standard input" : *file, number));
    }
    if (in.bad()) throw IoError("cannot read " + *file);
  }
  if (wrong == 0) return;
  if (std::fflush(stdout) != 0) throw IoError("standard output cannot be written");
  if (count > 1) firstError += fmt::format("; {} of {} reports have errors", wrong, count);
  throw ParameterError(firstError);
}

}  // namespace welkin::app
