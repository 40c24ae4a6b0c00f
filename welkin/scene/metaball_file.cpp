// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/metaball_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "welkin/core/error.h"
#include "welkin/scene/toml_reader.h"

namespace welkin::scene {
namespace {

using Json = nlohmann::ordered_json;

// A ball a line.
void appendBalls(const std::vector<field::Metaball>& balls, std::string& text) {
  text += "[";
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const field::Metaball& b = balls[i];
    const Json j = {{"center_m", {b.centreM.x, b.centreM.y, b.centreM.z}},
                    {"radius_m", b.radiusM},
                    {"density", b.density}};
    text += (i == 0 ? "\n  " : ",\n  ") + j.dump();
  }
  text += "]";
}

void appendErrors(const MetaballLevel& level, std::string& text) {
  if (level.relativeL2) text += ",\n\"relative_l2\": " + Json(*level.relativeL2).dump();
  if (level.rmse) text += ",\n\"rmse\": " + Json(*level.rmse).dump();
}

// Finds keys that an object has twice, of which a reader would take the last without a word.
class KeysOnce {
 public:
  explicit KeysOnce(const std::string& name) : name_(name) {}

  bool operator()(int, Json::parse_event_t event, const Json& parsed) {
    switch (event) {
      case Json::parse_event_t::object_start:
      case Json::parse_event_t::array_start:
        open_.emplace_back();
        open_.back().isList = event == Json::parse_event_t::array_start;
        break;
      case Json::parse_event_t::key:
        addKey(parsed.get_ref<const std::string&>());
        break;
      case Json::parse_event_t::object_end:
      case Json::parse_event_t::array_end:
        open_.pop_back();
        [[fallthrough]];
      case Json::parse_event_t::value:
        if (!open_.empty()) ++open_.back().index;
    }
    return true;
  }

 private:
  struct Open {
    bool isList = false;
    std::size_t index = 0;  // of the value to come
    std::vector<std::string> keys;
  };

  void addKey(const std::string& key) {
    std::vector<std::string>& keys = open_.back().keys;
    if (std::ranges::find(keys, key) != keys.end())
      throw ParseError(name_, 0, 0, place() + key + " is there twice; expected it once");
    keys.push_back(key);
  }

  // "level 1: ball 3: "
  std::string place() const {
    std::string text;
    for (std::size_t i = 0; i + 2 < open_.size(); ++i) {
      if (open_[i].keys.empty() || !open_[i + 1].isList) continue;
      const std::string& list = open_[i].keys.back();
      const std::string number = std::to_string(open_[i + 1].index) + ": ";
      if (list == "levels") text += "level " + number;
      if (list == "balls") text += "ball " + number;
    }
    return text;
  }

  const std::string& name_;
  std::vector<Open> open_;
};

// What a parser says, without its number and the place: "unexpected end of input; expected ...".
std::string reasonOf(const Json::exception& e) {
  constexpr std::size_t kMostLength = 120;
  std::string text = e.what();
  for (const std::string before : {" - ", "] "})
    if (const auto at = text.find(before); at != std::string::npos) {
      text = text.substr(at + before.size());
      break;
    }
  // What was last read may be long.
  return text.size() <= kMostLength ? text : text.substr(0, text.find(';'));
}

class Reader {
 public:
  explicit Reader(std::string name) : name_(std::move(name)) {}

  [[noreturn]] void fail(const std::string& why) const { throw ParseError(name_, 0, 0, why); }

  double number(const Json& ball, const char* key, const std::string& where) const {
    const auto it = ball.find(key);
    if (it == ball.end() || !it->is_number()) fail(where + key + ": expected a number");
    return it->get<double>();
  }

  field::Metaball ball(const Json& json, const std::string& where) const {
    if (!json.is_object()) fail(where + "expected an object with center_m, radius_m and density");
    field::Metaball b;
    const auto centre = json.find("center_m");
    if (centre == json.end() || !centre->is_array() || centre->size() != 3 ||
        !std::all_of(centre->begin(), centre->end(), [](const Json& x) { return x.is_number(); }))
      fail(where + "center_m: expected three numbers");
    for (int i = 0; i < 3; ++i) b.centreM[i] = (*centre)[static_cast<std::size_t>(i)].get<double>();
    b.radiusM = number(json, "radius_m", where);
    b.density = number(json, "density", where);
    return b;
  }

  MetaballLevel level(const Json& json, const std::string& where) const {
    MetaballLevel level;
    const auto balls = json.find("balls");
    if (balls == json.end() || !balls->is_array() || balls->empty())
      fail(where + "balls: expected a list of at least one ball");
    level.balls.reserve(balls->size());
    for (std::size_t i = 0; i < balls->size(); ++i)
      level.balls.push_back(ball((*balls)[i], where + "ball " + std::to_string(i) + ": "));
    try {
      field::validate(level.balls);
    } catch (const ParameterError& e) {
      fail(where + e.what());
    }
    if (json.contains("relative_l2")) level.relativeL2 = number(json, "relative_l2", where);
    if (json.contains("rmse")) level.rmse = number(json, "rmse", where);
    return level;
  }

 private:
  std::string name_;
};

}  // namespace

std::string metaballText(const MetaballFile& file) {
  std::string text = "{\"welkin\": \"metaballs\",\n\"balls\": ";
  appendBalls(file.balls(), text);
  appendErrors(file.levels.back(), text);
  if (file.levels.size() > 1) {
    text += ",\n\"levels\": [";
    for (std::size_t i = 0; i + 1 < file.levels.size(); ++i) {
      text += i == 0 ? "\n{\"balls\": " : ",\n{\"balls\": ";
      appendBalls(file.levels[i].balls, text);
      appendErrors(file.levels[i], text);
      text += "}";
    }
    text += "]";
  }
  return text + "}\n";
}

MetaballFile parseMetaballs(const std::string& text, const std::string& name) {
  Json json;
  try {
    json = Json::parse(text, KeysOnce(name));
  } catch (const Json::parse_error& e) {
    const std::size_t at = std::min(e.byte > 0 ? e.byte - 1 : 0, text.size());
    const auto begin = text.begin(), place = begin + static_cast<std::ptrdiff_t>(at);
    const auto line = 1 + std::count(begin, place, '\n');
    const std::size_t lineBegin = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    const std::size_t column = lineBegin == std::string::npos ? at + 1 : at - lineBegin;
    throw ParseError(name, static_cast<int>(line), static_cast<int>(column), "is no JSON: " + reasonOf(e));
  } catch (const Json::exception& e) {  // a number that is out of range
    throw ParseError(name, 0, 0, "is no JSON: " + reasonOf(e));
  }
  const Reader reader(name);
  const auto kind = json.is_object() ? json.find("welkin") : json.end();
  if (!json.is_object() || kind == json.end() || *kind != "metaballs")
    reader.fail("holds no metaballs; expected an object with \"welkin\": \"metaballs\"");
  MetaballFile file;
  if (const auto levels = json.find("levels"); levels != json.end()) {
    if (!levels->is_array()) reader.fail("levels: expected a list");
    for (std::size_t i = 0; i < levels->size(); ++i) {
      const std::string where = "level " + std::to_string(i) + ": ";
      if (!(*levels)[i].is_object()) reader.fail(where + "expected an object with balls");
      file.levels.push_back(reader.level((*levels)[i], where));
    }
  }
  file.levels.push_back(reader.level(json, ""));
  return file;
}

MetaballFile readMetaballs(const std::string& path) {
  return parseMetaballs(readText(path, "a file of metaballs"), path);
}

}  // namespace welkin::scene
