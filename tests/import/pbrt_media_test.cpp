// Media of pbrt's scenes that vary from place to place.

#include "core/media/read_vdb.h"
#include "tests/import/pbrt_files.h"

namespace hyades::test {
namespace {

using ::testing::HasSubstr;

core::Result<std::shared_ptr<const core::VdbGrid<float>>> grid_of(const PbrtJob& job,
                                                                  const std::string& name) {
  auto bytes = job.source->made_file("media/0.vdb");
  if (!bytes) return bytes.error();
  return core::read_vdb_numbers(*bytes, name);
}

std::string body(const std::string& medium) {
  return pbrt_world("MakeNamedMedium \"m\" " + medium +
                    "\nMaterial \"interface\" MediumInterface \"m\" \"\" Shape \"sphere\"");
}

TEST(PbrtMedia, AUniformGridIsAVdb) {
  const PbrtJob job =
      pbrt_job(body("\"string type\" \"uniformgrid\" \"integer nx\" 2 \"integer ny\" 3 "
                    "\"float density\" [1 2 3 4 5 6] \"point3 p0\" [0 0 0] \"point3 p1\" [4 3 2] "
                    "\"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [4 5 6] \"float scale\" 2"));
  ASSERT_EQ(job.error, "");
  EXPECT_THAT(job.text, HasSubstr("absorption: [1, 2, 3]"));
  EXPECT_THAT(job.text, HasSubstr("scale: 2"));
  EXPECT_THAT(job.text, HasSubstr("vdb: media/0.vdb"));
  // Spheres of jobs stand around y: the grid is turned back.
  EXPECT_THAT(job.text, HasSubstr("{matrix: [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1]}"));
  const auto grid = grid_of(job, "density");
  ASSERT_TRUE(grid.ok()) << grid.error().message;
  EXPECT_EQ((*grid)->voxels.at({0, 0, 0}), 1.0F);
  EXPECT_EQ((*grid)->voxels.at({1, 0, 0}), 2.0F);
  EXPECT_EQ((*grid)->voxels.at({1, 2, 0}), 6.0F);
  // Values are those of the middles of cells.
  EXPECT_EQ(core::transform_point((*grid)->to_file, {0, 0, 0}), core::Vec3(1.0F, 0.5F, 1.0F));
  EXPECT_EQ(core::transform_point((*grid)->to_file, {1, 2, 0}), core::Vec3(3.0F, 2.5F, 1.0F));
}

TEST(PbrtMedia, AnRgbGridHasATint) {
  const PbrtJob job =
      pbrt_job(body("\"string type\" \"rgbgrid\" \"rgb sigma_a\" [.5 1 1.5] "
                    "\"rgb sigma_s\" [1.5 1 .5]"));
  ASSERT_EQ(job.error, "");
  EXPECT_THAT(job.text, HasSubstr("tint: tint"));
  const auto bytes = job.source->made_file("media/0.vdb");
  ASSERT_TRUE(bytes.ok());
  const auto tint = core::read_vdb_colors(*bytes, "tint");
  ASSERT_TRUE(tint.ok()) << tint.error().message;
  EXPECT_EQ((*tint)->voxels.at({0, 0, 0}), core::Rgb(0.75F, 0.5F, 0.25F));
  EXPECT_EQ((*grid_of(job, "density"))->voxels.at({0, 0, 0}), 2.0F);
}

TEST(PbrtMedia, FireOfTemperatures) {
  const PbrtJob job =
      pbrt_job(body("\"string type\" \"uniformgrid\" \"float density\" 2 "
                    "\"float temperature\" 3000 \"rgb sigma_a\" [3 3 3]"));
  ASSERT_EQ(job.error, "");
  EXPECT_THAT(job.text, HasSubstr("emission: {temperature: temperature, color: 3, grid: glow}"));
  EXPECT_EQ((*grid_of(job, "temperature"))->voxels.at({0, 0, 0}), 3000.0F);
  // A spectrum with a peak of 1 at 966 nm has a luminance of 44.5 nm (times the density and over
  // (3000 / 1500)^4).
  EXPECT_NEAR((*grid_of(job, "glow"))->voxels.at({0, 0, 0}), 44.5F * 2.0F / 16.0F, 0.05F);
}

TEST(PbrtMedia, CloudsAreDenseBelowAndThinAbove) {
  const PbrtJob job =
      pbrt_job(body("\"string type\" \"cloud\" \"point3 p0\" [0 0 .5] \"point3 p1\" [1 1 .51]"));
  ASSERT_EQ(job.error, "");
  const auto grid = grid_of(job, "density");
  ASSERT_TRUE(grid.ok()) << grid.error().message;
  EXPECT_EQ((*grid)->voxels.at({64, 0, 0}), 1.0F);
  double above = 0.0;
  for (int x = 0; x < 128; ++x) above += static_cast<double>((*grid)->voxels.at({x, 120, 0}));
  EXPECT_LT(above / 128.0, 0.2);
}

TEST(PbrtMedia, GridsThatAreWrong) {
  const auto error = [](const std::string& more) { return pbrt_job(body(more)).error; };
  EXPECT_THAT(error("\"string type\" \"uniformgrid\""), HasSubstr("has no values"));
  EXPECT_THAT(error("\"string type\" \"uniformgrid\" \"float density\" [1 2]"),
              HasSubstr("not nx * ny * nz"));
  EXPECT_THAT(error("\"string type\" \"uniformgrid\" \"integer nx\" 2000000000 \"integer ny\" "
                    "2000000000 \"float density\" [1 2]"),
              HasSubstr("not nx * ny * nz"));
  EXPECT_THAT(error("\"string type\" \"uniformgrid\" \"integer nx\" -1 \"float density\" 1"),
              HasSubstr("not nx * ny * nz"));
  EXPECT_THAT(error("\"string type\" \"rgbgrid\" \"rgb sigma_a\" [1 1 1 2 2 2] \"rgb sigma_s\" "
                    "[1 1 1]"),
              HasSubstr("different numbers of values"));
  EXPECT_THAT(error("\"string type\" \"cloud\" \"point3 p1\" [0 1 1]"), HasSubstr("is empty"));
}

TEST(PbrtMedia, AMeasuredMediumIsPerMillimetre) {
  const PbrtJob job =
      pbrt_job(body("\"string type\" \"homogeneous\" \"string preset\" \"Skimmilk\""));
  ASSERT_EQ(job.error, "");
  // Jensen et al. 2001: 0.70 1.22 1.90 and 0.0014 0.0025 0.0142 per millimetre.
  EXPECT_THAT(job.text, HasSubstr("scattering: [0.7, 1.22, 1.9"));
  EXPECT_THAT(pbrt_job(body("\"string type\" \"homogeneous\" \"string preset\" \"Skimilk\"")).error,
              HasSubstr("did you mean"));
}

}  // namespace
}  // namespace hyades::test
