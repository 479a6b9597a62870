#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include "coordinator/film_store/segment.h"
#include "tests/coordinator/film_store/log_testing.h"

namespace hyades::coordinator {
namespace {

using Texts = std::vector<std::string>;
const char* const kFirstSegment = "log/00000001.films";

/// A closed log of three records of different lengths in one segment.
void make_three(FaultyFiles& files) {
  Opened opened = open_log(files);
  for (const std::string& text :
       {std::string("first"), std::string(90, 's'), std::string("third")}) {
    ASSERT_TRUE(opened.log->append(record_of(text)));
  }
}
const Texts kThree = {"first", std::string(90, 's'), "third"};

TEST(FilmLogFaults, TornAtAnyByteKeepsWholeRecordsAndGoesOn) {
  FaultyFiles whole;
  make_three(whole);
  const size_t size = whole.bytes(kFirstSegment).size();
  const size_t third = size - kRecordHeaderBytes - 5;
  const size_t second = third - kRecordHeaderBytes - 90;
  const size_t first = second - kRecordHeaderBytes - 5;
  for (size_t cut = 0; cut < size; ++cut) {
    FaultyFiles files;
    make_three(files);
    files.bytes(kFirstSegment).resize(cut);
    Texts expected;
    size_t good = kSegmentHeaderBytes;
    if (cut >= second) expected.push_back(kThree[0]), good = second;
    if (cut >= third) expected.push_back(kThree[1]), good = third;
    ASSERT_EQ(first, kSegmentHeaderBytes);
    {
      Opened opened = open_log(files);
      ASSERT_EQ(opened.records, expected) << cut;
      ASSERT_EQ(opened.report.torn_bytes, cut > good ? cut - good : 0);
      ASSERT_EQ(opened.report.damaged_bytes, 0U);
      ASSERT_TRUE(opened.log->append(record_of("fourth")));
    }
    expected.push_back("fourth");
    Opened again = open_log(files);
    ASSERT_EQ(again.records, expected) << cut;
    ASSERT_EQ(again.report.torn_bytes + again.report.damaged_bytes, 0U) << "the tail was cut off";
  }
}

TEST(FilmLogFaults, AFlippedBitCostsAtMostTheRecordItIsIn) {
  FaultyFiles whole;
  make_three(whole);
  const size_t size = whole.bytes(kFirstSegment).size();
  const size_t third = size - kRecordHeaderBytes - 5;
  const size_t second = third - kRecordHeaderBytes - 90;
  for (size_t at = 0; at < size; ++at) {
    for (const int bit : {0, 3, 7}) {
      FaultyFiles files;
      make_three(files);
      files.bytes(kFirstSegment)[at] ^= std::byte{1} << bit;
      Texts expected = kThree;
      if (at >= kSegmentHeaderBytes)
        expected.erase(expected.begin() + (at >= second) + (at >= third));
      Opened opened = open_log(files);
      ASSERT_EQ(opened.records, expected) << at;
      ASSERT_EQ(opened.report.damaged_bytes + opened.report.torn_bytes > 0,
                at >= kSegmentHeaderBytes);
    }
  }
}

TEST(FilmLogFaults, FindsItsWayThroughGarbage) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    FaultyFiles files;
    make_three(files);
    std::vector<std::byte>& bytes = files.bytes(kFirstSegment);
    const size_t third = bytes.size() - kRecordHeaderBytes - 5;
    std::vector<std::byte> garbage(1 + random() % 700000);  // longer than the search window too
    for (std::byte& b : garbage) b = static_cast<std::byte>(random() % 256);
    const uint32_t magic = 0x31524648;  // looks like a record now and then
    for (size_t i = 0; i + 4 < garbage.size(); i += 997) std::memcpy(&garbage[i], &magic, 4);
    bytes.insert(bytes.begin() + static_cast<ptrdiff_t>(third), garbage.begin(), garbage.end());
    Opened opened = open_log(files);
    ASSERT_EQ(opened.records, kThree);
    ASSERT_EQ(opened.report.damaged_bytes, garbage.size());
    ASSERT_EQ(opened.report.problems.size(), 1U);
  }
}

TEST(FilmLogFaults, RecordsOfAnotherLogAreNotTaken) {
  FaultyFiles files;
  FaultyFiles other;
  make_three(files);
  make_three(other);
  files.bytes(kFirstSegment) = other.bytes(kFirstSegment);
  EXPECT_TRUE(open_log(files).records.empty());
}

TEST(FilmLogFaults, ANewerVersionIsRefusedNotReinterpreted) {
  FaultyFiles files;
  make_three(files);
  std::vector<std::byte>& bytes = files.bytes(kFirstSegment);
  auto header = *decode_segment_header(bytes);
  header.version = kSegmentVersion + 1;
  const auto encoded = encode_segment_header(header);
  std::copy(encoded.begin(), encoded.end(), bytes.begin());
  auto log = FilmLog::open(kFolder, "key", options_with(files));
  const auto report = (*log)->replay([](std::span<const std::byte>) { return core::Status(); });
  ASSERT_FALSE(report.ok());
  EXPECT_NE(report.error().message.find("newer version"), std::string::npos);
}

TEST(FilmLogFaults, AFailedSyncIsNotBelievedTheSecondTime) {
  FaultyFiles files;
  std::mt19937 random(1);
  int troubles = 0;
  {
    FilmLogOptions options = options_writing_at_sync(files);
    options.on_trouble = [&troubles](const core::Error& error) {
      EXPECT_EQ(error.message, "input/output error");
      ++troubles;
    };
    Opened opened = open_log(options);
    ASSERT_TRUE(opened.log->append(record_of("one")));
    ASSERT_TRUE(opened.log->sync().ok());
    files.fail_next_sync();
    ASSERT_TRUE(opened.log->append(record_of("two")));
    EXPECT_FALSE(opened.log->sync().ok());
    EXPECT_EQ(opened.log->durable(), 1U);
    ASSERT_TRUE(opened.log->append(record_of("three")));
    EXPECT_TRUE(opened.log->sync().ok());
    EXPECT_EQ(opened.log->durable(), 3U);
    files.fail_from_operation(0);
  }
  EXPECT_EQ(troubles, 1);
  files.crash(random);
  EXPECT_EQ(open_log(files).records, (Texts{"one", "two", "three"}));
}

TEST(FilmLogFaults, AGroupThatWasWrittenTwiceCountsOnce) {
  FaultyFiles files;
  const FilmLogOptions options = options_writing_at_sync(files);
  {
    Opened opened = open_log(options);
    ASSERT_TRUE(opened.log->append(record_of("one")));
    ASSERT_TRUE(opened.log->sync().ok());
    files.fail_next_sync();
    files.fail_next_truncate();  // so that its first copy stays
    ASSERT_TRUE(opened.log->append(record_of("two")));
    ASSERT_FALSE(opened.log->sync().ok());
    ASSERT_TRUE(opened.log->sync().ok());
  }
  EXPECT_EQ(open_log(files).records, (Texts{"one", "two"}));
}

TEST(FilmLogFaults, AFullDiskStopsNothingForGood) {
  FaultyFiles files;
  FilmLogOptions options = options_with(files);
  options.max_pending_bytes = 1000;
  {
    Opened opened = open_log(options);
    ASSERT_TRUE(opened.log->append(record_of("one")));
    ASSERT_TRUE(opened.log->sync().ok());
    files.set_capacity(200);
    ASSERT_TRUE(opened.log->append(record_of(std::string(600, 'x'))));
    const core::Status full = opened.log->sync();
    ASSERT_FALSE(full.ok());
    EXPECT_EQ(full.error().message, "no space left");
    const auto refused = opened.log->append(record_of(std::string(600, 'y')));
    ASSERT_FALSE(refused.ok()) << "memory is bounded";
    EXPECT_NE(refused.error().message.find("no space left"), std::string::npos);
    files.set_capacity(UINT64_MAX);
    EXPECT_TRUE(opened.log->sync().ok());
    ASSERT_TRUE(opened.log->append(record_of("three")));
  }
  EXPECT_EQ(open_log(files).records, (Texts{"one", std::string(600, 'x'), "three"}));
}

TEST(FilmLogFaults, AShortWriteLeavesOneCopy) {
  for (size_t budget = 0; budget < 40; ++budget) {
    FaultyFiles files;
    {
      Opened opened = open_log(options_writing_at_sync(files));
      ASSERT_TRUE(opened.log->append(record_of("one")));
      ASSERT_TRUE(opened.log->sync().ok());
      files.fail_next_write_after(budget);
      ASSERT_TRUE(opened.log->append(record_of("two")));
      ASSERT_EQ(opened.log->sync().ok(), budget >= kRecordHeaderBytes + 3);
      ASSERT_TRUE(opened.log->sync().ok());
    }
    ASSERT_EQ(open_log(files).records, (Texts{"one", "two"}));
  }
}

/// What one run of the crash test appended, and what the log called durable.
struct Story {
  std::set<std::string> appended;
  std::set<std::string> acknowledged;
};

/// The records that a replay gave, those that snapshots name among them.
std::multiset<std::string> records_in(const Texts& replayed) {
  std::multiset<std::string> found;
  for (const std::string& records : replayed) {
    for (size_t at = 0; at < records.size();) {
      const size_t end = records.find(';', at) + 1;
      found.insert(records.substr(at, end - at));
      at = end;
    }
  }
  return found;
}

/// Appends, syncs, compacts and restarts until the power goes. A snapshot's record names all the
/// records that it stands for.
void live(FaultyFiles& files, Story& story, uint32_t seed, bool failing_disk) {
  std::mt19937 random(seed);
  FilmLogOptions options = options_writing_at_sync(files);  // so that a seed means one life
  options.segment_bytes = 150;
  int next = 0;
  for (int run = 0; run < 3; ++run) {
    auto log = FilmLog::open(kFolder, "key", options);
    if (!log) return;
    Texts held;  // all that is in the log, in order of number or by snapshot
    const auto report = (*log)->replay([&](std::span<const std::byte> record) {
      held.push_back(text_of(record));
      return core::Status();
    });
    if (!report) return;
    for (int step = 0; step < 12; ++step) {
      const std::string text = std::to_string(seed) + "/" + std::to_string(next++) + ";";
      story.appended.insert(text);
      const auto number = (*log)->append(record_of(text));
      held.push_back(text);
      if (failing_disk && random() % 8 == 0) files.fail_next_sync();
      if (failing_disk && random() % 8 == 0) files.fail_next_truncate();
      if (random() % 3 != 0) continue;
      if (!(*log)->sync()) continue;
      for (const std::string& record : records_in(held)) story.acknowledged.insert(record);
      if (random() % 3 == 0) {
        std::string all;
        for (const std::string& records : held) all += records;
        const core::Status compacted = (*log)->compact(
            *number, [&](const FilmLog::Sink& sink) { return sink(record_of(all)); });
        if (compacted) held = {all};
      }
    }
  }
}

/// Opens the log and checks it: all that was acknowledged is there, exactly once, and nothing
/// unknown. What it gave counts as acknowledged from now on.
void check_after_restart(FaultyFiles& files, Story& story) {
  const Opened opened = open_log(files);
  ASSERT_TRUE(opened.log);
  const std::multiset<std::string> found = records_in(opened.records);
  for (const std::string& text : story.acknowledged) ASSERT_EQ(found.count(text), 1U) << text;
  for (const std::string& text : found) {
    ASSERT_TRUE(story.appended.count(text)) << text;
    ASSERT_EQ(found.count(text), 1U) << text;
    story.acknowledged.insert(text);
  }
}

/// The power fails at every single operation of a life with restarts, failing syncs, rotation and
/// compaction; then again after the first repair.
TEST(FilmLogFaults, WhatWasAcknowledgedSurvivesACrashAtAnyOperation) {
  int crashes = 0;
  for (uint32_t seed = 0; seed < 8; ++seed) {
    for (uint64_t stop = 1;; ++stop, ++crashes) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", operation " + std::to_string(stop));
      FaultyFiles files;
      Story story;
      files.fail_from_operation(stop);
      live(files, story, seed, true);
      const bool survived = files.operations() <= stop;
      std::mt19937 random(seed * 1000 + static_cast<uint32_t>(stop));
      for (int again = 0; again < 2; ++again) {
        files.crash(random);
        ASSERT_NO_FATAL_FAILURE(check_after_restart(files, story));
      }
      if (survived) break;
    }
  }
  EXPECT_GT(crashes, 500);
}

/// The process is killed at every single operation; its successor reads what may not be on the
/// disk yet; then the power fails, sooner or later.
TEST(FilmLogFaults, WhatReplayGaveAfterAKillSurvivesALossOfPower) {
  for (uint32_t seed = 0; seed < 8; ++seed) {
    for (uint64_t stop = 1;; ++stop) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", operation " + std::to_string(stop));
      FaultyFiles files;
      Story story;
      files.fail_from_operation(stop);
      live(files, story, seed, false);
      const bool survived = files.operations() <= stop;
      std::mt19937 random(seed * 1000 + static_cast<uint32_t>(stop));
      files.kill();
      if (random() % 2 == 0) {
        ASSERT_NO_FATAL_FAILURE(check_after_restart(files, story));
      } else {
        files.fail_from_operation(files.operations() + random() % 8);
        if (auto log = FilmLog::open(kFolder, "key", options_with(files)); log.ok()) {
          const auto report =
              (*log)->replay([](std::span<const std::byte>) { return core::Status(); });
          ASSERT_TRUE(!report.ok() || (*log)->append(record_of("unknown;")).ok());
        }
        story.appended.insert("unknown;");
      }
      files.crash(random);
      ASSERT_NO_FATAL_FAILURE(check_after_restart(files, story));
      if (survived) break;
    }
  }
}

}  // namespace
}  // namespace hyades::coordinator
