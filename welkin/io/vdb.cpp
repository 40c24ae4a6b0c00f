// SPDX-License-Identifier: Apache-2.0
// The only file that includes OpenVDB: its headers take a quarter of a minute to compile.
#include "welkin/io/vdb.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <fstream>
#include <limits>
#include <mutex>
#include <streambuf>
#include <utility>

#include "welkin/core/error.h"
#include "welkin/core/parallel.h"
#include "welkin/io/atomic_file.h"
#include "welkin/io/vdb_file.h"

namespace welkin::io {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using openvdb::FloatTree;
using Leaf = FloatTree::LeafNodeType;

constexpr int kLeafSide = Leaf::DIM;
constexpr std::uint64_t kMostVoxels = std::uint64_t{1} << 31;  // of a box
constexpr const char *kBoxMin = "welkin_box_min", *kBoxMax = "welkin_box_max";

void initialize() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

// OpenVDB's archives put a random identifier into each file. Ours is made from what follows it, so that the
// same voxels give the same bytes.
constexpr std::uint64_t kIdentifierByte = 21, kIdentifierBytes = 36;

// Lets OpenVDB write through AtomicFile, so that errors and the rename at the end are those of all formats.
class OutBuffer : public std::streambuf {
 public:
  explicit OutBuffer(AtomicFile& file) : file_(file) {}

  // A name-based identifier in the usual form of version 5 (RFC 4122) from 128 bits of hash.
  std::string identifier() const {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string text;
    for (std::size_t i = 0; i < 32; ++i) {
      if (i == 8 || i == 12 || i == 16 || i == 20) text += '-';
      const std::uint64_t digit = hashes_[i / 16] >> (4 * (i % 16)) & 15;
      text += i == 12 ? '5' : kDigits[i == 16 ? 8 | (digit & 3) : digit];
    }
    return text;
  }

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    const std::uint64_t at = file_.position();
    for (std::streamsize i = 0; i < count; ++i)
      if (at + static_cast<std::uint64_t>(i) >= kIdentifierByte + kIdentifierBytes) {
        // FNV-1a (G. Fowler, L. C. Noll, K.-P. Vo) from two starting points
        for (std::uint64_t& hash : hashes_)
          hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3;
      }
    file_.write(bytes, static_cast<std::size_t>(count));
    return count;
  }
  int_type overflow(int_type c) override {
    const char byte = traits_type::to_char_type(c);
    xsputn(&byte, 1);
    return c;
  }
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    if (from == std::ios_base::end) return pos_type(off_type(-1));
    if (from == std::ios_base::cur) offset += static_cast<off_type>(file_.position());
    return seekpos(offset, std::ios_base::out);
  }
  pos_type seekpos(pos_type position, std::ios_base::openmode) override {
    file_.seek(static_cast<std::uint64_t>(off_type(position)));
    return position;
  }

 private:
  AtomicFile& file_;
  std::array<std::uint64_t, 2> hashes_ = {0xcbf29ce484222325, 0x84222325cbf29ce4};
};

struct OutArchive : openvdb::io::Archive {
  void writeGrids(std::ostream& out, const openvdb::GridPtrVec& grids) { write(out, grids, true); }
};

openvdb::Vec3d vec3(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

// Dense values as a box of voxels that are handed over in rows of x.
class DenseBox {
 public:
  DenseBox(Texels& texels, const Coord& min) : texels_(texels), min_(min) {}

  // The values of voxels (x0 ... x0 + n - 1, y, z) of the grid, clipped to the box.
  void put(int x0, int y, int z, std::span<const float> values) {
    const TexelShape& s = texels_.shape;
    const std::int64_t j = std::int64_t{y} - min_.y(), k = std::int64_t{z} - min_.z();
    const std::int64_t i = std::int64_t{x0} - min_.x();
    if (j < 0 || j >= s.ny || k < 0 || k >= s.nz) return;
    const std::int64_t begin = std::max<std::int64_t>(i, 0);
    const std::int64_t end = std::min<std::int64_t>(i + static_cast<std::int64_t>(values.size()), s.nx);
    if (begin >= end) return;
    const std::size_t at = s.sliceBytes() * static_cast<std::size_t>(k) +
                           s.rowBytes() * static_cast<std::size_t>(j) +
                           s.texelBytes() * static_cast<std::size_t>(begin);
    const auto part =
        values.subspan(static_cast<std::size_t>(begin - i), static_cast<std::size_t>(end - begin));
    fromFloats(part, s.format.type, std::span(texels_.bytes).subspan(at, part.size() * s.texelBytes()));
  }

  void fill(CoordBBox box, float value) {
    const TexelShape& s = texels_.shape;
    box.intersect({min_, min_.offsetBy(s.nx - 1, s.ny - 1, s.nz - 1)});
    if (box.empty()) return;
    row_.assign(static_cast<std::size_t>(box.dim().x()), value);
    for (int z = box.min().z(); z <= box.max().z(); ++z)
      for (int y = box.min().y(); y <= box.max().y(); ++y) put(box.min().x(), y, z, row_);
  }

 private:
  Texels& texels_;
  Coord min_;
  std::vector<float> row_;
};

// The voxels that the volume shall have: the box that Welkin noted if it holds all that is there, or else
// that of the active ones.
CoordBBox boxOf(const InputFile& file, const vdb::GridHead& head, const FloatTree& tree) {
  CoordBBox active;
  const bool any = tree.evalActiveVoxelBoundingBox(active);
  const auto min = head.vectors.find(kBoxMin), max = head.vectors.find(kBoxMax);
  if (min != head.vectors.end() && max != head.vectors.end()) {
    const glm::ivec3 a = min->second, b = max->second;
    const CoordBBox noted(a.x, a.y, a.z, b.x, b.y, b.z);
    if (!noted.empty() && (!any || noted.isInside(active))) return noted;
  }
  if (!any) file.fail("the grid is empty");
  return active;
}

std::string sizeText(const CoordBBox& box) {
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += (i == 0 ? "" : "x") + std::to_string(std::int64_t{box.max()[i]} - box.min()[i] + 1);
  return text;
}

TexelShape shapeOf(const InputFile& file, const CoordBBox& box, bool half) {
  std::array<int, 3> size;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t side = std::int64_t{box.max()[i]} - box.min()[i] + 1;
    if (side > std::numeric_limits<int>::max())
      file.fail("the grid's box has " + sizeText(box) + " voxels; expected fewer than 2^31 a side");
    size[static_cast<std::size_t>(i)] = static_cast<int>(side);
  }
  return {{Channels::kR, half ? ValueType::kHalf : ValueType::kFloat}, size[0], size[1], size[2], true};
}

void requireDense(const InputFile& file, const CoordBBox& box, const TexelShape& shape) {
  constexpr std::uint64_t kAlways = 1 << 24, kForEachByte = 512;
  std::uint64_t voxels = 1;
  bool overflow = false;
  for (const int side : {shape.nx, shape.ny, shape.nz})
    overflow = overflow || __builtin_mul_overflow(voxels, static_cast<std::uint64_t>(side), &voxels);
  if (overflow || voxels > kMostVoxels || (voxels > kAlways && voxels / kForEachByte > file.size()))
    file.fail("the grid's box has " + sizeText(box) +
              " voxels, which is too many for a volume from a file of " + std::to_string(file.size()) +
              " bytes");
}

const vdb::Entry& chosen(const InputFile& file, const vdb::Contents& contents, const std::string& name) {
  const vdb::Entry* first = nullptr;
  for (const vdb::Entry& e : contents.grids) {
    const bool named = e.name == name || e.name + "[0]" == name;
    if (!name.empty() && named && e.type != vdb::kFloatTree)
      file.fail("the grid \"" + name + "\" is of type " + e.type + "; expected floats");
    if (e.type != vdb::kFloatTree) continue;
    if (name.empty() ? e.name == "density" : named) return e;
    if (!first) first = &e;
  }
  if (!name.empty()) file.fail("there is no grid \"" + name + '"');
  if (!first) file.fail("there is no grid of floats");
  return *first;
}

// Of what is no fog volume, which is what goes without saying.
constexpr const char* kClass = "class";
bool isOther(const std::string& gridClass) {
  return gridClass == "level set" || gridClass == "staggered";
}

bool isReserved(const std::string& key) {
  return key.empty() || key == "name" || key == kClass || key == "creator" || key == "vector_type" ||
         key == "value_type" || key.starts_with("is_") || key.starts_with("file_") || key == kBoxMin ||
         key == kBoxMax;
}

}  // namespace

bool hasVdb() {
  return true;
}

struct VdbWriter::Impl {
  Impl(const std::filesystem::path& path, const TexelShape& s, const TexelNotes& notes)
      : shape(s), file(path) {
    grid->setName(notes.name.empty() ? "density" : notes.name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    transform->preScale(vec3(notes.voxelSizeM));
    transform->postTranslate(vec3(notes.firstVoxelM));
    grid->setTransform(transform);
    grid->setSaveFloatAsHalf(shape.format.type == ValueType::kUnorm8 ||
                             shape.format.type == ValueType::kHalf);
    grid->insertMeta(kBoxMin, openvdb::Vec3IMetadata({0, 0, 0}));
    grid->insertMeta(kBoxMax, openvdb::Vec3IMetadata({shape.nx - 1, shape.ny - 1, shape.nz - 1}));
    for (const auto& [key, text] : notes.metadata) {
      if (key == kClass && isOther(text)) {
        grid->setGridClass(FloatGrid::stringToGridClass(text));
        continue;
      }
      if (isReserved(key))
        throw ParameterError("cannot write " + path.string() + ": metadata cannot be named \"" + key + '"');
      grid->insertMeta(key, openvdb::StringMetadata(text));
    }
  }

  // Rows are kept as floats until a layer of leaves is complete.
  void write(std::span<const std::byte> rows) {
    const std::size_t row = static_cast<std::size_t>(shape.nx),
                      layer = row * static_cast<std::size_t>(shape.ny) * kLeafSide;
    const std::size_t total = shape.bytes() / shape.texelBytes();
    while (!rows.empty()) {
      const std::size_t room = std::min(layer, total - layers * layer) - values.size();
      const std::size_t n = std::min(room, rows.size() / shape.texelBytes()), before = values.size();
      values.resize(before + n);
      toFloats(shape.format.type, rows.first(n * shape.texelBytes()), std::span(values).subspan(before));
      rows = rows.subspan(n * shape.texelBytes());
      for (std::size_t i = before; i < values.size(); ++i)
        if (!std::isfinite(values[i]))
          throw ParameterError("cannot write " + file.path().string() + ": no finite number at " +
                               texelPlace(shape, layers * layer + i));
      written += n;
      if (n == room) addLeaves();
    }
  }

  void addLeaves() {
    const int wide = (shape.nx + kLeafSide - 1) / kLeafSide, deep = (shape.ny + kLeafSide - 1) / kLeafSide;
    const int z0 = static_cast<int>(layers) * kLeafSide, slices = std::min(kLeafSide, shape.nz - z0);
    std::vector<std::unique_ptr<Leaf>> leaves(static_cast<std::size_t>(wide) *
                                              static_cast<std::size_t>(deep));
    parallelFor(leaves.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        leaves[i] = makeLeaf(static_cast<int>(i) % wide * kLeafSide, static_cast<int>(i) / wide * kLeafSide,
                             z0, slices);
    });
    for (auto& leaf : leaves)
      if (leaf) grid->tree().addLeaf(leaf.release());
    values.clear();
    ++layers;
  }

  // Null if all its voxels are zero.
  std::unique_ptr<Leaf> makeLeaf(int x0, int y0, int z0, int slices) const {
    std::unique_ptr<Leaf> leaf;
    for (int z = 0; z < slices; ++z)
      for (int y = y0; y < std::min(y0 + kLeafSide, shape.ny); ++y)
        for (int x = x0; x < std::min(x0 + kLeafSide, shape.nx); ++x) {
          const float value = values[(static_cast<std::size_t>(z) * static_cast<std::size_t>(shape.ny) +
                                      static_cast<std::size_t>(y)) *
                                         static_cast<std::size_t>(shape.nx) +
                                     static_cast<std::size_t>(x)];
          if (value == 0.0f) continue;
          if (!leaf) leaf = std::make_unique<Leaf>(Coord(x0, y0, z0), 0.0f);
          leaf->setValueOn(Leaf::coordToOffset({x, y, z}), value);
        }
    return leaf;
  }

  void close() {
    assert(written == shape.bytes() / shape.texelBytes());
    OutBuffer buffer(file);
    std::ostream out(&buffer);
    out.exceptions(std::ios_base::badbit | std::ios_base::failbit);  // of AtomicFile pass through
    OutArchive archive;
    archive.setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    try {
      archive.writeGrids(out, {grid});
    } catch (const Error&) {
      throw;
    } catch (const std::exception& e) {
      throw IoError("cannot write " + file.path().string() + ": " + e.what());
    }
    file.seek(kIdentifierByte);
    file.write(buffer.identifier());
    file.commit();
  }

  TexelShape shape;
  AtomicFile file;
  FloatGrid::Ptr grid = FloatGrid::create(0.0f);
  std::vector<float> values;  // of the layer of leaves that is being collected
  std::size_t layers = 0, written = 0;
};

VdbWriter::VdbWriter(const std::filesystem::path& path, const TexelShape& shape, const TexelNotes& notes) {
  const auto refuse = [&](const char* why) {
    throw ParameterError("cannot write " + path.string() + ": " + why);
  };
  validate(shape);
  if (!shape.volume) refuse("a VDB holds volumes, not pictures");
  if (countOf(shape.format.channels) != 1) refuse("a grid of a VDB holds one value a voxel");
  if (shape.bytes() / shape.texelBytes() > kMostVoxels)
    refuse("a VDB of more than 2^31 voxels would not be read again");
  for (int i = 0; i < 3; ++i)
    if (!(notes.voxelSizeM[i] > 0.0) || !std::isfinite(notes.voxelSizeM[i]) ||
        !std::isfinite(notes.firstVoxelM[i]))
      refuse("expected a positive voxel size and a finite place");
  initialize();
  try {
    impl_ = std::make_unique<Impl>(path, shape, notes);
  } catch (const openvdb::ArithmeticError&) {
    refuse("OpenVDB takes no voxels as small or as far away as that");
  }
}

VdbWriter::~VdbWriter() = default;

void VdbWriter::write(std::span<const std::byte> rows) {
  assert(rows.size() % impl_->shape.rowBytes() == 0);
  impl_->write(rows);
}

void VdbWriter::close() {
  impl_->close();
}

namespace {

// A grid as sparse as it lies in its file.
struct StoredGrid {
  FloatTree::Ptr tree = std::make_shared<FloatTree>();
  CoordBBox box;
  TexelShape shape;  // of the box
  TexelNotes notes;
};

StoredGrid readGrid(InputFile& file, const std::filesystem::path& path, const VdbReadOptions& options) {
  const vdb::Contents contents = vdb::readContents(file);
  const vdb::Entry& entry = chosen(file, contents, options.grid);
  const vdb::GridHead head = vdb::readGridHead(file, entry);
  const std::uint64_t buffers = vdb::checkFloatTree(file, entry, head);

  initialize();
  std::ifstream in(path, std::ios_base::binary);
  in.exceptions(std::ios_base::badbit | std::ios_base::failbit | std::ios_base::eofbit);
  openvdb::io::setVersion(in, {contents.libraryMajor, contents.libraryMinor}, contents.fileVersion);
  openvdb::io::setDataCompression(in, head.compression);
  StoredGrid grid;
  in.seekg(static_cast<std::streamoff>(head.treeByte));
  grid.tree->readTopology(in, entry.half);
  in.seekg(static_cast<std::streamoff>(buffers));
  grid.tree->readBuffers(in, entry.half);

  grid.box = boxOf(file, head, *grid.tree);
  grid.shape = shapeOf(file, grid.box, entry.half);
  grid.notes.name = entry.ownName;
  for (const vdb::Entry& other : contents.grids)
    if (&other != &entry) grid.notes.leftOut.push_back("grid " + other.name);
  grid.notes.voxelSizeM = head.scale;
  const Coord& min = grid.box.min();
  grid.notes.firstVoxelM = head.translation + head.scale * glm::dvec3(min.x(), min.y(), min.z());
  for (const auto& [key, text] : head.texts)
    if (!isReserved(key) || (key == kClass && isOther(text))) grid.notes.metadata[key] = text;
  return grid;
}

// Calls tile(box, value) for each that is not the background, and row(x, y, z, values) for what leaves hold.
template <class Tile, class Row>
void visitValues(const FloatTree& tree, const Tile& tile, const Row& row) {
  auto it = tree.cbeginValueAll();
  it.setMaxDepth(FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; it; ++it)
    if (it.getValue() != tree.background()) {
      CoordBBox where;
      it.getBoundingBox(where);
      tile(where, it.getValue());
    }
  std::array<float, kLeafSide> values;
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    const Coord origin = leaf->origin();
    for (int z = 0; z < kLeafSide; ++z)
      for (int y = 0; y < kLeafSide; ++y) {
        for (int x = 0; x < kLeafSide; ++x)
          values[static_cast<std::size_t>(x)] = leaf->getValue(Leaf::coordToOffset({x, y, z}));
        row(origin.x(), origin.y() + y, origin.z() + z, values);
      }
  }
}

// Over the voxels of a box.
class Statistics {
 public:
  Statistics(const InputFile& file, const CoordBBox& box) : file_(file), box_(box) {}

  void add(CoordBBox where, float value) {
    where.intersect(box_);
    if (where.empty()) return;
    const Coord dim = where.dim();
    add(where.min(), value, static_cast<double>(dim.x()) * dim.y() * dim.z());
  }
  void add(int x0, int y, int z, std::span<const float> values) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (const Coord at(x0 + static_cast<int>(i), y, z); box_.isInside(at)) add(at, values[i], 1.0);
  }
  // The rest of the box is background.
  void into(float background, VdbSummary& summary) {
    const Coord dim = box_.dim();
    const double all = static_cast<double>(dim.x()) * dim.y() * dim.z();
    if (all > voxels_) add(box_.min(), background, all - voxels_);
    summary.min = min_, summary.max = max_, summary.mean = sum_ / all;
  }

 private:
  void add(const Coord& at, float value, double voxels) {
    if (!std::isfinite(value)) {
      const Coord place = at - box_.min();
      file_.fail("no finite number at texel (" + std::to_string(place.x()) + ", " +
                 std::to_string(place.y()) + ", " + std::to_string(place.z()) + ")");
    }
    min_ = std::min(min_, value), max_ = std::max(max_, value);
    sum_ += voxels * static_cast<double>(value);
    voxels_ += voxels;
  }

  const InputFile& file_;
  CoordBBox box_;
  float min_ = std::numeric_limits<float>::infinity(), max_ = -min_;
  double sum_ = 0.0, voxels_ = 0.0;
};

// What OpenVDB throws as an IoError.
template <class Read>
auto reading(const InputFile& file, const Read& read) {
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    file.fail(std::string("damaged: ") + e.what());
  }
}

}  // namespace

Texels readVdb(const std::filesystem::path& path, const VdbReadOptions& options) {
  InputFile file(path);
  return reading(file, [&] {
    StoredGrid grid = readGrid(file, path, options);
    requireDense(file, grid.box, grid.shape);
    Texels texels(grid.shape);
    texels.notes = std::move(grid.notes);
    DenseBox dense(texels, grid.box.min());
    if (grid.tree->background() != 0.0f) dense.fill(grid.box, grid.tree->background());
    visitValues(
        *grid.tree, [&](const CoordBBox& where, float value) { dense.fill(where, value); },
        [&](int x, int y, int z, std::span<const float> values) { dense.put(x, y, z, values); });
    requireFinite(texels, path);
    return texels;
  });
}

VdbSummary readVdbSummary(const std::filesystem::path& path, const VdbReadOptions& options) {
  InputFile file(path);
  return reading(file, [&] {
    StoredGrid grid = readGrid(file, path, options);
    VdbSummary summary;
    summary.shape = grid.shape;
    summary.notes = std::move(grid.notes);
    summary.activeVoxels = grid.tree->activeVoxelCount();
    Statistics statistics(file, grid.box);
    visitValues(
        *grid.tree, [&](const CoordBBox& where, float value) { statistics.add(where, value); },
        [&](int x, int y, int z, std::span<const float> values) { statistics.add(x, y, z, values); });
    statistics.into(grid.tree->background(), summary);
    return summary;
  });
}

}  // namespace welkin::io
