// Units that go to others: what the job's log says of them, and what explain knows of those that
// are out.
#include <gmock/gmock.h>

#include "coordinator/controller/log_buffer.h"
#include "tests/coordinator/services/farm_world.h"
#include "tests/coordinator/services/troubled_store.h"

namespace hyades::coordinator {
namespace {

using testing::HasSubstr;
using testing::Not;

class Losses : public ::testing::Test {
 protected:
  Losses() { world_.options.copy_after = 1h; }

  /// A worker that takes what it gets and delivers nothing.
  ScriptedWorker::Script holder() const {
    ScriptedWorker::Script script = world_.script();
    script.name = "anna";
    script.hold = true;
    script.reconnect = false;
    script.beat_every = 50ms;
    return script;
  }
  uint64_t leased() const { return world_.get(job_).job().leased(); }
  void begin(int frames = 1, const std::function<void(v1::SubmitRequest&)>& change = {}) {
    world_.start();
    job_ = world_.submit(frames, change);
  }
  std::vector<v1::LogLine> lines(const std::string& text) const {
    v1::LogsRequest request;
    request.set_job(job_);
    const auto context = world_.context();
    const auto reader = world_.jobs->Logs(context.get(), request);
    std::vector<v1::LogLine> found;
    v1::LogLine line;
    while (reader->Read(&line)) {
      if (line.text().find(text) != std::string::npos) found.push_back(line);
    }
    (void)reader->Finish();
    return found;
  }
  void expect_one_line(const std::string& text) const {
    ASSERT_TRUE(eventually([&] { return !lines(text).empty(); })) << text;
    EXPECT_EQ(lines(text).size(), 1U) << "not one for each unit";
    EXPECT_EQ(lines(text)[0].worker(), "anna");
    EXPECT_EQ(lines(text)[0].level(), v1::LOG_LEVEL_WARNING);
  }
  std::string explain() const { return world_.explain(job_); }
  bool explains(const std::string& text) const {
    return eventually([&] { return explain().find(text) != std::string::npos; });
  }
  void quarantine(const char* reason) const {
    v1::WorkerRequest request;
    request.set_worker("anna");
    request.set_reason(reason);
    v1::WorkerResponse response;
    EXPECT_TRUE(world_.farm_->QuarantineWorker(world_.context().get(), request, &response).ok());
  }

  FarmWorld world_;
  uint64_t job_ = 0;
};

TEST_F(Losses, AWorkerThatDiesIsInTheLog) {
  begin();
  {
    const ScriptedWorker anna(world_.address, holder());
    ASSERT_TRUE(eventually([&] { return leased() == 2; }));
  }
  expect_one_line("is lost: 2 units of frame 1 go to others");
  EXPECT_EQ(lines("is lost")[0].frame(), 1);
}

TEST_F(Losses, AWorkerThatIsStartedAgainHasForgottenItsUnits) {
  world_.options.reconnect_time = 30s;
  begin();
  std::optional<ScriptedWorker> anna;
  anna.emplace(world_.address, holder());
  ASSERT_TRUE(eventually([&] { return leased() == 2; }));
  anna.reset();
  anna.emplace(world_.address, holder());
  expect_one_line("has been started again: 2 units of frame 1 go to others");
}

TEST_F(Losses, LeasesThatAreNotRenewedAreInTheLog) {
  world_.options.lease_time = 1s;
  begin();
  ScriptedWorker::Script forgetful = holder();
  forgetful.threads = 1;
  bool once = true;
  forgetful.meddle = [&](ScriptedWorker&, const v1::LeasedUnit&) {
    return !std::exchange(once, false);
  };
  const ScriptedWorker anna(world_.address, forgetful);
  expect_one_line("did not renew its leases in time: 1 unit of frame 1 goes to others");
}

TEST_F(Losses, AQuarantineIsInTheLogAndExplained) {
  begin();
  const ScriptedWorker anna(world_.address, holder());
  ASSERT_TRUE(eventually([&] { return leased() == 2; }));
  quarantine("odd bits");
  expect_one_line("is in quarantine: odd bits");
  EXPECT_THAT(explain(), HasSubstr("no worker is there that could take units"));
  EXPECT_THAT(explain(), HasSubstr("worker anna is in quarantine (odd bits); 'release' ends that"));
}

TEST_F(Losses, WishesAreToldWhoeverIsThere) {
  begin(1, [](v1::SubmitRequest& request) {
    request.add_tags("gpu");
    request.set_memory_bytes(1 << 30);
  });
  EXPECT_THAT(explain(), HasSubstr("no worker is there"));
  EXPECT_THAT(explain(), HasSubstr("the tag 'gpu', and none is there"));
  EXPECT_THAT(explain(), HasSubstr("1 frame waits for its turn"));
  ScriptedWorker::Script script = holder();
  script.tags = {"gpu"};
  const ScriptedWorker anna(world_.address, script);
  ASSERT_TRUE(eventually([&] { return leased() > 0; }));
  EXPECT_THAT(explain(), Not(HasSubstr("gpu")));
}

TEST_F(Losses, WhatIsKnownOfUnitsIsToldAndNoMore) {
  begin(3);
  ScriptedWorker::Script script = holder();
  script.stage = v1::LeaseProgress::STAGE_WAITING;
  const ScriptedWorker anna(world_.address, script);
  EXPECT_TRUE(explains("2 units with workers: 2 waiting for a thread\n")) << explain();
  EXPECT_THAT(explain(), Not(HasSubstr("being rendered")));
  EXPECT_TRUE(explains("2 frames wait for their turn\n")) << explain();
}

TEST_F(Losses, LinesThatCannotBeStoredWait) {
  const auto trouble = std::make_shared<Trouble>();
  world_.wrap_store = [&](std::unique_ptr<JobStore> store) {
    return std::make_unique<TroubledStore>(std::move(store), trouble);
  };
  begin();
  std::optional<ScriptedWorker> anna;
  anna.emplace(world_.address, holder());
  ASSERT_TRUE(eventually([&] { return leased() == 2 && !lines("begun").empty(); }));
  trouble->of_writes(Trouble::Kind::fails);
  anna.reset();
  std::this_thread::sleep_for(1s);
  EXPECT_TRUE(lines("is lost").empty());
  trouble->of_writes(Trouble::Kind::none);
  expect_one_line("is lost: 2 units of frame 1 go to others");
}

TEST(LossesOfTheCoordinator, LinesThatCannotBeStoredAreBounded) {
  LogBuffer log;
  const auto line_of = [](const std::string& text) {
    StoredLine line;
    line.text = text;
    return line;
  };
  std::vector<StoredLine> old;
  for (int i = 0; i < 1999; ++i) old.push_back(line_of("old"));
  const TimePoint now;
  log.add(line_of("new"));
  ASSERT_TRUE(log.begin_storing(now));
  EXPECT_FALSE(log.begin_storing(now)) << "somebody does";
  log.add(line_of("newest"));
  log.not_stored(old, now + 1s);
  EXPECT_FALSE(log.begin_storing(now)) << "it has just failed";
  EXPECT_TRUE(log.begin_storing(now + 1s));
  const std::vector<StoredLine> taken = log.take();
  ASSERT_EQ(taken.size(), 2001U);
  EXPECT_EQ(taken[1999].text, "newest");
  EXPECT_EQ(taken[2000].text, "1 line was dropped: too many at once");
}

TEST_F(Losses, WorkersThatAreAwayForLongAreForgotten) {
  world_.options.forget_time = 300ms;
  begin();
  { const ScriptedWorker anna(world_.address, holder()); }
  EXPECT_TRUE(eventually([&] {
    v1::WorkersResponse workers;
    EXPECT_TRUE(world_.farm_->Workers(world_.context().get(), {}, &workers).ok());
    return workers.workers().empty();
  }));
}

}  // namespace
}  // namespace hyades::coordinator
