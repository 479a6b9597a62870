#include "farm/content_store.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/farm/content_testing.h"
#include "tests/support/temp_folder.h"

namespace hyades::farm {
namespace {

namespace fs = std::filesystem;
using core::Bytes;
using core::Result;
using test::TempFolder;

std::string text_of(const Result<Bytes>& bytes) {
  return bytes ? std::string(bytes->chars(), bytes->size()) : bytes.error().message;
}

TEST(ContentStore, KeepsFilesByContent) {
  const TempFolder folder;
  std::string name;
  {
    const auto store = open_store(folder.file("assets"));
    EXPECT_FALSE(store->contains(name_of("mesh"), 4));
    name = put(*store, "mesh");
    EXPECT_TRUE(store->contains(name, 4));
    EXPECT_EQ(text_of(store->read(name)), "mesh");
    EXPECT_EQ(text_of(store->read(put(*store, ""))), "");
    put(*store, "mesh");  // again does no harm
  }
  const auto store = open_store(folder.file("assets"));
  EXPECT_EQ(text_of(store->read(name)), "mesh");
  const Result<Bytes> bytes = store->read(name);
  EXPECT_TRUE(store->remove(name));
  EXPECT_TRUE(store->remove(name));
  EXPECT_FALSE(store->contains(name, 4));
  EXPECT_EQ(text_of(bytes), "mesh");  // what was read stays
  EXPECT_TRUE(fs::is_empty(folder.file("assets/partial")));
}

/// That this process has read of files so far.
uint64_t bytes_read() {
  std::ifstream io("/proc/self/io");
  std::string name;
  uint64_t bytes = 0;
  io >> name >> bytes;
  EXPECT_EQ(name, "rchar:");
  return bytes;
}

TEST(ContentStore, GoesOnWithAFileWithoutReadingItAgain) {
  constexpr uint64_t kPart = uint64_t{8} << 20U;
  const TempFolder folder;
  const std::string text(2 * kPart, 'x');
  const std::string name = name_of(text);
  const auto part = [&](size_t i) { return bytes_of(text).subspan(i * kPart, kPart); };
  auto store = open_store(folder.file("assets"));
  const auto read_to_go_on = [&] {
    const uint64_t before = bytes_read();
    auto writer = store->write(name, text.size());
    EXPECT_TRUE(writer) << error_of(writer);
    EXPECT_EQ(writer->offset(), kPart);
    EXPECT_EQ(store->expected(), kPart);
    return bytes_read() - before;
  };
  ASSERT_TRUE(store->write(name, text.size())->append(part(0)));
  for (int i = 0; i < 3; ++i) EXPECT_LT(read_to_go_on(), kPart / 2);
  store = open_store(folder.file("assets"));
  EXPECT_GE(read_to_go_on(), kPart) << "once after a start";
  EXPECT_LT(read_to_go_on(), kPart / 2);
  // Somebody else has changed it.
  const std::string partial = folder.file("assets/partial/" + name);
  {
    std::fstream file(partial, std::ios::in | std::ios::out);
    file.seekp(100);
    file << 'y';
  }
  EXPECT_GE(read_to_go_on(), kPart);
  {
    auto writer = store->write(name, text.size());
    ASSERT_TRUE(writer->append(part(1)));
    EXPECT_FALSE(writer->commit()) << "it is not what the name promises";
  }
  ASSERT_TRUE(store->write(name, text.size())->append(part(0)));
  auto writer = store->write(name, text.size());
  ASSERT_EQ(writer->offset(), kPart);
  ASSERT_TRUE(writer->append(part(1)));
  const core::Status whole = writer->commit();
  EXPECT_TRUE(whole) << error_of(whole);
}

/// How many of eight that want these files (each one's, or all one) are told to come again.
int told_to_come_again(ContentStore& store, const std::vector<std::string>& names) {
  constexpr size_t kAtOnce = 8;
  std::atomic<size_t> here{0};
  std::atomic<int> told{0};
  std::vector<std::thread> threads;
  for (size_t i = 0; i < kAtOnce; ++i) {
    threads.emplace_back([&, i] {
      ++here;
      while (here < kAtOnce) std::this_thread::yield();
      bool busy = false;
      EXPECT_FALSE(store.read(names[i % names.size()], &busy));
      told += busy ? 1 : 0;
    });
  }
  for (std::thread& thread : threads) thread.join();
  return told;
}

TEST(ContentStore, ALargeFileThatAllWantTakesOneThread) {
  const TempFolder folder;
  const auto store = open_store(folder.file("assets"));
  std::vector<std::string> names;
  // Not what their names promise, and long enough that all come while they are hashed.
  for (int i = 0; i < 8; ++i) {
    names.push_back(name_of(std::to_string(i)));
    const std::string path = folder.file("assets/" + names.back());
    std::ofstream(path).close();
    fs::resize_file(path, uint64_t{i == 0 ? 512U : 128U} << 20U);
  }
  EXPECT_GE(told_to_come_again(*store, {names[0]}), 6);
  EXPECT_GE(told_to_come_again(*store, names), 2) << "some threads are left for others";
  for (const std::string& name : names) EXPECT_FALSE(store->read(name)) << "who waits is told";
  EXPECT_TRUE(store->names().empty());
}

TEST(ContentStore, WhatIsGoneTakesNoMemory) {
  const TempFolder folder;
  const auto store = open_store(folder.file("assets"), 1000);
  for (int i = 0; i < 10; ++i) put(*store, std::to_string(i));
  EXPECT_EQ(store->known(), 10U);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(store->remove_unused(name_of(std::to_string(i)), {}));
  for (int i = 4; i < 8; ++i) EXPECT_TRUE(store->remove(name_of(std::to_string(i))));
  EXPECT_EQ(store->known(), 2U);
  put(*store, std::string(950, 'x'));
  put(*store, std::string(950, 'y'));
  EXPECT_EQ(store->known(), 1U) << "others were evicted";
}

TEST(ContentStore, ResumesWhatWasBegun) {
  const TempFolder folder;
  const std::string text(100'000, 'x');
  const std::string name = name_of(text);
  {
    const auto store = open_store(folder.file("assets"));
    auto writer = store->write(name, text.size());
    ASSERT_TRUE(writer) << error_of(writer);
    EXPECT_EQ(writer->offset(), 0U);
    ASSERT_TRUE(writer->append(bytes_of(text).first(60'000)));
    EXPECT_NE(error_of(writer->commit()).find("60000 of 100000"), std::string::npos);
  }
  const auto store = open_store(folder.file("assets"));
  EXPECT_FALSE(store->contains(name, text.size()));
  EXPECT_FALSE(store->read(name));
  EXPECT_EQ(store->begun(name), 60'000U);
  EXPECT_EQ(store->begun(name_of("never")), 0U);
  EXPECT_FALSE(fs::exists(folder.file("assets/partial/" + name_of("never"))));
  auto writer = store->write(name, text.size());
  ASSERT_TRUE(writer) << error_of(writer);
  ASSERT_EQ(writer->offset(), 60'000U);
  EXPECT_FALSE(writer->append(bytes_of(text)));  // more than announced
  ASSERT_TRUE(writer->append(bytes_of(text).subspan(60'000)));
  const core::Status done = writer->commit();
  ASSERT_TRUE(done) << error_of(done);
  EXPECT_EQ(text_of(store->read(name)), text);
}

TEST(ContentStore, NamesNothingThatWasNotChecked) {
  const TempFolder folder;
  const auto store = open_store(folder.file("assets"));
  const std::string name = name_of("good");
  for (int i = 0; i < 2; ++i) {
    auto writer = store->write(name, 4);
    ASSERT_TRUE(writer);
    EXPECT_EQ(writer->offset(), 0U);  // the wrong bytes were thrown away
    ASSERT_TRUE(writer->append(bytes_of("evil")));
    EXPECT_NE(error_of(writer->commit()).find(name_of("evil")), std::string::npos);
    EXPECT_FALSE(store->contains(name, 4));
  }
  EXPECT_EQ(text_of(store->read(put(*store, "good"))), "good");
}

/// A partial file that a crash has left with other bytes than were written costs a second upload.
TEST(ContentStore, TornPartialFilesAreNoticed) {
  const TempFolder folder;
  const auto store = open_store(folder.file("assets"));
  const std::string text = "0123456789";
  const std::string name = name_of(text);
  std::ofstream(folder.file("assets/partial/" + name)) << std::string(5, '\0');
  {
    auto writer = store->write(name, text.size());
    ASSERT_TRUE(writer);
    EXPECT_EQ(writer->offset(), 5U);
    ASSERT_TRUE(writer->append(bytes_of(text).subspan(5)));
    EXPECT_FALSE(writer->commit());
  }
  // Longer than the file can be: begun again at once.
  std::ofstream(folder.file("assets/partial/" + name)) << std::string(11, 'x');
  EXPECT_EQ(text_of(store->read(put(*store, text))), text);
}

/// Flamenco kept a truncated file of a killed worker as done.
TEST(ContentStore, TruncatedFilesAreFetchedAgain) {
  const TempFolder folder;
  const auto store = open_store(folder.file("assets"));
  const std::string name = put(*store, "a mesh of some length");
  EXPECT_TRUE(store->read(name));
  fs::resize_file(folder.file("assets/" + name), 5);
  EXPECT_FALSE(store->contains(name, 21));
  EXPECT_FALSE(fs::exists(folder.file("assets/" + name)));
  put(*store, "a mesh of some length");
  EXPECT_TRUE(store->contains(name, 21));
}

TEST(ContentStore, CorruptedFilesAreRemoved) {
  const TempFolder folder;
  const auto store = open_store(folder.file("assets"));
  const std::string name = put(*store, "good");
  EXPECT_TRUE(store->read(name));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // clocks of files tick coarsely
  fs::permissions(folder.file("assets/" + name), fs::perms::owner_all);
  std::ofstream(folder.file("assets/" + name)) << "evil";
  EXPECT_NE(error_of(store->read(name)).find("damaged"), std::string::npos);
  EXPECT_FALSE(store->contains(name, 4));
}

/// A disk may give other bytes than it was given, and say nothing.
TEST(ContentStore, FilesThatAreKnownCanBeCheckedAgain) {
  const TempFolder folder;
  const auto store = open_store(folder.file("assets"));
  const std::string name = put(*store, "good");
  const std::string path = folder.file("assets/" + name);
  const auto written = fs::last_write_time(path);
  fs::permissions(path, fs::perms::owner_all);
  std::fstream(path, std::ios::in | std::ios::out) << "evil";
  fs::last_write_time(path, written);
  EXPECT_TRUE(store->contains(name, 4));
  store->check_again(name);
  EXPECT_FALSE(store->contains(name, 4));
}

/// Who asks with a wrong size must not be able to remove a good file.
TEST(ContentStore, WrongSizesRemoveNothing) {
  const TempFolder folder;
  const auto store = open_store(folder.file("assets"));
  const std::string name = put(*store, "good");
  EXPECT_TRUE(store->contains(name, 5));
  EXPECT_TRUE(store->contains(name, 4));
}

TEST(ContentStore, HostileNamesReachNoFile) {
  const TempFolder folder;
  const auto store = open_store(folder.file("assets"));
  std::ofstream(folder.file("secret")) << "secret";
  const std::string up = "../secret";
  const std::string good = name_of("x");
  std::vector<std::string> names = {"",
                                    ".",
                                    "..",
                                    up,
                                    folder.file("secret"),
                                    "partial",
                                    good.substr(1),
                                    good + "0",
                                    std::string(64, '/'),
                                    "../" + good.substr(3),
                                    good.substr(1) + '\0'};
  std::string upper = good;
  upper[upper.find_first_of("abcdef")] -= 'a' - 'A';
  names.push_back(upper);
  for (const std::string& name : names) {
    EXPECT_FALSE(is_content_name(name)) << name;
    EXPECT_FALSE(store->contains(name, 6)) << name;
    EXPECT_FALSE(store->read(name)) << name;
    EXPECT_FALSE(store->pin(name)) << name;
    EXPECT_FALSE(store->write(name, 6)) << name;
    EXPECT_FALSE(store->remove(name)) << name;
  }
  EXPECT_TRUE(fs::exists(folder.file("secret")));
  // Something else in the place of a file is not followed.
  fs::create_symlink(folder.file("secret"), folder.file("assets/" + good));
  EXPECT_FALSE(store->read(good));
  EXPECT_FALSE(store->pin(good));
  fs::create_symlink(folder.file("secret"), folder.file("assets/partial/" + name_of("y")));
  EXPECT_FALSE(store->write(name_of("y"), 1));
}

TEST(ContentStore, TwoWritersOfOneFileDoNotDisturbEachOther) {
  const TempFolder folder;
  const auto store = open_store(folder.file("assets"));
  const std::string name = name_of("abcdef");
  auto first = store->write(name, 6);
  ASSERT_TRUE(first);
  ASSERT_TRUE(first->append(bytes_of("ab")));
  {
    auto second = store->write(name, 6);
    ASSERT_TRUE(second) << error_of(second);
    EXPECT_EQ(second->offset(), 0U);
    ASSERT_TRUE(second->append(bytes_of("abcdef")));
    ASSERT_TRUE(second->commit());
    auto third = store->write(name, 6);  // abandoned: leaves nothing behind
    ASSERT_TRUE(third);
  }
  EXPECT_EQ(text_of(store->read(name)), "abcdef");
  ASSERT_TRUE(first->append(bytes_of("cdef")));
  ASSERT_TRUE(first->commit());
  EXPECT_EQ(text_of(store->read(name)), "abcdef");
  EXPECT_TRUE(fs::is_empty(folder.file("assets/partial")));
}

/// Many processes write, resume, die and read in one folder.
TEST(ContentStore, ProcessesShareAFolder) {
  const TempFolder folder;
  std::vector<std::string> texts;
  for (int i = 0; i < 5; ++i) texts.emplace_back(20'000 + i, static_cast<char>('a' + i));
  std::vector<pid_t> children;
  for (int child = 0; child < 4; ++child) {
    const pid_t pid = ::fork();
    ASSERT_GE(pid, 0);
    if (pid != 0) {
      children.push_back(pid);
      continue;
    }
    auto store = ContentStore::open({folder.file("assets"), 0});
    if (!store) _exit(1);
    for (int round = 0; round < 40; ++round) {
      const std::string& text = texts[static_cast<size_t>(child + round) % texts.size()];
      const std::string name = name_of(text);
      auto writer = (*store)->write(name, text.size());
      if (!writer) _exit(2);
      const auto rest = bytes_of(text).subspan(writer->offset());
      const bool give_up = (child + round) % 3 == 0;
      if (!writer->append(give_up ? rest.first(rest.size() / 2) : rest)) _exit(3);
      if (!give_up && !writer->commit()) _exit(4);
      const auto bytes = (*store)->read(name);
      if (bytes && std::string_view(bytes->chars(), bytes->size()) != text) _exit(5);
      if (round % 7 == 0 && !(*store)->remove(name)) _exit(6);
    }
    _exit(0);
  }
  for (const pid_t pid : children) {
    int status = 0;
    ASSERT_EQ(::waitpid(pid, &status, 0), pid);
    EXPECT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), 0);
  }
}

}  // namespace
}  // namespace hyades::farm
