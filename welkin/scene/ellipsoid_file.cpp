// SPDX-License-Identifier: Apache-2.0
#include "welkin/scene/ellipsoid_file.h"

#include "welkin/scene/toml_reader.h"

namespace welkin::scene {
namespace {

struct EllipsoidFile {
  std::vector<field::Ellipsoid> ellipsoids;
};

void describe(EllipsoidFile& file, ParamVisitor& v) {
  v.list({"ellipsoid", "", "one part of the cloud"}, file.ellipsoids);
}

}  // namespace

std::vector<field::Ellipsoid> readEllipsoids(const std::string& path) {
  const toml::table root = parseToml(readText(path, "a file of ellipsoids"), path);
  EllipsoidFile file;
  TomlReader reader(root, path, documentParams<EllipsoidFile>());
  describe(file, reader);
  reader.finish();
  if (file.ellipsoids.empty()) throw ParseError(path, 0, 0, "has no [[ellipsoid]]; expected at least one");
  return file.ellipsoids;
}

}  // namespace welkin::scene
