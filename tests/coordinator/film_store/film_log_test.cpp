#include "coordinator/film_store/film_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <thread>

#include "tests/coordinator/film_store/log_testing.h"

namespace hyades::coordinator {
namespace {

using Texts = std::vector<std::string>;

std::string new_folder(const std::string& name) {
  std::string folder = ::testing::TempDir() + "hyades_film_log_" + name;
  std::filesystem::remove_all(folder);
  return folder;
}

TEST(FilmLog, GivesBackWhatWasAppended) {
  const std::string folder = new_folder("round_trip") + "/nested/";
  for (int run = 0; run < 3; ++run) {
    Opened opened = open_log(FilmLogOptions{}, folder);
    ASSERT_TRUE(opened.log);
    Texts expected;
    for (int i = 0; i < run; ++i) {
      expected.push_back("a" + std::to_string(i));
      expected.push_back(std::string(100000, static_cast<char>('x' + i)));
    }
    EXPECT_EQ(opened.records, expected);
    EXPECT_EQ(opened.report.records, expected.size());
    EXPECT_TRUE(opened.report.problems.empty());
    const auto first = opened.log->append(record_of("a" + std::to_string(run)));
    ASSERT_TRUE(first.ok());
    EXPECT_EQ(*first, 2U * static_cast<unsigned>(run) + 1);
    ASSERT_TRUE(opened.log->append(record_of(std::string(100000, static_cast<char>('x' + run)))));
    if (run == 0) {  // later ones leave it to the destructor
      ASSERT_TRUE(opened.log->sync().ok());
    }
  }
  std::filesystem::remove_all(new_folder("round_trip"));
}

TEST(FilmLog, RefusesAnotherJobsLogAndASecondUser) {
  const std::string folder = new_folder("refuse");
  {
    Opened opened = open_log(FilmLogOptions{}, folder, "job-a");
    const auto second = FilmLog::open(folder, "job-a");
    ASSERT_FALSE(second.ok());
    EXPECT_NE(second.error().message.find("is held by another process"), std::string::npos);
    EXPECT_FALSE(erase_film_log(folder).ok());
  }
  const auto other = FilmLog::open(folder, "job-b");
  ASSERT_FALSE(other.ok());
  EXPECT_NE(other.error().message.find("work of another job"), std::string::npos);
  EXPECT_NE(other.error().message.find("job-a"), std::string::npos);
  EXPECT_NE(other.error().message.find("job-b"), std::string::npos);
  EXPECT_TRUE(FilmLog::open(folder, "job-a").ok());

  const std::string foreign = folder + "/notes.txt";
  { EXPECT_TRUE(disk_log_files().create(foreign).ok()); }
  ASSERT_TRUE(erase_film_log(folder).ok());
  EXPECT_TRUE(std::filesystem::exists(foreign)) << "it removes its own files only";
  EXPECT_TRUE(FilmLog::open(folder, "job-b").ok());
  std::filesystem::remove_all(folder);
}

TEST(FilmLog, WhatCannotBeReadNowIsNeitherLostNorCutOff) {
  FaultyFiles files;
  {
    Opened opened = open_log(files);
    ASSERT_TRUE(opened.log);
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(opened.log->append(record_of(std::string(100, 'a'))));
    ASSERT_TRUE(opened.log->sync().ok());
  }
  for (const uint64_t from : {uint64_t{0}, uint64_t{20}, uint64_t{60}, uint64_t{1000}}) {
    files.refuse_to_read_from(from);
    auto log = FilmLog::open(kFolder, "key", options_with(files));
    if (!log) continue;  // not even whose it is
    const auto replayed = (*log)->replay([](auto) { return core::Status(); });
    EXPECT_FALSE(replayed.ok()) << from;
  }
  files.refuse_to_read_from(UINT64_MAX);
  EXPECT_EQ(open_log(files).records.size(), 20U);
}

TEST(FilmLog, RefusesMisuse) {
  FaultyFiles files;
  EXPECT_FALSE(FilmLog::open(kFolder, "two\nlines", options_with(files)).ok());
  auto log = FilmLog::open(kFolder, "key", options_with(files));
  ASSERT_TRUE(log.ok());
  EXPECT_FALSE((*log)->append(record_of("before replay")).ok());
  EXPECT_FALSE((*log)->compact(0, [](const auto&) { return core::Status(); }).ok());
  const auto nothing = [](std::span<const std::byte>) { return core::Status(); };
  ASSERT_TRUE((*log)->replay(nothing).ok());
  EXPECT_FALSE((*log)->replay(nothing).ok());
  EXPECT_FALSE((*log)->append({}).ok());
  EXPECT_FALSE((*log)->compact(1, [](const auto&) { return core::Status(); }).ok());
}

TEST(FilmLog, RefusesSegmentsWithoutGuard) {
  FaultyFiles files;
  {
    Opened opened = open_log(files);
    ASSERT_TRUE(opened.log->append(record_of("a")));
  }
  ASSERT_TRUE(files.remove("log/log.key").ok());
  const auto log = FilmLog::open(kFolder, "key", options_with(files));
  ASSERT_FALSE(log.ok());
  EXPECT_NE(log.error().message.find("no log.key"), std::string::npos);
}

TEST(FilmLog, BeginsNewSegmentsAndKeepsTheOrder) {
  FaultyFiles files;
  FilmLogOptions options = options_with(files);
  options.segment_bytes = 300;
  Texts expected;
  {
    Opened opened = open_log(options);
    for (int i = 0; i < 50; ++i) {
      expected.push_back("record " + std::to_string(i) + std::string(40, '.'));
      ASSERT_TRUE(opened.log->append(record_of(expected.back())));
      ASSERT_TRUE(opened.log->sync().ok());
    }
  }
  EXPECT_GT(files.paths().size(), 10U);
  EXPECT_EQ(open_log(options).records, expected);
}

TEST(FilmLog, ManyThreadsShareSyncs) {
  FaultyFiles files;
  FilmLogOptions options = options_with(files);
  options.commit_delay = std::chrono::milliseconds(2);
  std::atomic<uint64_t> told{0};
  options.on_durable = [&told](uint64_t through) {
    EXPECT_GT(through, told.load());
    told = through;
  };
  {
    Opened opened = open_log(options);
    const uint64_t before = files.syncs();
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&opened, t] {
        for (int i = 0; i < 250; ++i) {
          const auto number = opened.log->append(record_of(std::to_string(t * 1000 + i)));
          ASSERT_TRUE(number.ok());
          if (i % 50 == 49) {
            ASSERT_TRUE(opened.log->wait(*number).ok());
            ASSERT_GE(opened.log->durable(), *number);
          }
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    ASSERT_TRUE(opened.log->sync().ok());
    EXPECT_EQ(opened.log->durable(), 1000U);
    EXPECT_LT(files.syncs() - before, 200U);
  }
  EXPECT_EQ(told, 1000U);
  Texts records = open_log(files).records;
  ASSERT_EQ(records.size(), 1000U);
  for (int t = 0; t < 4; ++t) {  // each thread's own order is kept
    Texts own;
    std::copy_if(records.begin(), records.end(), std::back_inserter(own),
                 [t](const std::string& r) { return std::stoi(r) / 1000 == t; });
    for (int i = 0; i < 250; ++i)
      EXPECT_EQ(own[static_cast<size_t>(i)], std::to_string(t * 1000 + i));
  }
}

TEST(FilmLog, ReportsWhatTheVisitorRefuses) {
  FaultyFiles files;
  {
    Opened opened = open_log(files);
    for (const char* text : {"good", "bad", "fine"}) {
      ASSERT_TRUE(opened.log->append(record_of(text)));
    }
  }
  auto log = FilmLog::open(kFolder, "key", options_with(files));
  const auto report = (*log)->replay([](std::span<const std::byte> record) {
    return text_of(record) == "bad" ? core::Status(core::Error{"no film"}) : core::Status();
  });
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->records, 2U);
  ASSERT_EQ(report->problems.size(), 1U);
  EXPECT_NE(report->problems[0].find("record 2 was refused: no film"), std::string::npos);
}

TEST(FilmLog, CompactionReplacesWhatItCoversAndKeepsTheRest) {
  FaultyFiles files;
  FilmLogOptions options = options_with(files);
  options.segment_bytes = 200;
  {
    Opened opened = open_log(options);
    for (int i = 1; i <= 20; ++i) {
      ASSERT_TRUE(opened.log->append(record_of("old " + std::to_string(i) + std::string(50, '.'))));
      ASSERT_TRUE(opened.log->sync().ok());
    }
    const size_t before = files.paths().size();
    ASSERT_TRUE(opened.log
                    ->compact(17,
                              [&](const FilmLog::Sink& sink) {
                                // Appending goes on meanwhile.
                                EXPECT_TRUE(opened.log->append(record_of("new")));
                                EXPECT_TRUE(opened.log->sync().ok());
                                EXPECT_TRUE(sink(record_of("frame 1")).ok());
                                return sink(record_of("frame 2"));
                              })
                    .ok());
    EXPECT_LE(files.paths().size(), before / 2);
    ASSERT_TRUE(opened.log->append(record_of("newer")));
  }
  const auto expected = [](Texts begin) {
    for (int i = 18; i <= 20; ++i)
      begin.push_back("old " + std::to_string(i) + std::string(50, '.'));
    begin.insert(begin.end(), {"new", "newer"});
    return begin;
  };
  {
    Opened opened = open_log(options);
    EXPECT_EQ(opened.records, expected({"frame 1", "frame 2"}));
    EXPECT_TRUE(opened.report.problems.empty());
    // A snapshot that fails changes nothing.
    const core::Status failed =
        opened.log->compact(22, [](const FilmLog::Sink& sink) -> core::Status {
          EXPECT_TRUE(sink(record_of("half")).ok());
          return core::Error{"no more"};
        });
    ASSERT_FALSE(failed.ok());
    EXPECT_EQ(failed.error().message, "no more");
  }
  EXPECT_EQ(open_log(options).records, expected({"frame 1", "frame 2"}));
  {
    Opened opened = open_log(options);
    ASSERT_TRUE(
        opened.log->compact(22, [](const FilmLog::Sink& sink) { return sink(record_of("all")); })
            .ok());
    EXPECT_EQ(*opened.log->append(record_of("last")), 23U);
  }
  EXPECT_EQ(open_log(options).records, (Texts{"all", "last"}));
  // Guard, snapshot and one segment: the lock is none of the fake's files.
  EXPECT_EQ(files.paths().size(), 3U);
}

}  // namespace
}  // namespace hyades::coordinator
