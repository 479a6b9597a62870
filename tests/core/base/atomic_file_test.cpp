#include "core/base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

size_t files_in(const fs::path& folder) {
  return static_cast<size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(AtomicFile, WritesAndReplaces) {
  const TempFolder folder;
  const std::string path = folder.file("a.txt");
  ASSERT_TRUE(write_file(path, bytes_of("first")));
  EXPECT_EQ(contents(path), "first");
  ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
  ASSERT_TRUE(write_file(path, bytes_of("second, longer")));
  EXPECT_EQ(contents(path), "second, longer");
  struct stat info {};
  ASSERT_EQ(::stat(path.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 07777, 0640U);
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFile, FailureLeavesOldFileAndNoTemporary) {
  const TempFolder folder;
  const std::string path = folder.file("a.txt");
  ASSERT_TRUE(write_file(path, bytes_of("old")));
  const Status status = replace_file(path, [](const std::string& temporary) -> Status {
    std::ofstream(temporary) << "half";
    return Error{"the encoder gave up"};
  });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().message, "the encoder gave up");
  EXPECT_EQ(contents(path), "old");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFile, AnExceptionLeavesNoTemporary) {
  const TempFolder folder;
  EXPECT_THROW((void)replace_file(folder.file("a"),
                                  [](const std::string& temporary) -> Status {
                                    std::ofstream(temporary) << "half";
                                    throw std::runtime_error("x");
                                  }),
               std::runtime_error);
  EXPECT_EQ(files_in(folder.path()), 0U);
}

TEST(AtomicFile, SaysWhatIsWrong) {
  const TempFolder folder;
  const Status missing = write_file(folder.file("no/such/a.txt"), bytes_of("x"));
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("folder does not exist"), std::string::npos);

  const Status is_folder = write_file(folder.path().string(), bytes_of("x"));
  ASSERT_FALSE(is_folder);
  EXPECT_NE(is_folder.error().message.find("not a regular file"), std::string::npos);

  EXPECT_FALSE(write_file("", bytes_of("x")));
  EXPECT_FALSE(write_file(folder.path().string() + "/", bytes_of("x")));
  EXPECT_FALSE(write_file(std::string("a\0b", 3), bytes_of("x")));
  EXPECT_FALSE(write_file("/dev/null", bytes_of("x")));
}

TEST(AtomicFile, FullDiskIsNamed) {
  // /dev/full answers every write with ENOSPC; the writer that hits it must pass the word on.
  std::ofstream full("/dev/full");
  if (!full) GTEST_SKIP() << "no /dev/full here";
  const TempFolder folder;
  const std::string path = folder.file("a.txt");
  const Status status = replace_file(path, [](const std::string& temporary) -> Status {
    fs::remove(temporary);
    fs::create_symlink("/dev/full", temporary);
    return write_in_place(temporary, bytes_of("x"));
  });
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find("disk is full"), std::string::npos)
      << status.error().message;
  EXPECT_NE(status.error().message.find(path), std::string::npos);
  EXPECT_EQ(status.error().message.find(".tmp"), std::string::npos) << "of which nobody knows";
  EXPECT_FALSE(fs::exists(path));
}

TEST(AtomicFile, LinkStaysALink) {
  const TempFolder folder;
  ASSERT_TRUE(write_file(folder.file("real"), bytes_of("1")));
  fs::create_symlink("real", folder.path() / "link");
  ASSERT_TRUE(write_file(folder.file("link"), bytes_of("2")));
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(contents(folder.path() / "real"), "2");
}

TEST(AtomicFile, WritersOfOneFileDoNotMix) {
  const TempFolder folder;
  const std::string path = folder.file("a");
  const std::vector<std::string> texts{std::string(100000, 'a'), std::string(50000, 'b')};
  std::vector<std::thread> threads;
  for (const std::string& text : texts) {
    threads.emplace_back([&] {
      for (int i = 0; i < 5; ++i) EXPECT_TRUE(write_file(path, bytes_of(text)));
    });
  }
  for (auto& thread : threads) thread.join();
  const std::string found = contents(path);
  EXPECT_TRUE(found == texts[0] || found == texts[1]);
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFile, LongNamesWork) {
  const TempFolder folder;
  const std::string path = folder.file(std::string(250, 'n') + ".exr");
  EXPECT_TRUE(write_file(path, bytes_of("x")));
}

}  // namespace
}  // namespace hyades::core
