#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "coordinator/film_store/disk_room.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

constexpr uint64_t kMiB = uint64_t{1} << 20U;
constexpr uint64_t kGiB = uint64_t{1} << 30U;

TEST(DiskRoom, KeepsATwentiethOfTheDiskAndAtMostTwoGiB) {
  DiskRoom small({});
  EXPECT_FALSE(small.update({100 * kMiB, 5 * kMiB, 0}));
  EXPECT_EQ(small.level(), DiskLevel::roomy);
  EXPECT_EQ(small.room(), 0U);
  EXPECT_TRUE(small.update({100 * kMiB, 5 * kMiB - 1, 0}));
  EXPECT_EQ(small.level(), DiskLevel::low);
  DiskRoom large({});
  large.update({1000 * kGiB, 3 * kGiB, 0});
  EXPECT_EQ(large.level(), DiskLevel::roomy);
  EXPECT_EQ(large.room(), kGiB);
}

TEST(DiskRoom, FallsInStepsAndRisesALittleLater) {
  DiskRoom room({0, 100 * kMiB});
  room.update({kGiB, 500 * kMiB, 0});
  EXPECT_EQ(room.room(), 400 * kMiB);
  EXPECT_TRUE(room.reason().empty());
  EXPECT_TRUE(room.update({kGiB, 99 * kMiB, 0}));
  EXPECT_EQ(room.level(), DiskLevel::low);
  EXPECT_EQ(room.room(), 0U);
  EXPECT_NE(room.reason().find("99.0 MiB of 1.0 GiB are free"), std::string::npos) << room.reason();
  EXPECT_FALSE(room.update({kGiB, 124 * kMiB, 0})) << "a little above the line it stays low";
  EXPECT_TRUE(room.update({kGiB, 24 * kMiB, 0}));
  EXPECT_EQ(room.level(), DiskLevel::full);
  EXPECT_FALSE(room.update({kGiB, 49 * kMiB, 0}));
  EXPECT_TRUE(room.update({kGiB, 50 * kMiB, 0}));
  EXPECT_EQ(room.level(), DiskLevel::low);
  EXPECT_TRUE(room.update({kGiB, 125 * kMiB, 0}));
  EXPECT_EQ(room.level(), DiskLevel::roomy);
  EXPECT_EQ(room.room(), 25 * kMiB);
}

TEST(DiskRoom, ABudgetCountsAsADiskOfItsOwn) {
  DiskRoom room({100 * kMiB, 10 * kMiB});
  room.update({kGiB, 500 * kMiB, 40 * kMiB});
  EXPECT_EQ(room.room(), 55 * kMiB);
  EXPECT_TRUE(room.update({kGiB, 500 * kMiB, 96 * kMiB}));
  EXPECT_EQ(room.level(), DiskLevel::low);
  EXPECT_NE(room.reason().find("96.0 MiB of the 100.0 MiB"), std::string::npos) << room.reason();
  EXPECT_NE(room.reason().find("--disk-budget"), std::string::npos);
  room.update({kGiB, 500 * kMiB, 130 * kMiB});
  EXPECT_EQ(room.level(), DiskLevel::full);
  // Both short: the disk is named where it is worse.
  room.update({kGiB, kMiB, 96 * kMiB});
  EXPECT_EQ(room.level(), DiskLevel::full);
  EXPECT_NE(room.reason().find("--disk-reserve"), std::string::npos) << room.reason();
  room.update({kGiB, 500 * kMiB, 10 * kMiB});
  EXPECT_EQ(room.level(), DiskLevel::roomy);
}

TEST(DiskRoom, SaysHowMuchItLacks) {
  DiskRoom room({1000 * kMiB, 100 * kMiB});
  room.update({kGiB, 100 * kMiB, 500 * kMiB});
  EXPECT_EQ(room.shortage(), 0U);
  room.update({kGiB, 70 * kMiB, 500 * kMiB});
  ASSERT_EQ(room.level(), DiskLevel::low);
  EXPECT_EQ(room.shortage(), 55 * kMiB);
  room.update({kGiB, (70 + 55) * kMiB, 500 * kMiB});
  EXPECT_EQ(room.level(), DiskLevel::roomy) << "with so much more it is roomy again";
  room.update({kGiB, 500 * kMiB, 1100 * kMiB});
  ASSERT_EQ(room.level(), DiskLevel::full);
  const uint64_t lacks = room.shortage();
  room.update({kGiB, 500 * kMiB, 1100 * kMiB - lacks + 1});
  EXPECT_EQ(room.level(), DiskLevel::low);
}

TEST(DiskRoom, WithoutAReserveTheLastByteCounts) {
  DiskRoom room({0, 0});
  room.update({kGiB, 1, 0});
  EXPECT_EQ(room.level(), DiskLevel::roomy);
  room.update({kGiB, 0, 0});
  EXPECT_EQ(room.level(), DiskLevel::full);
}

TEST(DiskRoom, MeasuresWhatIsThere) {
  const test::TempFolder folder;
  const auto disk = measure_disk(folder.file(""));
  ASSERT_TRUE(disk.ok());
  EXPECT_GT(disk->size, disk->free);
  const uint64_t before = measure_folder(folder.file(""));
  std::filesystem::create_directories(folder.file("a/b"));
  std::ofstream(folder.file("a/b/c")) << std::string(100'000, 'x');
  const uint64_t after = measure_folder(folder.file(""));
  EXPECT_GE(after, before + 100'000);
  EXPECT_LE(after, before + 200'000);
  EXPECT_FALSE(measure_disk(folder.file("none")).ok());
}

TEST(DiskRoom, IsNotTakenByWhoAnnouncesMuch) {
  EXPECT_EQ(room_beside(1000, {}, "ada"), 1000U);
  EXPECT_EQ(room_beside(1000, {{"ada", 400}}, "ada"), 600U) << "what one announces oneself counts";
  EXPECT_EQ(room_beside(1000, {{"ada", 1000}}, "ada"), 0U);
  EXPECT_EQ(room_beside(1000, {{"bob", 400}}, "ada"), 600U);
  EXPECT_EQ(room_beside(1000, {{"eve", 1'000'000}}, "ada"), 500U);
  EXPECT_EQ(room_beside(1000, {{"bob", 100}, {"eve", 1000}}, "ada"), 400U);
  EXPECT_EQ(room_beside(1000, {{"ada", 200}, {"eve", 1000}}, "ada"), 400U);
}

}  // namespace
}  // namespace hyades::coordinator
