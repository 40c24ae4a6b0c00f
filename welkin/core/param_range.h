// SPDX-License-Identifier: Apache-2.0
// The ranges of described parameters: whether numbers are within them, and the sentences that say what is
// wrong. Whoever checks a parameter uses these, so that a mistake reads the same wherever it is made.
#pragma once

#include <cstdint>
#include <string>

#include "welkin/core/params.h"

namespace welkin {

// The shortest text that reads back as the same number: "0.1", "40000", "1e-09".
std::string numberText(double x);

// "-90 to 90 deg", "at least 0", or empty when everything is allowed.
std::string rangeText(const ParamInfo& info);

// Empty, or what is wrong with the number: "latitude_deg is 95; expected -90 to 90 deg". NaN and infinities
// are never allowed.
std::string rangeProblem(const ParamInfo& info, double x);
// The same of a whole number, to the last digit.
std::string rangeProblem(const ParamInfo& info, std::int64_t n);
inline std::string rangeProblem(const ParamInfo& info, int n) {
  return rangeProblem(info, std::int64_t{n});
}

namespace detail {

// Keeps the first problem that it meets.
class RangeCheck final : public ParamVisitor {
 public:
  const std::string& problem() const { return problem_; }

  void value(const ParamInfo& info, std::int64_t& x) override;
  void value(const ParamInfo& info, double& x) override;
  void value(const ParamInfo& info, glm::dvec3& x) override;
  void value(const ParamInfo& info, std::optional<double>& x) override;
  void value(const ParamInfo&, bool&) override {}
  void value(const ParamInfo&, std::string&) override {}
  void value(const ParamInfo&, UtcTime&) override {}
  void value(const ParamInfo&, std::optional<std::string>&) override {}
  void choice(const ParamInfo&, std::span<const std::string_view>, int&) override {}

 protected:
  bool beginGroup(const ParamInfo&) override { return true; }
  void endGroup() override {}
  std::size_t beginList(const ParamInfo&, std::size_t size) override { return size; }
  void beginElement(std::size_t) override {}
  void endElement() override {}
  void endList() override {}

 private:
  std::string problem_;
};

}  // namespace detail

// Of all numbers of a parameter struct: empty, or what is wrong with the first that is out of its range.
template <class T>
std::string rangeProblemIn(T params) {
  detail::RangeCheck check;
  describe(params, check);
  return check.problem();
}

}  // namespace welkin
