// SPDX-License-Identifier: Apache-2.0
// Described parameters as rows of documentation: for `welkin help scene`, for the help of flags and for
// docs/scene_file.md.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "welkin/core/params.h"

namespace welkin::scene {

struct ParamDoc {
  std::string group;         // "" at the top, "[place]", "[[layer]]"
  std::string groupMeaning;  // one line about the group
  std::string path;          // "seed", "place.latitude_deg", "layer.genus"
  std::string key;           // the last part of the path
  std::string
      type;  // "number", "whole number", "text", "time", "true or false", "3 numbers", or the choices "a | b"
  std::string unit;   // empty for pure numbers, texts and choices
  std::string range;  // "-90 to 90", without the unit; empty when everything is allowed
  std::string
      defaultValue;  // as it stands in a scene file; a word such as "absent" where there is no fixed value
  std::string meaning;
};

namespace detail {

class DocVisitor final : public ParamVisitor {
 public:
  std::vector<ParamDoc> rows;

  void value(const ParamInfo& info, bool& x) override;
  void value(const ParamInfo& info, std::int64_t& x) override;
  void value(const ParamInfo& info, double& x) override;
  void value(const ParamInfo& info, glm::dvec3& x) override;
  void value(const ParamInfo& info, std::string& x) override;
  void value(const ParamInfo& info, UtcTime& x) override;
  void value(const ParamInfo& info, std::optional<double>& x) override;
  void value(const ParamInfo& info, std::optional<std::string>& x) override;
  void choice(const ParamInfo& info, std::span<const std::string_view> names, int& x) override;

 protected:
  bool beginGroup(const ParamInfo& info) override;
  void endGroup() override;
  std::size_t beginList(const ParamInfo& info, std::size_t size) override;
  void beginElement(std::size_t) override {}
  void endElement() override {}
  void endList() override;
  bool wantsListPrototype() const override { return true; }

 private:
  void add(const ParamInfo& info, std::string type, std::string defaultValue);
  std::string group_, groupMeaning_, prefix_;
};

}  // namespace detail

// One row for each parameter of T, in the order of its description, with the defaults that stand in T or the
// values of `params`; of a list as of one element of defaults.
template <class T>
std::vector<ParamDoc> documentParams(T params = {}) {
  detail::DocVisitor visitor;
  describe(params, visitor);
  return visitor.rows;
}

// The row at `path`; it must exist.
const ParamDoc& docOf(std::span<const ParamDoc> rows, std::string_view path);

// For a terminal of `columns` characters: each group, then key, unit, range, default and meaning.
std::string plainTable(std::span<const ParamDoc> rows, int columns = 100);

// A Markdown table for each group.
std::string markdownTable(std::span<const ParamDoc> rows);

}  // namespace welkin::scene
