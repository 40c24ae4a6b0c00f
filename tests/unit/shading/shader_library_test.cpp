// SPDX-License-Identifier: Apache-2.0
#include "welkin/shading/shader_library.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/testing/scratch_folder.h"
#include "welkin/core/error.h"
#include "welkin/field/cloud_field.h"
#include "welkin/gpu/context.h"
#include "welkin/gpu/draw.h"
#include "welkin/gpu/framebuffer.h"
#include "welkin/gpu/program.h"
#include "welkin/gpu/texture.h"
#include "welkin/shading/sheet_order.h"
#include "welkin/shading/uniforms.h"

namespace welkin::shading {
namespace {

std::size_t count(std::string_view text, std::string_view what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string_view::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

// A shaders/ folder on disk that assembleShader reads while the object lives.
class DiskShaders {
 public:
  DiskShaders() {
    std::filesystem::create_directories(folder_.path() / "lib");
    std::filesystem::create_directories(folder_.path() / "pass");
    write("lib/prelude.glsl", "precision highp float;\n");
    setenv("WELKIN_SHADER_DIR", folder_.path().c_str(), 1);
  }
  ~DiskShaders() { unsetenv("WELKIN_SHADER_DIR"); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
  }

 private:
  testing::ScratchFolder folder_;
};

std::string messageOf(std::string_view name) {
  try {
    assembleShader(name, ShaderDialect::kGl330);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ShaderLibrary, BeginsWithTheVersionOfEachDialect) {
  EXPECT_TRUE(
      assembleShader("pass/fullscreen.vert", ShaderDialect::kGl330).text.starts_with("#version 330 core\n"));
  EXPECT_TRUE(
      assembleShader("pass/fullscreen.vert", ShaderDialect::kEs300).text.starts_with("#version 300 es\n"));
  EXPECT_TRUE(assembleShader("pass/fullscreen.vert", ShaderDialect::kGl430Compute)
                  .text.starts_with("#version 430 core\n"));
}

TEST(ShaderLibrary, EmbeddedFilesAreThoseOfTheSourceFolder) {
  const std::vector<std::string> embedded = shaderNames();
  setenv("WELKIN_SHADER_DIR", WELKIN_TEST_DATA_DIR "/../../shaders", 1);
  const std::vector<std::string> onDisk = shaderNames();
  unsetenv("WELKIN_SHADER_DIR");
  EXPECT_EQ(embedded, onDisk);
  EXPECT_NE(std::find(embedded.begin(), embedded.end(), "lib/prelude.glsl"), embedded.end());
}

TEST(ShaderLibrary, IncludesEachFileOnceAndInOrder) {
  const DiskShaders disk;
  disk.write("lib/a.glsl", "#include \"lib/c.glsl\"\nint a;\n");
  disk.write("lib/b.glsl", "  #  include \"lib/c.glsl\"\nint b;");  // no newline at its end
  disk.write("lib/c.glsl", "#include \"lib/a.glsl\"\nint c;\n");    // a circle
  disk.write(
      "pass/x.frag",
      "#include \"lib/a.glsl\"\n#include \"lib/b.glsl\"\n// #include \"lib/none.glsl\"\nvoid main() {}\n");
  const ShaderSource source = assembleShader("pass/x.frag", ShaderDialect::kGl330);
  EXPECT_EQ(count(source.text, "int a;"), 1u);
  EXPECT_EQ(count(source.text, "int b;"), 1u);
  EXPECT_EQ(count(source.text, "int c;"), 1u);
  EXPECT_LT(source.text.find("int c;"), source.text.find("int a;"));
  EXPECT_LT(source.text.find("int a;"), source.text.find("int b;"));
  EXPECT_EQ(source.files, (std::vector<std::string>{"pass/x.frag", "lib/prelude.glsl", "lib/a.glsl",
                                                    "lib/c.glsl", "lib/b.glsl"}));
}

TEST(ShaderLibrary, DefinesStandBetweenPreludeAndShader) {
  const ShaderDefine defines[] = {{"STEPS", "64"}, {"FAST", ""}};
  const std::string text = assembleShader("pass/fullscreen.vert", ShaderDialect::kGl330, defines).text;
  EXPECT_LT(text.find("precision highp float"), text.find("#define STEPS 64\n"));
  EXPECT_LT(text.find("#define FAST"), text.find("void main"));
}

TEST(ShaderLibrary, UnknownIncludeNamesFileAndLine) {
  const DiskShaders disk;
  disk.write("lib/phase.glsl", "int p;\n");
  disk.write("lib/a.glsl", "int a;\n\n#include \"lib/phasse.glsl\"\n");
  disk.write("pass/x.frag", "#include \"lib/a.glsl\"\nvoid main() {}\n");
  disk.write("pass/y.frag", "#include <lib/a.glsl>\nvoid main() {}\n");
  EXPECT_EQ(messageOf("pass/x.frag"),
            "lib/a.glsl:3: there is no shader file \"lib/phasse.glsl\"; is \"lib/phase.glsl\" meant?");
  EXPECT_EQ(messageOf("pass/y.frag"), "pass/y.frag:1: expected #include \"lib/name.glsl\"");
}

TEST(ShaderLibrary, UnknownEntryPointSuggestsTheNearest) {
  EXPECT_EQ(messageOf("pass/fulscreen.vert"),
            "there is no shader file \"pass/fulscreen.vert\"; is \"pass/fullscreen.vert\" meant?");
}

TEST(ShaderLibrary, MissingFolderIsAnError) {
  setenv("WELKIN_SHADER_DIR", "/nonexistent", 1);
  EXPECT_THROW(assembleShader("pass/fullscreen.vert", ShaderDialect::kGl330), IoError);
  unsetenv("WELKIN_SHADER_DIR");
}

// Both ways of reading uniforms give the same values: alone, several in a line, structs, arrays with and
// without WELKIN_FIXED, left out by a condition, in an include, and where main() is one line.
TEST(ShaderLibrary, UniformsReadOnceAreTheSame) {
  const DiskShaders disk;
  disk.write("lib/prelude.glsl", "precision highp float;\n#define WELKIN_FIXED\n");
  disk.write("lib/air.glsl",
             "struct Air { float thick; vec2 wind; };\n"
             "uniform Air uAir;   // of a, kind; that has all\n"
             "#ifdef SECOND\nuniform vec3 uLight;\n#else\nconst vec3 uLight = vec3(7.0);\n#endif\n"
             "float air() { return uAir.thick + uAir.wind.y + uLight.z; }\n");
  disk.write(
      "pass/v.vert",
      "void main() { gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0); }\n");
  disk.write("pass/x.frag",
             "#include \"lib/air.glsl\"\n"
             "  uniform   int uCount, uFirst;\n"
             "uniform mat3 uTurn;\n"
             "WELKIN_FIXED uniform Air uLayers[2];\n"
             "WELKIN_FIXED uniform float uFixed[3], uOther ;\n"
             "uniform float uFree[4];\n"
             "uniform sampler2D uTexture;\n"
             "out vec4 c;\n"
             "float sum() {\n"
             "  float s = 0.0;\n"
             "  for (int i = uFirst; i < uCount; ++i) s += uFree[i];\n"
             "  return s;\n"
             "}\n"
             "void main() { c = vec4(air(), sum(), (uTurn * vec3(1.0)).y + uOther, uLayers[1].wind.x + "
             "uFixed[2]); }\n");
  const gpu::Context context;
  for (const bool second : {false, true}) {
    ShaderDefines defines;
    if (second) defines.emplace_back("SECOND", "1");
    for (const UniformReads reads : {UniformReads::kWhereUsed, UniformReads::kOnce}) {
      const ShaderSource source = assembleShader("pass/x.frag", ShaderDialect::kGl330, defines, reads);
      // What is read at the beginning of main().
      const auto once = [&](const char* name) {
        return source.text.find("read_" + std::string(name) + "();") != std::string::npos;
      };
      for (const char* name : {"uAir", "uLight", "uCount", "uFirst", "uTurn", "uLayers", "uFixed", "uOther"})
        EXPECT_EQ(once(name), reads == UniformReads::kOnce) << name;
      EXPECT_FALSE(once("uFree") || once("uTexture"));

      gpu::Program program =
          gpu::Program::graphics(assembleShader("pass/v.vert", ShaderDialect::kGl330, {}, reads), source);
      program.set("uAir.thick", 1.0f);
      program.set("uAir.wind", glm::vec2(0.0f, 20.0f));
      program.set("uLight", glm::vec3(0.0f, 0.0f, 300.0f));
      program.set("uCount", 4);
      program.set("uFirst", 2);
      glm::mat3 turn(0.0f);
      turn[2][1] = 5.0f;
      program.set("uTurn", turn);
      program.set("uOther", 0.25f);
      program.set("uLayers[1].wind", glm::vec2(40.0f, 0.0f));
      const float fixed[] = {1.0f, 2.0f, 3.0f}, free[] = {1.0f, 2.0f, 4.0f, 8.0f};
      program.set("uFixed", std::span<const float>(fixed));
      program.set("uFree", std::span<const float>(free));
      const gpu::Texture2D texture(1, 1, {.format = gpu::Format::kRgba32F});
      const gpu::Framebuffer target(texture);
      const gpu::FullscreenTriangle triangle;
      triangle.draw(program, target);
      EXPECT_EQ(target.readPicture().data,
                (std::vector<float>{second ? 321.0f : 28.0f, 12.0f, 5.25f, 43.0f}));
    }
  }
}

// Without the line at which they are read, variables would be used that nobody has filled.
TEST(ShaderLibrary, UniformsReadOnceWantAMainToReadThemIn) {
  const DiskShaders disk;
  disk.write("pass/x.frag", "uniform float uX;\nout vec4 c;\nvoid main()\n{ c = vec4(uX); }\n");
  EXPECT_NO_THROW(assembleShader("pass/x.frag", ShaderDialect::kGl330));
  try {
    assembleShader("pass/x.frag", ShaderDialect::kGl330, {}, UniformReads::kOnce);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "pass/x.frag: expected a line that begins with \"void main() {\"");
  }
}

// The line that a compiler names is the line of the file, before, between and after includes, in both
// dialects, however uniforms are read.
TEST(ShaderLibrary, CompilersNameTheRightFileAndLine) {
  const DiskShaders disk;
  disk.write("lib/good.glsl", "float two() {\n  return 2.0f;\n}\n");
  disk.write("lib/bad.glsl", "uniform float uThree;\nfloat three() {\n  return uThree + threee;\n}\n");
  disk.write("pass/v.vert", "void main() { gl_Position = vec4(0.0f); }\n");
  disk.write("pass/in_include.frag",
             "#include \"lib/good.glsl\"\n#include \"lib/bad.glsl\"\nout vec4 c;\nvoid main() { c = "
             "vec4(two()); }\n");
  disk.write("pass/after.frag",
             "#include \"lib/good.glsl\"\nuniform vec4 c0;\nout vec4 c;\nvoid main() {\n  c = c0 + "
             "vec4(twoo());\n}\n");
  for (const auto& [es, reads] :
       {std::pair(false, UniformReads::kWhereUsed), std::pair(true, UniformReads::kWhereUsed),
        std::pair(false, UniformReads::kOnce), std::pair(true, UniformReads::kOnce)}) {
    gpu::Context context({.api = es ? gpu::Api::kGles : gpu::Api::kGl});
    const ShaderDialect dialect = es ? ShaderDialect::kEs300 : ShaderDialect::kGl330;
    const auto message = [&](const char* name) -> std::string {
      try {
        gpu::Program::graphics(assembleShader("pass/v.vert", dialect),
                               assembleShader(name, dialect, {}, reads));
      } catch (const GpuError& error) {
        return error.what();
      }
      return "compiled";
    };
    EXPECT_NE(message("pass/in_include.frag").find("lib/bad.glsl:3"), std::string::npos)
        << message("pass/in_include.frag");
    EXPECT_NE(message("pass/after.frag").find("pass/after.frag:5"), std::string::npos)
        << message("pass/after.frag");
  }
}

// So many layers, in bands of three.
ShaderDefines definesOfLayers(int count) {
  LightVolumeLayout layout;
  for (int i = 0; i < count; ++i) {
    if (i % 3 == 0) {
      const float baseM = 1000.0f * static_cast<float>(i);
      layout.bands.push_back({baseM, baseM + 500.0f, i, i + 2, {}});
    }
    layout.bands.back().layers.push_back(i);
    layout.bands.back().balls = count == 2;  // metaballs among them
  }
  ShaderDefines defines = marchDefines(layout, 1200.0);
  defines.push_back({"WELKIN_BAND", "0"});
  // Sheets in all tiers of light, on either kind of pattern.
  defines.push_back({"WELKIN_TIER", std::to_string(count % 3)});
  defines.push_back({"WELKIN_PATTERN_3D", count % 2 ? "1" : "0"});
  defines.push_back({"WELKIN_BACKDROP", std::to_string(count % 3)});
  // Living octaves of each kernel, one and more.
  defines.push_back({"WELKIN_KERNEL", std::to_string(count % 3)});
  defines.push_back({"WELKIN_OCTAVES", std::to_string(std::clamp(count * 3, 1, 8))});
  // Matter with phase functions of its own, and a sky with stars.
  if (count % 2 == 1)
    for (const char* name : {"WELKIN_MIE", "WELKIN_HALOS", "WELKIN_RAIN", "WELKIN_BEYOND"})
      defines.push_back({name, "1"});
  // Few and many cells of the fluence.
  defines.push_back({"WELKIN_CELLS", std::to_string(std::clamp(count * 5, 1, 16))});
  return defines;
}

// Every entry point compiles for the desktop, and all but compute for the web as well, where drivers of
// desktops are laxer; with no layer of cloud, with one and with the most there are.
TEST(ShaderLibrary, EveryEntryPointCompilesInEveryDialect) {
  for (const bool es : {false, true}) {
    gpu::Context context({.api = es ? gpu::Api::kGles : gpu::Api::kGl, .debug = true});
    const ShaderDialect dialect = es ? ShaderDialect::kEs300 : ShaderDialect::kGl330;
    const ShaderSource triangle = assembleShader("pass/fullscreen.vert", dialect);
    const ShaderSource nothing{
        std::string(es ? "#version 300 es" : "#version 330 core") + "\nvoid main() {}\n", {"-"}};
    const std::vector<std::string> names = shaderNames();
    for (const std::string& name : names)
      for (const int layers : {0, 1, 2, field::kMaxLayers}) {
        SCOPED_TRACE(name + " with " + std::to_string(layers) + " layers" +
                     (es ? " as GLSL ES 3.00" : " as GLSL 3.30"));
        const ShaderDefines defines = definesOfLayers(layers);
        const UniformReads reads = layers % 2 ? UniformReads::kOnce : UniformReads::kWhereUsed;
        if (name.ends_with(".frag")) {
          // Its own vertices, where it has some.
          const std::string vertices = name.substr(0, name.size() - 4) + "vert";
          const bool own = std::ranges::find(names, vertices) != names.end();
          EXPECT_NO_THROW(gpu::Program::graphics(own ? assembleShader(vertices, dialect, defines) : triangle,
                                                 assembleShader(name, dialect, defines, reads)));
        } else if (name.ends_with(".vert")) {
          EXPECT_NO_THROW(gpu::Program::graphics(assembleShader(name, dialect, defines), nothing));
        } else if (name.ends_with(".comp") && !es && context.hasCompute()) {
          for (const UniformReads either : {UniformReads::kWhereUsed, UniformReads::kOnce})
            EXPECT_NO_THROW(
                gpu::Program::compute(assembleShader(name, ShaderDialect::kGl430Compute, defines, either)));
        }
      }
    EXPECT_TRUE(context.takeErrors().empty());
  }
}

// A march with all kinds of sheets in all tiers among two bands, from within, as a picture and as what
// arrives.
TEST(ShaderLibrary, MarchesWithSheetsCompileInEveryDialect) {
  LightVolumeLayout layout;
  layout.bands = {{1000.0f, 2000.0f, 0, 4, {0}}, {6000.0f, 7000.0f, 5, 9, {1}}};
  std::vector<SheetOnRay> sheets;
  for (const auto surface : {scene::SheetSurface::kPlane, scene::SheetSurface::kSkyPlane,
                             scene::SheetSurface::kDome, scene::SheetSurface::kHemisphere})
    for (const auto tier : {scene::SheetTier::kFlat, scene::SheetTier::kEmbossed, scene::SheetTier::kLit}) {
      sheets.push_back({.surface = surface, .tier = tier});
      sheets.back().look.heightM = 900.0f * static_cast<float>(sheets.size());
    }
  for (const bool es : {false, true}) {
    gpu::Context context({.api = es ? gpu::Api::kGles : gpu::Api::kGl, .debug = true});
    const ShaderDialect dialect = es ? ShaderDialect::kEs300 : ShaderDialect::kGl330;
    ShaderDefines defines = sheetDefines(layout, std::span(sheets).first(6), 3000.0);
    for (int i = 0; i < 2; ++i) {
      EXPECT_NO_THROW(gpu::Program::graphics(assembleShader("pass/fullscreen.vert", dialect),
                                             assembleShader("pass/sky.frag", dialect, defines)));
      defines = sheetDefines({}, std::span(sheets).last(4), 3000.0);  // without volumes
      defines.emplace_back("WELKIN_TRANSMITTANCE", "1");
    }
    EXPECT_TRUE(context.takeErrors().empty());
  }
}

}  // namespace
}  // namespace welkin::shading
