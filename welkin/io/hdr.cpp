// SPDX-License-Identifier: Apache-2.0
#include "welkin/io/hdr.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "welkin/core/error.h"
#include "welkin/io/atomic_file.h"
#include "welkin/io/input_file.h"
#include "welkin/io/quantise.h"

namespace welkin::io {
namespace {

constexpr std::string_view kLuminanceLine = "# Values are luminance in cd/m2";
using Rgbe = std::array<std::uint8_t, 4>;
constexpr int kExponentBias = 128 + 8;                    // value = mantissa * 2^(exponent - bias)
constexpr int kShortestCoded = 8, kLongestCoded = 32767;  // widths that the newer run-length code can hold

Rgbe encode(float r, float g, float b) {
  r = std::max(r, 0.0f);
  g = std::max(g, 0.0f);
  b = std::max(b, 0.0f);
  const float largest = std::max({r, g, b});
  int exponent = 0;
  std::frexp(largest, &exponent);  // largest = m * 2^exponent, m in [0.5, 1)
  const auto mantissa = [&](float x) { return std::lround(std::ldexp(x, 8 - exponent)); };
  if (largest > 0.0f && mantissa(largest) > 255) ++exponent;  // rounded up to the next power of two
  if (largest <= 0.0f || exponent < -127) return {0, 0, 0, 0};
  exponent = std::min(exponent, 127);
  const auto byte = [&](float x) { return static_cast<std::uint8_t>(std::min(mantissa(x), 255L)); };
  return {byte(r), byte(g), byte(b), static_cast<std::uint8_t>(exponent + 128)};
}

// One component of a scan line: a count above 128 is a run of count - 128 equal bytes, another is that many
// bytes as they are.
void appendRuns(std::string& out, const std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kShortestRun = 4, kLongestRun = 127, kLongestPlain = 128;
  const auto runAt = [&](std::size_t i) {
    std::size_t n = 1;
    while (i + n < bytes.size() && n < kLongestRun && bytes[i + n] == bytes[i]) ++n;
    return n;
  };
  std::size_t i = 0;
  while (i < bytes.size()) {
    std::size_t plain = 0, run = 0;
    while (i + plain < bytes.size() && plain < kLongestPlain) {
      run = runAt(i + plain);
      if (run >= kShortestRun) break;
      run = 0;
      ++plain;
    }
    if (plain > 0) {
      out += static_cast<char>(plain);
      out.append(reinterpret_cast<const char*>(&bytes[i]), plain);
      i += plain;
    }
    if (run > 0) {
      out += static_cast<char>(128 + run);
      out += static_cast<char>(bytes[i]);
      i += run;
    }
  }
}

// Takes bytes off the front of a file in memory.
class Reader {
 public:
  Reader(std::string_view bytes, std::string path) : left_(bytes), path_(std::move(path)) {}
  [[noreturn]] void fail(const std::string& why) const { throw IoError("cannot read " + path_ + ": " + why); }
  std::uint8_t byte() {
    if (left_.empty()) fail("the file is cut short");
    const char c = left_.front();
    left_.remove_prefix(1);
    return static_cast<std::uint8_t>(c);
  }
  std::string line() {
    const std::size_t end = left_.find('\n');
    if (end == std::string_view::npos) fail("this is no Radiance picture");
    std::string text(left_.substr(0, end));
    left_.remove_prefix(end + 1);
    return text;
  }
  bool codedRow(int width) const {
    return width >= kShortestCoded && width <= kLongestCoded && left_.size() >= 4 && left_[0] == 2 &&
           left_[1] == 2 && static_cast<std::uint8_t>(left_[2]) < 128;
  }
  // The line of the sizes: width and height.
  std::pair<int, int> size() {
    const std::string text = line();
    constexpr std::string_view kFirst = "-Y ", kSecond = " +X ";
    int height = 0, width = 0;
    const char* const end = text.data() + text.size();
    bool whole = false;
    if (text.starts_with(kFirst)) {
      const char* at = std::from_chars(text.data() + kFirst.size(), end, height).ptr;
      if (std::string_view(at, end).starts_with(kSecond))
        whole = std::from_chars(at + kSecond.size(), end, width).ptr == end;
    }
    if (!whole || width < 1 || height < 1) fail("expected a size such as -Y 720 +X 1280");
    return {width, height};
  }
  std::size_t left() const { return left_.size(); }

 private:
  std::string_view left_;
  std::string path_;
};

// What a line EXPOSURE= says that values have been multiplied by; 1 for other lines.
double exposureOf(const Reader& in, std::string_view line) {
  constexpr std::string_view kName = "EXPOSURE=";
  if (!line.starts_with(kName)) return 1.0;
  line.remove_prefix(std::min(line.find_first_not_of(' ', kName.size()), line.size()));
  double exposure = 0.0;
  const char *const begin = line.data(), *const end = begin + line.size();
  const char* const read = std::from_chars(begin, end, exposure).ptr;
  if (std::string_view(read, end).find_first_not_of(" \t\r") != std::string_view::npos || !(exposure > 0.0))
    in.fail("expected a number above 0 after EXPOSURE=");
  return exposure;
}

void readRow(Reader& in, std::vector<Rgbe>& row) {
  const int width = static_cast<int>(row.size());
  if (!in.codedRow(width)) {
    for (Rgbe& pixel : row)
      for (std::uint8_t& part : pixel) part = in.byte();
    return;
  }
  in.byte(), in.byte();
  const int high = in.byte(), low = in.byte();
  if ((high << 8 | low) != width) in.fail("a row has the wrong length");
  for (std::size_t part = 0; part < 4; ++part)
    for (std::size_t x = 0; x < row.size();) {
      const int code = in.byte();
      const std::size_t n = static_cast<std::size_t>(code > 128 ? code - 128 : code);
      if (n == 0 || x + n > row.size()) in.fail("a row is damaged");
      const std::uint8_t same = code > 128 ? in.byte() : std::uint8_t{0};
      for (std::size_t i = 0; i < n; ++i) row[x++][part] = code > 128 ? same : in.byte();
    }
}

}  // namespace

void writeHdr(const std::filesystem::path& path, const Image<float>& image, bool luminance) {
  if (image.width < 1 || image.height < 1 || (image.channels != 3 && image.channels != 4))
    throw ParameterError("cannot write " + path.string() +
                         ": an HDR picture has at least one pixel and 3 channels");
  requireFinite(image);
  AtomicFile file(path);
  file.write("#?RADIANCE\n");
  if (luminance) file.write(std::string(kLuminanceLine) + "\n");
  file.write("FORMAT=32-bit_rle_rgbe\n");
  if (luminance) file.write("PRIMARIES=0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290\n");
  file.write("\n");
  file.write("-Y " + std::to_string(image.height) + " +X " + std::to_string(image.width) + "\n");

  const bool coded = image.width >= kShortestCoded && image.width <= kLongestCoded;
  std::array<std::vector<std::uint8_t>, 4> parts;
  for (auto& part : parts) part.resize(static_cast<std::size_t>(image.width));
  std::string row;
  for (int y = 0; y < image.height; ++y) {
    row.clear();
    for (int x = 0; x < image.width; ++x) {
      const Rgbe pixel = encode(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2));
      for (std::size_t part = 0; part < 4; ++part) parts[part][static_cast<std::size_t>(x)] = pixel[part];
      if (!coded) row.append(reinterpret_cast<const char*>(pixel.data()), pixel.size());
    }
    if (coded) {
      row += {'\2', '\2', static_cast<char>(image.width >> 8), static_cast<char>(image.width & 255)};
      for (const auto& part : parts) appendRuns(row, part);
    }
    file.write(row);
  }
  file.commit();
}

Image<float> readHdr(const std::filesystem::path& path, bool* luminance) {
  InputFile file(path);
  std::string bytes(file.size(), '\0');
  file.read(bytes.data(), bytes.size());
  Reader in(bytes, path.string());
  if (!in.line().starts_with("#?")) in.fail("this is no Radiance picture");
  bool rgbe = false;
  double exposure = 1.0;
  if (luminance) *luminance = false;
  for (std::string line = in.line(); !line.empty(); line = in.line()) {
    rgbe = rgbe || line == "FORMAT=32-bit_rle_rgbe";
    exposure *= exposureOf(in, line);
    if (luminance) *luminance = *luminance || line == kLuminanceLine;
  }
  if (!(exposure > 0.0 && std::isfinite(exposure))) in.fail("EXPOSURE is beyond the range of numbers");
  if (!rgbe) in.fail("expected FORMAT=32-bit_rle_rgbe");
  const auto [width, height] = in.size();
  // What the shortest rows need: a bound on what the sizes may claim.
  constexpr std::uint64_t kPartHeader = 4, kLongestRun = 127;
  const std::uint64_t w = static_cast<std::uint64_t>(width), h = static_cast<std::uint64_t>(height);
  const std::uint64_t coded = kPartHeader + 4 * 2 * ((w + kLongestRun - 1) / kLongestRun);
  if (in.left() / h < (width >= kShortestCoded && width <= kLongestCoded ? std::min(coded, 4 * w) : 4 * w))
    in.fail("the file is cut short");

  Image<float> image(width, height, 3);
  std::vector<Rgbe> row(static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    readRow(in, row);
    for (int x = 0; x < width; ++x) {
      const Rgbe& pixel = row[static_cast<std::size_t>(x)];
      for (int c = 0; c < 3 && pixel[3] != 0; ++c) {
        const double mantissa = pixel[static_cast<std::size_t>(c)];
        const double value = std::ldexp(mantissa, pixel[3] - kExponentBias) / exposure;
        if (value > std::numeric_limits<float>::max()) in.fail("a value over EXPOSURE is too large");
        image.at(x, y, c) = static_cast<float>(value);
      }
    }
  }
  return image;
}

}  // namespace welkin::io
