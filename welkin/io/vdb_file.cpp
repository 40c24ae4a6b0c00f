// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/vdb_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <set>

#include "welkin/io/vdb.h"

namespace welkin::io::vdb {
namespace {

constexpr std::uint64_t kMagic = 0x56444220;
constexpr std::uint32_t kOldestVersion = 222, kNewestVersion = 224;
constexpr std::uint32_t kLongestText = 1 << 20, kMostEntries = 1 << 16;
constexpr std::uint32_t kZip = 1, kActiveMask = 2, kBlosc = 4;
constexpr const char* kHalfEnding = "_HalfFloat";

std::string readText(InputFile& file) {
  const std::uint64_t at = file.position();
  const auto length = file.get<std::uint32_t>();
  if (length > kLongestText || length > file.left())
    file.fail("a text of " + std::to_string(length) + " bytes", at);
  std::string text(length, '\0');
  file.read(text.data(), length);
  return text;
}

std::uint32_t readCount(InputFile& file, const char* of) {
  const std::uint64_t at = file.position();
  const auto count = file.get<std::uint32_t>();
  if (count > kMostEntries) file.fail("a count of " + std::to_string(count) + " " + of, at);
  return count;
}

// Numbers of one type as text, the shortest that says them exactly, by blanks.
template <class Number>
std::string numbersAsText(InputFile& file, std::uint32_t bytes) {
  std::string text;
  for (std::uint32_t i = 0; i < bytes / sizeof(Number); ++i) {
    char digits[32];
    text.append(i == 0 ? "" : " ")
        .append(digits, std::to_chars(digits, digits + sizeof digits, file.get<Number>()).ptr);
  }
  return text;
}

struct NumberType {
  const char* name;
  std::uint32_t bytes;
  std::string (*asText)(InputFile&, std::uint32_t);
};
constexpr std::array<NumberType, 9> kNumberTypes = {{{"bool", 1, numbersAsText<std::uint8_t>},
                                                     {"int32", 4, numbersAsText<std::int32_t>},
                                                     {"int64", 8, numbersAsText<std::int64_t>},
                                                     {"float", 4, numbersAsText<float>},
                                                     {"double", 8, numbersAsText<double>},
                                                     {"vec2s", 8, numbersAsText<float>},
                                                     {"vec2d", 16, numbersAsText<double>},
                                                     {"vec3s", 12, numbersAsText<float>},
                                                     {"vec3d", 24, numbersAsText<double>}}};

// Texts, numbers and vectors are kept, all else is skipped by its length.
void readMetadata(InputFile& file, GridHead* head) {
  const std::uint32_t count = readCount(file, "metadata");
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string name = readText(file), type = readText(file);
    const std::uint64_t at = file.position();
    const auto bytes = file.get<std::uint32_t>();
    if (bytes > file.left())
      file.fail("metadata \"" + name + "\" of " + std::to_string(bytes) + " bytes", at);
    const auto* const number = std::ranges::find_if(
        kNumberTypes, [&](const NumberType& n) { return type == n.name && bytes == n.bytes; });
    if (head && type == "string" && bytes <= kLongestText) {
      std::string& text = head->texts[name];
      text.resize(bytes);
      file.read(text.data(), bytes);
    } else if (head && type == "vec3i" && bytes == sizeof(glm::ivec3)) {
      head->vectors[name] = file.get<glm::ivec3>();
    } else if (head && number != kNumberTypes.end()) {
      head->texts[name] = number->asText(file, bytes);
    } else {
      file.skip(bytes);
    }
  }
}

// As OpenVDB's own tools name them: the second "density" is "density[1]".
void tellApart(std::vector<Entry>& grids) {
  std::map<std::string, int> seen;
  for (Entry& e : grids)
    if (const int before = seen[e.ownName]++; before > 0) e.name += '[' + std::to_string(before) + ']';
}

void readTransform(InputFile& file, GridHead& head) {
  const std::uint64_t at = file.position();
  const std::string map = readText(file);
  constexpr std::uint64_t kOtherScales = 4 * sizeof(glm::dvec3);  // the same scale told in other ways
  if (map == "UniformScaleMap" || map == "ScaleMap") {
    head.scale = file.get<glm::dvec3>();
    file.skip(kOtherScales);
  } else if (map == "UniformScaleTranslateMap" || map == "ScaleTranslateMap") {
    head.translation = file.get<glm::dvec3>();
    head.scale = file.get<glm::dvec3>();
    file.skip(kOtherScales);
  } else if (map == "TranslationMap") {
    head.translation = file.get<glm::dvec3>();
  } else if (map == "AffineMap") {
    const auto m = file.get<std::array<double, 16>>();  // rows; points are rows too
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 4; ++j)
        if (i != j && m[4 * i + j] != 0.0) file.fail("the grid's transform is not along the axes", at);
      head.scale[static_cast<int>(i)] = m[4 * i + i];
      head.translation[static_cast<int>(i)] = m[12 + i];
    }
  } else {
    file.fail("the grid's transform is none of scale and translation", at);
  }
  for (int i = 0; i < 3; ++i)
    if (!(head.scale[i] > 0.0) || !std::isfinite(head.scale[i]) || !std::isfinite(head.translation[i]))
      file.fail("the grid's voxels have no size or place", at);
}

// One grid's tree of floats: root, nodes of 32^3 and 16^3, leaves of 8^3.
class TreeCheck {
 public:
  TreeCheck(InputFile& file, bool isHalf, std::uint32_t compression)
      : file_(file), valueBytes_(isHalf ? 2 : 4), half_(isHalf), compression_(compression) {}

  void topology() {
    if (file_.get<std::uint32_t>() != 1) fail("a tree of several buffers");
    file_.skip(sizeof(float));  // background
    const auto tiles = file_.get<std::uint32_t>(), children = file_.get<std::uint32_t>();
    constexpr std::uint64_t kTileBytes = 3 * 4 + sizeof(float) + 1, kLeastChildBytes = 3 * 4 + 2 * 4096;
    if (tiles > file_.left() / kTileBytes || children > file_.left() / kLeastChildBytes)
      fail("more nodes than the file can hold");
    for (std::uint32_t i = 0; i < tiles; ++i) {
      origin();
      file_.skip(sizeof(float));
      if (file_.get<std::uint8_t>() > 1) fail("a tile that is neither active nor inactive");
    }
    for (std::uint32_t i = 0; i < children; ++i) {
      origin();
      internalNode<32>([&] { internalNode<16>([&] { leaf(); }); });
    }
  }

  void leafValues() {
    for (std::uint64_t i = 0; i < leaves_; ++i) values(512, mask<8>());
  }

 private:
  [[noreturn]] void fail(const char* why) { file_.fail(std::string("damaged: ") + why, file_.position()); }

  // Of a root's entry; each place once, and where sums of coordinates cannot overflow.
  void origin() {
    const auto xyz = file_.get<std::array<std::int32_t, 3>>();
    for (const std::int32_t x : xyz)
      if (x % 4096 != 0 || x < -(1 << 30) || x > (1 << 30)) fail("a node where there can be none");
    if (!origins_.insert(xyz).second) fail("two nodes in one place");
  }

  template <int side>
  using Mask = std::array<std::uint64_t, side * side * side / 64>;

  template <int side>
  std::uint32_t mask(Mask<side>* out = nullptr) {
    Mask<side> words;
    file_.read(words.data(), sizeof words);
    std::uint32_t on = 0;
    for (const std::uint64_t word : words) on += static_cast<std::uint32_t>(std::popcount(word));
    if (out) *out = words;
    return on;
  }

  template <int side, class Child>
  void internalNode(Child&& child) {
    const std::uint32_t children = mask<side>();
    const std::uint32_t active = mask<side>();
    values(side * side * side, active);
    for (std::uint32_t i = 0; i < children; ++i) child();
  }

  void leaf() {
    mask<8>();
    ++leaves_;
  }

  // What readCompressedValues() reads: a byte that says how inactive values are told, up to two of them, a
  // mask that chooses, and the active values.
  void values(std::uint32_t count, std::uint32_t active) {
    enum { kNone, kMinusBackground, kOne, kMask, kMaskAndOne, kMaskAndTwo, kAll };
    const auto kind = file_.get<std::uint8_t>();
    if (kind > kAll) fail("an unknown kind of values");
    if (kind == kOne || kind == kMaskAndOne) file_.skip(sizeof(float));
    if (kind == kMaskAndTwo) file_.skip(2 * sizeof(float));
    if (kind == kMask || kind == kMaskAndOne || kind == kMaskAndTwo) file_.skip(count / 8);
    if ((compression_ & kActiveMask) != 0 && kind != kAll) count = active;
    if (half_ && count == 0) return;
    chunk(count * valueBytes_);
  }

  void chunk(std::uint64_t bytes) {
    if ((compression_ & (kZip | kBlosc)) == 0) return file_.skip(bytes);
    const auto stored = file_.get<std::int64_t>();
    if (stored <= 0) {  // as it is
      if (std::uint64_t{0} - static_cast<std::uint64_t>(stored) != bytes) fail("a chunk of the wrong length");
      return file_.skip(bytes);
    }
    const std::uint64_t length = static_cast<std::uint64_t>(stored);
    if (length > 2 * bytes + 1024 || length > file_.left()) fail("a chunk of the wrong length");
    const std::uint64_t end = file_.position() + length;
    if ((compression_ & kBlosc) != 0) {
      // Blosc believes its own header: two bytes of version, flags, size of a value, then these.
      if (length < 16) fail("a chunk without a header");
      file_.skip(4);
      const auto plain = file_.get<std::uint32_t>(), block = file_.get<std::uint32_t>(),
                 packed = file_.get<std::uint32_t>();
      if (plain != bytes || packed != length || block == 0 || block > std::max<std::uint64_t>(bytes, 1))
        fail("a chunk whose header is wrong");
    }
    file_.seek(end);
  }

  InputFile& file_;
  std::uint64_t valueBytes_;
  bool half_;
  std::uint32_t compression_;
  std::uint64_t leaves_ = 0;
  std::set<std::array<std::int32_t, 3>> origins_;
};

}  // namespace

Contents readContents(InputFile& file) {
  if (file.size() < 8 || file.get<std::uint64_t>() != kMagic) file.fail("this is no OpenVDB file", 0);
  Contents contents;
  contents.fileVersion = file.get<std::uint32_t>();
  if (contents.fileVersion < kOldestVersion || contents.fileVersion > kNewestVersion)
    file.fail("version " + std::to_string(contents.fileVersion) + " of the format; expected 222 to 224", 8);
  contents.libraryMajor = file.get<std::uint32_t>();
  contents.libraryMinor = file.get<std::uint32_t>();
  const bool offsets = file.get<std::uint8_t>() != 0;
  constexpr std::uint64_t kUuidBytes = 36;
  file.skip(kUuidBytes);
  readMetadata(file, nullptr);
  const std::uint32_t count = readCount(file, "grids");
  for (std::uint32_t i = 0; i < count; ++i) {
    Entry entry;
    entry.ownName = readText(file);
    // Grids of one name are told apart by an ending.
    entry.ownName.resize(std::min(entry.ownName.find('\x1e'), entry.ownName.size()));
    entry.name = entry.ownName;
    entry.type = readText(file);
    if (entry.type.ends_with(kHalfEnding)) {
      entry.type.resize(entry.type.size() - std::char_traits<char>::length(kHalfEnding));
      entry.half = true;
    }
    const std::uint64_t at = file.position();
    const std::string sharedTree = readText(file);
    if (!sharedTree.empty()) entry.type = "shared";  // an instance of another grid's tree
    entry.gridByte = file.get<std::uint64_t>();
    entry.bufferByte = file.get<std::uint64_t>();
    const auto end = file.get<std::uint64_t>();
    if (!offsets) {  // written to a stream: they are zero, and the grid follows
      entry.gridByte = file.position();
      entry.bufferByte = 0;
      contents.grids.push_back(entry);
      break;
    }
    const bool instance = !sharedTree.empty();  // has no buffers of its own
    if (instance) entry.bufferByte = entry.gridByte;
    if (entry.gridByte < file.position() || entry.bufferByte < entry.gridByte || end < entry.bufferByte ||
        end > file.size())
      file.fail("the file is cut short or its table of contents is wrong", at);
    contents.grids.push_back(entry);
    file.seek(end);
  }
  tellApart(contents.grids);
  return contents;
}

GridHead readGridHead(InputFile& file, const Entry& entry) {
  file.seek(entry.gridByte);
  GridHead head;
  head.compression = file.get<std::uint32_t>();
  if (head.compression > (kZip | kActiveMask | kBlosc) ||
      (head.compression & (kZip | kBlosc)) == (kZip | kBlosc))
    file.fail("an unknown kind of compression", entry.gridByte);
  readMetadata(file, &head);
  readTransform(file, head);
  head.treeByte = file.position();
  return head;
}

std::uint64_t checkFloatTree(InputFile& file, const Entry& entry, const GridHead& head) {
  file.seek(head.treeByte);
  TreeCheck check(file, entry.half, head.compression);
  check.topology();
  const std::uint64_t buffers = entry.bufferByte != 0 ? entry.bufferByte : file.position();
  if (buffers != file.position()) file.fail("damaged: the values begin elsewhere", file.position());
  check.leafValues();
  return buffers;
}

}  // namespace welkin::io::vdb

namespace welkin::io {

std::vector<VdbGrid> readVdbGrids(const std::filesystem::path& path) {
  InputFile file(path);
  std::vector<VdbGrid> grids;
  for (const vdb::Entry& e : vdb::readContents(file).grids) grids.push_back({e.name, e.type, e.half});
  return grids;
}

void writeVdb(const std::filesystem::path& path, const Texels& texels) {
  VdbWriter writer(path, texels.shape, texels.notes);
  writer.write(texels.bytes);
  writer.close();
}

}  // namespace welkin::io
