// SPDX-License-Identifier: Apache-2.0
// Described parameters as TOML: every key is written but those that are absent.
#pragma once

#include <sstream>
#include <string>

#include "welkin/core/params.h"

namespace welkin::scene {

namespace detail {

class TomlWriter final : public ParamVisitor {
 public:
  std::string text() const { return out_.str(); }

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
  void endGroup() override {}
  std::size_t beginList(const ParamInfo& info, std::size_t size) override;
  void beginElement(std::size_t) override;
  void endElement() override {}
  void endList() override {}

 private:
  void line(const ParamInfo& info, const std::string& text);
  std::ostringstream out_;
  std::string list_;
};

}  // namespace detail

template <class T>
std::string toToml(const T& params) {
  T copy = params;  // visitors may write, this one does not
  detail::TomlWriter writer;
  describe(copy, writer);
  return writer.text();
}

}  // namespace welkin::scene
