// While the disk of the coordinator fails or does not answer, everybody who does not need it is
// served as ever.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/coordinator/services/farm_world.h"
#include "tests/coordinator/services/troubled_store.h"

namespace hyades::coordinator {
namespace {

/// A document that takes seconds to read.
std::string long_document() {
  std::string text = FarmWorld::document(1);
  std::string balls;
  for (int i = 0; i < 70'000; ++i) {
    balls += "  o" + std::to_string(i) + ": {shape: sphere, radius: 1, material: clay}\n";
  }
  const std::string one = "objects: {ball: {shape: sphere, radius: 1, material: clay}}\n";
  return text.replace(text.find(one), one.size(), "objects:\n" + balls);
}

class NeverFreezes : public testing::Test {
 protected:
  void SetUp() override {
    world.wrap_store = [this](std::unique_ptr<JobStore> store) {
      return std::make_unique<TroubledStore>(std::move(store), trouble);
    };
    world.start();
  }
  void TearDown() override {
    trouble->of_writes(Trouble::Kind::none);
    trouble->of_reads(Trouble::Kind::none);
    trouble->of_outputs(Trouble::Kind::none);
    await_clients();
  }
  void await_clients() {
    for (std::thread& client : clients) client.join();
    clients.clear();
  }

  grpc::Status cancel(uint64_t job, std::chrono::milliseconds timeout = 20s) const {
    v1::JobResponse now;
    return world.jobs->Cancel(world.context(timeout).get(), about(job), &now);
  }
  grpc::Status retry(uint64_t job, std::chrono::milliseconds timeout = 20s) const {
    v1::JobResponse now;
    return world.jobs->Retry(world.context(timeout).get(), about(job), &now);
  }
  grpc::Status remove(uint64_t job, std::chrono::milliseconds timeout = 20s) const {
    v1::DeleteJobResponse gone;
    return world.jobs->Delete(world.context(timeout).get(), about(job), &gone);
  }
  uint64_t ended_job() {
    const uint64_t job = world.submit(1);
    EXPECT_TRUE(cancel(job).ok());
    return job;
  }

  /// A frame of 150 tiles, which keeps a worker busy for some seconds.
  uint64_t long_job() {
    std::string text = FarmWorld::document(1);
    text.replace(text.find("[80, 48]"), 8, "[640, 480]");
    return world.submit_text(text);
  }
  std::unique_ptr<ScriptedWorker> worker() const {
    ScriptedWorker::Script script = world.script();
    script.unit_time = 20ms;
    return std::make_unique<ScriptedWorker>(world.address, script);
  }

  /// For a second: the worker's films are acknowledged, and whoever asks about open jobs, workers
  /// and the coordinator has an answer at once.
  void expect_served(uint64_t job, const ScriptedWorker& busy) const {
    const uint64_t before = busy.acknowledged();
    const auto begin = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() < begin + 1s) {
      const auto timeout = 500ms;
      v1::ListJobsResponse list;
      EXPECT_TRUE(world.jobs->List(world.context(timeout).get(), {}, &list).ok());
      EXPECT_GE(list.jobs_size(), 1);
      v1::GetJobRequest asked;
      asked.set_job(job);
      v1::GetJobResponse got;
      EXPECT_TRUE(world.jobs->Get(world.context(timeout).get(), asked, &got).ok());
      v1::ExplainResponse why;
      EXPECT_TRUE(world.jobs->Explain(world.context(timeout).get(), about(job), &why).ok());
      v1::WorkersResponse workers;
      EXPECT_TRUE(world.farm_->Workers(world.context(timeout).get(), {}, &workers).ok());
      v1::WatchRequest watched;
      watched.set_job(job);
      const auto context = world.context(timeout);
      const auto watch = world.jobs->Watch(context.get(), watched);
      v1::WatchEvent event;
      EXPECT_TRUE(watch->Read(&event)) << "somebody who watches";
      context->TryCancel();
      if (HasFailure()) return;
      std::this_thread::sleep_for(20ms);
    }
    EXPECT_GT(busy.acknowledged(), before + 5) << "results are taken and leases are given";
    EXPECT_EQ(busy.streams(), 1U) << "the worker is not given up";
  }

  FarmWorld world;
  std::shared_ptr<Trouble> trouble = std::make_shared<Trouble>();
  std::vector<std::thread> clients;
};

TEST_F(NeverFreezes, WhileTheJobStoreIsFull) {
  std::vector<uint64_t> open;
  std::vector<uint64_t> ended;
  for (int i = 0; i < 6; ++i) open.push_back(world.submit(1));
  for (int i = 0; i < 6; ++i) ended.push_back(ended_job());
  const uint64_t job = long_job();
  for (const uint64_t id : open) {  // or they would have the worker first
    v1::JobResponse now;
    ASSERT_TRUE(world.jobs->Pause(world.context().get(), about(id), &now).ok());
  }
  const auto busy = worker();
  ASSERT_TRUE(eventually([&] { return busy->acknowledged() > 4; }));
  trouble->of_writes(Trouble::Kind::fails);
  std::atomic<int> wrong{0};
  const auto expect_not_now = [&](const grpc::Status& status) {
    if (status.error_code() != grpc::StatusCode::UNAVAILABLE) ++wrong;
    EXPECT_GT(farm::detail_of(status).retry_after_ms(), 0U) << status.error_message();
  };
  for (size_t i = 0; i < 6; ++i) {
    clients.emplace_back([&, id = open[i]] { expect_not_now(cancel(id)); });
    clients.emplace_back(
        [&, id = ended[i], first = i % 2 == 0] { expect_not_now(first ? remove(id) : retry(id)); });
  }
  expect_served(job, *busy);
  await_clients();
  EXPECT_EQ(wrong, 0) << "nothing was stored, and somebody was told that it is";
  trouble->of_writes(Trouble::Kind::none);
  for (const uint64_t id : open) EXPECT_TRUE(world.wait_for(id, v1::JOB_STATE_CANCELLED)) << id;
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_TRUE(i % 2 == 0 ? remove(ended[i]).ok() : retry(ended[i]).ok());
  }
  EXPECT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
}

TEST_F(NeverFreezes, NothingIsPromisedThatACrashWouldUndo) {
  ScriptedWorker::Script script = world.script();
  script.threads = 64;
  script.meddle = [](ScriptedWorker& self, const v1::LeasedUnit& unit) {
    if (unit.unit().frame() != 1) return false;  // it keeps them
    v1::WorkerMessage message;
    *message.mutable_failure()->mutable_unit() = unit;
    self.write(message);
    return false;
  };
  const ScriptedWorker holder(world.address, script);
  const uint64_t job = world.submit(2, [](v1::SubmitRequest& asked) { asked.set_max_attempts(1); });
  const auto first = [&] { return world.get(job).frames(0).state(); };
  ASSERT_TRUE(eventually([&] { return first() == v1::FRAME_STATE_FAILED; }));
  v1::WorkerRequest asked;
  asked.set_worker("scripted/1");
  v1::WorkerResponse now;
  const auto quarantine = [&] {
    return world.farm_->QuarantineWorker(world.context().get(), asked, &now).error_code();
  };
  const auto release = [&] {
    return world.farm_->ReleaseWorker(world.context().get(), asked, &now).error_code();
  };
  trouble->of_writes(Trouble::Kind::fails);
  EXPECT_EQ(quarantine(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(release(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(retry(job).error_code(), grpc::StatusCode::UNAVAILABLE);
  trouble->of_writes(Trouble::Kind::none);
  // On a busy machine it may not be stored within the time that an answer has.
  EXPECT_TRUE(eventually([&] { return quarantine() == grpc::StatusCode::OK; }));
  EXPECT_EQ(now.worker().state(), v1::WORKER_STATE_QUARANTINED);
  EXPECT_EQ(world.controller->store().quarantines()->size(), 1U);
  EXPECT_EQ(release(), grpc::StatusCode::OK);
  EXPECT_TRUE(world.controller->store().quarantines()->empty());
  EXPECT_TRUE(retry(job).ok());
  EXPECT_TRUE(eventually([&] { return world.get(job).frames(0).restarts() > 0; }));
}

/// Nobody else's job waits for it: it takes some seconds, and whoever removes jobs waits for two.
TEST_F(NeverFreezes, WhileALongDocumentIsRead) {
  const std::string text = long_document();
  std::vector<uint64_t> ended;
  for (int i = 0; i < 40; ++i) ended.push_back(ended_job());
  std::atomic<bool> taken{false};
  clients.emplace_back([&] {
    EXPECT_TRUE(world.upload(text).ok());
    v1::SubmitResponse response;
    const auto context = world.context(120s);
    EXPECT_TRUE(world.jobs->Submit(context.get(), FarmWorld::request(text), &response).ok());
    taken = true;
  });
  size_t removed = 0;
  while (!taken && removed < ended.size()) {
    EXPECT_TRUE(remove(ended[removed++], 1500ms).ok());
    std::this_thread::sleep_for(100ms);
  }
  await_clients();
  EXPECT_GT(removed, 3U) << "it was read too fast for anybody to wait";
}

/// Jobs whose documents take seconds to read, and are read whenever they are needed.
class LongRecovery : public NeverFreezes {
 protected:
  void SetUp() override {
    world.options.document_memory = 1;
    world.options.recovery_time = std::chrono::seconds(0);
    NeverFreezes::SetUp();
    for (int i = 0; i < 40; ++i) ended.push_back(ended_job());
    ASSERT_TRUE(world.upload(text).ok());
    v1::SubmitResponse response;
    const auto context = world.context(120s);
    ASSERT_TRUE(world.jobs->Submit(context.get(), FarmWorld::request(text), &response).ok());
    job = response.job().id();
  }
  /// Others remove their jobs until `over`.
  template <class Over>
  void expect_others_served(const Over& over) {
    size_t removed = 0;
    while (!over() && removed < ended.size()) {
      EXPECT_TRUE(remove(ended[removed++], 1500ms).ok());
      std::this_thread::sleep_for(100ms);
    }
    EXPECT_GT(removed, 3U) << "it was read too fast for anybody to wait";
  }

  const std::string text = long_document();
  std::vector<uint64_t> ended;
  uint64_t job = 0;
};

TEST_F(LongRecovery, OfARetriedJobHoldsNobodyUp) {
  ASSERT_TRUE(cancel(job).ok());
  std::atomic<bool> taken{false};
  clients.emplace_back([&] {
    EXPECT_TRUE(retry(job, 120s).ok());
    taken = true;
  });
  expect_others_served([&] { return taken.load(); });
  await_clients();
}

TEST_F(LongRecovery, AfterAStartHoldsNobodyUp) {
  world.stop();
  world.start();
  expect_others_served([&] { return world.get(job).job().reason().empty(); });
}

/// Looking at what a job has written takes its time too.
TEST_F(NeverFreezes, WhileTheOutputsOfARetriedJobAreLookedAt) {
  const uint64_t job = ended_job();
  const uint64_t other = ended_job();
  trouble->of_outputs(Trouble::Kind::waits);
  clients.emplace_back([&] { EXPECT_TRUE(retry(job).ok()); });
  ASSERT_TRUE(eventually([&] { return trouble->waiting() > 0; }));
  EXPECT_TRUE(remove(other, 1500ms).ok());
  world.submit(1);
  // Nobody removes it meanwhile, or recovers it once more.
  EXPECT_EQ(remove(job).error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(retry(job).error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(cancel(job).error_code(), grpc::StatusCode::UNAVAILABLE);
  trouble->of_outputs(Trouble::Kind::none);
  await_clients();
  EXPECT_TRUE(cancel(job).ok());
}

TEST_F(NeverFreezes, AStartWhileTheOutputsOfAJobAreLookedAt) {
  const uint64_t job = world.submit(1);
  world.options.recovery_time = 100ms;
  world.stop();
  trouble->of_outputs(Trouble::Kind::waits);
  world.start();
  EXPECT_NE(world.get(job).job().reason().find("has just been started"), std::string::npos);
  EXPECT_EQ(cancel(job).error_code(), grpc::StatusCode::UNAVAILABLE);
  world.submit(1);
  trouble->of_outputs(Trouble::Kind::none);
  EXPECT_TRUE(eventually([&] { return world.get(job).job().reason().empty(); }));
  EXPECT_TRUE(cancel(job).ok());
}

/// What others' jobs need of the background is done beside it.
TEST_F(LongRecovery, OfManyHoldsUpNobodysNewJob) {
  std::vector<uint64_t> held;
  for (const char* owner : {"eve", "dan", "eve", "dan", "eve", "dan"}) {
    v1::SubmitRequest request = FarmWorld::request(text);
    request.set_owner(owner);
    request.set_idempotency_key("0123456789abcdef" + std::to_string(held.size()));
    v1::SubmitResponse response;
    const auto context = world.context(120s);
    ASSERT_TRUE(world.jobs->Submit(context.get(), request, &response).ok());
    v1::JobResponse now;
    held.push_back(response.job().id());
    ASSERT_TRUE(world.jobs->Pause(world.context().get(), about(held.back()), &now).ok());
  }
  ASSERT_TRUE(cancel(job).ok());
  world.stop();
  world.start();
  const ScriptedWorker worker(world.address, world.script());
  EXPECT_TRUE(world.wait_for(world.submit(1), v1::JOB_STATE_DONE));
  const auto waits = [&](uint64_t id) { return !world.get(id).job().reason().empty(); };
  EXPECT_TRUE(std::any_of(held.begin(), held.end(), waits)) << "it came after all of them";
}

TEST_F(NeverFreezes, WhileTheJobStoreDoesNotAnswer) {
  std::vector<uint64_t> open;
  for (int i = 0; i < 6; ++i) open.push_back(world.submit(1));
  const uint64_t over = ended_job();
  const uint64_t other = ended_job();
  const uint64_t job = long_job();
  for (const uint64_t id : open) {
    v1::JobResponse now;
    ASSERT_TRUE(world.jobs->Pause(world.context().get(), about(id), &now).ok());
  }
  const auto busy = worker();
  ASSERT_TRUE(eventually([&] { return busy->acknowledged() > 4; }));
  trouble->of_writes(Trouble::Kind::waits);
  trouble->of_reads(Trouble::Kind::waits);
  for (const uint64_t id : open) {
    clients.emplace_back([this, id] { (void)cancel(id); });
    clients.emplace_back([this, over] { (void)remove(over, 3s); });
    clients.emplace_back([this, other] { (void)retry(other, 3s); });
    clients.emplace_back([this, other] {
      v1::ExplainResponse why;
      (void)world.jobs->Explain(world.context(3s).get(), about(other), &why);
    });
    clients.emplace_back([this] {
      v1::ListJobsRequest all;
      all.set_ended(true);
      v1::ListJobsResponse list;
      (void)world.jobs->List(world.context(3s).get(), all, &list);
    });
  }
  expect_served(job, *busy);
  EXPECT_GT(trouble->most_waiting(), 3) << "the test waits for nothing";
  trouble->of_writes(Trouble::Kind::none);
  trouble->of_reads(Trouble::Kind::none);
  for (const uint64_t id : open) EXPECT_TRUE(world.wait_for(id, v1::JOB_STATE_CANCELLED)) << id;
  EXPECT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
}

TEST_F(NeverFreezes, WhileFilesCannotBeRead) {
  const uint64_t done = world.submit_text(FarmWorld::document(2) + "keep_films: true\n");
  {
    const auto first = worker();
    ASSERT_TRUE(world.wait_for(done, v1::JOB_STATE_DONE));
  }
  // Who opens a pipe that nobody writes to waits, as for a disk that does not answer.
  const std::string film = world.controller->output_folder(done) + "/balls.0001.film.exr";
  const std::string picture = world.controller->output_folder(done) + "/balls.0001.png";
  for (const std::string& path : {film, picture}) {
    ASSERT_TRUE(std::filesystem::remove(path));
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  }
  const uint64_t job = long_job();
  const auto busy = worker();
  ASSERT_TRUE(eventually([&] { return busy->acknowledged() > 4; }));
  std::atomic<int> served{0};
  for (int i = 0; i < 3; ++i) {
    clients.emplace_back([&, this] {
      v1::FilmRequest request;
      request.set_job(done);
      request.set_frame(1);
      const auto context = world.context();
      const auto reader = world.jobs->Film(context.get(), request);
      v1::FilmPart part;
      while (reader->Read(&part)) ++served;
      (void)reader->Finish();
    });
    clients.emplace_back([&, this] {
      v1::FetchRequest request;
      request.set_job(done);
      request.set_path("balls.0001.png");
      const auto context = world.context();
      const auto reader = world.jobs->Fetch(context.get(), request);
      v1::Chunk chunk;
      while (reader->Read(&chunk)) ++served;
      (void)reader->Finish();
    });
  }
  expect_served(job, *busy);
  EXPECT_EQ(served, 0) << "the test waits for nothing";
  // Whoever waits is let go: there is a writer, and then none.
  std::atomic<bool> over{false};
  std::thread writer([&] {
    while (!over) {
      for (const std::string& path : {film, picture}) {
        const int pipe = open(path.c_str(), O_WRONLY | O_NONBLOCK);
        if (pipe >= 0) close(pipe);
      }
      std::this_thread::sleep_for(1ms);
    }
  });
  await_clients();
  over = true;
  writer.join();
}

TEST_F(NeverFreezes, AJobThatCannotBeTakenUpNowWaitsAndSaysWhy) {
  const uint64_t job = world.submit(2);
  world.stop();
  trouble->of_frames(Trouble::Kind::fails);
  world.start();
  v1::ListJobsResponse list;
  ASSERT_TRUE(world.jobs->List(world.context().get(), {}, &list).ok());
  ASSERT_EQ(list.jobs_size(), 1);
  EXPECT_EQ(list.jobs(0).state(), v1::JOB_STATE_RUNNING) << list.jobs(0).reason();
  EXPECT_NE(list.jobs(0).reason().find("disk is full"), std::string::npos);
  v1::ExplainResponse why;
  ASSERT_TRUE(world.jobs->Explain(world.context().get(), about(job), &why).ok());
  ASSERT_EQ(why.reasons_size(), 1);
  EXPECT_NE(why.reasons(0).find("waits to be recovered"), std::string::npos) << why.reasons(0);
  v1::JobResponse paused;
  const grpc::Status refused = world.jobs->Pause(world.context().get(), about(job), &paused);
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::FAILED_PRECONDITION) << "who comes again waits";
  EXPECT_NE(refused.error_message().find("disk is full"), std::string::npos);
  trouble->of_frames(Trouble::Kind::none);
  const auto busy = worker();
  EXPECT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  EXPECT_EQ(world.get(job).job().reason(), "");
}

TEST_F(NeverFreezes, AJobWhoseFailureCannotBeStoredIsAmongThoseThatWait) {
  const uint64_t job = world.submit(2);
  world.stop();
  const std::string file = core::to_hex(core::sha256(FarmWorld::document(2)));
  ASSERT_TRUE(std::filesystem::remove(world.options.folder + "/assets/" + file));
  trouble->of_writes(Trouble::Kind::fails);
  world.start();
  v1::ListJobsResponse list;
  ASSERT_TRUE(world.jobs->List(world.context().get(), {}, &list).ok());
  ASSERT_EQ(list.jobs_size(), 1);
  EXPECT_EQ(list.jobs(0).id(), job);
  EXPECT_NE(list.jobs(0).reason().find("job.yaml is gone"), std::string::npos)
      << list.jobs(0).reason();
  trouble->of_writes(Trouble::Kind::none);
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_FAILED));
  list.Clear();
  EXPECT_TRUE(eventually([&] {
    return world.jobs->List(world.context().get(), {}, &list).ok() && list.jobs_size() == 0;
  })) << "it waits no longer";
}

TEST_F(NeverFreezes, AJobThatWaitsToBeTakenUpCanBeCancelled) {
  const uint64_t first = world.submit(1);
  const uint64_t job = world.submit(2);
  const uint64_t last = world.submit(1);
  world.stop();
  trouble->of_frames(Trouble::Kind::fails);
  world.start();
  trouble->of_writes(Trouble::Kind::fails);
  EXPECT_EQ(cancel(job).error_code(), grpc::StatusCode::UNAVAILABLE) << "it would not last";
  trouble->of_writes(Trouble::Kind::none);
  v1::JobResponse over;
  ASSERT_TRUE(world.jobs->Cancel(world.context().get(), about(job), &over).ok());
  EXPECT_EQ(over.job().state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(cancel(job).error_code(), grpc::StatusCode::FAILED_PRECONDITION) << "it has ended";
  v1::ListJobsRequest page;
  page.set_limit(1);
  v1::ListJobsResponse list;
  ASSERT_TRUE(world.jobs->List(world.context().get(), page, &list).ok());
  ASSERT_EQ(list.jobs_size(), 1);
  EXPECT_EQ(list.jobs(0).id(), last);
  page.set_before(list.next_before());
  ASSERT_TRUE(world.jobs->List(world.context().get(), page, &list).ok());
  ASSERT_EQ(list.jobs_size(), 1);
  EXPECT_EQ(list.jobs(0).id(), first) << "not the cancelled one";
  trouble->of_frames(Trouble::Kind::none);
  const auto busy = worker();
  EXPECT_TRUE(world.wait_for(last, v1::JOB_STATE_DONE));
  EXPECT_EQ(world.get(job).job().state(), v1::JOB_STATE_CANCELLED) << "recovered all the same";
  EXPECT_TRUE(retry(job).ok());
  EXPECT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
}

TEST_F(NeverFreezes, WhatIsStoredLastOfAJobIsWhatWasLast) {
  const uint64_t job = world.submit(1);
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < 8; ++i) {
      clients.emplace_back([&, this, priority = 10 * round + i] {
        v1::SetPriorityRequest request;
        request.set_job(job);
        request.set_priority(priority);
        v1::JobResponse now;
        EXPECT_TRUE(world.jobs->SetPriority(world.context().get(), request, &now).ok());
      });
    }
    for (std::thread& client : clients) client.join();
    clients.clear();
    const int now = world.get(job).job().priority();
    world.stop();
    world.start();
    ASSERT_EQ(world.get(job).job().priority(), now);
  }
  // The end is never overtaken by what came before it.
  clients.emplace_back([&, this] {
    for (int i = 0; i < 50; ++i) {
      v1::JobResponse now;
      (void)world.jobs->Pause(world.context().get(), about(job), &now);
      (void)world.jobs->Resume(world.context().get(), about(job), &now);
    }
  });
  std::this_thread::sleep_for(10ms);
  EXPECT_TRUE(cancel(job).ok());
  await_clients();
  world.stop();
  world.start();
  EXPECT_EQ(world.get(job).job().state(), v1::JOB_STATE_CANCELLED);
}

TEST_F(NeverFreezes, WhatIsExplainedOfAMillionFramesIsShort) {
  const uint64_t job =
      world.submit(1000, [](v1::SubmitRequest& request) { request.set_max_attempts(1); });
  ScriptedWorker::Script script = world.script();
  script.meddle = [](ScriptedWorker& self, const v1::LeasedUnit& unit) {
    return self.fail(unit, "it was not meant to be");
  };
  const ScriptedWorker broken(world.address, script);
  ASSERT_TRUE(eventually([&] { return world.get(job).job().frames_failed() > 40; }));
  v1::ExplainResponse why;
  ASSERT_TRUE(world.jobs->Explain(world.context().get(), about(job), &why).ok());
  EXPECT_LT(why.reasons_size(), 60);
  bool counted = false;
  for (const std::string& reason : why.reasons()) {
    counted |= reason.ends_with(" more frames failed");
  }
  EXPECT_TRUE(counted);
}

}  // namespace
}  // namespace hyades::coordinator
