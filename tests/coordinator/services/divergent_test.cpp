// Workers that are found divergent after frames with their films were finished.
#include <gmock/gmock.h>

#include <atomic>
#include <mutex>
#include <optional>

#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

using testing::HasSubstr;

constexpr int kDivergent = 1;

class DivergentWorker : public testing::Test {
 protected:
  /// Renders everything wrong, and of frame 2 of a job of several frames one unit alone.
  ScriptedWorker::Script divergent_script() {
    ScriptedWorker::Script script = world_.script(kDivergent);
    script.corrupt = [](core::Film& film) { film.mutable_plane(0)[0] += core::Fixed128{0, 1}; };
    script.meddle = [this](ScriptedWorker&, const v1::LeasedUnit& unit) {
      const std::lock_guard lock(mutex_);
      if (unit.unit().frame() < 2) return true;
      if (disputed_) return false;
      disputed_ = unit;
      return true;
    };
    return script;
  }
  std::optional<v1::LeasedUnit> disputed() {
    const std::lock_guard lock(mutex_);
    return disputed_;
  }
  std::string log(uint64_t job) {
    const auto lines = world_.controller->store().lines(job, 0, 1000);
    std::string all;
    for (const StoredLine& line : *lines) all += line.text + "\n";
    return all;
  }
  /// It has given all of the first frame of the job, and a unit of the next.
  bool has_finished_a_frame(uint64_t job) {
    return eventually(
        [&] { return disputed() && world_.get(job).frames(0).state() == v1::FRAME_STATE_DONE; });
  }
  /// Two others give that unit; then all three frames of the job are as they should be.
  void expect_found_out(uint64_t job) {
    bert_.emplace(world_.address, world_.script(2));
    cora_.emplace(world_.address, world_.script(3));
    ASSERT_TRUE(eventually([&] { return bert_->streams() > 0 && cora_->streams() > 0; }));
    bert_->deliver(world_.leased_to(*bert_, *disputed()));
    cora_->deliver(world_.leased_to(*cora_, *disputed()));
    ASSERT_TRUE(world_.wait_for(job, v1::JOB_STATE_DONE));
    for (int32_t frame = 1; frame <= 3; ++frame) world_.expect_truth(job, frame);
  }

  FarmWorld world_;
  std::mutex mutex_;
  std::optional<v1::LeasedUnit> disputed_;
  std::optional<ScriptedWorker> bert_;
  std::optional<ScriptedWorker> cora_;
};

TEST_F(DivergentWorker, HasItsFinishedFramesRenderedAgain) {
  world_.start();
  const uint64_t ended = world_.submit(1);
  ASSERT_EQ(ended, 1U);
  ScriptedWorker divergent(world_.address, divergent_script());
  ASSERT_TRUE(world_.wait_for(ended, v1::JOB_STATE_DONE));
  const uint64_t open = world_.submit(3);
  ASSERT_TRUE(has_finished_a_frame(open));
  EXPECT_THAT(world_.explain(ended), HasSubstr("it is done"));
  expect_found_out(open);
  EXPECT_THAT(log(open), HasSubstr("which are in doubt: 1"));
  // The job that had ended is told of, and not touched until somebody wants it.
  EXPECT_TRUE(world_.get(ended).frames(0).doubtful());
  EXPECT_EQ(world_.get(ended).job().state(), v1::JOB_STATE_DONE);
  EXPECT_THAT(world_.explain(ended), HasSubstr("frame 1 is in doubt"));
  EXPECT_THAT(log(ended), HasSubstr("which are in doubt: 1"));
  v1::JobRequest again;
  again.set_job(ended);
  v1::JobResponse now;
  const grpc::Status retried = world_.jobs->Retry(world_.context().get(), again, &now);
  ASSERT_TRUE(retried.ok()) << retried.error_message();
  ASSERT_TRUE(world_.wait_for(ended, v1::JOB_STATE_DONE));
  world_.expect_truth(ended, 1);
  EXPECT_FALSE(world_.get(ended).frames(0).doubtful());
  EXPECT_EQ(world_.jobs->Retry(world_.context().get(), again, &now).error_code(),
            grpc::StatusCode::FAILED_PRECONDITION);
}

TEST_F(DivergentWorker, IsTrustedUpToTheFrameInWhichAnotherAgreedWithIt) {
  world_.start();
  std::atomic<bool> wrong{false};
  std::atomic<bool> go{false};
  ScriptedWorker::Script script = divergent_script();
  script.corrupt = [&, corrupt = script.corrupt](core::Film& film) {
    if (wrong) corrupt(film);
  };
  std::optional<v1::LeasedUnit> shared;
  script.meddle = [&, meddle = script.meddle](ScriptedWorker& worker, const v1::LeasedUnit& unit) {
    if (unit.job() != 2) return meddle(worker, unit);
    {
      const std::lock_guard lock(mutex_);
      if (!shared) {
        shared = unit;
        return true;
      }
    }
    return eventually([&] { return go.load(); });
  };
  ScriptedWorker divergent(world_.address, script);
  ASSERT_EQ(world_.submit(1), 1U);
  ASSERT_TRUE(world_.wait_for(1, v1::JOB_STATE_DONE));
  ASSERT_EQ(world_.submit(1), 2U);
  ASSERT_TRUE(eventually([&] { return world_.get(2).job().samples_done() > 0; }));
  {
    ScriptedWorker bert(world_.address, world_.script(2));
    ASSERT_TRUE(eventually([&] { return bert.streams() > 0; }));
    bert.deliver(world_.leased_to(bert, *shared));
    ASSERT_TRUE(eventually([&] { return !world_.controller->store().trusted()->empty(); }));
    go = true;
    ASSERT_TRUE(world_.wait_for(2, v1::JOB_STATE_DONE));
  }
  wrong = true;
  const uint64_t open = world_.submit(3);
  ASSERT_TRUE(has_finished_a_frame(open));
  expect_found_out(open);
  EXPECT_FALSE(world_.get(1).frames(0).doubtful()) << "it was finished before they agreed";
  EXPECT_TRUE(world_.get(2).frames(0).doubtful()) << "it may have erred in what came later";
}

TEST_F(DivergentWorker, IsRememberedByTheNextCoordinator) {
  world_.start();
  uint64_t open = 0;
  {
    ScriptedWorker divergent(world_.address, divergent_script());
    ASSERT_EQ(world_.submit(1), 1U);
    ASSERT_TRUE(world_.wait_for(1, v1::JOB_STATE_DONE));
    open = world_.submit(3);
    ASSERT_TRUE(has_finished_a_frame(open));
  }
  world_.stop();
  {
    // As if it had died right after that was stored; what it would have voided is no matter here.
    auto store = open_sqlite_job_store(world_.options.folder + "/state.db");
    ASSERT_TRUE(store.ok());
    ASSERT_TRUE((*store)->mark_divergent({world_.script(kDivergent).id, "divergent"}, 0, {}).ok());
  }
  world_.start();
  ScriptedWorker bert(world_.address, world_.script(2));
  EXPECT_TRUE(eventually([&] { return world_.get(open).frames(0).restarts() == 1; }));
  ASSERT_TRUE(world_.wait_for(open, v1::JOB_STATE_DONE));
  world_.expect_truth(open, 1);
}

}  // namespace
}  // namespace hyades::coordinator
