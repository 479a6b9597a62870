#include "farm/small_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temp_folder.h"

namespace hyades::farm {
namespace {

namespace fs = std::filesystem;

std::string kept_in(const std::string& path) {
  const auto bytes = read_small_file(path);
  return bytes ? *bytes : bytes.error().message;
}

TEST(Secret, TakesThePlaceOfOneThatOthersCouldRead) {
  const test::TempFolder folder;
  const std::string key = folder.file("key");
  std::ofstream(key) << "old";
  fs::permissions(key, fs::perms::all);
  ASSERT_TRUE(replace_secret(key, "new").ok());
  EXPECT_EQ(kept_in(key), "new");
  struct stat info {};
  ASSERT_EQ(::stat(key.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777U, 0600U);
  EXPECT_FALSE(write_secret(key, "never over another").ok());
  EXPECT_EQ(kept_in(key), "new");
}

TEST(Secret, FollowsNoLinkAndLeavesNothingOnItsWay) {
  const test::TempFolder folder;
  const std::string others = folder.file("others");
  std::ofstream(others) << "theirs";
  const std::string key = folder.file("key");
  for (const std::string& link : {key, key + ".new"}) {
    fs::create_symlink(others, link);
    ASSERT_TRUE(replace_secret(key, "new").ok());
    EXPECT_EQ(kept_in(others), "theirs");
    EXPECT_FALSE(fs::is_symlink(key));
    EXPECT_EQ(kept_in(key), "new");
  }
  fs::create_directories(folder.file("folder/in the way"));
  const auto refused = replace_secret(folder.file("folder"), "new");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("cannot be written"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder.file("folder.new")));
}

}  // namespace
}  // namespace hyades::farm
