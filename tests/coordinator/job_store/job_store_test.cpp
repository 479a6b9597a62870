#include "coordinator/job_store/job_store.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "coordinator/job_store/contributor_rows.h"
#include "core/base/wall_clock.h"
#include "tests/coordinator/job_store/store_place.h"
#include "tests/coordinator/sql/postgres_server.h"

namespace hyades::coordinator {
namespace {

/// Each test is run with a store in each engine.
class JobStoreOf : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string engine = GetParam();
    if (engine == "postgres" && !test::postgres_is_there()) return;
    place_ = std::make_unique<StorePlace>(engine);
  }
  std::unique_ptr<StorePlace> place_;
};

TEST_P(JobStoreOf, KeepsWhatItWasGivenOverRestarts) {
  {
    auto store = place_->open();
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
  auto store = place_->open();
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

TEST_P(JobStoreOf, OutputsGoByNameAndFolderAndOthersComeAtOnce) {
  auto store = place_->open();
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

TEST_P(JobStoreOf, OldLinesGoAndAreMissed) {
  auto store = place_->open();
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

TEST_P(JobStoreOf, AllFailedFramesAreForgottenTogether) {
  auto store = place_->open();
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

TEST_P(JobStoreOf, KeepsQuarantinesUntilTheyEnd) {
  {
    auto store = place_->open();
    ASSERT_TRUE(store->quarantine({"worker-0001", "hot"}).ok());
    ASSERT_TRUE(store->quarantine({"worker-0002", "divergent"}).ok());
    ASSERT_TRUE(store->quarantine({"worker-0001", "divergent as well"}).ok());
    ASSERT_TRUE(store->end_quarantine("worker-0002").ok());
  }
  auto store = place_->open();
  const auto kept = store->quarantines();
  ASSERT_TRUE(kept.ok());
  ASSERT_EQ(kept->size(), 1U);
  EXPECT_EQ(kept->front().worker, "worker-0001");
  EXPECT_EQ(kept->front().reason, "divergent as well");
}

class DivergentWorkers : public JobStoreOf {
 protected:
  void SetUp() override {
    JobStoreOf::SetUp();
    if (!place_) return;
    store_ = place_->open();
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
  std::unique_ptr<JobStore> store_;
};

TEST_P(DivergentWorkers, MakeWhatTheyHadAPartInDoubtful) {
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
  store_ = place_->open();
  EXPECT_EQ(store_->quarantines()->at(0).worker, "divergent-worker");
  EXPECT_TRUE(store_->frames(1)->at(1).suspect);
  done(1, 4, 20, {"good-worker"});  // again
  ASSERT_TRUE(store_->forget_frames(1, std::vector<int32_t>{5}).ok());
  EXPECT_TRUE(store_->suspect_frames(1, 10)->empty());
  EXPECT_TRUE(mark_divergent(1, 0).empty());
}

TEST_P(DivergentWorkers, ThatWereTrustedLongAgoAreForgotten) {
  std::vector<StoredTrust> workers;
  for (size_t i = 0; i < kMostTrusted + 3; ++i) {
    workers.push_back({"worker-" + std::to_string(i), 1 + i});
  }
  ASSERT_TRUE(store_->trust(workers).ok());
  const auto kept = store_->trusted();
  ASSERT_EQ(kept->size(), kMostTrusted);
  for (const StoredTrust& worker : *kept) EXPECT_GT(worker.moment, 3U) << worker.worker;
}

TEST_P(DivergentWorkers, CouldBeTrustedOnce) {
  ASSERT_TRUE(store_->trust({{"divergent-worker", 3}}).ok());
  ASSERT_TRUE(store_->trust({{"divergent-worker", 11}, {"other", 5}}).ok());
  done(1, 3, 11, {"divergent-worker"});
  done(1, 4, 12, {"divergent-worker"});
  store_.reset();
  store_ = place_->open();
  const auto trusted = store_->trusted();
  ASSERT_EQ(trusted->size(), 2U);
  EXPECT_EQ(trusted->at(0).moment, 11U);
  EXPECT_EQ(mark_divergent(1, trusted->at(0).moment), std::vector<int32_t>{4});
}

TEST_P(DivergentWorkers, AreNotToldApartWhereTheyAreTooMany) {
  std::vector<std::string> crowd;
  for (size_t i = 0; i < kMostContributors; ++i) crowd.push_back("worker " + std::to_string(i));
  done(1, 3, 1, crowd);
  crowd.emplace_back("one more");
  done(1, 4, 2, crowd);
  EXPECT_EQ(mark_divergent(1, 0), std::vector<int32_t>{4});
}

TEST_P(JobStoreOf, KeepsWhichFramesAreBlack) {
  auto store = place_->open();
  ASSERT_TRUE(store->add_job(some_job("", "ada")).ok());
  StoredFrame frame{3, true, "", "class", 0};
  ASSERT_TRUE(store->frame_over(1, frame, {}).ok());
  EXPECT_TRUE(store->black(1, 10)->empty());
  frame.black = true;
  ASSERT_TRUE(store->frame_over(1, frame, {}).ok());
  EXPECT_EQ(*store->black(1, 10), std::vector<int32_t>{3});
  EXPECT_TRUE(store->frames(1)->at(0).black);
}

TEST_P(JobStoreOf, AReplacedOutputIsANewOne) {
  auto store = place_->open();
  ASSERT_TRUE(store->add_job(some_job("", "ada")).ok());
  ASSERT_TRUE(store->change_outputs(1, {}, {{"a", 1, 9, "x"}, {"b", 1, 9, "y"}}).ok());
  ASSERT_TRUE(store->change_outputs(1, {}, {{"a", 1, 10, "z"}}).ok());
  const auto outputs = store->outputs(1, 0, 10);
  ASSERT_EQ(outputs->size(), 2U);
  EXPECT_EQ(outputs->at(0).path, "b");
  EXPECT_EQ(outputs->at(1).path, "a");
  EXPECT_EQ(outputs->at(1).sha256, "z");
  EXPECT_GT(outputs->at(1).number, outputs->at(0).number);
  EXPECT_EQ(outputs->at(1).number, 3U) << "numbers are never used twice";
}

TEST_P(JobStoreOf, NothingIsStoredOfAJobThatIsNotThere) {
  auto store = place_->open();
  EXPECT_FALSE(store->frame_over(7, {3, true, "", "class", 2}, {}).ok());
  EXPECT_FALSE(store->change_outputs(7, {}, {{"a", 1, 9, "x"}}).ok());
  EXPECT_FALSE(store->add_lines(7, some_lines(1)).ok());
  EXPECT_TRUE(store->change_outputs(7, {"a"}, {}).ok()) << "it adds nothing";
  EXPECT_TRUE(store->add_lines(7, {}).ok());
  const auto db = [&] {
    store.reset();
    return place_->open_raw();
  }();
  for (const char* table : {"frames", "parts", "outputs", "lines"}) {
    Query rows(*db, std::string("SELECT COUNT(*) FROM ") + table);
    ASSERT_TRUE(rows.next());
    EXPECT_EQ(rows.integer(0), 0) << table;
  }
}

TEST_P(JobStoreOf, KeepsItsSecret) {
  const std::string secret = *place_->open()->secret();
  EXPECT_EQ(secret.size(), 64U);
  EXPECT_EQ(*place_->open()->secret(), secret);
  EXPECT_NE(*StorePlace(GetParam()).open()->secret(), secret) << "each store has its own";
}

TEST_P(JobStoreOf, KeepsTokens) {
  auto store = place_->open();
  const StoredToken ada{"9f3a01c2", "ada", 2, std::string("h\0ash", 5), 1000, 9000, 0, 0, "", 0};
  const StoredToken worker{"00000001", "worker", 1, "other", 1000, 0, 0, 0, "pool", 20};
  ASSERT_TRUE(store->add_token(ada).ok());
  ASSERT_TRUE(store->add_token(worker).ok());
  EXPECT_FALSE(store->add_token(ada).ok()) << "its id is there already";
  ASSERT_TRUE(store->note_uses({{"9f3a01c2", 5000}, {"00000001", 6000}}).ok());
  ASSERT_TRUE(store->revoke_token("9f3a01c2", 7000).ok());
  ASSERT_TRUE(store->revoke_token("9f3a01c2", 8000).ok()) << "once";
  store.reset();
  store = place_->open();
  const auto tokens = store->tokens();
  ASSERT_EQ(tokens->size(), 2U);
  EXPECT_EQ(tokens->at(0).id, "00000001");
  EXPECT_EQ(tokens->at(0).pool, "pool");
  EXPECT_EQ(tokens->at(0).machines, 20U);
  EXPECT_EQ(tokens->at(1).hash, ada.hash);
  EXPECT_EQ(tokens->at(1).expires_ms, 9000);
  EXPECT_EQ(tokens->at(1).used_ms, 5000);
  EXPECT_EQ(tokens->at(1).revoked_ms, 7000);
  ASSERT_TRUE(store->forget_token("9f3a01c2").ok());
  EXPECT_EQ(store->tokens()->size(), 1U);
}

TEST_P(JobStoreOf, OneKeyOneJob) {
  auto store = place_->open();
  EXPECT_EQ(store->add_job(some_job("a-key", "ada"))->id, 1U);
  const auto again = store->add_job(some_job("a-key", "bob"));
  EXPECT_EQ(again->id, 1U);
  EXPECT_TRUE(again->existed);
  EXPECT_EQ(store->add_job(some_job("", "ada"))->id, 2U);
  EXPECT_EQ(store->add_job(some_job("", "ada"))->id, 3U);
}

TEST_P(JobStoreOf, ListsTheNewestFirst) {
  auto store = place_->open();
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

TEST_P(JobStoreOf, CoreTimeIsKeptOfOwnersWhoseJobsAreForgotten) {
  const int64_t since = core::wall_ms() - 3'600'000;
  {
    auto store = place_->open();
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
  auto store = place_->open();
  EXPECT_EQ(*store->core_ns_of("ada", since), 1'500'000'000'007U);
  EXPECT_EQ(*store->core_ns_of("bob", since), 5U);
  EXPECT_EQ(*store->core_ns_of("ada", core::wall_ms() + 2 * 3'600'000), 0U) << "not since then";
}

const auto kEngines = testing::Values("sqlite", "postgres");
const auto kName = [](const auto& engine) { return std::string(engine.param); };
INSTANTIATE_TEST_SUITE_P(, JobStoreOf, kEngines, kName);
INSTANTIATE_TEST_SUITE_P(, DivergentWorkers, kEngines, kName);

}  // namespace
}  // namespace hyades::coordinator
