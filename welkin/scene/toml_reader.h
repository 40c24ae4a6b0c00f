// SPDX-License-Identifier: Apache-2.0
// Described parameters from TOML. For the .cpp files of this folder alone: toml++ is heavy to compile and
// stays out of every other header.
#pragma once

// toml++ 3.3 asserts, or with clang assumes, what it checks properly a few lines further on ("a.=1",
// "1979-05-27T x"): a damaged file would abort a debug build and be undefined behaviour in a release build.
// Its assertions are therefore off in every build, which takes both macros, and such files end as the parse
// errors that they are.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/core/params.h"
#include "welkin/scene/param_docs.h"
#include "welkin/scene/param_text.h"

namespace welkin::scene {

// The whole file. Throws IoError; `expected` is "a scene file", for a path that is a folder.
std::string readText(const std::string& path, const std::string& expected);

// Throws ParseError with file:line:column.
toml::table parseToml(std::string_view text, const std::string& name);

// What is wrong with a node of the file `name`, with its place.
ParseError errorAt(const toml::node& node, const std::string& name, const std::string& message);

// What no single range can say of each element of the list `key`: validate() with the element's place, as
// ParseError.
template <class T>
void validateEach(const std::vector<T>& elements, const toml::table& root, std::string_view key,
                  const std::string& name) {
  for (std::size_t i = 0; i < elements.size(); ++i) try {
      validate(elements[i]);
    } catch (const ParameterError& e) {
      throw errorAt(*root[key][i].node(), name, e.what());
    }
}

// "a whole number": what a message calls it.
std::string kindOf(const toml::node& node);

// Sets described parameters from a TOML table and complains about what the description does not know.
class TomlReader final : public ParamVisitor {
 public:
  // known: every key that the file may have, so that one in the wrong place can be told.
  TomlReader(const toml::table& root, const std::string& file, std::vector<ParamDoc> known)
      : file_(file), known_(std::move(known)) {
    levels_.push_back({&root, {}, {}, {}});
  }

  std::vector<std::string> given;

  void finish() { checkKeys(); }

  void value(const ParamInfo& info, bool& x) override {
    if (const toml::node* n = find(info)) x = typed<bool>(*n, info, "true or false");
  }
  void value(const ParamInfo& info, std::int64_t& x) override {
    const toml::node* n = find(info);
    if (n == nullptr) return;
    const std::int64_t i = typed<std::int64_t>(*n, info, "a whole number");
    requireInRange(*n, info, i);
    x = i;
  }
  void value(const ParamInfo& info, double& x) override {
    if (const toml::node* n = find(info)) x = number(*n, info, "a number");
  }
  void value(const ParamInfo& info, glm::dvec3& x) override {
    const toml::node* n = find(info);
    if (n == nullptr) return;
    const toml::array* a = n->as_array();
    if (a == nullptr || a->size() != 3) wrongType(*n, info, "a list of three numbers");
    glm::dvec3 v{};
    for (int i = 0; i < 3; ++i)
      v[i] = number(*a->get(static_cast<std::size_t>(i)), info, "a list of three numbers");
    x = v;
  }
  void value(const ParamInfo& info, std::string& x) override {
    if (const toml::node* n = find(info)) x = typed<std::string>(*n, info, "text");
  }
  void value(const ParamInfo& info, UtcTime& x) override {
    const toml::node* n = find(info);
    if (n == nullptr) return;
    std::string text;
    if (const auto* t = n->as_date_time()) {
      std::ostringstream s;
      s << t->get();
      text = s.str();
    } else if (const auto* s = n->as_string()) {
      text = s->get();
    } else {
      wrongType(*n, info, "a date and time such as 2026-06-21T18:30:00Z");
    }
    try {
      x = parseUtcTime(text);
    } catch (const ParseError& e) {
      fail(*n, std::string(info.key) + ": " + e.what());
    }
  }
  void value(const ParamInfo& info, std::optional<double>& x) override {
    if (const toml::node* n = find(info)) x = number(*n, info, "a number");
  }
  void value(const ParamInfo& info, std::optional<std::string>& x) override {
    if (const toml::node* n = find(info)) x = typed<std::string>(*n, info, "text");
  }
  void choice(const ParamInfo& info, std::span<const std::string_view> names, int& x) override {
    const toml::node* n = find(info);
    if (n == nullptr) return;
    const std::string found = typed<std::string>(*n, info, "text");
    const auto it = std::find(names.begin(), names.end(), found);
    if (it == names.end()) fail(*n, choiceProblem(info, names, found));
    x = static_cast<int>(it - names.begin());
  }

 protected:
  bool beginGroup(const ParamInfo& info) override {
    const toml::node* n = find(info);
    if (n == nullptr) return false;
    const std::string name = "[" + std::string(info.key) + "]";
    if (!n->is_table()) wrongType(*n, info, "a table " + name);
    levels_.push_back({n->as_table(), name, std::string(info.key) + ".", {}});
    return true;
  }
  void endGroup() override {
    checkKeys();
    levels_.pop_back();
  }
  std::size_t beginList(const ParamInfo& info, std::size_t) override {
    const toml::node* n = find(info);
    list_ = nullptr;
    if (n == nullptr) return 0;
    const std::string name = "[[" + std::string(info.key) + "]]";
    list_ = n->as_array();
    if (list_ == nullptr) wrongType(*n, info, "a list of tables " + name);
    for (const toml::node& element : *list_)
      if (!element.is_table()) wrongType(element, info, "a list of tables " + name);
    listName_ = name;
    listPrefix_ = std::string(info.key) + ".";
    return list_->size();
  }
  void beginElement(std::size_t i) override {
    levels_.push_back({list_->get(i)->as_table(), listName_, listPrefix_, {}});
  }
  void endElement() override { endGroup(); }
  void endList() override {}

 private:
  struct Level {
    const toml::table* table;
    std::string name;                // "", "[place]", "[[layer]]"
    std::string prefix;              // "", "place.", "layer."
    std::vector<std::string> known;  // keys that the description has asked for so far
  };

  const toml::node* find(const ParamInfo& info) {
    Level& level = levels_.back();
    level.known.emplace_back(info.key);
    const toml::node* n = level.table->get(info.key);
    if (n != nullptr) given.push_back(level.prefix + std::string(info.key));
    return n;
  }

  [[noreturn]] void failAt(const toml::source_region& where, const std::string& message) const {
    throw ParseError(file_, static_cast<int>(where.begin.line), static_cast<int>(where.begin.column),
                     message);
  }
  [[noreturn]] void fail(const toml::node& node, const std::string& message) const {
    failAt(node.source(), message);
  }
  [[noreturn]] void wrongType(const toml::node& node, const ParamInfo& info,
                              const std::string& expected) const {
    fail(node, std::string(info.key) + ": expected " + expected + ", found " + kindOf(node));
  }

  template <class T>
  T typed(const toml::node& node, const ParamInfo& info, const std::string& expected) const {
    const auto* v = node.as<T>();
    if (v == nullptr) wrongType(node, info, expected);
    return v->get();
  }
  double number(const toml::node& node, const ParamInfo& info, const std::string& expected) const {
    double x = 0;
    if (const auto* i = node.as_integer())
      x = static_cast<double>(i->get());
    else
      x = typed<double>(node, info, expected);
    requireInRange(node, info, x);
    return x;
  }
  template <class Number>
  void requireInRange(const toml::node& node, const ParamInfo& info, Number x) const {
    if (const std::string problem = rangeProblem(info, x); !problem.empty()) fail(node, problem);
  }

  void checkKeys() const {
    const Level& level = levels_.back();
    for (const auto& [key, node] : *level.table) {
      const std::string found(key.str());
      if (std::find(level.known.begin(), level.known.end(), found) != level.known.end()) continue;
      std::string message = "unknown key \"" + found + "\"";
      if (!level.name.empty()) message += " in " + level.name;
      failAt(key.source(), message + hint(found, level));
    }
  }

  // The same key in another group is a better guess than a similar one in this group.
  std::string hint(const std::string& found, const Level& level) const {
    for (const ParamDoc& row : known_)
      if (row.key == found)
        return "; it belongs " +
               (row.group.empty() ? "at the top of the file, above every [table]" : "in " + row.group);
    // A key without its unit is the commonest slip.
    for (const std::string& k : level.known)
      if (k.starts_with(found + "_")) return "; did you mean \"" + k + "\"?";
    if (const std::string near = nearestName(found, level.known); !near.empty())
      return "; did you mean \"" + near + "\"?";
    std::string list;
    for (const std::string& k : level.known) list += (list.empty() ? "" : ", ") + k;
    return "; expected one of " + list;
  }

  std::string file_;
  std::vector<ParamDoc> known_;
  std::vector<Level> levels_;
  const toml::array* list_ = nullptr;
  std::string listName_, listPrefix_;
};

}  // namespace welkin::scene
