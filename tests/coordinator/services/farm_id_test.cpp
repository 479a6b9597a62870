// Whose files a coordinator takes for its own, since it removes those that none of its jobs names.
#include "coordinator/controller/farm_id.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "coordinator/controller/controller.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

namespace fs = std::filesystem;

void put(const std::string& path) {
  fs::create_directories(fs::path(path).parent_path());
  std::ofstream(path) << "a picture";
}

TEST(FarmId, AnEmptyFolderIsTakenAndKnownAgain) {
  const test::TempFolder folder;
  const std::string files = folder.path().string();
  ASSERT_TRUE(claim_files(files, "one", false).ok());
  put(files + "/outputs/1/a.png");
  EXPECT_TRUE(claim_files(files, "one", false).ok());
  const auto other = claim_files(files, "two", true);
  ASSERT_FALSE(other.ok());
  EXPECT_NE(other.error().message.find("another farm"), std::string::npos);
}

TEST(FarmId, FilesOfNobodyKnowsWhomAreLeftAlone) {
  const test::TempFolder folder;
  const std::string files = folder.path().string();
  put(files + "/outputs/1/a.png");
  EXPECT_FALSE(claim_files(files, "one", false).ok());
  EXPECT_FALSE(fs::exists(files + "/farm-id"));
  EXPECT_TRUE(claim_files(files, "one", true).ok()) << "of a farm from before there were ids";
}

TEST(FarmId, ACoordinatorWithoutItsStateRemovesNoPictures) {
  const test::TempFolder folder;
  ControllerOptions options;
  options.folder = folder.file("data");
  options.finisher = "/nonexistent";
  { ASSERT_TRUE(Controller::open(options).ok()); }
  put(options.folder + "/outputs/1/a.png");
  fs::rename(options.folder + "/state.db", options.folder + "/state.db.migrated");
  const auto moved = Controller::open(options);
  ASSERT_FALSE(moved.ok());
  EXPECT_NE(moved.error().message.find("--state"), std::string::npos) << moved.error().message;
  fs::remove(options.folder + "/state.db.migrated");
  const auto lost = Controller::open(options);
  ASSERT_FALSE(lost.ok());
  EXPECT_NE(lost.error().message.find("another farm"), std::string::npos) << lost.error().message;
  EXPECT_TRUE(fs::exists(options.folder + "/outputs/1/a.png"));
}

}  // namespace
}  // namespace hyades::coordinator
