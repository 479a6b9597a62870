#include "core/base/posix_file.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <string_view>
#include <thread>
#include <vector>

#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

std::span<const std::byte> text_bytes(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

TEST(PosixFile, WhatIsWrittenIsReadAgain) {
  const test::TempFolder folder;
  const std::string path = folder.file("file");
  {
    const Descriptor file = open_file(path, O_WRONLY | O_CREAT | O_EXCL, 0600);
    ASSERT_TRUE(file.valid());
    EXPECT_NE(::fcntl(file.get(), F_GETFD) & FD_CLOEXEC, 0);
    EXPECT_TRUE(write_all(file.get(), text_bytes("a file of words")));
    EXPECT_TRUE(write_all_at(file.get(), text_bytes("page"), 2));
  }
  const Descriptor file = open_file(path, O_RDONLY);
  std::vector<std::byte> read(100);
  ASSERT_EQ(read_all(file.get(), read), 15U);
  EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(read.data()), 15), "a page of words");
  ASSERT_EQ(read_all_at(file.get(), std::span(read).first(4), 10), 4U);
  EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(read.data()), 4), "word");
  EXPECT_EQ(read_all_at(file.get(), read, 15), 0U) << "the file has ended";
}

TEST(PosixFile, FailuresSayWhyInErrno) {
  const test::TempFolder folder;
  EXPECT_FALSE(open_file(folder.file("none"), O_RDONLY).valid());
  EXPECT_EQ(errno, ENOENT);
  const Descriptor file = open_file(folder.file("file"), O_WRONLY | O_CREAT);
  std::vector<std::byte> read(1);
  EXPECT_FALSE(read_all(file.get(), read));
  EXPECT_EQ(errno, EBADF);
  const Descriptor again = open_file(folder.file("file"), O_RDONLY);
  EXPECT_FALSE(write_all(again.get(), text_bytes("words")));
  EXPECT_EQ(errno, EBADF);
}

/// A pipe that nobody reads from yet blocks, and signals come without end.
TEST(PosixFile, SignalsInterruptNothing) {
  struct sigaction quiet {};
  struct sigaction before {};
  quiet.sa_handler = [](int) {};  // without SA_RESTART
  ASSERT_EQ(::sigaction(SIGUSR1, &quiet, &before), 0);
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const Descriptor out(ends[0]);
  Descriptor in(ends[1]);
  const std::vector<std::byte> sent(1U << 20U, std::byte{7});
  std::atomic<bool> written{false};
  bool whole = false;
  std::thread writer([&] {
    whole = write_all(in.get(), sent);
    in.close();
    written = true;
  });
  for (int i = 0; i < 20; ++i) {
    ::pthread_kill(writer.native_handle(), SIGUSR1);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::vector<std::byte> got(sent.size() + 1);
  EXPECT_EQ(read_all(out.get(), got), sent.size());
  writer.join();
  EXPECT_TRUE(whole);
  ::sigaction(SIGUSR1, &before, nullptr);
}

TEST(PosixFile, AFolderThatMayNotBeListedIsNoFailureAndOneThatIsMissingIs) {
  const test::TempFolder folder;
  EXPECT_TRUE(sync_folder(folder.path().string()));
  EXPECT_FALSE(sync_folder(folder.file("none")));
  EXPECT_EQ(errno, ENOENT);
  const std::string shut = folder.file("shut");
  ASSERT_EQ(::mkdir(shut.c_str(), 0300), 0);
  EXPECT_TRUE(sync_folder(shut));
}

}  // namespace
}  // namespace hyades::core
