// SPDX-License-Identifier: Apache-2.0
// Described parameters as JSON: groups become objects, lists arrays, times ISO 8601 texts, absent values
// null.
#pragma once

#include <memory>
#include <string>

#include "welkin/core/params.h"

namespace welkin::scene {

namespace detail {

class JsonWriter final : public ParamVisitor {
 public:
  JsonWriter();
  ~JsonWriter() override;
  std::string text(int indent) const;

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
  void beginElement(std::size_t i) override;
  void endElement() override;
  void endList() override;

 private:
  struct Impl;  // keeps the JSON library out of this header
  std::unique_ptr<Impl> impl_;
};

}  // namespace detail

// indent: spaces for each level, -1 for one line.
template <class T>
std::string toJson(const T& params, int indent = 2) {
  T copy = params;  // visitors may write, this one does not
  detail::JsonWriter writer;
  describe(copy, writer);
  return writer.text(indent);
}

}  // namespace welkin::scene
