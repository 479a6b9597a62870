// Files of OpenVDB made here: read back by our own reader and by OpenVDB.

#include "core/media/write_vdb.h"

#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <sstream>

#include "core/media/read_vdb.h"

namespace hyades::core {
namespace {

VdbBox box_of_numbers() {
  VdbBox box;
  box.name = "density";
  box.lower = {-3, 130, 5};
  box.size = {20, 9, 33};
  box.voxel = {0.5, 1.0, 2.0};
  box.origin = {10.0, 20.0, 30.0};
  for (int i = 0; i < 20 * 9 * 33; ++i) {
    box.values.push_back(i % 7 == 0 ? 0.0F : static_cast<float>(i));
  }
  return box;
}

float value_at(const VdbBox& box, const Vec3i& p) {
  return box.values[static_cast<size_t>((p.z * box.size.y + p.y) * box.size.x + p.x)];
}

TEST(WriteVdb, OurReaderReadsIt) {
  const VdbBox box = box_of_numbers();
  const auto bytes = write_vdb({box});
  ASSERT_TRUE(bytes.ok()) << bytes.error().message;
  const auto grid = read_vdb_numbers(*bytes, "density");
  ASSERT_TRUE(grid.ok()) << grid.error().message;
  for (const Vec3i p : {Vec3i(0, 0, 0), Vec3i(1, 0, 0), Vec3i(19, 8, 32), Vec3i(7, 3, 11)}) {
    EXPECT_EQ((*grid)->voxels.at(Vec3(p + box.lower)), value_at(box, p));
  }
  const Vec3 place = transform_point((*grid)->to_file, Vec3(2.0F, 3.0F, 4.0F));
  EXPECT_EQ(place, Vec3(11.0F, 23.0F, 38.0F));
}

TEST(WriteVdb, OpenVdbReadsIt) {
  const VdbBox box = box_of_numbers();
  VdbBox colors;
  colors.name = "tint";
  colors.size = {2, 1, 1};
  colors.values = {0.1F, 0.2F, 0.3F, 0.4F, 0.5F, 0.6F};
  colors.colors = true;
  const auto bytes = write_vdb({box, colors});
  ASSERT_TRUE(bytes.ok()) << bytes.error().message;
  openvdb::initialize();
  std::istringstream stream(std::string(bytes->chars(), bytes->size()));
  const auto grids = openvdb::io::Stream(stream).getGrids();
  ASSERT_EQ(grids->size(), 2U);
  const auto numbers = openvdb::gridPtrCast<openvdb::FloatGrid>((*grids)[0]);
  ASSERT_NE(numbers, nullptr);
  EXPECT_EQ(numbers->getName(), "density");
  EXPECT_EQ(numbers->getGridClass(), openvdb::GRID_FOG_VOLUME);
  EXPECT_EQ(numbers->transform().indexToWorld(openvdb::Vec3d(2, 3, 4)), openvdb::Vec3d(11, 23, 38));
  const auto accessor = numbers->getConstAccessor();
  for (const Vec3i p : {Vec3i(0, 0, 0), Vec3i(1, 0, 0), Vec3i(19, 8, 32), Vec3i(7, 3, 11)}) {
    const Vec3i at = p + box.lower;
    EXPECT_EQ(accessor.getValue({at.x, at.y, at.z}), value_at(box, p));
  }
  EXPECT_EQ(accessor.getValue({17, 135, 9}), 0.0F);
  const auto vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>((*grids)[1]);
  ASSERT_NE(vectors, nullptr);
  EXPECT_EQ(vectors->getConstAccessor().getValue({1, 0, 0}), openvdb::Vec3s(0.4F, 0.5F, 0.6F));
}

TEST(WriteVdb, RefusesWhatIsNoBox) {
  VdbBox box = box_of_numbers();
  box.values.pop_back();
  EXPECT_FALSE(write_vdb({box}).ok());
  box = box_of_numbers();
  box.size = {0, 1, 1};
  EXPECT_FALSE(write_vdb({box}).ok());
  box = box_of_numbers();
  box.voxel.x = 0.0;
  EXPECT_FALSE(write_vdb({box}).ok());
}

}  // namespace
}  // namespace hyades::core
