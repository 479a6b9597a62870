// Jobs of a great many frames and outputs hold nobody up.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "coordinator/job_store/contributor_rows.h"
#include "coordinator/job_store/frame_rows.h"
#include "coordinator/job_store/job_store.h"
#include "coordinator/job_store/output_rows.h"
#include "coordinator/job_store/removals.h"
#include "coordinator/job_store/schema.h"
#include "tests/coordinator/job_store/store_place.h"
#include "tests/coordinator/sql/postgres_server.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

StoredJob job_of(const std::string& owner, const std::string& key = {}) {
  StoredJob job;
  job.owner = owner;
  job.key = key;
  return job;
}

std::vector<StoredOutput> many_outputs(int32_t count) {
  std::vector<StoredOutput> outputs;
  for (int32_t i = 0; i < count; ++i) {
    outputs.push_back({fmt::format("film.mp4.frames/{:06}.png", i), i, 9, "sha"});
  }
  return outputs;
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

int64_t rows_of(SqlConnection& db, const std::string& table) {
  Query rows(db, "SELECT COUNT(*) FROM " + table);
  return rows.next() ? rows.integer(0) : -1;
}

/// With a store in each engine.
class LargeJobsOf : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string engine = GetParam();
    if (engine == "postgres" && !test::postgres_is_there()) return;
    place_ = std::make_unique<StorePlace>(engine);
    store_ = place_->open();
  }
  std::unique_ptr<StorePlace> place_;
  std::unique_ptr<JobStore> store_;
};

TEST_P(LargeJobsOf, AreGoneAtOnceForAllWhoAsk) {
  const std::string key(16, 'k');
  ASSERT_TRUE(store_->add_job(job_of("ada", key)).ok());
  const StoredFrame over{0, true, "", "class", 0, {"worker"}, 1};
  ASSERT_TRUE(store_->frame_over(1, over, many_outputs(10)).ok());
  ASSERT_TRUE(store_->add_lines(1, std::vector<StoredLine>(10)).ok());
  ASSERT_TRUE(store_->remove_job(1).ok());
  const auto is_gone = [&] {
    EXPECT_FALSE(store_->job(1)->has_value());
    EXPECT_FALSE(store_->state(1)->has_value());
    EXPECT_FALSE(store_->job_of_key(key)->has_value());
    EXPECT_TRUE(store_->open_jobs()->empty());
    EXPECT_TRUE(store_->frames(1)->empty());
    EXPECT_TRUE(store_->outputs(1, 0, 100)->empty());
    EXPECT_TRUE(store_->outputs_of(1, 0)->empty());
    EXPECT_FALSE(store_->output(1, "film.mp4.frames/000000.png")->has_value());
    EXPECT_TRUE(store_->lines(1, 0, 100)->empty());
    EXPECT_TRUE(store_->mark_divergent({"worker", "why"}, 0, {})->empty());
    EXPECT_TRUE(store_->suspect_frames(1, 10)->empty());
    EXPECT_FALSE(store_->add_lines(1, std::vector<StoredLine>(1)).ok());
    EXPECT_FALSE(store_->change_outputs(1, {}, many_outputs(1)).ok());
    EXPECT_FALSE(store_->frame_over(1, over, {}).ok());
  };
  is_gone();
  store_.reset();  // killed before anything of it was dropped
  store_ = place_->open();
  is_gone();
  while (*store_->drop_removed(3)) is_gone();
  EXPECT_EQ(store_->add_job(job_of("ada", key))->id, 2U);
  store_.reset();
  const auto db = place_->open_raw();
  for (const char* table : {"outputs", "frames", "parts", "lines", "removals"}) {
    EXPECT_EQ(rows_of(*db, table), 0) << table;
  }
  EXPECT_EQ(rows_of(*db, "specs"), 1) << "the new job's";
}

TEST_P(LargeJobsOf, ShowWhatTheyAskForPageByPage) {
  StoredJob job = job_of("ada");
  job.spec = std::string(1000, 's');
  for (int i = 0; i < 7; ++i) ASSERT_TRUE(store_->add_job(job).ok());
  ASSERT_TRUE(store_->remove_job(4).ok());
  std::vector<std::vector<uint64_t>> pages;
  for (uint64_t after = 0;; after = pages.back().back()) {
    const auto page = store_->specs(after, 1500);
    ASSERT_TRUE(page.ok());
    if (page->empty()) break;
    pages.emplace_back();
    for (const StoredSpec& one : *page) pages.back().push_back(one.id);
  }
  EXPECT_EQ(pages, (std::vector<std::vector<uint64_t>>{{1, 2}, {3, 5}, {6, 7}}));
  EXPECT_EQ(store_->specs(0, 0)->size(), 1U);
}

INSTANTIATE_TEST_SUITE_P(, LargeJobsOf, testing::Values("sqlite", "postgres"),
                         [](const auto& engine) { return std::string(engine.param); });

/// With a store in SQLite, which tells what it has done for what.
class LargeJobs : public testing::Test {
 protected:
  void SetUp() override { open_store(); }
  void open_store() {
    auto opened = open_sqlite_job_store(path_);
    ASSERT_TRUE(opened.ok()) << (opened ? "" : opened.error().message);
    store_ = std::move(*opened);
  }
  void open_raw() {
    store_.reset();
    auto opened = open_job_database(path_);
    ASSERT_TRUE(opened.ok());
    db_ = std::move(*opened);
  }
  int64_t count(const std::string& table) const { return rows_of(*db_, table); }
  /// Steps of SQLite's machine that `what` takes, in hundreds.
  int steps_of(const std::function<void()>& what) const {
    int hundreds = 0;
    const auto note = [](void* count) { return ++*static_cast<int*>(count) < 0 ? 1 : 0; };
    sqlite3_progress_handler(db_->get(), 100, note, &hundreds);
    what();
    sqlite3_progress_handler(db_->get(), 0, nullptr, nullptr);
    return hundreds;
  }
  /// Questions of others that are answered while `what` goes on.
  int answered_while(const std::function<void()>& what) {
    std::atomic<int> answered{0};
    std::atomic<bool> over{false};
    std::thread others([&] {
      while (!over) {
        EXPECT_TRUE(store_->state(1).ok());
        ++answered;
        // So that they do not keep `what` from its turn.
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    while (answered == 0) std::this_thread::yield();
    const int before = answered;
    what();
    const int during = answered - before;
    over = true;
    others.join();
    return during;
  }

  const test::TempFolder folder_;
  const std::string path_ = folder_.file("state.db");
  std::unique_ptr<JobStore> store_;
  std::unique_ptr<SqliteConnection> db_;
};

TEST_F(LargeJobs, GoInPieces) {
  for (const char* owner : {"ada", "eve"}) ASSERT_TRUE(store_->add_job(job_of(owner)).ok());
  for (const uint64_t job : {1, 2}) {
    ASSERT_TRUE(store_->change_outputs(job, {}, many_outputs(2500)).ok());
    for (int32_t frame = 0; frame < 20; ++frame) {
      const StoredFrame over{frame, true, "", "class", 0, {"worker"}, 1};
      ASSERT_TRUE(store_->frame_over(job, over, {}).ok());
    }
    ASSERT_TRUE(store_->add_lines(job, std::vector<StoredLine>(30)).ok());
  }
  open_raw();
  int before = sqlite3_total_changes(db_->get());
  ASSERT_TRUE(mark_removed(*db_, 1).ok());
  EXPECT_LT(sqlite3_total_changes(db_->get()) - before, 5) << "in the one step that is waited for";
  int pieces = 0;
  for (bool more = true; more; ++pieces) {
    before = sqlite3_total_changes(db_->get());
    const auto dropped = drop_removed_rows(*db_, 500);
    ASSERT_TRUE(dropped.ok());
    EXPECT_LE(sqlite3_total_changes(db_->get()) - before, 501);
    more = *dropped;
  }
  EXPECT_GE(pieces, 5);
  EXPECT_EQ(count("outputs"), 2480) << "another job's";
  EXPECT_EQ(count("frames"), 20);
  EXPECT_EQ(count("parts"), 20);
  EXPECT_EQ(count("lines"), 30);
  EXPECT_EQ(count("specs"), 1);
  EXPECT_EQ(count("removals"), 0);
}

TEST_F(LargeJobs, AreReadInTurnsWithOthers) {
  constexpr int32_t kMany = 60'000;
  ASSERT_TRUE(store_->add_job(job_of("ada")).ok());
  ASSERT_TRUE(store_->change_outputs(1, {}, many_outputs(kMany)).ok());
  size_t read = 0;
  EXPECT_GE(answered_while([&] { read = store_->outputs(1, 0, UINT32_MAX)->size(); }), 25);
  EXPECT_EQ(read, static_cast<size_t>(kMany));
  EXPECT_EQ(store_->outputs(1, 7, 2500)->size(), 2500U);
  EXPECT_EQ(store_->outputs(1, 0, 2000)->back().number, 2000U);
}

TEST_F(LargeJobs, BeginAgainInTurnsWithOthers) {
  ASSERT_TRUE(store_->add_job(job_of("ada")).ok());
  open_raw();
  {
    Transaction all(*db_);
    for (int32_t frame = 0; frame < 20'000; ++frame) {
      const bool done = frame % 3 == 0;
      ASSERT_TRUE(put_frame(*db_, 1, {frame, done, "why", "class", 0, {"worker"}, 1}).ok());
    }
    ASSERT_TRUE(all.commit().ok());
  }
  db_.reset();
  open_store();
  EXPECT_GE(answered_while([&] { ASSERT_TRUE(store_->forget_failed_frames(1).ok()); }), 10);
  const auto left = store_->frames(1);
  EXPECT_EQ(left->size(), 6667U);
  EXPECT_TRUE(std::all_of(left->begin(), left->end(), [](const auto& f) { return f.done; }));
}

TEST_F(LargeJobs, AreListedAndChangedWithoutTheirSpecs) {
  constexpr uint64_t kSpec = uint64_t{1} << 20U;
  constexpr uint64_t kJobs = 40;
  StoredJob job = job_of("ada");
  job.spec = std::string(kSpec, 's');
  for (uint64_t i = 0; i < kJobs; ++i) ASSERT_TRUE(store_->add_job(job).ok());
  store_.reset();
  open_store();  // nothing is in its memory
  const auto read_by = [](const std::function<void()>& what) {
    const uint64_t before = bytes_read();
    what();
    return bytes_read() - before;
  };
  EXPECT_LT(read_by([&] { EXPECT_EQ(store_->list(true, "", 0, 100)->size(), kJobs); }), kSpec);
  EXPECT_LT(read_by([&] { EXPECT_TRUE(store_->list(true, "eve", 0, 100)->empty()); }), kSpec);
  EXPECT_LT(read_by([&] {
              auto one = **store_->summary(7);
              EXPECT_TRUE(one.spec.empty());
              one.state = StoredState::done;
              EXPECT_TRUE(store_->update_job(one).ok());
            }),
            kSpec);
  EXPECT_EQ((*store_->job(7))->spec, job.spec);
}

TEST_F(LargeJobs, OfOthersAreNotLookedThroughForAnOwners) {
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(store_->add_job(job_of(i == 250 ? "eve" : "ada")).ok());
  open_raw();
  const auto plan = [&](const std::string& what) {
    Query rows(*db_, "EXPLAIN QUERY PLAN SELECT * FROM jobs WHERE id < 1000 AND " + what +
                         " ORDER BY id DESC LIMIT 10");
    return rows.next() ? rows.bytes(3) : "";
  };
  EXPECT_NE(plan("owner = 'eve'").find("jobs_of_owner"), std::string::npos);
  EXPECT_EQ(plan("state < 3").find("jobs_of_owner"), std::string::npos);
}

TEST_F(LargeJobs, AreNotSearchedForOneOutput) {
  ASSERT_TRUE(store_->add_job(job_of("ada")).ok());
  ASSERT_TRUE(store_->change_outputs(1, {}, many_outputs(20'000)).ok());
  open_raw();
  EXPECT_LT(steps_of([&] { EXPECT_TRUE(delete_outputs(*db_, 1, {"film.mp4"}).ok()); }), 5);
  EXPECT_EQ(count("outputs"), 20'000);
}

TEST_F(LargeJobs, AreLookedThroughInTurnsWithOthersForWhatAWorkerDid) {
  constexpr int32_t kMany = 60'000;
  ASSERT_TRUE(store_->add_job(job_of("ada")).ok());
  ASSERT_TRUE(store_->add_job(job_of("ada")).ok());
  open_raw();
  {
    Transaction all(*db_);
    for (int32_t frame = 0; frame < kMany; ++frame) {
      const std::string worker = frame % 1000 == 0 ? "divergent" : "good";
      ASSERT_TRUE(put_frame(*db_, 2, {frame, true, "", "", 0, {worker}, 5}).ok());
    }
    ASSERT_TRUE(all.commit().ok());
  }
  db_.reset();
  open_store();
  // Frames that are finished meanwhile, before those that are looked at.
  std::atomic<bool> over{false};
  std::atomic<int32_t> finished{0};
  std::thread others([&] {
    while (!over) {
      EXPECT_TRUE(store_->frame_over(1, {finished, true, "", "", 0, {"divergent"}, 6}, {}).ok());
      ++finished;
    }
  });
  std::vector<SuspectFrames> suspects;
  EXPECT_GE(answered_while([&] {
              suspects = *store_->mark_divergent({"divergent", "why"}, 4, {1, 2, {}, "", ""});
            }),
            10);
  while (finished < 100) std::this_thread::yield();
  over = true;
  others.join();
  ASSERT_EQ(suspects.size(), 2U);
  EXPECT_EQ(suspects[1].frames.size(), static_cast<size_t>(kMany) / 1000);
  // Of the others all up to some moment are suspect, and it was not the first.
  const auto frames = store_->frames(1);
  size_t suspect = 0;
  while (suspect < frames->size() && frames->at(suspect).suspect) ++suspect;
  EXPECT_GT(suspect, 1U);
  EXPECT_EQ(suspects[0].frames.size(), suspect) << "none after one that is not";
}

}  // namespace
}  // namespace hyades::coordinator
