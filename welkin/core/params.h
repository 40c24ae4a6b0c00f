// SPDX-License-Identifier: Apache-2.0
// Parameters described once. A parameter struct has in-class defaults and one free function beside it,
//
//   void describe(FogParams& p, ParamVisitor& v) {
//     v.value({"height_m", "m", "thickness of the fog", 0, 1000}, p.heightM);
//   }
//
// Scene files, command-line help, JSON, panels and documentation are visitors; none of them repeats a name,
// unit, range or default. A key is snake_case and ends in its unit when that is not plain from the meaning.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "welkin/core/utc_time.h"

namespace welkin {

struct ParamInfo {
  std::string_view key;      // snake_case
  std::string_view unit;     // "m", "deg", "1/m", "cd/m2"; empty for pure numbers, texts and choices
  std::string_view meaning;  // one line, no full stop
  double min = -std::numeric_limits<double>::infinity();  // inclusive; for vectors each component
  double max = std::numeric_limits<double>::infinity();   // inclusive
};

// Names of an enum's values in order of their numbers 0, 1, ...; specialise beside the enum:
//   template <> inline constexpr std::array kEnumNames<Projection> = {"perspective"sv, ...};
template <class E>
inline constexpr auto kEnumNames = std::array<std::string_view, 0>{};

class ParamVisitor {
 public:
  virtual ~ParamVisitor() = default;

  virtual void value(const ParamInfo& info, bool& x) = 0;
  virtual void value(const ParamInfo& info, std::int64_t& x) = 0;
  virtual void value(const ParamInfo& info, double& x) = 0;
  virtual void value(const ParamInfo& info, glm::dvec3& x) = 0;
  virtual void value(const ParamInfo& info, std::string& x) = 0;
  virtual void value(const ParamInfo& info, UtcTime& x) = 0;
  // Absent means "choose for me"; the meaning says what is chosen.
  virtual void value(const ParamInfo& info, std::optional<double>& x) = 0;
  virtual void value(const ParamInfo& info, std::optional<std::string>& x) = 0;
  // One of `names`, by number.
  virtual void choice(const ParamInfo& info, std::span<const std::string_view> names, int& x) = 0;

  template <class E>
  void choice(const ParamInfo& info, E& x) {
    int i = static_cast<int>(x);
    choice(info, std::span<const std::string_view>(kEnumNames<E>), i);
    x = static_cast<E>(i);
  }

  // A nested struct that has describe().
  template <class T>
  void group(const ParamInfo& info, T& x) {
    if (!beginGroup(info)) return;
    describe(x, *this);
    endGroup();
  }

  // A list of structs that have describe(): [[layer]] in a scene file.
  template <class T>
  void list(const ParamInfo& info, std::vector<T>& xs) {
    xs.resize(beginList(info, xs.size()));
    for (std::size_t i = 0; i < xs.size(); ++i) {
      beginElement(i);
      describe(xs[i], *this);
      endElement();
    }
    if (xs.empty() && wantsListPrototype()) {
      T prototype{};
      beginElement(0);
      describe(prototype, *this);
      endElement();
    }
    endList();
  }

 protected:
  virtual bool beginGroup(const ParamInfo& info) = 0;  // false: skip the group (endGroup is then not called)
  virtual void endGroup() = 0;
  // Gets the present number of elements, returns the number that the list is to have.
  virtual std::size_t beginList(const ParamInfo& info, std::size_t size) = 0;
  virtual void beginElement(std::size_t i) = 0;
  virtual void endElement() = 0;
  virtual void endList() = 0;
  // True for visitors that document parameters and so need to see an element even of an empty list.
  virtual bool wantsListPrototype() const { return false; }
};

// The candidate nearest to `word` by edit distance (insert, delete, replace, swap of neighbours), or empty
// when none is near enough to be what was meant.
std::string nearestName(std::string_view word, std::span<const std::string> candidates);

}  // namespace welkin
