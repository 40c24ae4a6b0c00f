// SPDX-License-Identifier: Apache-2.0
// Values of described parameters as text: reading one (a flag of the command line, a value typed into a
// panel), and the sentences that say what is wrong with one (of numbers: core/param_range.h). Scene files use
// the same sentences, so that a mistake reads the same wherever it is made.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "welkin/core/param_range.h"
#include "welkin/core/params.h"

namespace welkin::scene {

// What is wrong with a name that is none of the choices, with the nearest one when there is one.
std::string choiceProblem(const ParamInfo& info, std::span<const std::string_view> names,
                          std::string_view found);

// Sets the parameter at `path` ("seed", "place.latitude_deg") from text. Numbers are decimal; vectors are
// "x,y,z"; optional numbers take "auto" for absent. Throws ParameterError, what() being the sentence of
// what is wrong; where the text stood is for the caller to add. The path must exist.
template <class T>
void setParam(T& params, std::string_view path, std::string_view text);

namespace detail {

class TextSetter final : public ParamVisitor {
 public:
  TextSetter(std::string_view path, std::string_view text) : rest_(path), text_(text) {}
  bool found() const { return found_; }

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
  std::size_t beginList(const ParamInfo&, std::size_t size) override;
  void beginElement(std::size_t) override { ++depthInList_; }
  void endElement() override { --depthInList_; }
  void endList() override {}

 private:
  bool isTarget(const ParamInfo& info);
  std::string_view rest_;  // what of the path is still to be met
  std::string_view text_;
  int depthInList_ = 0;  // elements of lists have no path
  bool found_ = false;
};

void requireFound(bool found, std::string_view path);

}  // namespace detail

template <class T>
void setParam(T& params, std::string_view path, std::string_view text) {
  detail::TextSetter setter(path, text);
  describe(params, setter);
  detail::requireFound(setter.found(), path);
}

}  // namespace welkin::scene
