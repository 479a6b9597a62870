#include "core/base/leftovers.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "core/base/atomic_file.h"
#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

namespace fs = std::filesystem;

const auto kLater = fs::file_time_type::clock::now() + std::chrono::hours(1);

TEST(Leftovers, TheTemporaryOfAnUnfinishedFileIsFoundWithItsTarget) {
  const test::TempFolder folder;
  std::string found_inside;
  ASSERT_TRUE(replace_file(folder.file("picture.exr"), [&](const std::string& temporary) -> Status {
                std::ofstream(temporary) << "half";
                const auto leftovers = find_leftovers(folder.path().string(), kLater);
                EXPECT_EQ(leftovers.size(), 1U);
                if (!leftovers.empty()) {
                  EXPECT_EQ(leftovers[0].path, temporary);
                  EXPECT_EQ(leftovers[0].target, "picture.exr");
                }
                return {};
              }).ok());
  EXPECT_TRUE(find_leftovers(folder.path().string(), kLater).empty());
}

TEST(Leftovers, OtherFilesAndYoungOnesAreLeft) {
  const test::TempFolder folder;
  for (const char* name :
       {".picture.exr.0123456789abcdef.tmp", ".picture.exr.0123456789abcdeX.tmp", ".picture.tmp",
        "picture.exr.0123456789abcdef.tmp", ".0123456789abcdef.tmp", "..tmp"}) {
    std::ofstream(folder.file(name)) << "x";
  }
  fs::create_directory(folder.file(".folder.0123456789abcdef.tmp"));
  const auto found = find_leftovers(folder.path().string(), kLater);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].path, folder.file(".picture.exr.0123456789abcdef.tmp"));
  EXPECT_TRUE(find_leftovers(folder.path().string(), fs::last_write_time(found[0].path)).empty());
  EXPECT_TRUE(find_leftovers(folder.file("missing"), kLater).empty());
}

}  // namespace
}  // namespace hyades::core
