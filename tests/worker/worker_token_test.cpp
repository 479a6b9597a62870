#include "worker/worker_token.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temp_folder.h"

namespace hyades::worker {
namespace {

class KeptToken : public ::testing::Test {
 protected:
  static std::string join(const std::string& id) {
    return "hyades-" + id + "-" + std::string(64, 's');
  }
  static std::string own(const std::string& id, const std::string& worker) {
    return "hyades-" + id + "-" + std::string(64, 'c') + "-" + worker;
  }
  void put(const std::string& token) const { std::ofstream(folder.file("token")) << token << "\n"; }
  WorkerToken token() const { return {folder.file("token"), folder.file("worker-0.token")}; }

  test::TempFolder folder;
};

TEST_F(KeptToken, IsShownInPlaceOfTheOneThatItWasMadeFrom) {
  put(join("00000001"));
  WorkerToken first = token();
  ASSERT_TRUE(first.read("ada").ok());
  EXPECT_EQ(first.text(), join("00000001"));
  ASSERT_TRUE(first.keep(own("00000001", "ada"), "ada").ok());
  EXPECT_EQ(first.text(), own("00000001", "ada"));
  struct stat info {};
  ASSERT_EQ(::stat(folder.file("worker-0.token").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777U, 0600U);
  WorkerToken again = token();
  ASSERT_TRUE(again.read("ada").ok());
  EXPECT_EQ(again.text(), own("00000001", "ada"));
  ASSERT_TRUE(again.keep(own("00000001", "ada"), "ada").ok()) << "over the one that is there";
  std::filesystem::remove(folder.file("token"));
  ASSERT_TRUE(again.read("ada").ok()) << "the other one may go";
  EXPECT_EQ(again.text(), own("00000001", "ada"));
}

TEST_F(KeptToken, DoesNotOutlastTheOtherNorTheId) {
  put(join("00000001"));
  WorkerToken first = token();
  ASSERT_TRUE(first.read("ada").ok());
  ASSERT_TRUE(first.keep(own("00000001", "ada"), "ada").ok());
  EXPECT_TRUE(token().read("bob").ok());
  WorkerToken bobs = token();
  ASSERT_TRUE(bobs.read("bob").ok());
  EXPECT_EQ(bobs.text(), join("00000001"));
  put(join("00000002"));
  ASSERT_TRUE(first.read("ada").ok());
  EXPECT_EQ(first.text(), join("00000002"));
}

TEST_F(KeptToken, ThatIsUnknownGivesWayToWhatTheFileHolds) {
  put(join("00000001"));
  WorkerToken first = token();
  ASSERT_TRUE(first.read("ada").ok());
  ASSERT_TRUE(first.keep(own("00000001", "ada"), "ada").ok());
  EXPECT_TRUE(first.replace("ada"));
  EXPECT_EQ(first.text(), join("00000001"));
  EXPECT_FALSE(first.replace("ada")) << "there is no other, and each has been tried";
  EXPECT_EQ(first.text(), own("00000001", "ada")) << "the coordinator may know it by then";
  EXPECT_TRUE(first.replace("ada"));
  EXPECT_EQ(first.text(), join("00000001"));
  put(join("00000002"));
  EXPECT_TRUE(first.replace("ada"));
  EXPECT_EQ(first.text(), join("00000002"));
}

TEST_F(KeptToken, ThatIsTheOnlyOneIsNeverLost) {
  put(join("00000001"));
  WorkerToken first = token();
  ASSERT_TRUE(first.read("ada").ok());
  ASSERT_TRUE(first.keep(own("00000001", "ada"), "ada").ok());
  std::filesystem::remove(folder.file("token"));
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(first.replace("ada"));
    EXPECT_EQ(first.text(), own("00000001", "ada"));
  }
  EXPECT_TRUE(token().read("ada").ok());
}

TEST_F(KeptToken, IsNotWhateverACoordinatorSays) {
  put(join("00000001"));
  WorkerToken first = token();
  ASSERT_TRUE(first.read("ada").ok());
  for (const std::string& said :
       {own("00000002", "ada"), own("00000001", "bob"), std::string("-ada"),
        "hyades-00000001-" + std::string(64, 'c') + "\nx: y-ada",
        "hyades-00000001-" + std::string(300, 'c') + "-ada"}) {
    EXPECT_FALSE(first.keep(said, "ada").ok()) << said;
    EXPECT_EQ(first.text(), join("00000001"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder.file("worker-0.token")));
}

TEST_F(KeptToken, WithoutAnyTheWorkerCannotBegin) {
  EXPECT_FALSE(token().read("ada").ok());
  WorkerToken none("", folder.file("worker-0.token"));
  ASSERT_TRUE(none.read("ada").ok()) << "a farm may ask for none";
  EXPECT_EQ(none.text(), "");
}

}  // namespace
}  // namespace hyades::worker
