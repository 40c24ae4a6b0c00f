// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/param_docs.h"

#include <algorithm>
#include <cassert>
#include <sstream>

#include "welkin/scene/param_text.h"

namespace welkin::scene {
namespace detail {

void DocVisitor::add(const ParamInfo& info, std::string type, std::string defaultValue) {
  ParamInfo pure = info;
  pure.unit = {};
  rows.push_back({group_, groupMeaning_, prefix_ + std::string(info.key), std::string(info.key),
                  std::move(type), std::string(info.unit), rangeText(pure), std::move(defaultValue),
                  std::string(info.meaning)});
}

void DocVisitor::value(const ParamInfo& info, bool& x) {
  add(info, "true or false", x ? "true" : "false");
}
void DocVisitor::value(const ParamInfo& info, std::int64_t& x) {
  add(info, "whole number", std::to_string(x));
}
void DocVisitor::value(const ParamInfo& info, double& x) {
  add(info, "number", numberText(x));
}
void DocVisitor::value(const ParamInfo& info, glm::dvec3& x) {
  add(info, "3 numbers", "[" + numberText(x.x) + ", " + numberText(x.y) + ", " + numberText(x.z) + "]");
}
void DocVisitor::value(const ParamInfo& info, std::string& x) {
  add(info, "text", "\"" + x + "\"");
}
void DocVisitor::value(const ParamInfo& info, UtcTime& x) {
  add(info, "time", formatUtcTime(x));
}
void DocVisitor::value(const ParamInfo& info, std::optional<double>& x) {
  add(info, "number", x ? numberText(*x) : "absent");
}
void DocVisitor::value(const ParamInfo& info, std::optional<std::string>& x) {
  add(info, "text", x ? "\"" + *x + "\"" : "absent");
}
void DocVisitor::choice(const ParamInfo& info, std::span<const std::string_view> names, int& x) {
  std::string type;
  for (const std::string_view name : names) type += (type.empty() ? "" : " | ") + std::string(name);
  add(info, type, "\"" + std::string(names[static_cast<std::size_t>(x)]) + "\"");
}

// Scene files nest one level deep; deeper groups would need a stack here.
bool DocVisitor::beginGroup(const ParamInfo& info) {
  assert(group_.empty());
  group_ = "[" + std::string(info.key) + "]";
  groupMeaning_ = info.meaning;
  prefix_ = std::string(info.key) + ".";
  return true;
}
void DocVisitor::endGroup() {
  group_.clear();
  groupMeaning_.clear();
  prefix_.clear();
}
std::size_t DocVisitor::beginList(const ParamInfo& info, std::size_t) {
  beginGroup(info);
  group_ = "[" + group_ + "]";
  return 0;
}
void DocVisitor::endList() {
  endGroup();
}

}  // namespace detail

const ParamDoc& docOf(std::span<const ParamDoc> rows, std::string_view path) {
  const auto it = std::find_if(rows.begin(), rows.end(), [&](const ParamDoc& r) { return r.path == path; });
  assert(it != rows.end());
  return *it;
}

std::string plainTable(std::span<const ParamDoc> rows, int columns) {
  std::ostringstream out;
  std::size_t keyWidth = 0;
  for (const ParamDoc& r : rows) keyWidth = std::max(keyWidth, r.key.size());
  const std::size_t indent = keyWidth + 4, width = static_cast<std::size_t>(columns);
  const auto wrapped = [&](const std::string& text) {
    std::istringstream words(text);
    std::string word;
    std::size_t at = indent;
    while (words >> word) {
      if (at > indent && at + 1 + word.size() > width) {
        out << '\n' << std::string(indent, ' ');
        at = indent;
      }
      if (at > indent) out << ' ', ++at;
      out << word;
      at += word.size();
    }
    out << '\n';
  };
  const std::string* group = nullptr;
  for (const ParamDoc& r : rows) {
    if (group == nullptr || *group != r.group) {
      if (group != nullptr) out << '\n';
      if (!r.group.empty()) out << r.group << "  " << r.groupMeaning << '\n';
    }
    group = &r.group;
    out << "  " << r.key << std::string(keyWidth - r.key.size() + 2, ' ');
    std::string facts = r.type;
    if (!r.range.empty()) facts += ", " + r.range;
    if (!r.unit.empty()) facts += " " + r.unit;
    wrapped(r.meaning + " (" + facts + "; default " + r.defaultValue + ")");
  }
  return out.str();
}

namespace {

bool isWord(const ParamDoc& r) {
  return r.defaultValue == "absent" || r.defaultValue == "typical" || r.defaultValue == "of the projection";
}

}  // namespace

std::string markdownTable(std::span<const ParamDoc> rows) {
  const auto cell = [](std::string text) {
    for (std::size_t i = 0; (i = text.find('|', i)) != std::string::npos; i += 2) text.insert(i, "\\");
    return text;
  };
  std::ostringstream out;
  const std::string* group = nullptr;
  for (const ParamDoc& r : rows) {
    if (group == nullptr || *group != r.group) {
      if (group != nullptr) out << '\n';
      out << "### " << (r.group.empty() ? "At the top of the file" : "`" + r.group + "`: " + r.groupMeaning)
          << "\n\n| Key | Type | Range | Unit | Default | Meaning |\n|---|---|---|---|---|---|\n";
    }
    group = &r.group;
    out << "| `" << r.key << "` | " << cell(r.type) << " | " << r.range << " | " << r.unit << " | "
        << (isWord(r) ? r.defaultValue : "`" + r.defaultValue + "`") << " | " << cell(r.meaning) << " |\n";
  }
  return out.str();
}

}  // namespace welkin::scene
