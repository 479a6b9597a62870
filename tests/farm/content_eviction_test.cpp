#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "tests/farm/content_testing.h"
#include "tests/support/temp_folder.h"

namespace hyades::farm {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;

std::string text(char letter, size_t size = 1000) { return std::string(size, letter); }

/// Makes the file look last used (and written) `seconds` ago.
void age(const std::string& path, int64_t seconds) {
  const timespec then{std::time(nullptr) - seconds, 0};
  const timespec times[2] = {then, then};
  ASSERT_EQ(::utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
}

TEST(ContentEviction, WhatWasNotUsedForLongestGoes) {
  const TempFolder folder;
  const auto store = open_store(folder.file("cache"), 3500);
  const std::string a = put(*store, text('a'));
  const std::string b = put(*store, text('b'));
  const std::string c = put(*store, text('c'));
  age(folder.file("cache/" + a), 30);
  age(folder.file("cache/" + b), 20);
  age(folder.file("cache/" + c), 10);
  EXPECT_TRUE(store->read(a));  // used now
  put(*store, text('d'));
  EXPECT_TRUE(store->contains(a, 1000));
  EXPECT_FALSE(store->contains(b, 1000));
  EXPECT_TRUE(store->contains(c, 1000));
}

TEST(ContentEviction, PinnedFilesStayAcrossProcesses) {
  const TempFolder folder;
  const auto store = open_store(folder.file("cache"), 2500);
  const auto other = open_store(folder.file("cache"), 2500);  // as another process would
  const std::string a = put(*store, text('a'));
  const std::string b = put(*store, text('b'));
  age(folder.file("cache/" + a), 30);
  auto pinned = std::make_optional(store->pin(a));
  ASSERT_TRUE(*pinned) << error_of(*pinned);
  put(*other, text('c'));
  EXPECT_TRUE(store->contains(a, 1000));
  EXPECT_FALSE(store->contains(b, 1000));
  const auto also = store->pin(name_of(text('c')));
  ASSERT_TRUE(also);
  EXPECT_NE(error_of(other->write(name_of(text('d')), 1000)).find("in use"), std::string::npos);
  pinned.reset();
  put(*other, text('d'));
  EXPECT_FALSE(store->contains(a, 1000));
  EXPECT_FALSE(store->pin(a));
}

TEST(ContentEviction, AFileBeyondTheBudgetIsRefused) {
  const TempFolder folder;
  const auto store = open_store(folder.file("cache"), 1000);
  EXPECT_NE(error_of(store->write(name_of("x"), 1001)).find("larger than the whole budget"),
            std::string::npos);
  put(*store, text('a'));
}

TEST(ContentEviction, UnfinishedFilesCountAndGo) {
  const TempFolder folder;
  const auto store = open_store(folder.file("cache"), 2500);
  const std::string begun = name_of(text('x', 2000));
  {
    auto writer = store->write(begun, 2000);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->append(bytes_of(text('x', 1900))));
    // What a writer has still to write is spoken for.
    EXPECT_FALSE(store->write(name_of(text('y')), 1000));
  }
  {
    // Its own bytes are no obstacle to going on.
    const auto writer = store->write(begun, 2000);
    ASSERT_TRUE(writer) << error_of(writer);
    EXPECT_EQ(writer->offset(), 1900U);
  }
  put(*store, text('y'));
  EXPECT_FALSE(fs::exists(folder.file("cache/partial/" + begun)));
}

TEST(ContentEviction, OldUnfinishedFilesAreSwept) {
  const TempFolder folder;
  open_store(folder.file("assets"));
  const std::string old = folder.file("assets/partial/" + name_of("old"));
  const std::string young = folder.file("assets/partial/" + name_of("young"));
  const std::string foreign = folder.file("assets/partial/notes.txt");
  for (const std::string& path : {old, young, foreign}) std::ofstream(path) << "x";
  age(old, 4 * 24 * 3600);
  age(young, 2 * 24 * 3600);
  age(foreign, 4 * 24 * 3600);
  open_store(folder.file("assets"));
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(young));
  EXPECT_TRUE(fs::exists(foreign));
}

TEST(ContentEviction, WhereRoomIsWantedUnfinishedFilesOfNobodyGoOldestFirst) {
  const TempFolder folder;
  const auto store = open_store(folder.file("assets"));
  const std::string whole = put(*store, text('w'));
  const auto begin = [&](char letter) {
    auto writer = store->write(name_of(text(letter)), 1000);
    EXPECT_TRUE(writer && writer->append(bytes_of(text(letter, 900))));
    return writer;
  };
  const auto path = [&](char letter) {
    return folder.file("assets/partial/" + name_of(text(letter)));
  };
  for (const char letter : {'a', 'b', 'c', 'd'}) (void)begin(letter);
  const auto writing = begin('e');
  age(path('a'), 300);
  age(path('b'), 400);
  age(path('c'), 200);
  age(path('d'), 10);
  age(path('e'), 500);
  EXPECT_EQ(store->free_partials(1000), 1800U);
  EXPECT_FALSE(fs::exists(path('b')));
  EXPECT_FALSE(fs::exists(path('a')));
  EXPECT_TRUE(fs::exists(path('c'))) << "no more than is wanted";
  EXPECT_EQ(store->free_partials(100'000), 900U);
  EXPECT_FALSE(fs::exists(path('c')));
  EXPECT_TRUE(fs::exists(path('d'))) << "its next piece may be on the way";
  EXPECT_TRUE(fs::exists(path('e'))) << "somebody writes it";
  EXPECT_TRUE(store->contains(whole, 1000));
}

std::unique_ptr<ContentStore> open_listed(const std::string& folder, uint64_t budget,
                                          std::chrono::milliseconds list_every) {
  ContentStore::Options options{folder, budget};
  options.list_every = list_every;
  auto store = ContentStore::open(options);
  EXPECT_TRUE(store) << error_of(store);
  return store ? std::move(*store) : nullptr;
}

TEST(ContentEviction, AStoreWithRoomIsNotListedForEachFile) {
  const TempFolder folder;
  const auto rarely = open_listed(folder.file("cache"), 10'000, std::chrono::hours(1));
  const auto always = open_listed(folder.file("cache"), 10'000, std::chrono::milliseconds(0));
  put(*rarely, text('a'));
  // As nobody does who writes by a store: only who lists knows of it.
  const std::string stray = folder.file("cache/" + name_of("stray"));
  std::ofstream(stray) << text('s', 9500);
  age(stray, 100);
  put(*rarely, text('b'));
  EXPECT_TRUE(fs::exists(stray));
  put(*always, text('c'));
  EXPECT_FALSE(fs::exists(stray)) << "in time it is found";
}

TEST(ContentEviction, WhatOthersWriteCountsThoughNobodyLists) {
  const TempFolder folder;
  const auto one = open_listed(folder.file("cache"), 10'000, std::chrono::hours(1));
  const auto other = open_listed(folder.file("cache"), 10'000, std::chrono::hours(1));
  for (int i = 0; i < 40; ++i) {
    put(i % 3 == 0 ? *one : *other, text('a', 900) + std::to_string(i));
    ASSERT_LE(one->used(), 10'000U) << i;
  }
}

TEST(ContentEviction, AStoreWhoseCountWasLostIsListed) {
  const TempFolder folder;
  const auto store = open_listed(folder.file("cache"), 10'000, std::chrono::hours(1));
  for (char c = 'a'; c < 'a' + 5; ++c) put(*store, text(c));
  fs::remove(folder.file("cache/lock"));
  for (char c = 'f'; c < 'f' + 6; ++c) put(*store, text(c));
  EXPECT_LE(store->used(), 10'000U);
}

TEST(ContentEviction, AFullStoreGetsRoomForMoreThanOneFile) {
  const TempFolder folder;
  const auto store = open_listed(folder.file("cache"), 16'000, std::chrono::hours(1));
  for (char c = 'a'; c < 'a' + 16; ++c) put(*store, text(c));
  EXPECT_EQ(store->used(), 16'000U);
  put(*store, text('z'));
  EXPECT_EQ(store->used(), 15'000U);
  EXPECT_TRUE(store->contains(name_of(text('z')), 1000));
}

TEST(ContentEviction, OtherPeoplesFilesStay) {
  const TempFolder folder;
  std::ofstream(folder.file("thesis.tex")) << text('t', 5000);
  const auto store = open_store(folder.path().string(), 1500);
  put(*store, text('a'));
  put(*store, text('b'));
  EXPECT_TRUE(fs::exists(folder.file("thesis.tex")));
}

TEST(ContentEviction, WithoutABudgetNothingGoes) {
  const TempFolder folder;
  const auto store = open_store(folder.file("assets"));
  for (char c = 'a'; c <= 'z'; ++c) put(*store, text(c));
  for (char c = 'a'; c <= 'z'; ++c) EXPECT_TRUE(store->contains(name_of(text(c)), 1000));
}

}  // namespace
}  // namespace hyades::farm
