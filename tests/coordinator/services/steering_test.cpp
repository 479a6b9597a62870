// What people do with jobs while they run, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

TEST(Steering, APausedJobRestsAlsoOverARestart) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(2);
  v1::JobResponse now;
  ASSERT_TRUE(world.jobs->Pause(world.context().get(), about(job), &now).ok());
  EXPECT_EQ(now.job().state(), v1::JOB_STATE_PAUSED);
  EXPECT_EQ(now.job().begun_ms(), 0) << "nobody has had any of it";
  world.stop();
  world.start();
  EXPECT_EQ(world.get(job).job().state(), v1::JOB_STATE_PAUSED);
  const ScriptedWorker worker(world.address, world.script());
  std::this_thread::sleep_for(500ms);
  EXPECT_EQ(worker.delivered(), 0U);
  ASSERT_TRUE(world.jobs->Resume(world.context().get(), about(job), &now).ok());
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  world.expect_truth(job, 2);
}

/// The lines of a job's log.
std::string log_of(const FarmWorld& world, uint64_t job) {
  v1::LogsRequest request;
  request.set_job(job);
  const auto context = world.context();
  const auto reader = world.jobs->Logs(context.get(), request);
  std::string all;
  for (v1::LogLine line; reader->Read(&line);) all += line.text() + "\n";
  (void)reader->Finish();
  return all;
}

TEST(Steering, WaitingIsNotWhatAJobTook) {
  FarmWorld world;
  world.options.unit_time = 1ms;  // a batch: so there are many units
  world.start();
  const uint64_t job = world.submit(3);
  constexpr const char* kNobody = "no worker is there that could take units";
  const auto waits = [&] { return world.get(job).job().reason() == kNobody; };
  EXPECT_TRUE(eventually(waits));
  EXPECT_EQ(world.get(job).job().busy_seconds(), 0);
  {
    ScriptedWorker::Script script = world.script();
    script.unit_time = 20ms;
    const ScriptedWorker worker(world.address, script);
    ASSERT_TRUE(eventually([&] { return worker.acknowledged() >= 8; }));
    EXPECT_EQ(world.get(job).job().reason(), "");
  }
  EXPECT_TRUE(eventually(waits)) << "and what the worker had goes to others";
  const double busy = world.get(job).job().busy_seconds();
  EXPECT_GE(busy, 0.08) << "eight units of 20 ms on two threads";
  std::this_thread::sleep_for(600ms);
  EXPECT_EQ(world.get(job).job().busy_seconds(), busy);
  world.stop();
  world.start();
  EXPECT_NEAR(world.get(job).job().busy_seconds(), busy, 1e-6) << "an orderly end loses none of it";
  const ScriptedWorker worker(world.address, world.script(2));
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  const v1::Job over = world.get(job).job();
  EXPECT_GT(over.busy_seconds(), busy);
  EXPECT_LT(over.busy_seconds(),
            1e-3 * static_cast<double>(over.ended_ms() - over.begun_ms()) - 0.5);
}

TEST(Steering, AFrameThatIsBlackAllOverIsToldOf) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(2);
  ScriptedWorker::Script script = world.script();
  script.corrupt = [](core::Film& film) {
    for (int channel = 0; channel < 3; ++channel) {
      std::ranges::fill(film.mutable_plane(channel), core::Fixed128{});
    }
  };
  ScriptedWorker::Script first = script;
  first.meddle = [](ScriptedWorker&, const v1::LeasedUnit& leased) {
    return leased.unit().frame() == 1;
  };
  constexpr const char* kBlack = "frame 1 is black all over";
  {
    const ScriptedWorker worker(world.address, first);
    ASSERT_TRUE(eventually([&] { return world.get(job).frames(0).black(); }));
    EXPECT_NE(world.explain(job).find(kBlack), std::string::npos) << world.explain(job);
  }
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  EXPECT_TRUE(world.get(job).frames(1).black());
  EXPECT_NE(world.explain(job).find(kBlack), std::string::npos) << "after its end too";
  EXPECT_NE(log_of(world, job).find("is black all over"), std::string::npos);
}

TEST(Steering, AJobThatNothingLightsIsWarnedOf) {
  FarmWorld world;
  world.start();
  std::string text = FarmWorld::document(1);
  ASSERT_TRUE(world.upload(text).ok());
  v1::SubmitResponse response;
  ASSERT_TRUE(world.jobs->Submit(world.context().get(), world.request(text), &response).ok());
  EXPECT_EQ(response.warnings_size(), 0);
  constexpr std::string_view kSky = "environment: {color: 1}\n";
  text.erase(text.find(kSky), kSky.size());
  ASSERT_TRUE(world.upload(text).ok());
  const grpc::Status status =
      world.jobs->Submit(world.context().get(), world.request(text), &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(response.warnings_size(), 1);
  EXPECT_TRUE(eventually([&] {
    return log_of(world, response.job().id()).find(response.warnings(0)) != std::string::npos;
  }));
}

TEST(Steering, AJobsLogTellsOfStartsAndOfWhatPeopleDo) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  world.stop();
  world.start();
  v1::JobResponse now;
  v1::SetPriorityRequest request;
  request.set_job(job);
  request.set_priority(7);
  ASSERT_TRUE(world.jobs->SetPriority(world.context().get(), request, &now).ok());
  ASSERT_TRUE(world.jobs->Cancel(world.context().get(), about(job), &now).ok());
  const std::string log = log_of(world, job);
  for (const char* told : {"goes on: the coordinator has been started again\n",
                           "priority changed to 7\n", "cancelled\n"}) {
    EXPECT_NE(log.find(told), std::string::npos) << log;
  }
}

TEST(Steering, AWorkerThatCameAgainIsNotCalledDrained) {
  FarmWorld world;
  world.start();
  v1::WorkerResponse now;
  v1::WorkerRequest request;
  request.set_worker("scripted/1");
  request.set_reason("drained");
  {
    const ScriptedWorker worker(world.address, world.script());
    ASSERT_TRUE(eventually([&] { return worker.streams() == 1; }));
    ASSERT_TRUE(world.farm_->DrainWorker(world.context().get(), request, &now).ok());
  }
  ScriptedWorker::Script script = world.script();
  script.name = "scripted/3";  // another process, by the same cache
  const ScriptedWorker worker(world.address, script);
  v1::WorkersResponse workers;
  EXPECT_TRUE(eventually([&] {
    (void)world.farm_->Workers(world.context().get(), {}, &workers);
    return workers.workers_size() == 1 && workers.workers(0).name() == "scripted/3" &&
           workers.workers(0).state() == v1::WORKER_STATE_ACTIVE;
  }));
  EXPECT_EQ(workers.workers(0).reason(), "");
}

TEST(Steering, ACancelledJobCanBeTakenUpAgainAndDeleted) {
  FarmWorld world;
  world.options.unit_time = 1ms;  // a batch: so there are many units
  world.start();
  const uint64_t job = world.submit(3);
  v1::JobResponse now;
  {
    ScriptedWorker::Script script = world.script();
    script.unit_time = 5ms;
    const ScriptedWorker worker(world.address, script);
    ASSERT_TRUE(eventually([&] { return worker.acknowledged() >= 8; }));
    ASSERT_TRUE(world.jobs->Cancel(world.context().get(), about(job), &now).ok());
  }
  EXPECT_EQ(now.job().state(), v1::JOB_STATE_CANCELLED);
  const v1::Job over = world.get(job).job();
  EXPECT_GT(over.samples_done(), 0U) << "what 'retry' goes on with";
  EXPECT_GE(over.begun_ms(), over.submitted_ms());
  EXPECT_LE(over.begun_ms(), over.ended_ms());
  const grpc::Status late = world.jobs->Pause(world.context().get(), about(job), &now);
  EXPECT_EQ(late.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  ASSERT_TRUE(world.jobs->Retry(world.context().get(), about(job), &now).ok());
  EXPECT_GE(now.job().samples_done(), over.samples_done())
      << "its films are still there, and such as were on their way to the disk";
  const ScriptedWorker worker(world.address, world.script(2));
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  for (int frame = 1; frame <= 3; ++frame) world.expect_truth(job, frame);
  v1::DeleteJobResponse gone;
  ASSERT_TRUE(world.jobs->Delete(world.context().get(), about(job), &gone).ok());
  v1::GetJobRequest get;
  get.set_job(job);
  v1::GetJobResponse nothing;
  EXPECT_EQ(world.jobs->Get(world.context().get(), get, &nothing).error_code(),
            grpc::StatusCode::NOT_FOUND);
}

TEST(Steering, WhyAWorkerGivesUnitsBackIsInTheJobsLogOnce) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  std::atomic<int> given{0};
  ScriptedWorker::Script script = world.script();
  script.meddle = [&](ScriptedWorker& worker, const v1::LeasedUnit& unit) {
    if (++given > 3) return true;
    v1::WorkerMessage message;
    *message.mutable_returned()->add_units() = unit;
    message.mutable_returned()->set_reason("the disk is full");
    worker.write(message);
    v1::WorkerMessage more;
    more.mutable_request()->set_units(1);
    worker.write(more);
    return false;
  };
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  v1::LogsRequest request;
  request.set_job(job);
  const auto context = world.context();
  const auto reader = world.jobs->Logs(context.get(), request);
  int told = 0;
  v1::LogLine line;
  while (reader->Read(&line)) told += line.text() == "gives units back: the disk is full" ? 1 : 0;
  (void)reader->Finish();
  EXPECT_EQ(told, 1);
}

TEST(Steering, AUnitThatFailsThreeTimesFailsItsFrameAndRetryMendsIt) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(2);
  {
    ScriptedWorker::Script script = world.script();
    script.meddle = [](ScriptedWorker& worker, const v1::LeasedUnit& unit) {
      if (unit.unit().frame() != 1) return true;
      return worker.fail(unit, "the scene does not load");
    };
    const ScriptedWorker worker(world.address, script);
    ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_FAILED));
  }
  const v1::GetJobResponse over = world.get(job);
  EXPECT_EQ(over.job().frames_done(), 1U);
  EXPECT_EQ(over.job().frames_failed(), 1U);
  EXPECT_NE(over.job().reason().find("does not load"), std::string::npos) << over.job().reason();
  v1::JobResponse now;
  ASSERT_TRUE(world.jobs->Retry(world.context().get(), about(job), &now).ok());
  const ScriptedWorker worker(world.address, world.script(2));
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  world.expect_truth(job, 1);
  world.expect_truth(job, 2);
}

TEST(Steering, ARetriedFrameIsShownAsRenderedWhenOneWorkerTakesAllOfItAtOnce) {
  FarmWorld world;
  world.start();
  std::atomic<bool> mended{false};
  ScriptedWorker::Script script = world.script();
  script.threads = 64;
  script.meddle = [&](ScriptedWorker& worker, const v1::LeasedUnit& unit) {
    if (unit.unit().frame() != 1 || mended) return false;  // it keeps the rest
    return worker.fail(unit, "the scene does not load");
  };
  const ScriptedWorker worker(world.address, script);
  const uint64_t job = world.submit(2, [](v1::SubmitRequest& asked) { asked.set_max_attempts(1); });
  const auto first = [&] { return world.get(job).frames(0); };
  ASSERT_TRUE(eventually([&] { return first().state() == v1::FRAME_STATE_FAILED; }));
  mended = true;
  v1::JobResponse now;
  ASSERT_TRUE(world.jobs->Retry(world.context().get(), about(job), &now).ok());
  EXPECT_TRUE(eventually([&] { return first().state() == v1::FRAME_STATE_RENDERING; }));
  EXPECT_EQ(first().worker_class(), "class-a");
  EXPECT_EQ(first().restarts(), 1U);
}

TEST(Steering, AFrameWhoseClassHasVanishedBeginsAgain) {
  FarmWorld world;
  world.options.class_patience = 400ms;
  world.start();
  const uint64_t job = world.submit(1);
  {
    ScriptedWorker::Script script = world.script();
    script.unit_time = 10ms;
    const ScriptedWorker worker(world.address, script);
    ASSERT_TRUE(eventually([&] { return worker.acknowledged() >= 2; }));
  }
  ScriptedWorker::Script script = world.script(2);
  script.worker_class = "class-b";
  const ScriptedWorker worker(world.address, script);
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  EXPECT_EQ(world.get(job).frames(0).worker_class(), "class-b");
  EXPECT_EQ(world.get(job).frames(0).restarts(), 1U);
  world.expect_truth(job, 1);
}

TEST(Steering, DamagedAndForeignFilmsAreRefused) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  {
    ScriptedWorker::Script script = world.script();
    script.meddle = [](ScriptedWorker& worker, const v1::LeasedUnit& unit) {
      v1::WorkerMessage message;
      v1::UnitResult& result = *message.mutable_result();
      *result.mutable_lease() = unit.lease();
      result.set_job(unit.job());
      *result.mutable_unit() = unit.unit();
      result.set_film("this is no film");
      result.set_digest(std::string(32, 'x'));
      worker.write(message);
      return false;
    };
    const ScriptedWorker worker(world.address, script);
    ASSERT_TRUE(eventually([&] { return !worker.rejections().empty(); }));
    EXPECT_EQ(worker.rejections().front().reason(), v1::Rejected::REASON_DAMAGED);
  }
  const ScriptedWorker worker(world.address, world.script(2));
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  world.expect_truth(job, 1);
}

TEST(Steering, SubmittingTwiceMakesOneJobAndMissingFilesAreNamed) {
  FarmWorld world;
  world.start();
  const std::string text = FarmWorld::document(1);
  v1::SubmitRequest request = FarmWorld::request(text);
  request.set_idempotency_key("0123456789abcdef");
  v1::SubmitResponse response;
  const grpc::Status early = world.jobs->Submit(world.context().get(), request, &response);
  EXPECT_EQ(early.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  ASSERT_EQ(farm::detail_of(early).missing_size(), 1);
  EXPECT_EQ(farm::detail_of(early).missing(0), farm::to_wire(core::sha256(text)));
  ASSERT_TRUE(world.upload(text).ok());
  ASSERT_TRUE(world.jobs->Submit(world.context().get(), request, &response).ok());
  EXPECT_FALSE(response.existed());
  const uint64_t id = response.job().id();
  ASSERT_TRUE(world.jobs->Submit(world.context().get(), request, &response).ok());
  EXPECT_TRUE(response.existed());
  EXPECT_EQ(response.job().id(), id);

  const std::string bad = "hyades: 1\nfilm: {size: [80, 48]}\nobjets: {}\n";
  ASSERT_TRUE(world.upload(bad).ok());
  const grpc::Status refused =
      world.jobs->Submit(world.context().get(), FarmWorld::request(bad), &response);
  EXPECT_EQ(refused.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_NE(refused.error_message().find("job.yaml:3"), std::string::npos)
      << refused.error_message();
}

TEST(Steering, WithoutTheTokenNothingGoes) {
  FarmWorld world;
  const std::string file = world.folder.file("token");
  FILE* out = std::fopen(file.c_str(), "w");
  std::fputs("a-token-of-some-length\n", out);
  std::fclose(out);
  world.how.token_file = file;
  world.start();
  v1::InfoResponse info;
  const auto refusal = [&] {
    const grpc::Status status = world.farm_->Info(world.context().get(), {}, &info);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAUTHENTICATED);
    return status.error_message();
  };
  EXPECT_NE(refusal().find("wants a token"), std::string::npos) << refusal();
  for (const char* wrong : {"a-token-of-some-lengtH", "another-token-of-another-length"}) {
    world.token = wrong;
    EXPECT_NE(refusal().find("not a token of this coordinator"), std::string::npos) << refusal();
  }
  world.token.clear();
  ScriptedWorker::Script script = world.script();
  script.reconnect = false;
  {
    const ScriptedWorker worker(world.address, script);
    EXPECT_TRUE(eventually(
        [&] { return worker.last_status().error_code() == grpc::StatusCode::UNAUTHENTICATED; }));
  }
  world.token = "a-token-of-some-length";
  EXPECT_TRUE(world.farm_->Info(world.context().get(), {}, &info).ok());
  grpc::ClientContext old;
  old.AddMetadata(farm::kTokenKey, "Bearer " + world.token);
  EXPECT_EQ(world.farm_->Info(&old, {}, &info).error_code(), grpc::StatusCode::FAILED_PRECONDITION)
      << "a caller that does not tell its protocol";
}

}  // namespace
}  // namespace hyades::coordinator
