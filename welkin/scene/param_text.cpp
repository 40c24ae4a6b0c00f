// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/param_text.h"

#include <charconv>
#include <vector>

#include "welkin/core/error.h"

namespace welkin::scene {
namespace {

[[noreturn]] void fail(const ParamInfo& info, std::string_view expected, std::string_view found) {
  throw ParameterError(std::string(info.key) + ": expected " + std::string(expected) + ", found \"" +
                       std::string(found) + "\"");
}

template <class Number>
void requireInRange(const ParamInfo& info, Number x) {
  if (const std::string problem = rangeProblem(info, x); !problem.empty()) throw ParameterError(problem);
}

double parseDouble(const ParamInfo& info, std::string_view text) {
  double x = 0;
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size())
    fail(info, "a number", text);
  requireInRange(info, x);
  return x;
}

}  // namespace

std::string choiceProblem(const ParamInfo& info, std::span<const std::string_view> names,
                          std::string_view found) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i)
    list += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + std::string(names[i]);
  std::string message = std::string(info.key) + " is \"" + std::string(found) + "\"; expected " + list;
  const std::string near = nearestName(found, std::vector<std::string>(names.begin(), names.end()));
  if (!near.empty()) message += "; did you mean " + near + "?";
  return message;
}

namespace detail {

void requireFound(bool found, std::string_view path) {
  if (!found) throw ParameterError("there is no parameter \"" + std::string(path) + "\"");
}

bool TextSetter::isTarget(const ParamInfo& info) {
  if (depthInList_ > 0 || rest_ != info.key) return false;
  found_ = true;
  return true;
}

void TextSetter::value(const ParamInfo& info, bool& x) {
  if (!isTarget(info)) return;
  if (text_ != "true" && text_ != "false") fail(info, "true or false", text_);
  x = text_ == "true";
}

void TextSetter::value(const ParamInfo& info, std::int64_t& x) {
  if (!isTarget(info)) return;
  std::int64_t n = 0;
  const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), n);
  const bool read = !text_.empty() && end == text_.data() + text_.size();
  if (!read || error == std::errc::invalid_argument) fail(info, "a whole number", text_);
  if (error == std::errc::result_out_of_range)
    fail(info, rangeText(info).empty() ? "a smaller number" : rangeText(info), text_);
  requireInRange(info, n);
  x = n;
}

void TextSetter::value(const ParamInfo& info, double& x) {
  if (isTarget(info)) x = parseDouble(info, text_);
}

void TextSetter::value(const ParamInfo& info, glm::dvec3& x) {
  if (!isTarget(info)) return;
  glm::dvec3 v{};
  std::string_view rest = text_;
  for (int i = 0; i < 3; ++i) {
    const std::size_t comma = rest.find(',');
    if ((comma == std::string_view::npos) != (i == 2)) fail(info, "three numbers \"x,y,z\"", text_);
    v[i] = parseDouble(info, rest.substr(0, comma));
    if (i < 2) rest.remove_prefix(comma + 1);
  }
  x = v;
}

void TextSetter::value(const ParamInfo& info, std::string& x) {
  if (isTarget(info)) x = text_;
}

void TextSetter::value(const ParamInfo& info, UtcTime& x) {
  if (!isTarget(info)) return;
  try {
    x = parseUtcTime(text_);
  } catch (const ParseError& e) {
    throw ParameterError(std::string(info.key) + ": " + e.what());
  }
}

void TextSetter::value(const ParamInfo& info, std::optional<double>& x) {
  if (!isTarget(info)) return;
  if (text_ == "auto")
    x.reset();
  else
    x = parseDouble(info, text_);
}

void TextSetter::value(const ParamInfo& info, std::optional<std::string>& x) {
  if (isTarget(info)) x = std::string(text_);
}

void TextSetter::choice(const ParamInfo& info, std::span<const std::string_view> names, int& x) {
  if (!isTarget(info)) return;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == text_) {
      x = static_cast<int>(i);
      return;
    }
  throw ParameterError(choiceProblem(info, names, text_));
}

bool TextSetter::beginGroup(const ParamInfo& info) {
  if (depthInList_ > 0 || !rest_.starts_with(info.key)) return false;
  const std::string_view after = rest_.substr(info.key.size());
  if (!after.starts_with('.')) return false;
  rest_ = after.substr(1);
  return true;
}

// A path leads into one group only: once that has been visited nothing else may match.
void TextSetter::endGroup() {
  rest_ = {};
}

std::size_t TextSetter::beginList(const ParamInfo&, std::size_t size) {
  return size;
}

}  // namespace detail
}  // namespace welkin::scene
