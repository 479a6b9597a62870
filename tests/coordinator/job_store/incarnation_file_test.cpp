#include "coordinator/job_store/incarnation_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "coordinator/job_store/reserve_file.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

void overwrite(const std::string& path, std::streamoff offset, const std::string& bytes) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(offset);
  file << bytes;
  ASSERT_TRUE(file.good());
}

TEST(IncarnationFile, CountsInPlace) {
  const test::TempFolder folder;
  const std::string path = folder.file("starts");
  EXPECT_EQ(*count_start(path, 0), 1U);
  const auto size = std::filesystem::file_size(path);
  for (uint64_t start = 2; start < 20; ++start) EXPECT_EQ(*count_start(path, 0), start);
  EXPECT_EQ(std::filesystem::file_size(path), size) << "a full disk has no room for more";
  EXPECT_EQ(*count_start(path, 100), 101U) << "an older program has counted meanwhile";
  EXPECT_EQ(*count_start(path, 7), 102U);
}

TEST(IncarnationFile, NeverGoesBackFarWhereABlockIsTorn) {
  for (const std::streamoff offset : {std::streamoff{3}, std::streamoff{4096 + 18}}) {
    const test::TempFolder folder;
    const std::string path = folder.file("starts");
    for (uint64_t start = 1; start <= 8; ++start) ASSERT_EQ(*count_start(path, 0), start);
    overwrite(path, offset, "9999");
    const auto next = count_start(path, 0);
    ASSERT_TRUE(next.ok());
    EXPECT_TRUE(*next == 8 || *next == 9) << *next << ": a torn block is believed or both are lost";
  }
  const test::TempFolder folder;
  EXPECT_FALSE(count_start(folder.file("no/such/folder"), 0).ok());
}

TEST(ReserveFile, IsThereUntilItIsNeeded) {
  const test::TempFolder folder;
  const std::string path = folder.file("reserve");
  ReserveFile reserve(path, 100'000);
  EXPECT_FALSE(reserve.release()) << "there is nothing to release";
  reserve.keep();
  EXPECT_EQ(std::filesystem::file_size(path), 100'000U);
  EXPECT_TRUE(reserve.release());
  EXPECT_FALSE(std::filesystem::exists(path));
  ReserveFile huge(path, uint64_t{1} << 55U);
  huge.keep();
  EXPECT_FALSE(std::filesystem::exists(path)) << "half a reserve only takes room";
}

}  // namespace
}  // namespace hyades::coordinator
