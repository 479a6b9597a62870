// What every implementation of LogFiles promises, on the disk and in databases.
#include "coordinator/film_store/log_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "coordinator/shared_state/database_log_files.h"
#include "tests/coordinator/shared_state/film_database.h"
#include "tests/coordinator/sql/postgres_server.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

using Bytes = std::vector<std::byte>;
using Names = std::vector<std::string>;

constexpr size_t kMegabyte = size_t{1} << 20U;

/// Bytes that do not repeat.
Bytes bytes_of(size_t size, uint64_t seed = 1) {
  Bytes bytes(size);
  std::mt19937_64 random(seed);
  for (std::byte& b : bytes) b = static_cast<std::byte>(random() & 0xFFU);
  return bytes;
}

/// Each test is run with files on the disk, in SQLite and in PostgreSQL.
class LogFilesContract : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string kind = GetParam();
    if (kind == "disk") {
      folder_ = scratch_.file("log");
      files_ = &disk_log_files();
      ASSERT_TRUE(files_->make_folder(folder_).ok());
      return;
    }
    if (kind == "sqlite") {
      database_ = std::make_unique<DatabaseLogFiles>(film_tables_in_sqlite(scratch_.file("db")), 1,
                                                     std::chrono::seconds(1));
    } else {
      if (!test::postgres_is_there()) return;
      const std::string url = test::PostgresServer::shared().make_database();
      (void)make_film_database(url);
      database_ = std::make_unique<DatabaseLogFiles>(film_leader(url));
    }
    files_ = database_.get();
    folder_ = "films/7";
    ASSERT_TRUE(files_->make_folder(folder_).ok());
  }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::unique_ptr<LogWriter> create(const std::string& name) {
    auto file = files_->create(path(name));
    EXPECT_TRUE(file.ok()) << (file ? "" : file.error().message);
    return file ? std::move(*file) : nullptr;
  }
  /// A file that holds this, synced.
  void make(const std::string& name, std::span<const std::byte> bytes) {
    const auto file = create(name);
    ASSERT_TRUE(file);
    const core::Status written = file->write(bytes);
    ASSERT_TRUE(written.ok()) << written.error().message;
    const core::Status synced = file->sync();
    ASSERT_TRUE(synced.ok()) << synced.error().message;
  }
  Bytes read(const std::string& name) {
    const auto file = files_->open(path(name));
    EXPECT_TRUE(file.ok()) << (file ? "" : file.error().message);
    if (!file) return {};
    Bytes bytes(static_cast<size_t>((*file)->size()));
    const core::Status done = (*file)->read(0, bytes);
    EXPECT_TRUE(done.ok()) << done.error().message;
    return bytes;
  }
  Names list() {
    auto names = files_->list(folder_);
    EXPECT_TRUE(names.ok());
    std::sort(names->begin(), names->end());
    return *names;
  }

  const test::TempFolder scratch_;
  std::unique_ptr<DatabaseLogFiles> database_;
  LogFiles* files_ = nullptr;
  std::string folder_;
};

TEST_P(LogFilesContract, AnExistingNameIsRefused) {
  make("a", bytes_of(5));
  const auto second = files_->create(path("a"));
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().message.find(path("a")), std::string::npos) << second.error().message;
  EXPECT_EQ(read("a"), bytes_of(5));
  ASSERT_TRUE(files_->remove(path("a")).ok());
  make("a", bytes_of(6));
  EXPECT_EQ(read("a"), bytes_of(6));
}

TEST_P(LogFilesContract, WhatIsMissingIsAnError) {
  make("a", bytes_of(5));
  EXPECT_FALSE(files_->open(path("b")).ok());
  EXPECT_FALSE(files_->remove(path("b")).ok());
  EXPECT_FALSE(files_->truncate(path("b"), 0).ok());
  EXPECT_FALSE(files_->rename(path("b"), path("a")).ok());
  EXPECT_EQ(read("a"), bytes_of(5));
}

TEST_P(LogFilesContract, ListsTheNamesOfOneFolder) {
  EXPECT_EQ(list(), Names());
  make("b", {});
  make("00000001.films", bytes_of(5));
  ASSERT_TRUE(files_->make_folder(folder_ + "7").ok());
  ASSERT_TRUE(files_->create(folder_ + "7/other").ok());
  EXPECT_EQ(list(), (Names{"00000001.films", "b"}));
  ASSERT_TRUE(files_->remove(path("b")).ok());
  EXPECT_EQ(list(), Names{"00000001.films"});
  EXPECT_TRUE(files_->sync_file(path("00000001.films")).ok());
  EXPECT_TRUE(files_->sync_folder(folder_).ok());
}

TEST_P(LogFilesContract, IsReadAtAnyPlace) {
  // Pieces of all sizes, with and without a sync behind them.
  const Bytes all = bytes_of(3 * kMegabyte + 12'345);
  std::mt19937 random(2);
  {
    const auto file = create("a");
    for (std::span<const std::byte> left = all; !left.empty();) {
      const size_t most = std::vector<size_t>{1, 100, 30'000, 2 * kMegabyte}[random() % 4];
      const size_t some = std::min<size_t>(left.size(), 1 + random() % most);
      ASSERT_TRUE(file->write(left.first(some)).ok());
      if (random() % 3 == 0) {
        ASSERT_TRUE(file->sync().ok());
      }
      left = left.subspan(some);
    }
    ASSERT_TRUE(file->sync().ok());
    ASSERT_TRUE(file->sync().ok()) << "of nothing";
  }
  EXPECT_EQ(read("a"), all);
  const auto file = files_->open(path("a"));
  ASSERT_TRUE(file.ok());
  ASSERT_EQ((*file)->size(), all.size());
  for (int i = 0; i < 300; ++i) {
    const size_t most = std::vector<size_t>{2, 100, 50'000, 3 * kMegabyte}[random() % 4];
    const size_t offset = random() % (all.size() + 1);
    Bytes some(std::min(all.size() - offset, random() % most));
    const core::Status done = (*file)->read(offset, some);
    ASSERT_TRUE(done.ok()) << done.error().message;
    ASSERT_TRUE(std::equal(some.begin(), some.end(), all.begin() + static_cast<ptrdiff_t>(offset)))
        << offset << " " << some.size();
  }
  Bytes beyond(2);
  EXPECT_FALSE((*file)->read(all.size() - 1, beyond).ok());
  EXPECT_FALSE((*file)->read(all.size() + 5, beyond).ok());
}

TEST_P(LogFilesContract, AReaderKnowsTheSizeAsOfWhenItWasOpened) {
  const auto file = create("a");
  ASSERT_EQ(read("a"), Bytes());
  ASSERT_TRUE(file->write(bytes_of(100)).ok());
  ASSERT_TRUE(file->sync().ok());
  const auto reader = files_->open(path("a"));
  ASSERT_TRUE(reader.ok());
  ASSERT_TRUE(file->write(bytes_of(50, 2)).ok());
  ASSERT_TRUE(file->sync().ok());
  EXPECT_EQ((*reader)->size(), 100U);
  Bytes bytes(100);
  ASSERT_TRUE((*reader)->read(0, bytes).ok());
  EXPECT_EQ(bytes, bytes_of(100));
  EXPECT_EQ(read("a").size(), 150U);
}

TEST_P(LogFilesContract, RenamingTakesThePlaceOfWhatIsThere) {
  make("old", bytes_of(2 * kMegabyte));
  make("new", bytes_of(kMegabyte + 5, 2));
  ASSERT_TRUE(files_->rename(path("new"), path("old")).ok());
  EXPECT_EQ(list(), Names{"old"});
  EXPECT_EQ(read("old"), bytes_of(kMegabyte + 5, 2));
  ASSERT_TRUE(files_->rename(path("old"), path("old")).ok());
  EXPECT_EQ(read("old"), bytes_of(kMegabyte + 5, 2));
  ASSERT_TRUE(files_->rename(path("old"), path("other")).ok());
  EXPECT_EQ(list(), Names{"other"});
}

TEST_P(LogFilesContract, IsCutAnywhere) {
  const Bytes all = bytes_of(2 * kMegabyte + 1000);
  for (const size_t size : {2 * kMegabyte + 999, 2 * kMegabyte, kMegabyte + 7, kMegabyte,
                            size_t{20'000}, size_t{2}, size_t{0}}) {
    const auto file = create("a");
    std::span<const std::byte> rest = all;
    for (const size_t some : {size_t{3}, kMegabyte - 3, kMegabyte, size_t{1000}}) {
      ASSERT_TRUE(file->write(rest.first(some)).ok());
      ASSERT_TRUE(file->sync().ok());
      rest = rest.subspan(some);
    }
    ASSERT_TRUE(files_->truncate(path("a"), size).ok());
    const Bytes left = read("a");
    ASSERT_EQ(left.size(), size);
    EXPECT_TRUE(std::equal(left.begin(), left.end(), all.begin())) << size;
    // Once more within what was cut.
    ASSERT_TRUE(files_->truncate(path("a"), size / 2).ok());
    EXPECT_EQ(read("a").size(), size / 2);
    ASSERT_TRUE(files_->remove(path("a")).ok());
  }
}

TEST_P(LogFilesContract, ALockIsHeldOnce) {
  auto lock = files_->lock(path("log.lock"));
  ASSERT_TRUE(lock.ok());
  const auto second = files_->lock(path("log.lock"));
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().message.find(path("log.lock")), std::string::npos);
  EXPECT_TRUE(files_->lock(path("other.lock")).ok());
  lock->reset();
  EXPECT_TRUE(files_->lock(path("log.lock")).ok());
}

TEST_P(LogFilesContract, ManyFilesAtOnceAreKeptApart) {
  // By chance, against what they should be.
  std::mt19937 random(3);
  std::map<std::string, Bytes> expected;
  const auto any_name = [&] { return "file" + std::to_string(random() % 4); };
  for (int i = 0; i < 120; ++i) {
    const std::string name = any_name();
    const bool there = expected.contains(name);
    switch (random() % 4) {
      case 0:
        if (!there) {
          expected[name] = bytes_of(random() % 2 == 0 ? random() % 100 : random() % 40'000,
                                    static_cast<uint64_t>(i));
          make(name, expected[name]);
        } else {
          ASSERT_FALSE(files_->create(path(name)).ok());
        }
        break;
      case 1: {
        const std::string to = any_name();
        ASSERT_EQ(files_->rename(path(name), path(to)).ok(), there);
        if (there && name != to) {
          expected[to] = std::move(expected[name]);
          expected.erase(name);
        }
        break;
      }
      case 2:
        if (there) {
          expected[name].resize(random() % (expected[name].size() + 1));
          ASSERT_TRUE(files_->truncate(path(name), expected[name].size()).ok());
        }
        break;
      default:
        if (random() % 3 != 0) break;
        ASSERT_EQ(files_->remove(path(name)).ok(), there);
        expected.erase(name);
    }
    Names names;
    for (const auto& [known, bytes] : expected) {
      names.push_back(known);
      ASSERT_EQ(read(known), bytes) << known << " after " << i;
    }
    ASSERT_EQ(list(), names);
  }
}

INSTANTIATE_TEST_SUITE_P(, LogFilesContract, testing::Values("disk", "sqlite", "postgres"),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace hyades::coordinator
