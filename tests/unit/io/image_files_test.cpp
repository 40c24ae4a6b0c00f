// SPDX-License-Identifier: Apache-2.0
// Each format: round trips, other people's readers, damage, and nothing left behind.
#include <cmath>
#include <limits>

#include "scratch.h"
#include "welkin/core/parallel.h"
#include "welkin/core/random.h"
#include "welkin/io/exr.h"
#include "welkin/io/hdr.h"
#include "welkin/io/png.h"
#include "welkin/io/write_image.h"

namespace welkin::io {
namespace {

class ImageFiles : public Scratch {};

template <class T>
Image<T> randomIntegers(int w, int h, int c) {
  Image<T> image(w, h, c);
  Random random(static_cast<std::uint64_t>(w * 100 + c));
  for (T& x : image.data) x = static_cast<T>(random.next());
  return image;
}

// Over many magnitudes, as skies are: 10^-4 to 10^4.
Image<float> randomLight(int w, int h, int c) {
  Image<float> image(w, h, c);
  Random random(static_cast<std::uint64_t>(w * 100 + c));
  for (float& x : image.data) x = std::pow(10.0f, random.uniform() * 8.0f - 4.0f);
  return image;
}

TEST_F(ImageFiles, PngRoundTripsInAllKinds) {
  for (int channels = 1; channels <= 4; ++channels) {
    const auto bytes = randomIntegers<std::uint8_t>(13, 7, channels);
    writePng(folder / "8.png", bytes, {{"Software", "Welkin"}});
    const auto back8 = std::get<Image<std::uint8_t>>(readPng(folder / "8.png"));
    EXPECT_EQ(back8.width, 13);
    EXPECT_EQ(back8.height, 7);
    EXPECT_EQ(back8.channels, channels);
    EXPECT_EQ(back8.data, bytes.data);

    const auto words = randomIntegers<std::uint16_t>(5, 9, channels);
    writePng(folder / "16.png", words);
    EXPECT_EQ(std::get<Image<std::uint16_t>>(readPng(folder / "16.png")).data, words.data);
  }
  EXPECT_EQ(fileCount(), 2);
}

TEST_F(ImageFiles, PngIsReadByOthers) {
  Image<std::uint8_t> image(6, 4, 3);
  image.at(0, 0, 0) = 255;  // red at the top left
  image.at(5, 3, 2) = 255;  // blue at the bottom right
  writePng(folder / "a.png", image);
  EXPECT_EQ(
      outputOf("identify -format '%m %w %h %[colorspace] %z %[fx:p{0,0}.r] %[fx:p{0,0}.b] %[fx:p{5,3}.b]' " +
               (folder / "a.png").string()),
      "PNG 6 4 sRGB 8 1 0 1");
  Image<std::uint16_t> deep(2, 1, 1);
  deep.data = {258, 65535};
  writePng(folder / "b.png", deep);
  EXPECT_EQ(outputOf("identify -format '%z %[fx:round(65535*p{0,0})]' " + (folder / "b.png").string()),
            "16 258");
}

TEST_F(ImageFiles, PngKeepsTextsToTheByte) {
  const PngTexts texts = {
      {std::string(79, 'k'), "long"}, {"Place", "M\u00fcnchen, 20 \u00b0C \u2601"}, {"empty", ""}};
  writePng(folder / "a.png", Image<std::uint8_t>(2, 2, 1), texts);
  PngTexts found;
  readPng(folder / "a.png", &found);
  EXPECT_EQ(found, texts);
}

// Keywords and tEXt are Latin-1 in the file.
TEST_F(ImageFiles, PngTextsOfLatin1AreUtf8Here) {
  const PngTexts texts = {{"Gr\u00f6\u00dfe", "plain"}};
  writePng(folder / "a.png", Image<std::uint8_t>(2, 2, 1), texts);
  const std::string bytes = contents(folder / "a.png");
  EXPECT_NE(bytes.find(std::string("tEXtGr\xf6\xdf"
                                   "e\0plain",
                                   15)),
            std::string::npos);
  PngTexts found;
  readPng(folder / "a.png", &found);
  EXPECT_EQ(found, texts);
  EXPECT_THROW(writePng(folder / "b.png", Image<std::uint8_t>(2, 2, 1), {{"\u96f2", "x"}}), ParameterError);
}

TEST_F(ImageFiles, HeadersSayWhatValuesMeanWhereThatIsKnown) {
  for (const bool known : {false, true}) {
    bool srgb = !known, luminance = !known;
    writePng(folder / "a.png", Image<std::uint8_t>(2, 2, 1), {}, known);
    readPng(folder / "a.png", nullptr, &srgb);
    EXPECT_EQ(srgb, known);
    EXPECT_EQ(contents(folder / "a.png").find("sRGB") != std::string::npos, known);
    writeHdr(folder / "a.hdr", Image<float>(2, 2, 3), known);
    readHdr(folder / "a.hdr", &luminance);
    EXPECT_EQ(luminance, known);
    EXPECT_EQ(contents(folder / "a.hdr").find("PRIMARIES") != std::string::npos, known);
  }
}

TEST_F(ImageFiles, PngOfAnyWidth) {
  writePng(folder / "a.png", Image<std::uint8_t>(1000001, 1, 1));
  EXPECT_EQ(std::get<Image<std::uint8_t>>(readPng(folder / "a.png")).width, 1000001);
}

TEST_F(ImageFiles, PngErrors) {
  const Image<std::uint8_t> image(64, 64, 3);
  EXPECT_EQ(messageOf<IoError>([&] { writePng("/dev/full", image); }),
            "cannot write /dev/full: No space left on device");
  EXPECT_EQ(messageOf<IoError>([&] { writePng("/dev/full", randomIntegers<std::uint8_t>(1000, 1000, 3)); }),
            "cannot write /dev/full: No space left on device");  // in the midst of libpng
  EXPECT_THROW(writePng("/proc/a.png", image), IoError);
  EXPECT_THROW(writePng(folder / "a.png", Image<std::uint8_t>(0, 4, 3)), ParameterError);
  EXPECT_THROW(writePng(folder / "a.png", Image<std::uint8_t>(4, 4, 5)), ParameterError);
  for (const std::string& key : {std::string(), std::string(80, 'x'), std::string(" x"), std::string("x "),
                                 std::string("x  y"), std::string("x\ny"), std::string("x\x80")})
    EXPECT_EQ(messageOf<ParameterError>([&] { writePng(folder / "a.png", image, {{key, "text"}}); }),
              "cannot write " + (folder / "a.png").string() + ": metadata cannot be named \"" + key + '"');
  EXPECT_THROW(writePng(folder / "a.png", image, {{"key", std::string("a\0b", 3)}}), ParameterError);
  EXPECT_EQ(fileCount(), 0);

  writePng(folder / "a.png", randomIntegers<std::uint8_t>(50, 50, 3));
  std::filesystem::resize_file(folder / "a.png", 2000);
  EXPECT_THROW(readPng(folder / "a.png"), IoError);
  std::ofstream(folder / "b.png") << "no picture";
  EXPECT_THROW(readPng(folder / "b.png"), IoError);
  EXPECT_EQ(messageOf<IoError>([&] { readPng(folder / "none.png"); }),
            "cannot read " + (folder / "none.png").string() + ": No such file or directory");
}

TEST_F(ImageFiles, ExrRoundTripsInHalfAndFloat) {
  for (const int channels : {1, 3, 4}) {
    const Image<float> light = randomLight(19, 11, channels);
    writeExr(folder / "h.exr", light, {.metadata = {{"comment", "an evening"}}});
    const ExrPicture half = readExr(folder / "h.exr");
    EXPECT_TRUE(half.half);
    EXPECT_EQ(half.metadata.at("comment"), "an evening");
    ASSERT_EQ(half.image.data.size(), light.data.size());
    for (std::size_t i = 0; i < light.data.size(); ++i)
      EXPECT_NEAR(half.image.data[i], light.data[i],
                  light.data[i] * 0x1p-11f);  // 11 bits, rounded to the nearest

    writeExr(folder / "f.exr", light, {.depth = ExrDepth::kFloat, .metadata = {}});
    const ExrPicture full = readExr(folder / "f.exr");
    EXPECT_FALSE(full.half);
    EXPECT_EQ(full.image.data, light.data);
  }
}

// Nothing becomes infinite: a picture with the sun in it is kept in float, and clamped where half was
// insisted on.
TEST_F(ImageFiles, ExrKeepsTheSun) {
  Image<float> light = randomLight(8, 8, 3);
  light.at(3, 4, 1) = 1.6e9f;
  writeExr(folder / "sun.exr", light);
  const ExrPicture back = readExr(folder / "sun.exr");
  EXPECT_FALSE(back.half);
  EXPECT_EQ(back.image.at(3, 4, 1), 1.6e9f);
  EXPECT_EQ(back.image.data, light.data);

  writeExr(folder / "half.exr", light, {.depth = ExrDepth::kHalf, .metadata = {}});
  EXPECT_EQ(readExr(folder / "half.exr").image.at(3, 4, 1), 65504.0f);

  light.at(3, 4, 1) = 65519.0f;  // beyond half's largest, although it would round to it
  writeExr(folder / "edge.exr", light);
  EXPECT_EQ(readExr(folder / "edge.exr").image.at(3, 4, 1), 65519.0f);
}

// Tiles have an attribute that is OpenEXR's own, and no metadata.
TEST_F(ImageFiles, ExrOfTilesGoesRound) {
  writeExr(folder / "a.exr", randomLight(70, 40, 3), {.metadata = {{"scene", "Monterey"}}});
  outputOf("exrmaketiled " + (folder / "a.exr").string() + " " + (folder / "tiles.exr").string());
  const ExrPicture tiles = readExr(folder / "tiles.exr");
  EXPECT_EQ(tiles.image.data, readExr(folder / "a.exr").image.data);
  EXPECT_EQ(tiles.metadata.at("scene"), "Monterey");
  writeExr(folder / "b.exr", tiles.image, {.metadata = tiles.metadata});
  EXPECT_EQ(readExr(folder / "b.exr").metadata, tiles.metadata);
}

TEST_F(ImageFiles, ExrIsReadByOthers) {
  writeExr(folder / "a.exr", randomLight(10, 6, 3), {.metadata = {{"scene", "Monterey"}}});
  const std::string header = outputOf("exrheader " + (folder / "a.exr").string());
  for (const char* expected : {"whiteLuminance (type float): 1", "red   (0.64 0.33)", "white (0.3127 0.329)",
                               "zip, multi-scanline blocks", "dataWindow (type box2i): (0 0) - (9 5)",
                               "R, 16-bit floating-point, sampling 1 1", "scene (type string): \"Monterey\""})
    EXPECT_NE(header.find(expected), std::string::npos) << expected << "\nin\n" << header;
}

TEST_F(ImageFiles, ExrIsTheSameForAnyNumberOfThreads) {
  const Image<float> light = randomLight(300, 200, 3);
  setThreadCount(1);
  writeExr(folder / "1.exr", light);
  setThreadCount(4);
  writeExr(folder / "4.exr", light);
  setThreadCount(0);
  EXPECT_EQ(contents(folder / "1.exr"), contents(folder / "4.exr"));
}

TEST_F(ImageFiles, ExrErrors) {
  EXPECT_EQ(messageOf<IoError>([&] { writeExr("/dev/full", randomLight(400, 400, 3)); }),
            "cannot write /dev/full: No space left on device");
  EXPECT_THROW(writeExr("/proc/a.exr", randomLight(4, 4, 3)), IoError);
  EXPECT_THROW(writeExr(folder / "a.exr", randomLight(4, 4, 2)), ParameterError);
  EXPECT_THROW(writeExr(folder / "a.exr", Image<float>()), ParameterError);
  for (const char* key : {"", "channels", "type"})
    EXPECT_THROW(writeExr(folder / "a.exr", randomLight(4, 4, 3), {.metadata = {{key, "x"}}}), ParameterError)
        << key;
  EXPECT_THROW(writeExr(folder / "a.exr", Image<float>(65537, 1, 1)), ParameterError);
  Image<float> bad = randomLight(4, 4, 3);
  bad.at(2, 1, 0) = std::numeric_limits<float>::infinity();
  EXPECT_NE(
      messageOf<ParameterError>([&] { writeExr(folder / "a.exr", bad); }).find("pixel (2, 1), channel 0"),
      std::string::npos);
  EXPECT_EQ(fileCount(), 0);

  std::ofstream(folder / "b.exr") << "no picture";
  EXPECT_THROW(readExr(folder / "b.exr"), IoError);
  EXPECT_THROW(readExr(folder / "none.exr"), IoError);
  writeExr(folder / "c.exr", randomLight(64, 64, 3));
  std::filesystem::resize_file(folder / "c.exr", 5000);
  EXPECT_THROW(readExr(folder / "c.exr"), IoError);
}

TEST_F(ImageFiles, ExrPlanesHaveTheSizeOfThePicture) {
  ExrPlanes planes{.width = 3, .height = 2, .planes = {{"x", {1, 2, 3, 4, 5, 6}}}, .metadata = {}};
  writeExrPlanes(folder / "a.exr", planes);
  EXPECT_EQ(readExrPlanes(folder / "a.exr").planes, planes.planes);
  planes.planes["y"] = {1, 2, 3, 4, 5};
  EXPECT_NE(messageOf<ParameterError>([&] {
              writeExrPlanes(folder / "b.exr", planes);
            }).find("channel y has 5 values; expected 6"),
            std::string::npos);
  for (const auto& [width, height] : {std::pair(65537, 1), {1, 65537}, {0, 5}, {-1, -1}}) {
    ExrPlanes bad{
        .width = width, .height = height, .planes = {{"x", std::vector<float>(65537)}}, .metadata = {}};
    EXPECT_THROW(writeExrPlanes(folder / "b.exr", bad), ParameterError) << width << "x" << height;
  }
  EXPECT_THROW(writeExrPlanes(folder / "b.exr", {.width = 1, .height = 1, .planes = {}, .metadata = {}}),
               ParameterError);
  EXPECT_EQ(fileCount(), 1);
}

TEST_F(ImageFiles, HdrRoundTripsToItsPrecision) {
  for (const int width : {1, 7, 8, 9, 300, 1500}) {  // with and without run-length coding
    Image<float> light = randomLight(width, 5, 3);
    for (int x = width / 3; x < width * 2 / 3; ++x)  // long runs too
      for (int c = 0; c < 3; ++c) light.at(x, 2, c) = 1000.0f;
    light.at(0, 0, 0) = 1.6e9f;
    light.at(0, 1, 0) = light.at(0, 1, 1) = light.at(0, 1, 2) = 0.0f;
    writeHdr(folder / "a.hdr", light);
    const Image<float> back = readHdr(folder / "a.hdr");
    ASSERT_EQ(back.width, width);
    ASSERT_EQ(back.height, 5);
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < width; ++x) {
        const float largest = std::max({light.at(x, y, 0), light.at(x, y, 1), light.at(x, y, 2)});
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(back.at(x, y, c), light.at(x, y, c), largest * (1.0f / 256 + 1e-6f));
      }
  }
}

TEST_F(ImageFiles, HdrExtremes) {
  Image<float> light(4, 1, 3);
  light.data = {255.9f, 0.0f, 0.0f, -5.0f, 2.0f, 1.0f, 1e-40f, 1e-40f, 0.0f, 3e38f, 1.0f, 0.0f};
  writeHdr(folder / "a.hdr", light);
  const Image<float> back = readHdr(folder / "a.hdr");
  EXPECT_EQ(back.at(0, 0, 0), 256.0f);  // rounds up into the next exponent
  EXPECT_EQ(back.at(1, 0, 0), 0.0f);
  EXPECT_EQ(back.at(1, 0, 1), 2.0f);
  EXPECT_EQ(back.at(2, 0, 0), 0.0f);
  EXPECT_NEAR(back.at(3, 0, 0), 1.7e38f, 0.01e38f);  // the largest there is, not infinite
}

TEST_F(ImageFiles, HdrIsReadByOthers) {
  Image<float> light(40, 20, 3);
  for (float& x : light.data) x = 0.25f;
  light.at(0, 0, 0) = 0.5f;
  writeHdr(folder / "a.hdr", light);
  EXPECT_EQ(outputOf("identify -format '%m %w %h %[fx:round(100*p{0,0}.r)] %[fx:round(100*p{0,0}.g)] "
                     "%[fx:round(100*p{1,0}.r)]' " +
                     (folder / "a.hdr").string()),
            "HDR 40 20 50 25 25");
}

// "EXPOSURE= a multiplier that has been applied to all the pixels": several lines multiply (Radiance's "File
// Formats").
TEST_F(ImageFiles, HdrValuesAreThoseBeforeExposure) {
  const auto read = [&](const std::string& lines, const std::string& size = "-Y 1 +X 1") {
    std::ofstream(folder / "a.hdr", std::ios::binary)
        << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + lines + "\n" + size + "\n\x80\x40\x20\x81";
    return readHdr(folder / "a.hdr").data;
  };
  EXPECT_EQ(read(""), (std::vector<float>{1.0f, 0.5f, 0.25f}));
  EXPECT_EQ(read("EXPOSURE=0.5\n"), (std::vector<float>{2.0f, 1.0f, 0.5f}));
  EXPECT_EQ(read("EXPOSURE= 4\nEXPOSURE=  5.000000e-01\n"), (std::vector<float>{0.5f, 0.25f, 0.125f}));
  for (const char* bad : {"EXPOSURE=\n", "EXPOSURE=0\n", "EXPOSURE=-1\n", "EXPOSURE=two\n", "EXPOSURE=2x\n",
                          "EXPOSURE=nan\n", "EXPOSURE=inf\n", "EXPOSURE=1e-300\n"})
    EXPECT_THROW(read(bad), IoError) << bad;
  for (const char* bad : {"-Y 1 +X 1junk", "-Y 1junk +X 1", "-Y 1 +X 1 1"})
    EXPECT_THROW(read("", bad), IoError) << bad;
}

TEST_F(ImageFiles, HdrErrors) {
  EXPECT_THROW(writeHdr("/dev/full", randomLight(64, 64, 3)), IoError);
  EXPECT_THROW(writeHdr(folder / "a.hdr", randomLight(4, 4, 1)), ParameterError);
  Image<float> bad = randomLight(9, 4, 3);
  bad.at(8, 3, 2) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(
      messageOf<ParameterError>([&] { writeHdr(folder / "a.hdr", bad); }).find("pixel (8, 3), channel 2"),
      std::string::npos);
  EXPECT_EQ(fileCount(), 0);

  EXPECT_THROW(readHdr(folder / "none.hdr"), IoError);
  writeHdr(folder / "c.hdr", randomLight(64, 64, 3));
  const std::string good = contents(folder / "c.hdr");
  for (std::size_t cut = 0; cut < good.size(); cut += 97) {  // cut anywhere: an error, never a crash
    std::ofstream(folder / "d.hdr", std::ios::binary) << good.substr(0, cut);
    EXPECT_THROW(readHdr(folder / "d.hdr"), IoError) << cut;
  }
  std::ofstream(folder / "e.hdr") << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000 +X 1000000\n";
  EXPECT_THROW(readHdr(folder / "e.hdr"), IoError);
}

TEST_F(ImageFiles, FormatFollowsTheExtension) {
  Image<float> picture(16, 8, 3);
  for (float& x : picture.data) x = 0.5f;
  for (const char* name : {"a.png", "b.exr", "c.hdr", "D.PNG"}) writeImage(folder / name, picture);
  writeImage(folder / "e.png", picture, {.pngBits = 16, .metadata = {}});
  EXPECT_EQ(std::get<Image<std::uint8_t>>(readPng(folder / "D.PNG")).width, 16);
  EXPECT_EQ(std::get<Image<std::uint16_t>>(readPng(folder / "e.png")).at(0, 0), 32768);
  EXPECT_EQ(readExr(folder / "b.exr").image.data, picture.data);
  EXPECT_EQ(readHdr(folder / "c.hdr").data, picture.data);
  EXPECT_EQ(fileCount(), 5);
  EXPECT_FALSE(holdsLuminance(imageFormatOf("x.png")));
  EXPECT_TRUE(holdsLuminance(imageFormatOf("x.hdr")));
  EXPECT_EQ(messageOf<ParameterError>([&] { writeImage("sky.jpg", picture); }),
            "sky.jpg: unknown extension .jpg; expected .png, .exr or .hdr");
  EXPECT_EQ(messageOf<ParameterError>([&] { writeImage("sky", picture); }),
            "sky: no extension; expected .png, .exr or .hdr");
}

}  // namespace
}  // namespace welkin::io
