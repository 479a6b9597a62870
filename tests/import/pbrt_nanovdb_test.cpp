// Media of pbrt's scenes that are files of NanoVDB.

#include "core/media/read_vdb.h"
#include "tests/import/pbrt_files.h"
#include "tests/support/nanovdb_writer.h"
#include "tests/support/vdb_writer.h"

namespace hyades::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

openvdb::FloatGrid::Ptr box(const std::string& name, int n, double voxel, float step) {
  return vdb_box<openvdb::FloatGrid>(name, n, voxel, {1.0, 2.0, 3.0}, [&](int i, int, int) {
    return 1.0F + step * static_cast<float>(i);
  });
}

PbrtJob job_of(const std::string& medium, const std::vector<openvdb::FloatGrid::Ptr>& grids) {
  PbrtFiles files(
      pbrt_world("MakeNamedMedium \"m\" \"string type\" \"nanovdb\" " + medium +
                 "\nMaterial \"interface\" MediumInterface \"m\" \"\" Shape \"sphere\""));
  files.add("clouds/a.nvdb", nanovdb_file(grids, nanovdb::io::Codec::ZIP));
  files.add("text.nvdb", "not a grid");
  return read_pbrt_job(files);
}

constexpr const char* kFile = "\"string filename\" \"clouds/a.nvdb\" ";

TEST(PbrtNanoVdb, IsTheScenesOwnFile) {
  const PbrtJob job = job_of(std::string(kFile) +
                                 "\"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [4 5 6] "
                                 "\"float scale\" 2 \"float g\" .5",
                             {box("density", 4, 0.5, 0.1F)});
  ASSERT_EQ(job.error, "");
  EXPECT_THAT(job.notes, ::testing::IsEmpty());
  EXPECT_THAT(job.text, HasSubstr("absorption: [1, 2, 3]"));
  EXPECT_THAT(job.text, HasSubstr("scattering: [4, 5, 6]"));
  EXPECT_THAT(job.text, HasSubstr("scale: 2"));
  EXPECT_THAT(job.text, HasSubstr("g: 0.5"));
  EXPECT_THAT(job.text, HasSubstr("vdb: clouds/a.nvdb\n      place: native"));
  EXPECT_THAT(job.text, Not(HasSubstr("grid:")));
  EXPECT_THAT(job.text, Not(HasSubstr("emission")));
}

TEST(PbrtNanoVdb, MayHaveAGridOfAnotherName) {
  const PbrtJob job = job_of(std::string(kFile) + "\"string gridname\" \"smoke\"",
                             {box("density", 4, 0.5, 0.1F), box("smoke", 4, 0.5, 0.2F)});
  ASSERT_EQ(job.error, "");
  EXPECT_THAT(job.text, HasSubstr("grid: smoke"));
}

// Temperatures lie on a grid of their own, whose points are elsewhere.
TEST(PbrtNanoVdb, GlowsByItsTemperatures) {
  const std::vector<openvdb::FloatGrid::Ptr> grids = {box("density", 4, 0.5, 1.0F),
                                                      box("temperature", 40, 0.05, 0.1F)};
  const PbrtJob job = job_of(std::string(kFile) +
                                 "\"rgb sigma_a\" [3 3 3] \"float Lescale\" 2 "
                                 "\"float temperatureoffset\" .5 "
                                 "\"float temperaturescale\" 2000",
                             grids);
  ASSERT_EQ(job.error, "");
  EXPECT_THAT(job.text, HasSubstr("vdb: media/0.vdb"));
  EXPECT_THAT(job.text, HasSubstr("emission: {temperature: temperature, color: 6, grid: glow}"));
  const auto bytes = job.source->made_file("media/0.vdb");
  ASSERT_TRUE(bytes) << bytes.error().message;
  const auto at = [&](const char* name) {
    const auto grid = core::read_vdb_numbers(*bytes, name);
    EXPECT_TRUE(grid) << grid.error().message;
    EXPECT_EQ(core::transform_point((*grid)->to_file, {1, 2, 3}), core::Vec3(1.5F, 3.0F, 4.5F));
    return (*grid)->voxels.at({1, 2, 3});
  };
  EXPECT_EQ(at("density"), 2.0F);
  // Half a unit from its first point: 2, of which 1.5 count.
  EXPECT_NEAR(at("temperature"), 3000.0F, 0.5F);
  // As of uniform grids: a peak of 1 has a luminance of 44.5 nm at 3000 K.
  EXPECT_NEAR(at("glow"), 44.5F * 2.0F / 16.0F, 0.05F);
  const PbrtJob dark = job_of(std::string(kFile) + "\"float Lescale\" 0", grids);
  EXPECT_THAT(dark.text, HasSubstr("vdb: clouds/a.nvdb"));
}

TEST(PbrtNanoVdb, WhatIsWrongIsToldWithItsPlace) {
  const auto error = [](const std::string& medium) {
    return job_of(medium, {box("smoke", 4, 0.5, 0.1F)}).error;
  };
  EXPECT_EQ(error(""), "scene.pbrt:5:1: the medium names no file: \"string filename\"");
  EXPECT_EQ(error(kFile), "scene.pbrt:5:1: clouds/a.nvdb: has no grid 'density', expected smoke");
  EXPECT_THAT(error("\"string filename\" \"none.nvdb\""), HasSubstr("scene.pbrt:5:1: cannot open"));
  EXPECT_EQ(error("\"string filename\" \"text.nvdb\""),
            "scene.pbrt:5:1: text.nvdb: is no file of NanoVDB");
  EXPECT_THAT(error("\"string filename\" \"../a.nvdb\""), HasSubstr("scene.pbrt:5:1: "));
}

}  // namespace
}  // namespace hyades::test
