#include "core/sandbox/landlock.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"

namespace hyades::core {
namespace {

/// What `try_it` returns in a process that is held by `rules`; -1 where it could not be held.
int in_a_held_process(const std::vector<FileRule>& rules, const std::function<int()>& try_it) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(restrict_files(rules) ? try_it() : 255);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) != 255 ? WEXITSTATUS(status) : -1;
}

/// 0, or why the file cannot be opened.
int open_error(const std::string& path, int flags) {
  const int file = ::open(path.c_str(), flags | O_CLOEXEC, 0600);
  if (file < 0) return errno;
  ::close(file);
  return 0;
}

class Landlock : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!landlock_lacks().empty()) GTEST_SKIP() << landlock_lacks();
    for (const char* name : {"mine", "read", "other"}) {
      ASSERT_EQ(::mkdir(file(name).c_str(), 0700), 0);
      std::ofstream(file(name) + "/there") << "text";
    }
  }
  std::string file(const std::string& name) const { return folder_.file(name); }
  int held(const std::function<int()>& try_it) const {
    return in_a_held_process(
        {{file("mine"), FileAccess::write, true}, {file("read"), FileAccess::read, true}}, try_it);
  }
  test::TempFolder folder_;
};

TEST_F(Landlock, FilesOfNoRuleAreOutOfReach) {
  EXPECT_EQ(held([&] { return open_error(file("other/there"), O_RDONLY); }), EACCES);
  EXPECT_EQ(held([&] { return open_error(file("other/new"), O_WRONLY | O_CREAT); }), EACCES);
  EXPECT_EQ(held([&] { return ::unlink(file("other/there").c_str()) != 0 ? errno : 0; }), EACCES);
}

TEST_F(Landlock, AFolderToWriteInMayBeWorkedIn) {
  EXPECT_EQ(held([&] {
              if (::mkdir(file("mine/sub").c_str(), 0700) != 0) return errno;
              if (const int e = open_error(file("mine/sub/a"), O_WRONLY | O_CREAT | O_TRUNC))
                return e;
              if (std::rename(file("mine/sub/a").c_str(), file("mine/sub/b").c_str()) != 0)
                return errno;
              if (const int e = open_error(file("mine/sub"), O_RDONLY | O_DIRECTORY)) return e;
              if (::unlink(file("mine/sub/b").c_str()) != 0) return errno;
              return ::rmdir(file("mine/sub").c_str()) != 0 ? errno : 0;
            }),
            0);
}

TEST_F(Landlock, AFolderToReadMayOnlyBeRead) {
  EXPECT_EQ(held([&] { return open_error(file("read/there"), O_RDONLY); }), 0);
  EXPECT_EQ(held([&] { return open_error(file("read/there"), O_WRONLY); }), EACCES);
  EXPECT_EQ(held([&] { return ::unlink(file("read/there").c_str()) != 0 ? errno : 0; }), EACCES);
}

TEST_F(Landlock, WhatMustBeThereAndIsNotIsNamed) {
  const Status held = restrict_files({{file("none"), FileAccess::read, true}});
  ASSERT_FALSE(held.ok());
  EXPECT_NE(held.error().message.find(file("none")), std::string::npos) << held.error().message;
  EXPECT_EQ(open_error(file("other/there"), O_RDONLY), 0) << "nothing was given up";
}

}  // namespace
}  // namespace hyades::core
