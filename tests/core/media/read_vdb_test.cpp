#include "core/media/read_vdb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

#include "tests/support/random.h"
#include "tests/support/vdb_writer.h"

namespace hyades::core {
namespace {

using testing::HasSubstr;

Bytes bytes_of_vdb(const std::string& text) {
  const auto owner = std::make_shared<std::string>(text);
  return {owner, std::as_bytes(std::span(owner->data(), owner->size()))};
}

openvdb::FloatGrid::Ptr ramp() {
  return test::vdb_box<openvdb::FloatGrid>(
      "density", 11, 0.5, {1.0, 2.0, 3.0},
      [](int i, int j, int k) { return static_cast<float>(i + 20 * j + 400 * k); });
}

openvdb::Vec3SGrid::Ptr colours() {
  return test::vdb_box<openvdb::Vec3SGrid>("Cd", 4, 1.0, {0.0, 0.0, 0.0}, [](int i, int j, int k) {
    return openvdb::Vec3s(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k));
  });
}

TEST(ReadVdb, FindsValuesWhereTheFileSaysTheyAre) {
  const Bytes file = bytes_of_vdb(test::vdb_file({colours(), ramp()}));
  const auto read = read_vdb_numbers(file, "density");
  ASSERT_TRUE(read) << read.error().message;
  const VdbGrid<float>& grid = **read;
  EXPECT_EQ(grid.voxels.at(Vec3(3.0F, 4.0F, 5.0F)), 2083.0F);
  EXPECT_FLOAT_EQ(grid.voxels.at(Vec3(3.5F, 4.0F, 5.0F)), 2083.5F);
  EXPECT_EQ(transform_point(grid.to_file, Vec3(3.0F, 4.0F, 5.0F)), Vec3(2.5F, 4.0F, 5.5F));
  EXPECT_EQ(grid.voxels.bounds().lower, Vec3(-1.0F));
  EXPECT_EQ(grid.voxels.bounds().upper, Vec3(11.0F));
  const auto tint = read_vdb_colors(file, "Cd");
  ASSERT_TRUE(tint) << tint.error().message;
  EXPECT_EQ((*tint)->voxels.at(Vec3(3.0F, 2.0F, 1.0F)), Rgb(3.0F, 2.0F, 1.0F));
}

// Regions that a file stores as one value.
TEST(ReadVdb, ReadsActiveTilesAndLeavesOutWhatIsNotActive) {
  auto grid = openvdb::FloatGrid::create();
  grid->setName("density");
  grid->fill(openvdb::CoordBBox({-16, -16, -16}, {31, 15, 15}), 2.0F);
  grid->tree().setValueOff({5, 5, 5}, 7.0F);
  const auto read = read_vdb_numbers(bytes_of_vdb(test::vdb_file({grid})), "density");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ((*read)->voxels.at(Vec3(-15.5F, 0.0F, 14.25F)), 2.0F);
  EXPECT_EQ((*read)->voxels.at(Vec3(5.0F)), 0.0F);
  EXPECT_EQ((*read)->voxels.at(Vec3(40.0F, 0.0F, 0.0F)), 0.0F);
}

// Values as OpenVDB itself reads them, whatever way they are stored in.
TEST(ReadVdb, AgreesWithOpenVdbInEveryEncoding) {
  openvdb::initialize();
  test::Random random(4);
  auto grid = openvdb::FloatGrid::create();
  grid->setName("density");
  auto accessor = grid->getAccessor();
  for (int n = 0; n < 20'000; ++n) {
    const auto coordinate = [&] { return static_cast<int>(random.bits() % 60) - 25; };
    accessor.setValue({coordinate(), coordinate(), coordinate()}, random.uniform());
  }
  for (int n = 0; n < 500; ++n) {  // inactive ones of several values
    const auto coordinate = [&] { return static_cast<int>(random.bits() % 60) - 25; };
    accessor.setValueOff({coordinate(), coordinate(), coordinate()}, n % 2 == 0 ? 1.0F : -2.0F);
  }
  const std::array<uint32_t, 6> compressions = {
      openvdb::io::COMPRESS_NONE,
      openvdb::io::COMPRESS_ZIP,
      openvdb::io::COMPRESS_BLOSC,
      openvdb::io::COMPRESS_ACTIVE_MASK,
      openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK,
      openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK};
  for (const bool half : {false, true}) {
    grid->setSaveFloatAsHalf(half);
    for (const uint32_t compression : compressions) {
      std::ostringstream stream;
      openvdb::io::Stream writer(stream);
      writer.setCompression(compression);
      writer.write(openvdb::GridCPtrVec{colours(), grid});
      const auto found = read_vdb_numbers(bytes_of_vdb(stream.str()), "density");
      ASSERT_TRUE(found) << found.error().message;
      for (int n = 0; n < 20'000; ++n) {
        const auto coordinate = [&] { return static_cast<int>(random.bits() % 64) - 27; };
        const openvdb::Coord c(coordinate(), coordinate(), coordinate());
        const float expected = accessor.isValueOn(c) ? accessor.getValue(c) : 0.0F;
        const float value = (*found)->voxels.at(Vec3(c.x(), c.y(), c.z()));
        if (half) {
          ASSERT_NEAR(value, expected, 1e-3F * expected);
        } else {
          ASSERT_EQ(value, expected);
        }
      }
    }
  }
}

TEST(ReadVdb, SaysWhatIsWrong) {
  const std::string good = test::vdb_file({ramp(), colours()});
  const auto complaint = [](const std::string& text, const std::string& name) {
    const auto read = read_vdb_numbers(bytes_of_vdb(text), name);
    return read ? std::string("none") : read.error().message;
  };
  EXPECT_EQ(complaint(good, "smoke"), "has no grid 'smoke', expected density or Cd");
  EXPECT_THAT(complaint(good, "Cd"),
              HasSubstr("grid 'Cd': is of type Tree_vec3s_5_4_3, expected numbers"));
  EXPECT_THAT(complaint("not a vdb", "density"),
              HasSubstr("is neither a file of OpenVDB nor one of NanoVDB"));
  EXPECT_EQ(complaint("", "density"), "ends too early");
  auto level_set = ramp();
  level_set->setGridClass(openvdb::GRID_LEVEL_SET);
  EXPECT_THAT(complaint(test::vdb_file({level_set}), "density"),
              HasSubstr("is a level set, expected a fog volume"));
  auto wild = ramp();
  wild->getAccessor().setValue({1, 1, 1}, std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(complaint(test::vdb_file({wild}), "density"), HasSubstr("not finite"));
  auto empty = openvdb::FloatGrid::create();
  empty->setName("density");
  EXPECT_THAT(complaint(test::vdb_file({empty}), "density"), HasSubstr("no active voxels"));
  auto far = ramp();
  far->getAccessor().setValue({2'000'000, 2'000'000, 2'000'000}, 1.0F);
  EXPECT_THAT(complaint(test::vdb_file({far}), "density"), HasSubstr("more than can be read"));
}

// Whatever bytes come: an error or a grid, never a crash.
TEST(ReadVdb, SurvivesGarbage) {
  const std::string good = test::vdb_file({ramp(), colours()});
  test::Random random(12);
  int refused = 0;
  for (int n = 0; n < 20'000; ++n) {
    std::string text = good;
    if (n % 3 == 0) text.resize(random.bits() % text.size());
    for (uint64_t k = random.bits() % 8; k > 0 && !text.empty(); --k) {
      // Often near the front, where sizes and names are.
      const uint64_t reach = n % 2 == 0 ? text.size() : std::min<uint64_t>(text.size(), 700);
      text[random.bits() % reach] = static_cast<char>(random.bits());
    }
    const auto read = read_vdb_numbers(bytes_of_vdb(text), "density");
    refused += read ? 0 : 1;
  }
  EXPECT_GT(refused, 5000);
}

}  // namespace
}  // namespace hyades::core
