// SPDX-License-Identifier: Apache-2.0
// The skeleton of an OpenVDB file, read without OpenVDB: its table of contents, a grid's metadata and
// transform, and a walk over the nodes of a tree of floats that checks every size in it. OpenVDB trusts what
// it reads (a chunk whose length is wrong runs over the end of its buffer), so a tree is handed to it only
// after this walk. Not for others than vdb.cpp and the tests.
//
// Versions 222 to 224 of the format, which is what OpenVDB has written since 2013. The layout follows
// OpenVDB's own reader (io/Archive, io/Compression.h, tree/RootNode.h, InternalNode.h, LeafNode.h of version
// 10).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "welkin/io/input_file.h"

namespace welkin::io::vdb {

struct Entry {
  std::string name;     // in this file alone: "density[1]" of the second "density"
  std::string ownName;  // "density" of both
  std::string type;     // without the ending that says half
  bool half = false;
  std::uint64_t gridByte = 0;    // where the grid begins
  std::uint64_t bufferByte = 0;  // where its leaves' values begin; 0: after the topology
};

struct Contents {
  std::uint32_t fileVersion = 0, libraryMajor = 0, libraryMinor = 0;
  std::vector<Entry> grids;  // only the first of a file without offsets
};
Contents readContents(InputFile& file);

struct GridHead {
  std::uint32_t compression = 0;
  std::map<std::string, std::string> texts;  // metadata of type string; numbers, and vectors of them, as text
  std::map<std::string, glm::ivec3> vectors;  // of type vec3i
  glm::dvec3 scale{1.0}, translation{0.0};    // of the transform
  std::uint64_t treeByte = 0;                 // where the topology begins
};
// Throws IoError for transforms other than scales and translations along the axes.
GridHead readGridHead(InputFile& file, const Entry& entry);

// Checks the topology at file.position() and the leaves' values, which follow or are at entry.bufferByte;
// returns where the values begin.
std::uint64_t checkFloatTree(InputFile& file, const Entry& entry, const GridHead& head);

constexpr const char* kFloatTree = "Tree_float_5_4_3";

}  // namespace welkin::io::vdb
