// SPDX-License-Identifier: Apache-2.0
// Run headless, on Mesa's software rasteriser where there is no graphics card.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>

#include "welkin/core/error.h"
#include "welkin/core/glsl.h"
#include "welkin/core/random.h"
#include "welkin/gpu/context.h"
#include "welkin/gpu/draw.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"

namespace welkin::gpu {
namespace {

// A context whose driver must have had nothing to complain about when the test ends.
class Gpu : public ::testing::Test {
 protected:
  void TearDown() override {
    for (const std::string& error : context.takeErrors()) ADD_FAILURE() << error;
  }
  Context context{{.debug = true}};
};

const ShaderSource kTriangle{R"(#version 330 core
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }
)",
                             {"triangle.vert"}};

Program fragmentProgram(const std::string& body, const std::string& name = "test.frag") {
  return Program::graphics(
      kTriangle,
      {"#version 330 core\nprecision highp sampler3D;\nlayout(location = 0) out vec4 oColour;\n#line 1 0\n" +
           body,
       {name}});
}

Volume<float> noiseVolume(int nx, int ny, int nz, int channels) {
  Volume<float> volume(nx, ny, nz, channels);
  Random random(7);
  for (float& x : volume.data) x = random.uniform() * 2.0f - 0.5f;
  return volume;
}

// libepoxy would end the process.
TEST(Current, ErrorsSayWhatIsMissing) {
  const auto problem = [] {
    try {
      requireCurrent();
      return std::string();
    } catch (const GpuError& e) {
      return std::string(e.what());
    }
  };
  {
    const Context gl{{}};
    EXPECT_EQ(problem(), "");
  }
  EXPECT_EQ(problem(), "no OpenGL context is current in this thread");
  try {
    const Context es{{.api = Api::kGles}};
    EXPECT_NE(problem().find("OpenGL ES"), std::string::npos) << problem();
    EXPECT_NE(problem().find("expected OpenGL 3.3 or later"), std::string::npos) << problem();
  } catch (const GpuError& e) {
    GTEST_SKIP() << e.what();
  }
}

TEST_F(Gpu, ContextTellsAboutItself) {
  EXPECT_FALSE(context.deviceName().empty());
  EXPECT_GE(context.majorVersion() * 10 + context.minorVersion(), 33);
  EXPECT_GE(context.maxTextureSize2D(), 1024);
  EXPECT_GE(context.maxTextureSize3D(), 256);
  EXPECT_EQ(context.isSoftware(), context.deviceName().find("llvmpipe") != std::string::npos);
}

TEST_F(Gpu, SecondContextLeavesTheFirstUsable) {
  {
    Context other({.api = Api::kGles});
    EXPECT_FALSE(other.hasCompute());
  }
  context.makeCurrent();
  const Texture2D texture(2, 2, {.format = Format::kRgba32F});
  const Framebuffer target(texture);
  target.clear(0, {1.0f, 2.0f, 3.0f, 4.0f});
  EXPECT_EQ(target.readPicture().at(1, 1, 2), 3.0f);
}

TEST_F(Gpu, DriverErrorsAreRecorded) {
  const Texture2D texture(4, 4, {.format = Format::kRgba32F});
  const Framebuffer target(texture);
  EXPECT_TRUE(context.takeErrors().empty());
  target.clear(99);  // no such draw buffer
  EXPECT_FALSE(context.takeErrors().empty());
  EXPECT_TRUE(context.takeErrors().empty());
}

TEST_F(Gpu, CompileErrorNamesFileAndLine) {
  try {
    fragmentProgram("void main() {\n  oColour = vec4(1.0);\n  oColour.x = missing;\n}\n", "pass/broken.frag");
    FAIL() << "compiled";
  } catch (const GpuError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("pass/broken.frag does not compile: pass/broken.frag:3")) << message;
    EXPECT_NE(message.find("missing"), std::string::npos) << message;
  }
}

TEST_F(Gpu, LinkErrorNamesBothFiles) {
  try {
    fragmentProgram("float elsewhere();\nvoid main() { oColour = vec4(elsewhere()); }\n", "pass/half.frag");
    FAIL() << "linked";
  } catch (const GpuError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("triangle.vert with pass/half.frag does not link: "))
        << error.what();
  }
}

TEST(GpuLog, FileNamesReplaceIndicesOfAllDrivers) {
  const ShaderSource source{"", {"pass/a.frag", "lib/b.glsl"}};
  EXPECT_EQ(withFileNames("1:12(5): error: no x", source), "lib/b.glsl:12(5): error: no x");
  EXPECT_EQ(withFileNames("0(7) : error C1008: no x\n1(3) : warning C7050: y\n", source),
            "pass/a.frag:7: error C1008: no x\nlib/b.glsl:3: warning C7050: y");
  EXPECT_EQ(withFileNames("ERROR: 1:4: 'x' : undeclared", source), "lib/b.glsl:4: ERROR: 'x' : undeclared");
  EXPECT_EQ(withFileNames("7:4: file unknown\nplain text", source), "7:4: file unknown\nplain text");
}

TEST_F(Gpu, PictureIsReadTopRowFirst) {
  const Texture2D texture(5, 3, {.format = Format::kRgba32F});
  const Framebuffer target(texture);
  const FullscreenTriangle triangle;
  triangle.draw(fragmentProgram("void main() { oColour = vec4(gl_FragCoord.xy, 0.0, 1.0); }"), target);
  const Image<float> picture = target.readPicture(0, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x) {
      EXPECT_EQ(picture.at(x, y, 0), static_cast<float>(x) + 0.5f);
      EXPECT_EQ(picture.at(x, y, 1), static_cast<float>(2 - y) + 0.5f);
    }
  EXPECT_EQ(texture.read().at(0, 0, 1), 0.5f);  // the texture itself is not turned over
}

TEST_F(Gpu, TextureRoundTrips) {
  Image<float> image(7, 5, 3);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(i) * 1e3f;
  const Image<float> back = Texture2D(image, {.format = Format::kRgba32F}).read();
  ASSERT_EQ(back.channels, 4);
  EXPECT_EQ(back.at(6, 4, 2), image.at(6, 4, 2));
  EXPECT_EQ(back.at(0, 1, 0), image.at(0, 1, 0));
  EXPECT_EQ(back.at(3, 2, 3), 1.0f);

  Volume<float> volume = noiseVolume(3, 5, 7, 1);
  EXPECT_EQ(Texture3D(volume, {.format = Format::kR32F}).read().data, volume.data);
}

// More than any device has; OpenGL 3.3 promises 16.
TEST_F(Gpu, TooManyTexturesAreAnErrorWithTheDevicesLimit) {
  std::string uniforms, sum = "vec4(0.0)";
  for (int i = 0; i < 300; ++i) {
    const std::string name = "uTexture" + std::to_string(i);
    uniforms += "uniform sampler2D " + name + ";\n";
    sum += " + texture(" + name + ", gl_FragCoord.xy)";
  }
  try {
    fragmentProgram(uniforms + "void main() { oColour = " + sum + "; }\n", "pass/many.frag");
    FAIL() << "linked";
  } catch (const GpuError& error) {
    EXPECT_NE(std::string(error.what()).find("300 textures, and this device gives a shader "),
              std::string::npos)
        << error.what();
  }
}

TEST_F(Gpu, ImpossibleSizesAreErrors) {
  EXPECT_THROW(Texture2D(0, 4), GpuError);
  EXPECT_THROW(Texture2D(1 << 24, 4), GpuError);
  EXPECT_THROW(Texture3D(4, 4, 1 << 20), GpuError);
}

// The shader reads a volume as the C++ of core/glsl.h does, to the precision of the half floats it is kept
// in.
TEST_F(Gpu, HalfVolumeSamplesAsOnTheCpu) {
  const Volume<float> volume = noiseVolume(8, 4, 16, 1);
  const FullscreenTriangle triangle;
  Program program = fragmentProgram(R"(uniform sampler3D uVolume; uniform vec3 uOrigin, uStep;
void main() { oColour = textureLod(uVolume, uOrigin + uStep * gl_FragCoord.x, 0.0); })");
  const Texture2D texture(64, 1, {.format = Format::kRgba32F});
  const Framebuffer target(texture);
  for (const bool repeat : {true, false}) {
    const Wrap wrap = repeat ? Wrap::kRepeat : Wrap::kClamp;
    const Texture3D gpuVolume(volume, {.format = Format::kR16F, .wrapX = wrap, .wrapY = wrap, .wrapZ = wrap});
    const glsl::sampler3D cpuVolume{&volume, repeat ? glsl::Wrap::kRepeat : glsl::Wrap::kClamp};
    const glm::vec3 origin(-0.31f, -0.17f, -0.23f), step(0.029f, 0.0213f, 0.0257f);
    program.set("uOrigin", origin);
    program.set("uStep", step);
    program.bind("uVolume", gpuVolume);
    triangle.draw(program, target);
    const Image<float> row = target.readPicture();
    for (int x = 0; x < 64; ++x) {
      const glm::vec4 expected = textureLod(cpuVolume, origin + step * (static_cast<float>(x) + 0.5f), 0.0f);
      // Half has 11 bits; filters of real cards weigh with 8 bits, which over the 3 axes and a range of 2
      // adds 0.012.
      const float tolerance = context.isSoftware() ? 2e-3f : 1.5e-2f;
      EXPECT_NEAR(row.at(x, 0, 0), expected.x, tolerance) << x;
      EXPECT_EQ(row.at(x, 0, 3), 1.0f);
    }
  }
}

TEST_F(Gpu, DrawsToSlicesOfAVolume) {
  const Texture3D volume(4, 3, 5, {.format = Format::kR32F});
  Framebuffer target;
  const FullscreenTriangle triangle;
  Program program =
      fragmentProgram("uniform int uZ; void main() { oColour = vec4(float(uZ) * 100.0 + gl_FragCoord.x); }");
  for (int z = 0; z < 5; ++z) {
    target.attachSlice(0, volume, z);
    program.set("uZ", z);
    triangle.draw(program, target);
  }
  const Volume<float> result = volume.read();
  for (int z = 0; z < 5; ++z)
    for (int x = 0; x < 4; ++x)
      EXPECT_EQ(result.at(x, 2, z), static_cast<float>(z) * 100.0f + static_cast<float>(x) + 0.5f);
}

TEST_F(Gpu, SeveralAttachmentsGetTheirOutputs) {
  const Texture2D a(2, 2, {.format = Format::kRgba16F}), b(2, 2, {.format = Format::kRg16F});
  Framebuffer target;
  target.attach(0, a);
  target.attach(1, b);
  const FullscreenTriangle triangle;
  triangle.draw(fragmentProgram("layout(location = 1) out vec2 oSecond;\nvoid main() { oColour = vec4(3.0); "
                                "oSecond = vec2(5.0, 7.0); }"),
                target);
  EXPECT_EQ(target.readPicture(0).at(1, 0, 0), 3.0f);
  EXPECT_EQ(target.readPicture(1, 2).at(1, 0, 1), 7.0f);
}

TEST_F(Gpu, BlendingAccumulatesInsideTheTileOnly) {
  const Texture2D texture(6, 6, {.format = Format::kRgba32F});
  const Framebuffer target(texture);
  target.clear(0, glm::vec4(10.0f));
  const FullscreenTriangle triangle;
  const Program program = fragmentProgram("void main() { oColour = vec4(1.0, 0.25, 0.0, -1.0); }");
  for (int i = 0; i < 3; ++i)
    triangle.draw(program, target, {.tile = Tile{1, 0, 2, 2}, .blend = Blend::kAdd});
  const Image<float> picture = target.readPicture();
  EXPECT_EQ(picture.at(1, 5, 0), 13.0f);  // bottom row of the picture: the tile counts from below
  EXPECT_EQ(picture.at(2, 4, 1), 10.75f);
  EXPECT_EQ(picture.at(2, 4, 3), 7.0f);
  EXPECT_EQ(picture.at(0, 5, 0), 10.0f);
  EXPECT_EQ(picture.at(3, 5, 0), 10.0f);
  EXPECT_EQ(picture.at(1, 3, 0), 10.0f);
  triangle.draw(program, target);  // neither tile nor blending stays on
  EXPECT_EQ(target.readPicture().at(5, 0, 0), 1.0f);
}

TEST_F(Gpu, WhereAMaskSaysSoAlone) {
  const Texture2D texture(9, 5, {.format = Format::kRgba32F});
  Framebuffer target(texture);
  target.clear();
  const FullscreenTriangle triangle;
  const Program program = fragmentProgram("void main() { oColour = vec4(1.0); }");
  Image<std::uint8_t> mask(9, 5, 1);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 9; ++x) mask.at(x, y) = static_cast<std::uint8_t>((3 * x + 5 * y) % 4);
  target.setMask(mask);
  for (const std::uint8_t where : {1, 3, 3})
    triangle.draw(program, target, {.blend = Blend::kAdd, .where = where});
  for (auto& number : mask.data) number = number == 1 ? 255 : 1;
  target.setMask(mask);  // anew
  triangle.draw(program, target, {.tile = Tile{0, 0, 9, 2}, .blend = Blend::kAdd, .where = 255});
  const Image<float> picture = target.readPicture();
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 9; ++x) {
      const int number = (3 * x + 5 * y) % 4;
      const float expected = number == 3 ? 2.0f : number == 1 ? (y < 3 ? 1.0f : 2.0f) : 0.0f;
      EXPECT_EQ(picture.at(x, y), expected) << x << ", " << y;
    }
  triangle.draw(program, target);  // the mask does not stay on
  EXPECT_EQ(target.readPicture().at(0, 0), 1.0f);
}

TEST_F(Gpu, UniformsOfAllKinds) {
  Program program = fragmentProgram(R"(struct Layer { float base; vec4 wind; };
uniform Layer uLayers[2]; uniform vec4 uList[3]; uniform float uFloats[2]; uniform mat3 uTurn; uniform mat4 uMove;
uniform ivec2 uPair; uniform vec2 uSize; uniform vec3 uUnused;
void main() {
  oColour = vec4(uLayers[1].base + uFloats[1], uList[2].y, (uTurn * vec3(1.0, 0.0, 0.0)).y,
                 uMove[3][0] + float(uPair.y) + uSize.x + uLayers[0].wind.w);
})");
  program.set("uLayers[1].base", 1200.0f);
  program.set("uLayers[0].wind", glm::vec4(0, 0, 0, 1000.0f));
  const glm::vec4 list[] = {glm::vec4(0), glm::vec4(0), glm::vec4(1, 2, 3, 4)};
  program.set("uList", std::span<const glm::vec4>(list));
  const float floats[] = {0.0f, 34.0f};
  program.set("uFloats", std::span<const float>(floats));
  glm::mat3 turn(0.0f);
  turn[0][1] = 9.0f;  // column 0, row 1
  program.set("uTurn", turn);
  glm::mat4 move(1.0f);
  move[3][0] = 5.0f;
  program.set("uMove", move);
  program.set("uPair", glm::ivec2(1, 20));
  program.set("uSize", glm::vec2(300.0f, 0.0f));
  program.set("uUnused", glm::vec3(1.0f));
  program.set("uNowhere", 1.0f);
  EXPECT_TRUE(program.has("uList"));
  EXPECT_FALSE(program.has("uNowhere"));

  const Texture2D texture(1, 1, {.format = Format::kRgba32F});
  const Framebuffer target(texture);
  const FullscreenTriangle triangle;
  triangle.draw(program, target);
  const Image<float> p = target.readPicture();
  EXPECT_EQ(p.data, (std::vector<float>{1234.0f, 2.0f, 9.0f, 1325.0f}));
}

TEST_F(Gpu, MakingATextureBetweenBindAndDrawDisturbsNothing) {
  Image<float> image(1, 1, 1);
  image.data = {42.0f};
  const Texture2D bound(image, {.format = Format::kR32F});
  Program program =
      fragmentProgram("uniform sampler2D uA; void main() { oColour = textureLod(uA, vec2(0.5), 0.0); }");
  program.bind("uA", bound);
  image.data = {1.0f};
  const Texture2D later(image, {.format = Format::kR32F});
  const Texture2D texture(1, 1, {.format = Format::kRgba32F});
  const Framebuffer target(texture);
  const FullscreenTriangle triangle;
  triangle.draw(program, target);
  EXPECT_EQ(target.readPicture().at(0, 0, 0), 42.0f);
}

TEST_F(Gpu, MipmapsAverage) {
  Image<float> image(4, 4, 1);
  for (std::size_t i = 0; i < 16; ++i) image.data[i] = static_cast<float>(i);
  const Texture2D mipmapped(image, {.format = Format::kR32F, .filter = Filter::kMipmap});
  Program program =
      fragmentProgram("uniform sampler2D uA; void main() { oColour = textureLod(uA, vec2(0.5), 2.0); }");
  program.bind("uA", mipmapped);
  const Texture2D texture(1, 1, {.format = Format::kRgba32F});
  const Framebuffer target(texture);
  const FullscreenTriangle triangle;
  triangle.draw(program, target);
  EXPECT_FLOAT_EQ(target.readPicture().at(0, 0, 0), 7.5f);
}

TEST_F(Gpu, ComputeWritesVolumes) {
  if (!context.hasCompute()) GTEST_SKIP() << "OpenGL 4.3 is needed";
  const Texture3D volume(8, 8, 8, {.format = Format::kR32F});
  Program program = Program::compute({R"(#version 430 core
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(binding = 0, r32f) writeonly uniform image3D uOut;
void main() {
  ivec3 p = ivec3(gl_GlobalInvocationID);
  imageStore(uOut, p, vec4(float(p.x + 10 * p.y + 100 * p.z)));
})",
                                      {"test.comp"}});
  bindImage(0, volume, Access::kWrite);
  Stopwatch stopwatch;
  dispatch(program, 2, 2, 2);
  EXPECT_GT(stopwatch.finishedMs(), 0.0);
  const Volume<float> result = volume.read();
  EXPECT_EQ(result.at(7, 5, 3), 357.0f);
  EXPECT_EQ(result.at(0, 0, 7), 700.0f);
}

// The software rasteriser shares its work among threads; the bits must not show it. It reads their number
// once in a process, so each count gets a process of its own, which hands its picture over in a file.
TEST(GpuThreads, PictureIsTheSameForAnyNumber) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto fileFor = [](const char* threads) { return testing::TempDir() + "welkin-threads-" + threads; };
  const auto drawAndExit = [&](const char* threads) {
    setenv("LP_NUM_THREADS", threads, 1);
    Context context;
    const Texture2D texture(257, 129, {.format = Format::kRgba32F});
    const Framebuffer target(texture);
    target.clear();
    Program program = fragmentProgram(R"(uniform float uShift;
void main() {
  vec2 p = gl_FragCoord.xy * 0.0173 + uShift;
  oColour = vec4(sin(p.x * p.y), exp(-p.x), pow(abs(cos(p.y)), 0.37), dFdx(p.x * p.x));
})");
    const FullscreenTriangle triangle;
    for (int i = 0; i < 8; ++i) {
      program.set("uShift", static_cast<float>(i) * 0.1f);
      triangle.draw(program, target, {.tile = {}, .blend = Blend::kAdd});
    }
    const Image<float> picture = target.readPicture();
    std::FILE* file = std::fopen(fileFor(threads).c_str(), "wb");
    std::fwrite(picture.data.data(), sizeof(float), picture.data.size(), file);
    std::fclose(file);
    std::exit(0);
  };
  std::string pictures[2];
  int i = 0;
  for (const char* threads : {"1", "2"}) {
    EXPECT_EXIT(drawAndExit(threads), testing::ExitedWithCode(0), "");
    std::ifstream in(fileFor(threads), std::ios::binary);
    pictures[i++].assign(std::istreambuf_iterator<char>(in), {});
    std::remove(fileFor(threads).c_str());
  }
  EXPECT_EQ(pictures[0].size(), 257u * 129 * 16);
  EXPECT_TRUE(pictures[0] == pictures[1]);
}

// Without EGL there is a message, not an end of the process. EGL's dispatcher is given a vendor that does not
// exist.
TEST(GpuWithoutDriver, IsAnErrorWithReasons) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a fresh process: drivers are looked for once
  EXPECT_EXIT(
      {
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1);
        try {
          Context context;
        } catch (const GpuError& error) {
          std::fputs(error.what(), stderr);
          std::exit(3);
        }
        std::exit(0);
      },
      testing::ExitedWithCode(3), "no graphics context: .*default display");
}

}  // namespace
}  // namespace welkin::gpu
