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
#include <cmath>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/io/atomic_file.h"
#include "welkin/io/quantise.h"

namespace welkin::io {
namespace {

constexpr float kLargestHalf = 65504.0f;

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

}  // namespace

void writeExr(const std::filesystem::path& path, const Image<float>& image, const ExrOptions& options) {
  if (image.width < 1 || image.height < 1 ||
      (image.channels != 1 && image.channels != 3 && image.channels != 4))
    throw ParameterError("cannot write " + path.string() +
                         ": an EXR has at least one pixel and 1, 3 or 4 channels");
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
  for (const auto& [key, text] : options.metadata) {
    if (key.empty() || header.find(key) != header.end())
      throw ParameterError("cannot write " + path.string() + ": metadata cannot be named \"" + key + '"');
    header.insert(key, Imf::StringAttribute(text));
  }

  AtomicFile file(path);
  try {
    Stream stream(file);
    std::vector<half> halves;
    Imf::OutputFile out(stream, header, 0);
    if (asHalf) {
      halves.reserve(image.data.size());
      for (const float x : image.data) halves.emplace_back(std::clamp(x, -kLargestHalf, kLargestHalf));
      out.setFrameBuffer(frameBuffer(halves.data(), type, image.width, image.channels));
    } else {
      out.setFrameBuffer(
          frameBuffer(const_cast<float*>(image.data.data()), type, image.width, image.channels));
    }
    out.writePixels(image.height);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw IoError("cannot write " + path.string() + ": " + e.what());
  }
  file.commit();
}

ExrPicture readExr(const std::filesystem::path& path) {
  try {
    Imf::InputFile in(path.c_str(), 0);
    const Imf::Header& header = in.header();
    const Imf::ChannelList& list = header.channels();
    const bool rgb = list.findChannel("R") && list.findChannel("G") && list.findChannel("B");
    if (!rgb && !list.findChannel("Y"))
      throw IoError("cannot read " + path.string() + ": it has neither RGB nor Y");
    const Imath::Box2i window = header.dataWindow();
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;

    ExrPicture picture;
    picture.image = Image<float>(width, height, !rgb ? 1 : list.findChannel("A") ? 4 : 3);
    picture.half = list.findChannel(rgb ? "R" : "Y")->type == Imf::HALF;
    // OpenEXR counts from pixel (0, 0), which need not be in the data window; pointers outside an array are
    // not to be formed, so the sum is done on integers.
    const std::ptrdiff_t offset =
        (static_cast<std::ptrdiff_t>(window.min.y) * width + window.min.x) * picture.image.channels;
    float* origin = reinterpret_cast<float*>(reinterpret_cast<std::uintptr_t>(picture.image.data.data()) -
                                             static_cast<std::uintptr_t>(offset) * sizeof(float));
    in.setFrameBuffer(frameBuffer(origin, Imf::FLOAT, width, picture.image.channels));
    in.readPixels(window.min.y, window.max.y);
    for (auto it = header.begin(); it != header.end(); ++it)
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute()))
        picture.metadata.emplace(it.name(), text->value());
    return picture;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw IoError("cannot read " + path.string() + ": " + e.what());
  }
}

}  // namespace welkin::io
