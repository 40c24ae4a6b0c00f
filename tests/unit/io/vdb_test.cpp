// SPDX-License-Identifier: Apache-2.0
// OpenVDB files against OpenVDB's own reader and writer.
#include "welkin/io/vdb.h"

#include <openvdb/io/File.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>

#include "scratch.h"
#include "some_texels.h"
#include "welkin/io/convert_texels.h"
#include "welkin/io/vdb_file.h"

namespace welkin::io {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;

class Vdb : public Scratch {
 protected:
  Vdb() { openvdb::initialize(); }
  std::filesystem::path path() const { return folder / "x.vdb"; }

  FloatGrid::Ptr readByOpenVdb() const {
    openvdb::io::File file(path().string());
    file.open();
    return openvdb::gridPtrCast<FloatGrid>(file.readGrid(file.beginName().gridName()));
  }
  void writeByOpenVdb(const openvdb::GridPtrVec& grids, std::uint32_t compression) const {
    openvdb::io::File file(path().string());
    file.setCompression(compression);
    file.write(grids);
  }
};

Texels someVolume(const char* format, int nx, int ny, int nz) {
  Texels texels = randomTexels(volumeOf(format, nx, ny, nz));
  // Empty margins and holes.
  const std::size_t bytes = bytesOf(texels.shape.format.type);
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x)
        if (x < 3 || z > nz - 3 || (y / 8) % 2 == 1)
          std::memset(&texels.bytes[static_cast<std::size_t>((z * ny + y) * nx + x) * bytes], 0, bytes);
  texels.notes.voxelSizeM = {25.0, 25.0, 12.5};
  texels.notes.firstVoxelM = {100.0, -50.0, 800.0};
  texels.notes.name = "extinction";
  return texels;
}

TEST_F(Vdb, OpenVdbReadsTheSameVoxels) {
  for (const char* format : {"r32f", "r16f", "l8", "l16"}) {
    const Texels texels = someVolume(format, 21, 37, 11);
    writeVdb(path(), texels);
    const FloatGrid::Ptr grid = readByOpenVdb();
    EXPECT_EQ(grid->getName(), "extinction");
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_FOG_VOLUME);
    EXPECT_EQ(grid->background(), 0.0f);
    EXPECT_EQ(grid->saveFloatAsHalf(), format == std::string("r16f") || format == std::string("l8"));
    EXPECT_EQ(grid->indexToWorld(Coord(2, 4, 8)), openvdb::Vec3d(150.0, 50.0, 900.0));
    std::size_t active = 0;
    const float tolerance = format == std::string("l8") ? 0x1p-12f : 0.0f;
    for (int z = 0; z < 11; ++z)
      for (int y = 0; y < 37; ++y)
        for (int x = 0; x < 21; ++x) {
          EXPECT_NEAR(grid->tree().getValue({x, y, z}), texels.value(x, y, z), tolerance);
          active += texels.value(x, y, z) != 0.0f;
        }
    EXPECT_EQ(grid->activeVoxelCount(), active);  // zeros are not stored
    const Texels back = readVdb(path());
    EXPECT_EQ(back.shape.nx, 21);
    EXPECT_EQ(back.shape.nz, 11);
    EXPECT_EQ(convertTexels(back, texels.shape.format).bytes, texels.bytes);
  }
}

TEST_F(Vdb, EmptyAndSingleVoxels) {
  Texels texels(volumeOf("r32f", 3, 4, 5));
  writeVdb(path(), texels);
  EXPECT_EQ(readVdb(path()).bytes, texels.bytes);
  EXPECT_EQ(readVdb(path()).shape, texels.shape);
  EXPECT_EQ(readByOpenVdb()->activeVoxelCount(), 0u);
  texels.as<float>()[59] = -2.5f;
  writeVdb(path(), texels);
  EXPECT_EQ(readVdb(path()).bytes, texels.bytes);
}

// Tiles, a background that is not zero, negative places, every compression, with and without a table of
// offsets.
TEST_F(Vdb, FilesOfOpenVdb) {
  for (const bool half : {false, true})
    for (const std::uint32_t compression : {0u, 1u, 2u, 3u, 4u, 6u})
      for (const bool offsets : {true, false}) {
        const FloatGrid::Ptr grid = FloatGrid::create(0.25f);
        grid->setName("smoke");
        grid->setSaveFloatAsHalf(half);
        grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
        grid->fill(openvdb::CoordBBox(-20, -9, 3, 27, 40, 50), 1.0f);
        grid->fill(openvdb::CoordBBox(0, 0, 8, 9, 9, 13), 0.25f, false);
        auto accessor = grid->getAccessor();
        for (int i = 0; i < 28; ++i) accessor.setValue({i, i - 9, i + 8}, static_cast<float>(i) / 32);
        if (offsets) {
          writeByOpenVdb({FloatGrid::create(), openvdb::Vec3SGrid::create(), grid}, compression);
        } else {
          std::ofstream out(path(), std::ios::binary);
          openvdb::io::Stream stream(out);
          stream.setCompression(compression);
          stream.write({grid});
        }
        const Texels texels = readVdb(path(), {.grid = "smoke"});
        SCOPED_TRACE(compression);
        EXPECT_EQ(texels.shape, volumeOf(half ? "r16f" : "r32f", 48, 50, 48));
        EXPECT_EQ(texels.notes.name, "smoke");
        EXPECT_EQ(texels.notes.voxelSizeM, glm::dvec3(0.5));
        EXPECT_EQ(texels.notes.firstVoxelM, glm::dvec3(-10.0, -4.5, 1.5));
        for (int z = 0; z < 48; ++z)
          for (int y = 0; y < 50; ++y)
            for (int x = 0; x < 48; ++x)
              ASSERT_EQ(texels.value(x, y, z), grid->tree().getValue({x - 20, y - 9, z + 3}));
        const auto grids = readVdbGrids(path());
        ASSERT_EQ(grids.size(), offsets ? 3u : 1u);
        EXPECT_EQ(grids.back().name, "smoke");
        EXPECT_EQ(grids.back().type, "Tree_float_5_4_3");
        EXPECT_EQ(grids.back().half, half);
      }
}

TEST_F(Vdb, TheGridIsChosenByName) {
  const auto named = [](const char* name, float value) {
    const FloatGrid::Ptr grid = FloatGrid::create();
    grid->setName(name);
    grid->fill(openvdb::CoordBBox(0, 0, 0, 7, 7, 7), value);
    return grid;
  };
  const auto colour = openvdb::Vec3SGrid::create();
  colour->setName("colour");
  writeByOpenVdb({colour, named("heat", 1.0f), named("density", 2.0f)}, 6);
  EXPECT_EQ(readVdb(path()).value(0, 0, 0), 2.0f);
  EXPECT_EQ(readVdb(path()).notes.leftOut, (std::vector<std::string>{"grid colour", "grid heat"}));
  EXPECT_EQ(readVdb(path(), {.grid = "heat"}).value(0, 0, 0), 1.0f);
  EXPECT_EQ(messageOf<IoError>([&] { readVdb(path(), {.grid = "colour"}); }),
            "cannot read " + path().string() +
                ": the grid \"colour\" is of type Tree_vec3s_5_4_3; expected floats");
  EXPECT_EQ(messageOf<IoError>([&] { readVdb(path(), {.grid = "cold"}); }),
            "cannot read " + path().string() + ": there is no grid \"cold\"");
  writeByOpenVdb({named("heat", 1.0f), named("density", 2.0f), named("density", 3.0f)}, 6);
  EXPECT_EQ(readVdb(path()).value(0, 0, 0), 2.0f);
  EXPECT_EQ(readVdb(path()).notes.leftOut, (std::vector<std::string>{"grid heat", "grid density[1]"}));
  EXPECT_EQ(readVdb(path(), {.grid = "density[0]"}).value(0, 0, 0), 2.0f);
  const Texels second = readVdb(path(), {.grid = "density[1]"});
  EXPECT_EQ(second.value(0, 0, 0), 3.0f);
  EXPECT_EQ(second.notes.name, "density");
  EXPECT_EQ(readVdbGrids(path()).back().name, "density[1]");
  writeByOpenVdb({colour}, 6);
  EXPECT_EQ(messageOf<IoError>([&] { readVdb(path()); }),
            "cannot read " + path().string() + ": there is no grid of floats");
}

TEST_F(Vdb, NumbersAndTheClassAreKept) {
  const FloatGrid::Ptr grid = FloatGrid::create();
  grid->setName("density");
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->fill(openvdb::CoordBBox(0, 0, 0, 7, 7, 7), 1.0f);
  grid->insertMeta("frame", openvdb::Int32Metadata(-24));
  grid->insertMeta("bytes", openvdb::Int64Metadata(1LL << 40));
  grid->insertMeta("fps", openvdb::FloatMetadata(23.976f));
  grid->insertMeta("time", openvdb::DoubleMetadata(0.1));
  grid->insertMeta("looped", openvdb::BoolMetadata(true));
  grid->insertMeta("wind", openvdb::Vec3SMetadata({1.5f, -2.0f, 0.0f}));
  grid->insertMeta("author", openvdb::StringMetadata("me"));
  writeByOpenVdb({grid}, 6);
  const Texels texels = readVdb(path());
  const std::map<std::string, std::string> wanted = {{"author", "me"},       {"bytes", "1099511627776"},
                                                     {"class", "level set"}, {"fps", "23.976"},
                                                     {"frame", "-24"},       {"looped", "1"},
                                                     {"time", "0.1"},        {"wind", "1.5 -2 0"}};
  EXPECT_EQ((std::map<std::string, std::string>(texels.notes.metadata.begin(), texels.notes.metadata.end())),
            wanted);
  writeVdb(path(), texels);
  EXPECT_EQ(readByOpenVdb()->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_EQ(readVdb(path()).notes.metadata, texels.notes.metadata);
}

TEST_F(Vdb, WhatIsNotADenseBoxIsRefused) {
  const auto refusal = [&](const FloatGrid::Ptr& grid) {
    writeByOpenVdb({grid}, 6);
    const std::string message = messageOf<IoError>([&] { readVdb(path()); });
    return message.substr(message.find(": ") + 2);
  };
  const FloatGrid::Ptr far = FloatGrid::create();
  far->tree().setValue({0, 0, 0}, 1.0f);
  far->tree().setValue({100000, 100000, 100000}, 1.0f);
  EXPECT_NE(refusal(far).find("100001x100001x100001 voxels, which is too many"), std::string::npos);
  const FloatGrid::Ptr hugeTile = FloatGrid::create();
  hugeTile->tree().fill(openvdb::CoordBBox(0, 0, 0, 4095, 4095, 4095), 1.0f);
  EXPECT_NE(refusal(hugeTile).find("4096x4096x4096 voxels, which is too many"), std::string::npos);
  EXPECT_EQ(refusal(FloatGrid::create()), "the grid is empty");
  const FloatGrid::Ptr turned = FloatGrid::create();
  turned->tree().setValue({0, 0, 0}, 1.0f);
  const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
  transform->preRotate(0.3, openvdb::math::Z_AXIS);
  turned->setTransform(transform);
  EXPECT_NE(refusal(turned).find("the grid's transform is not along the axes"), std::string::npos);
  const FloatGrid::Ptr broken = FloatGrid::create();
  broken->tree().setValue({0, 0, 0}, 1.0f);
  broken->tree().setValue({2, 1, 0}, std::nanf(""));
  EXPECT_EQ(refusal(broken), "no finite number at texel (2, 1, 0)");
}

// Dense or far too sparse to be dense.
TEST_F(Vdb, SummariesAreThoseOfTheBox) {
  const Texels texels = someVolume("r16f", 21, 37, 11);
  writeVdb(path(), texels);
  VdbSummary summary = readVdbSummary(path());
  EXPECT_EQ(summary.shape, texels.shape);
  EXPECT_EQ(summary.notes.firstVoxelM, texels.notes.firstVoxelM);
  EXPECT_EQ(summary.activeVoxels, readByOpenVdb()->activeVoxelCount());
  float least = 1e9f, most = -1e9f;
  double sum = 0.0;
  for (int z = 0; z < 11; ++z)
    for (int y = 0; y < 37; ++y)
      for (int x = 0; x < 21; ++x) {
        const float value = texels.value(x, y, z);
        least = std::min(least, value), most = std::max(most, value);
        sum += static_cast<double>(value);
      }
  EXPECT_EQ(summary.min, least);
  EXPECT_EQ(summary.max, most);
  EXPECT_NEAR(summary.mean, sum / (21 * 37 * 11), 1e-12);

  const FloatGrid::Ptr grid = FloatGrid::create(0.5f);
  grid->tree().fill(openvdb::CoordBBox(0, 0, 0, 4095, 4095, 4095), 2.0f);
  grid->tree().setValue({99999, -1, 0}, -1.0f);
  writeByOpenVdb({grid}, 6);
  summary = readVdbSummary(path());
  EXPECT_EQ(summary.shape.nx, 100000);
  EXPECT_EQ(summary.shape.ny, 4097);
  EXPECT_EQ(summary.shape.nz, 4096);
  EXPECT_EQ(summary.activeVoxels, (std::uint64_t{1} << 36) + 1);
  EXPECT_EQ(summary.min, -1.0f);
  EXPECT_EQ(summary.max, 2.0f);
  const double all = 100000.0 * 4097.0 * 4096.0, tile = 0x1p36;
  EXPECT_NEAR(summary.mean, (2.0 * tile - 1.0 + 0.5 * (all - tile - 1.0)) / all, 1e-12);

  grid->tree().setValue({5, 6, 7}, std::nanf(""));
  writeByOpenVdb({grid}, 6);
  EXPECT_NE(messageOf<IoError>([&] { readVdbSummary(path()); }).find("no finite number at texel (5, 7, 7)"),
            std::string::npos);
}

TEST_F(Vdb, WhatIsNotWritten) {
  const Texels good = randomTexels(volumeOf("r32f", 4, 4, 4));
  EXPECT_THROW(writeVdb(path(), randomTexels(pictureOf("r32f", 4, 4))), ParameterError);
  EXPECT_THROW(writeVdb(path(), randomTexels(volumeOf("rgb32f", 4, 4, 4))), ParameterError);
  EXPECT_THROW(VdbWriter(path(), volumeOf("r32f", 2048, 2048, 1024)), ParameterError);
  Texels bad = good;
  bad.notes.voxelSizeM.y = 0.0;
  EXPECT_THROW(writeVdb(path(), bad), ParameterError);
  bad.notes.voxelSizeM = glm::dvec3(1e-30);
  EXPECT_EQ(messageOf<ParameterError>([&] { writeVdb(path(), bad); }),
            "cannot write " + path().string() + ": OpenVDB takes no voxels as small or as far away as that");
  bad = good;
  bad.notes.metadata["file_bbox_min"] = "mine";
  EXPECT_THROW(writeVdb(path(), bad), ParameterError);
  bad = good;
  bad.as<float>()[(2 * 4 + 1) * 4 + 3] = std::nanf("");
  EXPECT_EQ(messageOf<ParameterError>([&] { writeVdb(path(), bad); }),
            "cannot write " + path().string() + ": no finite number at texel (3, 1, 2)");
  EXPECT_EQ(messageOf<IoError>([&] { writeVdb("/dev/full", good); }),
            "cannot write /dev/full: No space left on device");
  EXPECT_EQ(fileCount(), 0);
}

// Chunks whose length or header is wrong, on which OpenVDB's own reader would run over the end of its
// buffers.
TEST_F(Vdb, ChunksAreCheckedBeforeOpenVdbSeesThem) {
  writeVdb(path(), randomTexels(volumeOf("r32f", 8, 8, 8)));
  const std::string good = contents(path());
  std::size_t at =
      good.size();  // of the one leaf's values: 512 random floats, kept as they are or packed by Blosc
  InputFile file(path());
  const vdb::Contents table = vdb::readContents(file);
  at = table.grids[0].bufferByte + 64 + 1;
  const auto refusal = [&](std::int64_t length) {
    std::string bad = good;
    std::memcpy(bad.data() + at, &length, sizeof length);
    std::ofstream(path(), std::ios::binary) << bad;
    const std::string message = messageOf<IoError>([&] { readVdb(path()); });
    return message.substr(message.find(": ") + 2);
  };
  for (const std::int64_t length : {std::int64_t{-4096}, std::int64_t{-1}, std::int64_t{1} << 40, INT64_MIN,
                                    INT64_MAX, std::int64_t{3000}, std::int64_t{8}})
    EXPECT_EQ(refusal(length).substr(0, 9), "damaged: ") << length;
}

}  // namespace
}  // namespace welkin::io
