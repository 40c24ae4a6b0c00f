// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/exr.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/io/atomic_file.h"
#include "welkin/io/input_file.h"
#include "welkin/io/quantise.h"

namespace welkin::io {
namespace {

constexpr int kLargestSide = 1 << 16;

// Lets OpenEXR write through AtomicFile, so that its errors and the rename at the end are those of all
// formats.
class Stream : public Imf::OStream {
 public:
  explicit Stream(AtomicFile& file) : Imf::OStream(file.path().c_str()), file_(file) {}
  void write(const char bytes[], int count) override { file_.write(bytes, static_cast<std::size_t>(count)); }
  uint64_t tellp() override { return file_.position(); }
  void seekp(uint64_t position) override { file_.seek(position); }

 private:
  AtomicFile& file_;
};

std::vector<std::string> channelNames(int channels) {
  if (channels == 1) return {"Y"};
  std::vector<std::string> names = {"R", "G", "B"};
  if (channels == 4) names.emplace_back("A");
  return names;
}

// Lays interleaved channels of type T out for OpenEXR. `origin` is where pixel (0, 0) of the data window's
// frame would be.
template <class T>
Imf::FrameBuffer frameBuffer(T* origin, Imf::PixelType type, int width, int channels) {
  const std::size_t pixel = sizeof(T) * static_cast<std::size_t>(channels);
  Imf::FrameBuffer buffer;
  const std::vector<std::string> names = channelNames(channels);
  for (std::size_t c = 0; c < names.size(); ++c)
    buffer.insert(names[c],
                  Imf::Slice(type, reinterpret_cast<char*>(origin + c), pixel,
                             pixel * static_cast<std::size_t>(width), 1, 1, names[c] == "A" ? 1.0 : 0.0));
  return buffer;
}

void requireSides(const std::filesystem::path& path, int width, int height) {
  if (width < 1 || height < 1 || std::max(width, height) > kLargestSide)
    throw ParameterError("cannot write " + path.string() + ": an EXR has 1 to " +
                         std::to_string(kLargestSide) + " pixels a side; got " + std::to_string(width) + "x" +
                         std::to_string(height));
}

void addMetadata(const std::filesystem::path& path, const std::map<std::string, std::string>& metadata,
                 Imf::Header& header) {
  for (const auto& [key, text] : metadata) {
    // "type" is OpenEXR's own, written over as the file is.
    if (key.empty() || key == "type" || header.find(key) != header.end())
      throw ParameterError("cannot write " + path.string() + ": metadata cannot be named \"" + key + '"');
    header.insert(key, Imf::StringAttribute(text));
  }
}

std::vector<half> halvesOf(const std::vector<float>& values) {
  std::vector<half> halves;
  halves.reserve(values.size());
  for (const float x : values) halves.emplace_back(std::clamp(x, -kLargestHalf, kLargestHalf));
  return halves;
}

void writeFile(const std::filesystem::path& path, const Imf::Header& header, const Imf::FrameBuffer& buffer,
               int rows) {
  AtomicFile file(path);
  try {
    Stream stream(file);
    Imf::OutputFile out(stream, header, 0);
    out.setFrameBuffer(buffer);
    out.writePixels(rows);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw IoError("cannot write " + path.string() + ": " + e.what());
  }
  file.commit();
}

}  // namespace

void writeExr(const std::filesystem::path& path, const Image<float>& image, const ExrOptions& options) {
  requireSides(path, image.width, image.height);
  if (image.channels != 1 && image.channels != 3 && image.channels != 4)
    throw ParameterError("cannot write " + path.string() + ": an EXR has 1, 3 or 4 channels");
  requireFinite(image);
  const bool fits =
      std::all_of(image.data.begin(), image.data.end(), [](float x) { return std::abs(x) <= kLargestHalf; });
  const bool asHalf = options.depth == ExrDepth::kHalf || (options.depth == ExrDepth::kAuto && fits);
  const Imf::PixelType type = asHalf ? Imf::HALF : Imf::FLOAT;

  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const std::string& name : channelNames(image.channels))
    header.channels().insert(name, Imf::Channel(type));
  Imf::addChromaticities(header, Imf::Chromaticities());  // by default those of Rec. 709
  Imf::addWhiteLuminance(header, 1.0f);
  addMetadata(path, options.metadata, header);

  std::vector<half> halves;
  Imf::FrameBuffer buffer;
  if (asHalf) {
    halves = halvesOf(image.data);
    buffer = frameBuffer(halves.data(), type, image.width, image.channels);
  } else {
    buffer = frameBuffer(const_cast<float*>(image.data.data()), type, image.width, image.channels);
  }
  writeFile(path, header, buffer, image.height);
}

void writeExrPlanes(const std::filesystem::path& path, const ExrPlanes& p) {
  requireSides(path, p.width, p.height);
  if (p.planes.empty())
    throw ParameterError("cannot write " + path.string() + ": an EXR has at least one channel");
  const std::size_t pixels = static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height);
  Imf::Header header(p.width, p.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::addChromaticities(header, Imf::Chromaticities());
  Imf::addWhiteLuminance(header, 1.0f);
  addMetadata(path, p.metadata, header);
  const Imf::PixelType type = p.half ? Imf::HALF : Imf::FLOAT;
  const std::size_t bytes = p.half ? sizeof(half) : sizeof(float);
  std::vector<std::vector<half>> halves;
  Imf::FrameBuffer buffer;
  for (const auto& [name, values] : p.planes) {
    if (values.size() != pixels)
      throw ParameterError("cannot write " + path.string() + ": channel " + name + " has " +
                           std::to_string(values.size()) + " values; expected " + std::to_string(pixels));
    Image<float> plane(p.width, p.height, 1);
    plane.data = values;
    requireFinite(plane);
    if (p.half) halves.push_back(halvesOf(values));
    const void* data = p.half ? static_cast<const void*>(halves.back().data()) : values.data();
    header.channels().insert(name, Imf::Channel(type));
    buffer.insert(name, Imf::Slice(type, static_cast<char*>(const_cast<void*>(data)), bytes,
                                   bytes * static_cast<std::size_t>(p.width)));
  }
  writeFile(path, header, buffer, p.height);
}

namespace {

// OpenEXR asks for memory by what a header says before it has seen a texel: for attributes by their length,
// for rows of chunks and for tiles by their sizes. So the header is walked here first ("The OpenEXR file
// layout"): attributes must fit in the file, and sides and tiles are bounded.
constexpr std::int64_t kLargestTile = 1 << 22;
constexpr int kRowsAtOnce = 256;  // as many as the largest chunks hold

std::string readName(InputFile& file) {
  constexpr std::size_t kLongestName = 255;
  std::string name;
  for (char c = file.get<char>(); c != '\0'; c = file.get<char>()) {
    name += c;
    if (name.size() > kLongestName) file.fail("a name of more than 255 bytes", file.position());
  }
  return name;
}

// Bytes of attributes of one size. OpenEXR reads that many whatever length the file states, and would then
// take bytes of a value for the next name.
const std::map<std::string, std::uint32_t> kFixedSizes = {{"box2f", 16},
                                                          {"box2i", 16},
                                                          {"chromaticities", 32},
                                                          {"compression", 1},
                                                          {"deepImageState", 1},
                                                          {"double", 8},
                                                          {"envmap", 1},
                                                          {"float", 4},
                                                          {"int", 4},
                                                          {"keycode", 28},
                                                          {"lineOrder", 1},
                                                          {"m33d", 72},
                                                          {"m33f", 36},
                                                          {"m44d", 128},
                                                          {"m44f", 64},
                                                          {"rational", 8},
                                                          {"tiledesc", 9},
                                                          {"timecode", 8},
                                                          {"v2d", 16},
                                                          {"v2f", 8},
                                                          {"v2i", 8},
                                                          {"v3d", 24},
                                                          {"v3f", 12},
                                                          {"v3i", 12}};

void checkHeader(InputFile& file) {
  constexpr std::uint32_t kMagic = 20000630, kManyParts = 0x1000;
  if (file.size() < 8 || file.get<std::uint32_t>() != kMagic) file.fail("this is no EXR picture", 0);
  if ((file.get<std::uint32_t>() & kManyParts) != 0)
    file.fail("it has several parts; expected one picture", 4);
  const auto sane = [](std::int64_t from, std::int64_t to) { return to >= from && to - from < kLargestSide; };
  for (std::string name = readName(file); !name.empty(); name = readName(file)) {
    const std::string type = readName(file);
    const std::uint64_t at = file.position();
    const auto bytes = file.get<std::uint32_t>();
    const std::uint64_t end = file.position() + bytes;
    if (bytes > file.left()) file.fail("attribute " + name + " is longer than the file", at);
    const auto fixed = kFixedSizes.find(type);
    bool right = fixed == kFixedSizes.end() || fixed->second == bytes;
    if (right && type == "box2i") {
      const auto box = file.get<std::array<std::int32_t, 4>>();
      if (name == "dataWindow" && !(sane(box[0], box[2]) && sane(box[1], box[3])))
        file.fail("the data window has no pixels or more than 65536 a side", at);
    } else if (right && type == "tiledesc") {
      const auto size = file.get<std::array<std::uint32_t, 2>>();
      if (std::int64_t{size[0]} > kLargestTile / std::max<std::int64_t>(size[1], 1))
        file.fail("tiles are too large", at);
    } else if (type == "preview") {
      const auto size = file.get<std::array<std::uint32_t, 2>>();
      right = bytes >= 8 && (std::uint64_t{size[0]} * size[1]) == (bytes - 8) / 4 && bytes % 4 == 0;
    } else if (type == "chlist") {
      constexpr std::uint64_t kChannelBytes = 16;
      while (!readName(file).empty()) file.skip(kChannelBytes);
      right = file.position() == end;
    }
    if (!right) file.fail("attribute " + name + " has the wrong length", at);
    file.seek(end);
  }
  file.seek(0);
}

// Lets OpenEXR count the file's bytes as all readers here do; it is also told where they end.
class InStream : public Imf::IStream {
 public:
  explicit InStream(InputFile& file) : Imf::IStream(file.path().c_str()), file_(file) {}
  bool read(char out[], int count) override {
    file_.read(out, static_cast<std::uint64_t>(std::max(count, 0)));
    return file_.left() > 0;
  }
  uint64_t tellg() override { return file_.position(); }
  void seekg(uint64_t position) override { file_.seek(position); }

 private:
  InputFile& file_;
};

// Calls f(first, last) for some rows at a time, from the top.
template <class F>
void inChunks(const Imath::Box2i& window, F&& f) {
  for (int y = window.min.y; y <= window.max.y; y += kRowsAtOnce)
    f(y, std::min(y + kRowsAtOnce - 1, window.max.y));
}

// OpenEXR counts from pixel (0, 0), which need not be in the rows at hand; pointers outside an array are not
// to be formed, so the sum is done on integers. offset: of the first value at hand.
template <class T>
char* originOf(std::vector<T>& rows, std::int64_t offset) {
  return reinterpret_cast<char*>(reinterpret_cast<std::uintptr_t>(rows.data()) -
                                 static_cast<std::uintptr_t>(offset) * sizeof(T));
}

std::map<std::string, std::string> textsOf(const Imf::Header& header) {
  std::map<std::string, std::string> texts;
  for (auto it = header.begin(); it != header.end(); ++it)
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
        text && std::strcmp(it.name(), "type") != 0)  // OpenEXR's own: how the file is laid out
      texts.emplace(it.name(), text->value());
  return texts;
}

// Rows are read and appended chunk by chunk, so that a header that promises more than the file has gets no
// further than the file goes.
template <class T>
void readRows(Imf::InputFile& in, Imf::PixelType type, const Imath::Box2i& window, int channels,
              std::vector<std::byte>& bytes) {
  const int width = window.max.x - window.min.x + 1;
  const std::size_t rowValues = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  std::vector<T> rows;
  inChunks(window, [&](int y, int last) {
    rows.resize(rowValues * static_cast<std::size_t>(last - y + 1));
    T* origin = reinterpret_cast<T*>(originOf(rows, (std::int64_t{y} * width + window.min.x) * channels));
    in.setFrameBuffer(frameBuffer(origin, type, width, channels));
    in.readPixels(y, last);
    const auto* begin = reinterpret_cast<const std::byte*>(rows.data());
    bytes.insert(bytes.end(), begin, begin + rows.size() * sizeof(T));
  });
}

}  // namespace

Texels readExrTexels(const std::filesystem::path& path) {
  InputFile file(path);
  checkHeader(file);
  try {
    InStream stream(file);
    Imf::InputFile in(stream, 0);
    const Imf::Header& header = in.header();
    const Imf::ChannelList& list = header.channels();
    const bool rgb = list.findChannel("R") && list.findChannel("G") && list.findChannel("B");
    if (!rgb && !list.findChannel("Y")) file.fail("it has neither RGB nor Y");
    Texels texels;
    TexelShape& shape = texels.shape;
    shape.format.channels = !rgb ? Channels::kL : list.findChannel("A") ? Channels::kRgba : Channels::kRgb;
    const int channels = countOf(shape.format.channels);
    bool allHalf = true;
    const std::vector<std::string> names = channelNames(channels);
    for (const std::string& name : names) allHalf = allHalf && list.findChannel(name)->type == Imf::HALF;
    for (auto c = list.begin(); c != list.end(); ++c)
      if (std::find(names.begin(), names.end(), c.name()) == names.end())
        texels.notes.leftOut.push_back(std::string("channel ") + c.name());
    shape.format.type = allHalf ? ValueType::kHalf : ValueType::kFloat;
    const Imath::Box2i window = header.dataWindow();
    shape.nx = window.max.x - window.min.x + 1;
    shape.ny = window.max.y - window.min.y + 1;
    if (allHalf)
      readRows<half>(in, Imf::HALF, window, channels, texels.bytes);
    else
      readRows<float>(in, Imf::FLOAT, window, channels, texels.bytes);
    texels.notes.metadata = textsOf(header);
    return texels;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    file.fail(e.what());
  }
}

ExrPicture readExr(const std::filesystem::path& path) {
  const Texels texels = readExrTexels(path);
  ExrPicture picture;
  picture.image = Image<float>(texels.shape.nx, texels.shape.ny, countOf(texels.shape.format.channels));
  toFloats(texels.shape.format.type, texels.bytes, picture.image.data);
  picture.half = texels.shape.format.type == ValueType::kHalf;
  picture.metadata = texels.notes.metadata;
  return picture;
}

ExrPlanes readExrPlanes(const std::filesystem::path& path) {
  InputFile file(path);
  checkHeader(file);
  try {
    InStream stream(file);
    Imf::InputFile in(stream, 0);
    const Imf::Header& header = in.header();
    const Imath::Box2i window = header.dataWindow();
    ExrPlanes p;
    p.width = window.max.x - window.min.x + 1;
    p.height = window.max.y - window.min.y + 1;
    p.half = true;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
      p.half = p.half && c.channel().type == Imf::HALF;
      p.planes.emplace(c.name(), std::vector<float>());
    }
    // A plane at a time, each in chunks of rows as they come.
    for (auto& [name, values] : p.planes) {
      std::vector<float> rows;
      inChunks(window, [&](int y, int last) {
        rows.resize(static_cast<std::size_t>(p.width) * static_cast<std::size_t>(last - y + 1));
        char* origin = originOf(rows, std::int64_t{y} * p.width + window.min.x);
        Imf::FrameBuffer buffer;
        buffer.insert(name, Imf::Slice(Imf::FLOAT, origin, sizeof(float),
                                       sizeof(float) * static_cast<std::size_t>(p.width)));
        in.setFrameBuffer(buffer);
        in.readPixels(y, last);
        values.insert(values.end(), rows.begin(), rows.end());
      });
    }
    p.metadata = textsOf(header);
    return p;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    file.fail(e.what());
  }
}

}  // namespace welkin::io
