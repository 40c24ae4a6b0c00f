// SPDX-License-Identifier: Apache-2.0
// The only file that includes toml++ (it is heavy to compile).
#include "welkin/scene/scene_file.h"

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
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "welkin/core/error.h"
#include "welkin/scene/param_text.h"

namespace welkin::scene {
namespace {

std::string kindOf(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "text";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

// Sets described parameters from a TOML table and complains about what the description does not know.
class TomlReader final : public ParamVisitor {
 public:
  TomlReader(const toml::table& root, const std::string& file) : file_(file) {
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
    requireInRange(*n, info, static_cast<double>(i));
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
  void requireInRange(const toml::node& node, const ParamInfo& info, double x) const {
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
  static std::string hint(const std::string& found, const Level& level) {
    for (const ParamDoc& row : documentParams<Scene>())
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
  std::vector<Level> levels_;
  const toml::array* list_ = nullptr;
  std::string listName_, listPrefix_;
};

// Layers with what is typical of their genus, before the reader sets what the file says. Mistakes are left
// for the reader.
std::vector<weather::Layer> typicalLayers(const toml::table& root, double latitudeDeg) {
  std::vector<weather::Layer> layers;
  const toml::array* list = root["layer"].as_array();
  if (list == nullptr) return layers;
  const auto& names = kEnumNames<weather::Genus>;
  for (const toml::node& element : *list) {
    weather::Layer layer;
    if (const toml::table* table = element.as_table()) {
      const auto name = (*table)["genus"].value<std::string>();
      const auto it = name ? std::find(names.begin(), names.end(), *name) : names.end();
      const int genus =
          it == names.end() ? static_cast<int>(layer.genus) : static_cast<int>(it - names.begin());
      layer = weather::typicalLayer(static_cast<weather::Genus>(genus), latitudeDeg);
      if (const auto base = (*table)["base_m"].value<double>())
        layer.topM = *base + (layer.topM - layer.baseM);
    }
    layers.push_back(layer);
  }
  return layers;
}

class TomlWriter final : public ParamVisitor {
 public:
  std::ostringstream out;

  void value(const ParamInfo& info, bool& x) override { line(info, x ? "true" : "false"); }
  void value(const ParamInfo& info, std::int64_t& x) override { line(info, std::to_string(x)); }
  void value(const ParamInfo& info, double& x) override { line(info, numberText(x)); }
  void value(const ParamInfo& info, glm::dvec3& x) override {
    line(info, "[" + numberText(x.x) + ", " + numberText(x.y) + ", " + numberText(x.z) + "]");
  }
  void value(const ParamInfo& info, std::string& x) override { line(info, quoted(x)); }
  void value(const ParamInfo& info, UtcTime& x) override { line(info, formatUtcTime(x)); }
  void value(const ParamInfo& info, std::optional<double>& x) override {
    if (x) line(info, numberText(*x));
  }
  void value(const ParamInfo& info, std::optional<std::string>& x) override {
    if (x) line(info, quoted(*x));
  }
  void choice(const ParamInfo& info, std::span<const std::string_view> names, int& x) override {
    line(info, quoted(std::string(names[static_cast<std::size_t>(x)])));
  }

 protected:
  bool beginGroup(const ParamInfo& info) override {
    out << "\n[" << info.key << "]\n";
    return true;
  }
  void endGroup() override {}
  std::size_t beginList(const ParamInfo& info, std::size_t size) override {
    list_ = info.key;
    return size;
  }
  void beginElement(std::size_t) override { out << "\n[[" << list_ << "]]\n"; }
  void endElement() override {}
  void endList() override {}

 private:
  void line(const ParamInfo& info, const std::string& text) { out << info.key << " = " << text << '\n'; }
  static std::string quoted(const std::string& text) {
    std::ostringstream s;
    s << toml::value<std::string>(text);
    return s.str();
  }
  std::string list_;
};

}  // namespace

bool SceneFile::gives(std::string_view path) const {
  return std::find(given.begin(), given.end(), path) != given.end();
}

SceneFile parseScene(std::string_view text, const std::string& name, std::optional<double> latitudeDeg) {
  toml::table root;
  try {
    root = toml::parse(text, std::string_view(name));
  } catch (const toml::parse_error& e) {
    throw ParseError(name, static_cast<int>(e.source().begin.line), static_cast<int>(e.source().begin.column),
                     std::string(e.description()));
  }
  SceneFile file;
  if (!latitudeDeg) latitudeDeg = root["place"]["latitude_deg"].value<double>();
  file.scene.layers = typicalLayers(root, latitudeDeg.value_or(file.scene.place.latitudeDeg));
  TomlReader reader(root, name);
  describe(file.scene, reader);
  reader.finish();
  file.given = std::move(reader.given);
  return file;
}

SceneFile readSceneFile(const std::string& path, std::optional<double> latitudeDeg) {
  if (std::filesystem::is_directory(path)) throw IoError(path + ": is a folder; expected a scene file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw IoError(path + ": cannot be opened: " + std::strerror(errno));
  std::ostringstream text;
  if (in.peek() != std::ifstream::traits_type::eof()) text << in.rdbuf();
  if (!text || in.bad()) throw IoError(path + ": cannot be read");
  return parseScene(text.str(), path, latitudeDeg);
}

std::vector<ParamDoc> documentSceneFile() {
  std::vector<ParamDoc> rows = documentParams<Scene>();
  for (ParamDoc& row : rows)
    if (row.group == "[[layer]]" && row.key != "genus" && row.key != "oktas") row.defaultValue = "typical";
  return rows;
}

std::string sceneToToml(const Scene& scene) {
  Scene copy = scene;  // visitors may write, this one does not
  TomlWriter writer;
  describe(copy, writer);
  return writer.out.str();
}

}  // namespace welkin::scene
