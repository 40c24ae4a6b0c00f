// SPDX-License-Identifier: Apache-2.0
// OpenVDB (.vdb): a volume of one value a voxel as a sparse grid of floats, stored as floats or halves (K.
// Museth 2013, "VDB: High-Resolution Sparse Volumes with Dynamic Topology"). Optional: without it (CMake's
// WELKIN_OPENVDB) the writer and readVdb() throw IoError that says so.
//
// A grid's transform maps voxel (i, j, k) to the metres of its centre: voxel size and the first voxel's place
// along the axes of texels.h, no rotation. Zero is the background; voxels of exactly zero are not stored. The
// size of the whole box stands in the grid's metadata ("welkin_box_min", "welkin_box_max"), so that empty
// margins come back; a grid of other programs gives the box of its active voxels. Numbers in the metadata
// come as text. A grid that is no fog volume has its class ("level set", "staggered") as metadata "class",
// and is written with it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "welkin/io/texel_writer.h"
#include "welkin/io/texels.h"

namespace welkin::io {

bool hasVdb();

// Collects the slices in a sparse grid, so that memory is that of the voxels that are not zero, and writes at
// close(), Blosc compressed. Halves and 8-bit integers are stored as halves (8 bits survive that exactly),
// 16-bit integers and floats as floats. The same voxels give the same bytes. Throws ParameterError for
// pictures, several channels, NaNs and voxel sizes that are not positive.
class VdbWriter : public TexelWriter {
 public:
  VdbWriter(const std::filesystem::path& path, const TexelShape& shape, const TexelNotes& notes = {});
  ~VdbWriter() override;
  void write(std::span<const std::byte> rows) override;
  void close() override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

void writeVdb(const std::filesystem::path& path, const Texels& texels);

struct VdbGrid {
  std::string name;   // "density[1]" of the second "density"
  std::string type;   // OpenVDB's, "Tree_float_5_4_3" for instance
  bool half = false;  // stored as halves
};
// The grids of a file, from its table of contents.
std::vector<VdbGrid> readVdbGrids(const std::filesystem::path& path);

struct VdbReadOptions {
  // Its name, "density[1]" for the second of that name; empty: "density" if there is one, otherwise the first
  // of floats.
  std::string grid;
};
// A grid of floats, dense: r32f, or r16f if stored as halves. Sparse files can be far smaller than what they
// stand for, so a box is refused that has more than 2^24 voxels and more than 512 for each byte of the file,
// or more than 2^31. Rotated and non-linear transforms are refused. Throws IoError.
//
// Files are not trusted: header, names, metadata and offsets are checked here against the file's size before
// OpenVDB sees the tree, which it reads from a stream that throws at the end of the file.
Texels readVdb(const std::filesystem::path& path, const VdbReadOptions& options = {});

// What a grid holds, without making it dense: for boxes of any size below 2^31 voxels a side. Throws as
// readVdb() does.
struct VdbSummary {
  TexelShape shape;  // of the box
  TexelNotes notes;
  std::uint64_t activeVoxels = 0;
  float min = 0.0f, max = 0.0f;
  double mean = 0.0;  // over all voxels of the box
};
VdbSummary readVdbSummary(const std::filesystem::path& path, const VdbReadOptions& options = {});

}  // namespace welkin::io
