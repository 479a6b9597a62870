// Lines that the disk does not take.
#include "coordinator/access/rotating_log.h"

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/temp_folder.h"

namespace {

std::atomic<bool> syncs_fail{false};

}  // namespace

/// Stands before the system's, and fails while a test wants it to.
extern "C" int fdatasync(int file) {
  if (!syncs_fail) return static_cast<int>(::syscall(SYS_fdatasync, file));
  errno = EIO;
  return -1;
}

namespace hyades::coordinator {
namespace {

class LineFilesTest : public testing::Test {
 protected:
  std::string text() const {
    std::ifstream in(path);
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
  }

  const test::TempFolder folder;
  const std::string path = folder.file("lines.jsonl");
  RotatingLog files{{folder.path().string(), "lines", 1000, 2}};
};

TEST_F(LineFilesTest, ThatAreNotSyncedAreNotPromised) {
  ASSERT_TRUE(files.open().ok());
  EXPECT_TRUE(files.write("first\n"));
  syncs_fail = true;
  EXPECT_FALSE(files.write("second\n"));
  syncs_fail = false;
  EXPECT_EQ(text(), "first\n") << "who is told no writes it again";
  EXPECT_TRUE(files.write("second\n"));
  EXPECT_EQ(text(), "first\nsecond\n");
}

TEST_F(LineFilesTest, AreOpenedAgainWhereAFileTakesNothing) {
  std::filesystem::create_symlink("/dev/full", path);
  ASSERT_TRUE(files.open().ok());
  EXPECT_FALSE(files.write("first\n"));
  std::filesystem::remove(path);
  EXPECT_TRUE(files.write("first\n"));
  EXPECT_EQ(text(), "first\n");
}

}  // namespace
}  // namespace hyades::coordinator
