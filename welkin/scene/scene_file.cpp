// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/scene_file.h"

#include <algorithm>
#include <sstream>

#include "welkin/core/error.h"
#include "welkin/scene/param_text.h"
#include "welkin/scene/toml_reader.h"

namespace welkin::scene {
namespace {

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
  const toml::table root = parseToml(text, name);
  SceneFile file;
  if (!latitudeDeg) latitudeDeg = root["place"]["latitude_deg"].value<double>();
  file.scene.layers = typicalLayers(root, latitudeDeg.value_or(file.scene.place.latitudeDeg));
  TomlReader reader(root, name, documentParams<Scene>());
  describe(file.scene, reader);
  reader.finish();
  file.given = std::move(reader.given);
  return file;
}

SceneFile readSceneFile(const std::string& path, std::optional<double> latitudeDeg) {
  return parseScene(readText(path, "a scene file"), path, latitudeDeg);
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
