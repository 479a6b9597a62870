// Files that NanoVDB itself writes, read by our reader; damaged ones.

#include "core/media/read_nanovdb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>

#include "tests/support/nanovdb_writer.h"
#include "tests/support/random.h"
#include "tests/support/vdb_writer.h"

namespace hyades::core {
namespace {

using nanovdb::io::Codec;
using testing::ElementsAre;
using testing::HasSubstr;

Bytes bytes_of(const std::string& text) {
  const auto owner = std::make_shared<std::string>(text);
  return {owner, std::as_bytes(std::span(owner->data(), owner->size()))};
}

/// Voxels on both sides of the origin, some not active, with active tiles of two sizes.
openvdb::FloatGrid::Ptr scattered() {
  openvdb::initialize();
  test::Random random(4);
  auto grid = openvdb::FloatGrid::create();
  grid->setName("density");
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->fill(openvdb::CoordBBox({128, 0, 0}, {255, 127, 127}), 0.75F);
  grid->fill(openvdb::CoordBBox({-64, 0, 0}, {-49, 7, 7}), 0.25F);
  auto accessor = grid->getAccessor();
  for (int n = 0; n < 20'000; ++n) {
    const auto coordinate = [&] { return static_cast<int>(random.bits() % 60) - 25; };
    accessor.setValue({coordinate(), coordinate(), coordinate()}, random.uniform());
  }
  for (int n = 0; n < 500; ++n) {
    const auto coordinate = [&] { return static_cast<int>(random.bits() % 60) - 25; };
    accessor.setValueOff({coordinate(), coordinate(), coordinate()}, n % 2 == 0 ? 1.0F : -2.0F);
  }
  return grid;
}

/// The largest difference at 40,000 points.
float difference(const VdbGrid<float>& read, const openvdb::FloatGrid& grid) {
  auto accessor = grid.getConstAccessor();
  test::Random random(9);
  float most = 0.0F;
  for (int n = 0; n < 40'000; ++n) {
    const int reach = n % 2 == 0 ? 64 : 400;
    const auto coordinate = [&] {
      return static_cast<int>(random.bits() % static_cast<uint64_t>(reach)) - reach / 3;
    };
    const openvdb::Coord c(coordinate(), coordinate(), coordinate());
    const float expected = accessor.isValueOn(c) ? accessor.getValue(c) : 0.0F;
    most = std::max(most, std::abs(read.voxels.at(Vec3(c.x(), c.y(), c.z())) - expected));
  }
  return most;
}

TEST(ReadNanoVdb, AgreesWithOpenVdbInEveryCompression) {
  const auto grid = scattered();
  for (const Codec codec : {Codec::NONE, Codec::ZIP, Codec::BLOSC}) {
    const Bytes file = bytes_of(test::nanovdb_file({grid}, codec));
    ASSERT_TRUE(is_nanovdb(file));
    const auto read = read_vdb_numbers(file, "density");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(difference(**read, *grid), 0.0F);
    EXPECT_EQ((*read)->voxels.bounds().lower, Vec3(-65.0F, -26.0F, -26.0F));
    EXPECT_EQ((*read)->voxels.bounds().upper, Vec3(256.0F, 128.0F, 128.0F));
  }
}

template <class Build>
float quantized_difference(const openvdb::FloatGrid& grid) {
  std::vector<test::NanoHandle> handles;
  handles.push_back(test::nanovdb_grid<Build>(grid));
  const auto read = read_nanovdb_numbers(bytes_of(test::nanovdb_file(handles)), "density");
  EXPECT_TRUE(read) << read.error().message;
  return read ? difference(**read, grid) : 1e9F;
}

TEST(ReadNanoVdb, ReadsQuantizedValues) {
  const auto grid = scattered();
  // Steps of a range of 3, -2 to 1, halved by rounding.
  EXPECT_LT(quantized_difference<nanovdb::Fp4>(*grid), 1.01F * 1.5F / 15.0F);
  EXPECT_LT(quantized_difference<nanovdb::Fp8>(*grid), 1.01F * 1.5F / 255.0F);
  EXPECT_LT(quantized_difference<nanovdb::Fp16>(*grid), 1.01F * 1.5F / 65535.0F);
  EXPECT_GT(quantized_difference<nanovdb::Fp4>(*grid), 0.01F);
  EXPECT_LT(quantized_difference<nanovdb::FpN>(*grid), 0.02F);
}

TEST(ReadNanoVdb, ReadsDoublesAndVectors) {
  openvdb::initialize();
  const auto doubles = test::vdb_box<openvdb::DoubleGrid>(
      "fine", 11, 0.5, {1.0, 2.0, 3.0}, [](int i, int j, int k) { return i + 20 * j + 400.5 * k; });
  const auto colors =
      test::vdb_box<openvdb::Vec3SGrid>("Cd", 4, 1.0, {0.0, 0.0, 0.0}, [](int i, int j, int k) {
        return openvdb::Vec3s(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k));
      });
  std::vector<test::NanoHandle> handles;
  handles.push_back(test::nanovdb_grid<double>(*doubles));
  handles.push_back(test::nanovdb_grid<nanovdb::Vec3f>(*colors));
  const Bytes file = bytes_of(test::nanovdb_file(handles, Codec::ZIP));
  EXPECT_THAT(*nanovdb_names(file), ElementsAre("fine", "Cd"));
  const auto fine = read_vdb_numbers(file, "fine");
  ASSERT_TRUE(fine) << fine.error().message;
  EXPECT_EQ((*fine)->voxels.at(Vec3(3.0F, 4.0F, 5.0F)), 2085.5F);
  EXPECT_EQ(transform_point((*fine)->to_file, Vec3(3.0F, 4.0F, 5.0F)), Vec3(2.5F, 4.0F, 5.5F));
  const auto tint = read_vdb_colors(file, "Cd");
  ASSERT_TRUE(tint) << tint.error().message;
  EXPECT_EQ((*tint)->voxels.at(Vec3(3.0F, 2.0F, 1.0F)), Rgb(3.0F, 2.0F, 1.0F));
}

// A map that turns, shears and mirrors.
TEST(ReadNanoVdb, PlacesVoxelsWhereTheFileSays) {
  auto grid = scattered();
  openvdb::Mat4R matrix = openvdb::Mat4R::identity();
  matrix.preScale(openvdb::Vec3d(0.5, -2.0, 0.25));
  matrix.postRotate(openvdb::math::X_AXIS, 0.7);
  matrix.postRotate(openvdb::math::Y_AXIS, -0.4);
  matrix.postTranslate(openvdb::Vec3d(4.0, 5.0, 6.0));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  const auto read = read_vdb_numbers(bytes_of(test::nanovdb_file({grid})), "density");
  ASSERT_TRUE(read) << read.error().message;
  const openvdb::Vec3d expected = grid->indexToWorld(openvdb::Vec3d(3.0, -7.0, 11.0));
  const Vec3 place = transform_point((*read)->to_file, Vec3(3.0F, -7.0F, 11.0F));
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(place[a], expected[a], 1e-5);
}

std::string complaint(const std::string& text, const std::string& name = "density") {
  const auto read = read_vdb_numbers(bytes_of(text), name);
  return read ? std::string("none") : read.error().message;
}

/// `text` with `value` written over its bytes at `place`.
template <class T>
std::string with(std::string text, size_t place, T value) {
  std::memcpy(text.data() + place, &value, sizeof(value));
  return text;
}

constexpr size_t kGrid = 16 + 176 + 8;  ///< after the heads and the name "density" with its zero

TEST(ReadNanoVdb, SaysWhatIsWrong) {
  const std::string good = test::nanovdb_file({scattered()});
  ASSERT_EQ(complaint(good), "none");
  EXPECT_EQ(complaint(good, "smoke"), "has no grid 'smoke', expected density");
  EXPECT_EQ(complaint(with(good, 8, uint32_t{29} << 21U | 3U << 10U)),
            "has version 29.3 of the NanoVDB format, expected 32.x");
  EXPECT_EQ(complaint(with(good, 14, uint16_t{7})),
            "grid 'density': is compressed in a way that is not known (number 7)");
  EXPECT_EQ(complaint(with(good, 14, uint16_t{1})), "grid 'density': cannot be decompressed");
  EXPECT_EQ(complaint(with(good, 14, uint16_t{2})), "grid 'density': cannot be decompressed");
  EXPECT_THAT(complaint(with(good, 48, uint32_t{4})), HasSubstr("is of type Int32, expected num"));
  EXPECT_THAT(complaint(with(good, kGrid + 632, uint32_t{1})), HasSubstr("is a level set"));
  EXPECT_THAT(complaint(with(good, kGrid + 384, 0.0)), HasSubstr("a transform that flattens it"));
  EXPECT_THAT(complaint(with(good, kGrid + 384, std::numeric_limits<double>::infinity())),
              HasSubstr("or is not finite"));
  EXPECT_THAT(complaint(good + std::string(100, 'x')), HasSubstr("something else than grids"));
  auto wild = scattered();
  wild->getAccessor().setValue({1, 1, 1}, std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(complaint(test::nanovdb_file({wild})), HasSubstr("not finite"));
  auto empty = openvdb::FloatGrid::create();
  empty->setName("density");
  EXPECT_THAT(complaint(test::nanovdb_file({empty})), HasSubstr("no active voxels"));
}

// Offsets and counts that lead out, back, or to one node from many places.
TEST(ReadNanoVdb, FollowsNoOffsetThatLies) {
  const std::string good = test::nanovdb_file({scattered()});
  size_t root = 0;
  std::memcpy(&root, good.data() + kGrid + 672 + 24, sizeof(root));
  root += kGrid + 672;
  const std::string leads_out = "grid 'density': ends too early, or leads out of itself";
  for (const int64_t lie : {int64_t{-1}, int64_t{1} << 40, std::numeric_limits<int64_t>::min(),
                            std::numeric_limits<int64_t>::max()}) {
    EXPECT_EQ(complaint(with(good, kGrid + 672 + 24, lie)), leads_out) << lie;
    EXPECT_NE(complaint(with(good, root + 64 + 8, lie)), "none") << lie;
  }
  EXPECT_EQ(complaint(with(good, root + 24, ~uint32_t{0})), leads_out);
  // All children of the first upper node are one and the same lower node.
  int64_t upper = 0;
  std::memcpy(&upper, good.data() + root + 64 + 8, sizeof(upper));
  const size_t node = root + static_cast<size_t>(upper);
  std::string shared = good;
  int64_t child = 0;
  for (size_t i = 0; i < 32768 && child == 0; ++i) {
    const auto byte = static_cast<unsigned char>(good[node + 4128 + i / 8]);
    if ((byte >> (i % 8) & 1) != 0) {
      std::memcpy(&child, good.data() + node + 8256 + 8 * i, sizeof(child));
    }
  }
  for (size_t i = 0; i < 32768; ++i) {
    std::memcpy(shared.data() + node + 8256 + 8 * i, &child, sizeof(child));
  }
  std::memset(shared.data() + node + 4128, 0xFF, 4096);
  EXPECT_EQ(complaint(shared), "grid 'density': has nodes that lie over one another");
}

// A grid may not say that it is larger than its bytes can be, nor lie that far.
TEST(ReadNanoVdb, TakesNoMemoryOnAFilesWord) {
  for (const Codec codec : {Codec::NONE, Codec::ZIP, Codec::BLOSC}) {
    const std::string good = test::nanovdb_file({scattered()}, codec);
    for (const uint64_t size : {uint64_t{0}, uint64_t{100}, uint64_t{1} << 33, ~uint64_t{0}}) {
      EXPECT_NE(complaint(with(good, 16, size)), "none") << size;
      EXPECT_NE(complaint(with(good, 24, size)), "none") << size;
    }
    EXPECT_EQ(complaint(with(good, 16 + 136, ~uint32_t{0})), "ends too early");
  }
  auto apart = scattered();
  apart->getAccessor().setValue({4'000'000, 4000, 0}, 1.0F);
  EXPECT_THAT(complaint(test::nanovdb_file({apart})), HasSubstr("more than can be read"));
}

TEST(ReadNanoVdb, SurvivesBeingCutAnywhere) {
  for (const Codec codec : {Codec::NONE, Codec::ZIP, Codec::BLOSC}) {
    const std::string good = test::nanovdb_file({scattered()}, codec);
    const size_t step = codec == Codec::NONE ? 9'973 : 97;
    for (size_t size = 0; size < good.size(); size += size < 4096 ? 97 : step) {
      EXPECT_NE(complaint(good.substr(0, size)), "none") << size;
    }
  }
}

// Whatever bytes come: an error or a grid, never a crash.
TEST(ReadNanoVdb, SurvivesGarbage) {
  const auto small = test::vdb_box<openvdb::FloatGrid>("density", 11, 0.5, {1.0, 2.0, 3.0},
                                                       [](int i, int, int) { return 0.1F + i; });
  test::Random random(12);
  std::vector<test::NanoHandle> quantized;
  quantized.push_back(test::nanovdb_grid<nanovdb::FpN>(*small));
  const std::array<std::string, 4> files = {
      test::nanovdb_file({small}), test::nanovdb_file({small}, Codec::ZIP),
      test::nanovdb_file({small}, Codec::BLOSC), test::nanovdb_file(quantized)};
  int refused = 0;
  for (size_t n = 0; n < 600; ++n) {
    std::string text = files[n % files.size()];
    for (uint64_t k = random.bits() % 8; k > 0; --k) {
      // Often near the front, where sizes and offsets are.
      const uint64_t reach = n % 8 < 6 ? std::min<uint64_t>(text.size(), 1040) : text.size();
      text[random.bits() % reach] = static_cast<char>(random.bits());
    }
    refused += complaint(text) == "none" ? 0 : 1;
  }
  EXPECT_GT(refused, 150);
}

}  // namespace
}  // namespace hyades::core
