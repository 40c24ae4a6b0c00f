// SPDX-License-Identifier: Apache-2.0
#include "welkin/core/param_range.h"

#include <charconv>
#include <cmath>

namespace welkin {
namespace {

std::string withUnit(std::string text, const ParamInfo& info) {
  if (!info.unit.empty()) text += " " + std::string(info.unit);
  return text;
}

}  // namespace

std::string numberText(double x) {
  char buffer[32];
  // Whole numbers of everyday size are written out: 100000 rather than 1e+05.
  const bool plain = std::abs(x) < 1e16 && x == std::trunc(x);
  const auto end = plain ? std::to_chars(buffer, buffer + sizeof buffer, x, std::chars_format::fixed).ptr
                         : std::to_chars(buffer, buffer + sizeof buffer, x).ptr;
  return {buffer, end};
}

std::string rangeText(const ParamInfo& info) {
  const bool low = std::isfinite(info.min), high = std::isfinite(info.max);
  if (low && high) return withUnit(numberText(info.min) + " to " + numberText(info.max), info);
  if (low) return withUnit("at least " + numberText(info.min), info);
  if (high) return withUnit("at most " + numberText(info.max), info);
  return {};
}

namespace {

std::string notInRange(const ParamInfo& info, const std::string& number) {
  const std::string range = rangeText(info);
  return std::string(info.key) + " is " + number + "; expected " +
         (range.empty() ? "a finite number" : range);
}

}  // namespace

std::string rangeProblem(const ParamInfo& info, double x) {
  if (x >= info.min && x <= info.max && std::isfinite(x)) return {};
  return notInRange(info, numberText(x));
}

std::string rangeProblem(const ParamInfo& info, std::int64_t n) {
  // 2^63 is the first double that no number here reaches; below it doubles have whole numbers' own values.
  constexpr double kBeyond = 0x1p63;
  const bool low =
      info.min >= kBeyond || (info.min > -kBeyond && n < static_cast<std::int64_t>(std::ceil(info.min)));
  const bool high =
      info.max < -kBeyond || (info.max < kBeyond && n > static_cast<std::int64_t>(std::floor(info.max)));
  return low || high ? notInRange(info, std::to_string(n)) : std::string();
}

namespace detail {

void RangeCheck::value(const ParamInfo& info, std::int64_t& x) {
  if (problem_.empty()) problem_ = rangeProblem(info, x);
}

void RangeCheck::value(const ParamInfo& info, double& x) {
  if (problem_.empty()) problem_ = rangeProblem(info, x);
}

void RangeCheck::value(const ParamInfo& info, glm::dvec3& x) {
  for (int i = 0; i < 3; ++i) value(info, x[i]);
}

void RangeCheck::value(const ParamInfo& info, std::optional<double>& x) {
  if (x) value(info, *x);
}

}  // namespace detail
}  // namespace welkin
