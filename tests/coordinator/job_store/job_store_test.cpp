#include "coordinator/job_store/job_store.h"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "coordinator/job_store/contributor_rows.h"
#include "coordinator/job_store/database.h"
#include "coordinator/job_store/log_rows.h"
#include "core/base/wall_clock.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

StoredJob some_job(const std::string& key, const std::string& owner) {
  StoredJob job;
  job.key = key;
  job.spec = std::string("spec\0bytes", 10);
  job.name = "balls";
  job.owner = owner;
  job.priority = -3;
  job.options = std::string("options\0bytes", 13);
  job.frames = 7;
  job.samples = 1'000'000'000'000;
  job.submitted_ms = 42;
  return job;
}

std::unique_ptr<JobStore> open(const std::string& path) {
  auto store = open_sqlite_job_store(path);
  EXPECT_TRUE(store.ok()) << (store ? "" : store.error().message);
  return store ? std::move(*store) : nullptr;
}

TEST(JobStore, ASecondOneIsToldWhoIsThere) {
  const test::TempFolder folder;
  const auto first = open(folder.file("state.db"));
  const auto second = open_sqlite_job_store(folder.file("state.db"));
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().message + "/state.db",
            "another coordinator works in " + folder.file("state.db"));
}

TEST(JobStore, KeepsWhatItWasGivenOverRestarts) {
  const test::TempFolder folder;
  const std::string path = folder.file("state.db");
  {
    auto store = open(path);
    EXPECT_EQ(*store->next_incarnation(), 1U);
    const auto added = store->add_job(some_job("key", "ada"));
    ASSERT_TRUE(added.ok());
    EXPECT_EQ(added->id, 1U);
    EXPECT_FALSE(added->existed);
    ASSERT_TRUE(
        store->frame_over(1, {3, true, "", "class", 2}, {{"b.0003.exr", 3, 9, "sha"}}).ok());
    ASSERT_TRUE(store->frame_over(1, {4, false, "why", "class", 0}, {}).ok());
    ASSERT_TRUE(
        store->add_lines(1, {{5, 2, 3, "w", "text"}, {6, 1, std::nullopt, "", "more"}}).ok());
  }
  auto store = open(path);
  EXPECT_EQ(*store->next_incarnation(), 2U);
  EXPECT_EQ(*store->open_jobs(), std::vector<uint64_t>{1});
  const auto job = store->job(1);
  ASSERT_TRUE(job.ok() && job->has_value());
  const StoredJob expected = some_job("key", "ada");
  EXPECT_EQ((*job)->spec, expected.spec);
  EXPECT_EQ((*job)->name, expected.name);
  EXPECT_EQ((*job)->owner, expected.owner);
  EXPECT_EQ((*job)->priority, expected.priority);
  EXPECT_EQ((*job)->options, expected.options);
  EXPECT_EQ((*job)->samples, expected.samples);
  EXPECT_EQ((*job)->state, StoredState::running);
  const auto frames = store->frames(1);
  ASSERT_EQ(frames->size(), 2U);
  EXPECT_TRUE(frames->at(0).done);
  EXPECT_EQ(frames->at(0).restarts, 2U);
  EXPECT_EQ(frames->at(1).reason, "why");
  const auto outputs = store->outputs(1, 0, 100);
  ASSERT_EQ(outputs->size(), 1U);
  EXPECT_EQ(outputs->at(0).sha256, "sha");
  EXPECT_TRUE(store->output(1, "b.0003.exr")->has_value());
  EXPECT_FALSE(store->output(1, "../state.db")->has_value());
  const auto lines = store->lines(1, 0, 10);
  ASSERT_EQ(lines->size(), 2U);
  EXPECT_EQ(lines->at(0).frame, 3);
  EXPECT_EQ(lines->at(1).text, "more");
  EXPECT_EQ(store->lines(1, lines->at(0).number, 10)->size(), 1U);
}

TEST(JobStore, OutputsGoByNameAndFolderAndOthersComeAtOnce) {
  const test::TempFolder folder;
  auto store = open(folder.file("state.db"));
  for (const char* key : {"a", "b"}) ASSERT_TRUE(store->add_job(some_job(key, "ada")).ok());
  for (const uint64_t job : {1U, 2U}) {
    ASSERT_TRUE(store
                    ->frame_over(job, {1, true, "", "class", 0},
                                 {{"f.mp4.frames/0001.png", 1, 9, "sha"},
                                  {"f.mp4.frames2/0001.png", 1, 9, "sha"},
                                  {"a%.png", 1, 9, "sha"},
                                  {"ab.png", 1, 9, "sha"}})
                    .ok());
  }
  const auto paths = [&](uint64_t job) {
    std::vector<std::string> found;
    const auto outputs = store->outputs(job, 0, 100);
    for (const StoredOutput& output : *outputs) found.push_back(output.path);
    return found;
  };
  const uint64_t last = store->outputs(1, 0, 100)->back().number;
  ASSERT_TRUE(
      store->change_outputs(1, {"f.mp4.frames", "a%.png"}, {{"f.mp4", 3, 70, "film"}}).ok());
  EXPECT_EQ(paths(1), (std::vector<std::string>{"f.mp4.frames2/0001.png", "ab.png", "f.mp4"}));
  EXPECT_EQ(paths(2).size(), 4U);
  const auto video = store->output(1, "f.mp4");
  ASSERT_TRUE(video.ok() && video->has_value());
  EXPECT_EQ((*video)->size, 70U);
  EXPECT_GT((*video)->number, last);  // who follows hears of it
  // Putting it in the place of another is one step too.
  ASSERT_TRUE(store->change_outputs(1, {"f.mp4"}, {{"f.mp4", 3, 71, "film"}}).ok());
  EXPECT_EQ((*store->output(1, "f.mp4"))->size, 71U);
}

TEST(JobStore, OldLinesGoAndAreMissed) {
  const test::TempFolder folder;
  auto store = open(folder.file("state.db"));
  ASSERT_TRUE(store->add_job(some_job("", "ada")).ok());
  ASSERT_TRUE(store->add_job(some_job("", "bob")).ok());
  ASSERT_TRUE(store->add_lines(2, {{1, 1, std::nullopt, "", "another job's"}}).ok());
  const auto add = [&](uint64_t first, uint64_t count) {
    std::vector<StoredLine> lines;
    for (uint64_t i = first; i < first + count; ++i) {
      lines.push_back({static_cast<int64_t>(i), 1, 7, "w", "line " + std::to_string(i)});
    }
    ASSERT_TRUE(store->add_lines(1, lines).ok());
  };
  add(0, kMostLines - 10);
  EXPECT_EQ(store->lines(1, 0, 1)->at(0).text, "line 0");
  add(kMostLines - 10, 10);
  EXPECT_EQ(store->lines(1, 0, 1)->at(0).text, "line 0") << "there was room";
  add(kMostLines, 1);
  const auto lines = store->lines(1, 0, kMostLines);
  ASSERT_EQ(lines->size(), kMostLines - kLinesDropped);
  EXPECT_NE(lines->at(0).text.find("older lines were dropped"), std::string::npos);
  EXPECT_EQ(lines->at(1).text, "line " + std::to_string(kLinesDropped + 2));
  EXPECT_EQ(lines->back().text, "line " + std::to_string(kMostLines));
  EXPECT_EQ(store->lines(2, 0, 10)->size(), 1U);
}

std::vector<StoredLine> some_lines(uint64_t count) {
  std::vector<StoredLine> lines;
  for (uint64_t i = 0; i < count; ++i) {
    lines.push_back({static_cast<int64_t>(i), 1, 7, "w", "line " + std::to_string(i)});
  }
  return lines;
}

/// While it lives the disk takes nothing that this process writes.
class NoWrites {
 public:
  NoWrites() {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit none{0, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &none);
  }
  ~NoWrites() { setrlimit(RLIMIT_FSIZE, &before_); }
  NoWrites(const NoWrites&) = delete;
  NoWrites& operator=(const NoWrites&) = delete;

 private:
  rlimit before_{};
};

TEST(JobStore, LinesThatCouldNotBeStoredPushOutNoOthers) {
  const test::TempFolder folder;
  auto store = open(folder.file("state.db"));
  ASSERT_TRUE(store->add_job(some_job("", "ada")).ok());
  ASSERT_TRUE(store->add_lines(1, some_lines(kMostLines - kLinesDropped + 100)).ok());
  for (uint64_t i = 0; i < 2; ++i) {
    const NoWrites full;
    ASSERT_FALSE(store->add_lines(1, some_lines(kLinesDropped / 2 - 100)).ok());
  }
  ASSERT_TRUE(store->add_lines(1, some_lines(200)).ok());
  EXPECT_EQ(store->lines(1, 0, 1)->at(0).text, "line 0") << "there was room";
  EXPECT_EQ(store->lines(1, 0, UINT32_MAX)->size(), kMostLines - kLinesDropped + 300);
}

TEST(JobStore, NoLineIsOverwrittenWhereNoneHadToGo) {
  const test::TempFolder folder;
  const std::string path = folder.file("state.db");
  ASSERT_TRUE(open(path)->add_job(some_job("", "ada")).ok());
  const auto db = open_database(path);
  ASSERT_TRUE(db.ok());
  LogRows table;
  ASSERT_TRUE(table.add(db->get(), 1, some_lines(10)).ok());
  {
    Transaction lost(db->get());  // nobody tells the table that it is rolled back
    ASSERT_TRUE(table.add(db->get(), 1, some_lines(kMostLines - 20)).ok());
  }
  ASSERT_TRUE(table.add(db->get(), 1, some_lines(20)).ok());
  const auto lines = read_lines(db->get(), 1, 0, UINT32_MAX);
  ASSERT_EQ(lines->size(), 30U);
  EXPECT_EQ(lines->at(0).text, "line 0");
}

TEST(JobStore, AllFailedFramesAreForgottenTogether) {
  const test::TempFolder folder;
  auto store = open(folder.file("state.db"));
  for (const char* owner : {"ada", "eve"}) {
    ASSERT_TRUE(store->add_job(some_job("", owner)).ok());
  }
  for (uint64_t job : {1, 2}) {
    for (int32_t frame = 1; frame <= 6; ++frame) {
      StoredFrame over{frame, frame % 2 == 0, "", "class", 0, {"worker"}, 1};
      ASSERT_TRUE(store->frame_over(job, over, {}).ok());
    }
  }
  ASSERT_TRUE(store->forget_failed_frames(1).ok());
  const auto left = store->frames(1);
  ASSERT_EQ(left->size(), 3U);
  for (const StoredFrame& frame : *left) EXPECT_TRUE(frame.done);
  EXPECT_EQ(store->frames(2)->size(), 6U) << "another job's";
  ASSERT_TRUE(store->forget_frames(2, std::vector<int32_t>{1, 2}).ok());
  EXPECT_EQ(store->frames(2)->size(), 4U);
}

TEST(JobStore, KeepsQuarantinesUntilTheyEnd) {
  const test::TempFolder folder;
  const std::string path = folder.file("state.db");
  {
    auto store = open(path);
    ASSERT_TRUE(store->quarantine({"worker-0001", "hot"}).ok());
    ASSERT_TRUE(store->quarantine({"worker-0002", "divergent"}).ok());
    ASSERT_TRUE(store->quarantine({"worker-0001", "divergent as well"}).ok());
    ASSERT_TRUE(store->end_quarantine("worker-0002").ok());
  }
  auto store = open(path);
  const auto kept = store->quarantines();
  ASSERT_TRUE(kept.ok());
  ASSERT_EQ(kept->size(), 1U);
  EXPECT_EQ(kept->front().worker, "worker-0001");
  EXPECT_EQ(kept->front().reason, "divergent as well");
}

class DivergentWorkers : public testing::Test {
 protected:
  void SetUp() override {
    store_ = open(path_);
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(store_->add_job(some_job("", "ada")).ok());
    StoredJob over = **store_->job(2);
    over.state = StoredState::done;
    ASSERT_TRUE(store_->update_job(over).ok());
  }
  void done(uint64_t job, int32_t frame, uint64_t moment, std::vector<std::string> parts) {
    const StoredFrame over{frame, true, "", "class", 0, std::move(parts), moment};
    ASSERT_TRUE(store_->frame_over(job, over, {}).ok());
  }
  std::vector<int32_t> mark_divergent(uint64_t job, uint64_t since) {
    const auto jobs = store_->mark_divergent({"divergent-worker", "divergent"}, since,
                                             {7, 2, {}, "w", "frames "});
    EXPECT_TRUE(jobs.ok());
    for (const SuspectFrames& suspected : *jobs) {
      if (suspected.job == job) return suspected.frames;
    }
    return {};
  }
  const test::TempFolder folder_;
  const std::string path_ = folder_.file("state.db");
  std::unique_ptr<JobStore> store_;
};

TEST_F(DivergentWorkers, MakeWhatTheyHadAPartInDoubtful) {
  done(1, 3, 10, {"good-worker"});
  done(1, 4, 11, {"good-worker", "divergent-worker"});
  done(1, 5, 12, {"", "good-worker"});  // before a restart
  done(1, 6, 13, {});                   // all of it was rendered twice
  done(2, 4, 14, {"divergent-worker"});
  EXPECT_EQ(mark_divergent(1, 0), (std::vector<int32_t>{4, 5}));
  EXPECT_EQ(*store_->suspect_frames(1, 10), (std::vector<int32_t>{4, 5}));
  EXPECT_EQ(*store_->suspect_frames(2, 10), std::vector<int32_t>{4}) << "it has ended";
  EXPECT_TRUE(store_->suspect_frames(3, 10)->empty());
  EXPECT_EQ(store_->lines(1, 0, 10)->at(0).text, "frames 4-5");
  EXPECT_EQ(store_->lines(2, 0, 10)->at(0).text, "frames 4");
  EXPECT_TRUE(mark_divergent(1, 0).empty()) << "nothing new";
  EXPECT_EQ(store_->lines(1, 0, 10)->size(), 1U);
  store_.reset();
  store_ = open(path_);
  EXPECT_EQ(store_->quarantines()->at(0).worker, "divergent-worker");
  EXPECT_TRUE(store_->frames(1)->at(1).suspect);
  done(1, 4, 20, {"good-worker"});  // again
  ASSERT_TRUE(store_->forget_frames(1, std::vector<int32_t>{5}).ok());
  EXPECT_TRUE(store_->suspect_frames(1, 10)->empty());
  EXPECT_TRUE(mark_divergent(1, 0).empty());
}

TEST_F(DivergentWorkers, ThatWereTrustedLongAgoAreForgotten) {
  std::vector<StoredTrust> workers;
  for (size_t i = 0; i < kMostTrusted + 3; ++i) {
    workers.push_back({"worker-" + std::to_string(i), 1 + i});
  }
  ASSERT_TRUE(store_->trust(workers).ok());
  const auto kept = store_->trusted();
  ASSERT_EQ(kept->size(), kMostTrusted);
  for (const StoredTrust& worker : *kept) EXPECT_GT(worker.moment, 3U) << worker.worker;
}

TEST_F(DivergentWorkers, CouldBeTrustedOnce) {
  ASSERT_TRUE(store_->trust({{"divergent-worker", 3}}).ok());
  ASSERT_TRUE(store_->trust({{"divergent-worker", 11}, {"other", 5}}).ok());
  done(1, 3, 11, {"divergent-worker"});
  done(1, 4, 12, {"divergent-worker"});
  store_.reset();
  store_ = open(path_);
  const auto trusted = store_->trusted();
  ASSERT_EQ(trusted->size(), 2U);
  EXPECT_EQ(trusted->at(0).moment, 11U);
  EXPECT_EQ(mark_divergent(1, trusted->at(0).moment), std::vector<int32_t>{4});
}

TEST_F(DivergentWorkers, AreNotToldApartWhereTheyAreTooMany) {
  std::vector<std::string> crowd;
  for (size_t i = 0; i < kMostContributors; ++i) crowd.push_back("worker " + std::to_string(i));
  done(1, 3, 1, crowd);
  crowd.emplace_back("one more");
  done(1, 4, 2, crowd);
  EXPECT_EQ(mark_divergent(1, 0), std::vector<int32_t>{4});
}

TEST(JobStore, KeepsWhichFramesAreBlack) {
  const test::TempFolder folder;
  auto store = open(folder.file("state.db"));
  ASSERT_TRUE(store->add_job(some_job("", "ada")).ok());
  StoredFrame frame{3, true, "", "class", 0};
  ASSERT_TRUE(store->frame_over(1, frame, {}).ok());
  EXPECT_TRUE(store->black(1, 10)->empty());
  frame.black = true;
  ASSERT_TRUE(store->frame_over(1, frame, {}).ok());
  EXPECT_EQ(*store->black(1, 10), std::vector<int32_t>{3});
  EXPECT_TRUE(store->frames(1)->at(0).black);
}

TEST(JobStore, FilesOfTheFirstSchemasAreBroughtUpToDate) {
  const test::TempFolder folder;
  const std::string path = folder.file("state.db");
  {
    auto store = open(path);
    ASSERT_TRUE(store->add_job(some_job("", "ada")).ok());
    ASSERT_TRUE(store->frame_over(1, {3, true, "", "class", 2}, {}).ok());
  }
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db,
                         "ALTER TABLE jobs ADD COLUMN spec BLOB NOT NULL DEFAULT x''; "
                         "UPDATE jobs SET spec = (SELECT spec FROM specs WHERE job = id); "
                         "DROP TABLE specs; DROP INDEX jobs_of_owner; "
                         "DROP INDEX black_frames; ALTER TABLE frames DROP COLUMN black; "
                         "DROP TABLE removals; DROP INDEX doubtful_frames; ALTER TABLE frames DROP "
                         "COLUMN doubtful; "
                         "DROP TABLE parts; DROP TABLE trusted; DROP INDEX outputs_of_frame; "
                         "DROP TABLE tokens; DROP TRIGGER count_core_time; DROP TABLE core_time; "
                         "ALTER TABLE jobs DROP COLUMN core_ns; ALTER TABLE jobs DROP COLUMN "
                         "preview; ALTER TABLE jobs DROP COLUMN owner_proven; "
                         "ALTER TABLE jobs DROP COLUMN options; DROP TABLE secret; "
                         "ALTER TABLE jobs DROP COLUMN samples_done; "
                         "ALTER TABLE jobs DROP COLUMN begun_ms; "
                         "ALTER TABLE jobs DROP COLUMN busy_ns; "
                         "PRAGMA user_version=3",
                         nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(db);
  auto store = open(path);
  const auto frames = store->frames(1);
  ASSERT_EQ(frames->size(), 1U);
  EXPECT_FALSE(frames->at(0).suspect);
  EXPECT_FALSE(frames->at(0).black);
  EXPECT_EQ((*store->job(1))->spec, some_job("", "ada").spec);
  EXPECT_EQ((*store->job(1))->core_ns, 0U);
  EXPECT_FALSE((*store->job(1))->preview);
  EXPECT_FALSE((*store->job(1))->owner_proven) << "no token has shown who ada is";
  EXPECT_TRUE(store->mark_divergent({"worker", "divergent"}, 0, {})->empty())
      << "whose films an older program finished is not known";
}

TEST(JobStore, OwnersOfTheSixthSchemaAreProvenByTokensThatWereThereBefore) {
  const test::TempFolder folder;
  const std::string path = folder.file("state.db");
  {
    auto store = open(path);
    StoredToken token{"9f3a01c2", "ada", 2, std::string(32, 'h'), 1000};
    ASSERT_TRUE(store->add_token(token).ok());
    for (const auto& [owner, submitted] :
         {std::pair("ada", 999), std::pair("ada", 1000), std::pair("bob", 2000)}) {
      StoredJob job = some_job("", owner);
      job.submitted_ms = submitted;
      ASSERT_TRUE(store->add_job(job).ok());
    }
  }
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db,
                         "ALTER TABLE jobs ADD COLUMN spec BLOB NOT NULL DEFAULT x''; "
                         "UPDATE jobs SET spec = (SELECT spec FROM specs WHERE job = id); "
                         "DROP TABLE specs; DROP INDEX jobs_of_owner; "
                         "DROP INDEX black_frames; ALTER TABLE frames DROP COLUMN black; "
                         "DROP TABLE removals; "
                         "DROP TRIGGER count_core_time; DROP TABLE core_time; "
                         "ALTER TABLE jobs DROP COLUMN owner_proven; "
                         "ALTER TABLE jobs DROP COLUMN options; DROP TABLE secret; "
                         "ALTER TABLE tokens DROP COLUMN pool; "
                         "ALTER TABLE tokens DROP COLUMN machines; "
                         "ALTER TABLE jobs DROP COLUMN samples_done; "
                         "ALTER TABLE jobs DROP COLUMN begun_ms; "
                         "ALTER TABLE jobs DROP COLUMN busy_ns; "
                         "PRAGMA user_version=6",
                         nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(db);
  auto store = open(path);
  EXPECT_EQ(store->tokens()->front().machines, 20'000U) << "as many as a farm may have";
  EXPECT_FALSE((*store->job(1))->owner_proven);
  EXPECT_TRUE((*store->job(2))->owner_proven);
  EXPECT_FALSE((*store->job(3))->owner_proven);
}

TEST(JobStore, OneKeyOneJob) {
  const test::TempFolder folder;
  auto store = open(folder.file("state.db"));
  EXPECT_EQ(store->add_job(some_job("a-key", "ada"))->id, 1U);
  const auto again = store->add_job(some_job("a-key", "bob"));
  EXPECT_EQ(again->id, 1U);
  EXPECT_TRUE(again->existed);
  EXPECT_EQ(store->add_job(some_job("", "ada"))->id, 2U);
  EXPECT_EQ(store->add_job(some_job("", "ada"))->id, 3U);
}

TEST(JobStore, ListsTheNewestFirst) {
  const test::TempFolder folder;
  auto store = open(folder.file("state.db"));
  for (int i = 0; i < 5; ++i) (void)store->add_job(some_job("", i % 2 ? "bob" : "ada"));
  StoredJob over = **store->job(3);
  over.state = StoredState::done;
  ASSERT_TRUE(store->update_job(over).ok());
  const auto ids = [](const core::Result<std::vector<StoredJob>>& jobs) {
    std::vector<uint64_t> found;
    for (const StoredJob& job : *jobs) found.push_back(job.id);
    return found;
  };
  EXPECT_EQ(ids(store->list(false, "", 0, 10)), (std::vector<uint64_t>{5, 4, 2, 1}));
  EXPECT_EQ(ids(store->list(true, "ada", 0, 10)), (std::vector<uint64_t>{5, 3, 1}));
  EXPECT_EQ(ids(store->list(true, "", 4, 2)), (std::vector<uint64_t>{3, 2}));
  ASSERT_TRUE(store->remove_job(5).ok());
  EXPECT_EQ(store->add_job(some_job("", "ada"))->id, 6U) << "ids are never used twice";
}

TEST(JobStore, CoreTimeIsKeptOfOwnersWhoseJobsAreForgotten) {
  const test::TempFolder folder;
  const std::string path = folder.file("state.db");
  const int64_t since = core::wall_ms() - 3'600'000;
  {
    auto store = open(path);
    ASSERT_TRUE(store->add_job(some_job("", "ada")).ok());
    ASSERT_TRUE(store->add_job(some_job("", "ada")).ok());
    ASSERT_TRUE(store->add_job(some_job("", "bob")).ok());
    const auto took = [&](uint64_t id, uint64_t core_ns) {
      StoredJob job = **store->job(id);
      job.core_ns = core_ns;
      EXPECT_TRUE(store->update_job(job).ok());
    };
    EXPECT_EQ(*store->core_ns_of("ada", since), 0U);
    took(1, 1'000'000'000'000);
    took(1, 1'500'000'000'000);
    took(1, 1'500'000'000'000);
    took(2, 7);
    took(3, 5);
    EXPECT_EQ(*store->core_ns_of("ada", since), 1'500'000'000'007U);
    ASSERT_TRUE(store->remove_job(1).ok());
  }
  auto store = open(path);
  EXPECT_EQ(*store->core_ns_of("ada", since), 1'500'000'000'007U);
  EXPECT_EQ(*store->core_ns_of("bob", since), 5U);
  EXPECT_EQ(*store->core_ns_of("ada", core::wall_ms() + 2 * 3'600'000), 0U) << "not since then";
}

TEST(JobStore, ANewerSchemaIsRefused) {
  const test::TempFolder folder;
  const std::string path = folder.file("state.db");
  open(path).reset();
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db, "PRAGMA user_version=999", nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(db);
  const auto refused = open_sqlite_job_store(path);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("newer"), std::string::npos) << refused.error().message;
}

TEST(JobStore, OneProcessAtATime) {
  const test::TempFolder folder;
  const auto store = open(folder.file("state.db"));
  EXPECT_FALSE(open_sqlite_job_store(folder.file("state.db")).ok());
}

}  // namespace
}  // namespace hyades::coordinator
