// What submit and watch promise, and the way to the coordinator.
#include "tests/cli/client/client_testing.h"

namespace hyades::cli {
namespace {

TEST_F(Client, SubmitBringsWhatIsMissing) {
  const Ran ran =
      submit({"--priority", "7", "--owner", "bob", "--frames", "2-6x2", "--samples", "32"});
  EXPECT_EQ(ran.status, kDone) << ran.err;
  EXPECT_TRUE(has(ran.out, "job 1: tri")) << ran.out;
  ASSERT_EQ(farm_.submitted.size(), 1U);
  const v1::SubmitRequest request = farm_.submitted[0];
  EXPECT_EQ(request.owner(), "bob");
  EXPECT_EQ(request.priority(), 7);
  EXPECT_EQ(request.spec().samples(), 32U);
  EXPECT_EQ(request.spec().document(), "job.yaml");
  ASSERT_EQ(request.spec().files_size(), 2);
  EXPECT_EQ(request.spec().files(1).path(), "m/tri.obj");
  ASSERT_EQ(request.spec().frames_size(), 1);
  EXPECT_EQ(request.spec().frames(0).last(), 6);
  EXPECT_EQ(request.spec().frames(0).step(), 2);
  EXPECT_GE(request.idempotency_key().size(), 16U);
  EXPECT_TRUE(farm_.files[digest_of(mesh_)] == mesh_);

  const uint64_t before = farm_.uploaded;
  EXPECT_EQ(submit({"--json"}).status, kDone);
  EXPECT_EQ(farm_.uploaded, before);  // all is there
  ASSERT_EQ(farm_.submitted.size(), 2U);
  EXPECT_NE(farm_.submitted[1].idempotency_key(), request.idempotency_key());
}

TEST_F(Client, UploadsGoOnWhereTheyBroke) {
  farm_.upload_cut = 1'500'000;
  const Ran ran = submit();
  EXPECT_EQ(ran.status, kDone) << ran.err;
  EXPECT_TRUE(farm_.files[digest_of(mesh_)] == mesh_);
  // Sent twice is at most the piece that the break fell into.
  EXPECT_LT(farm_.uploaded, mesh_.size() + (size_t{1} << 20));
}

TEST_F(Client, UploadsBeginAgainWhereTheirBeginningIsLost) {
  farm_.upload_cut = 1'500'000;
  farm_.lose_partial = true;
  const Ran ran = submit();
  EXPECT_EQ(ran.status, kDone) << ran.err;
  EXPECT_TRUE(farm_.files[digest_of(mesh_)] == mesh_);
}

TEST_F(Client, UploadsThatArriveDamagedAreSentAgain) {
  farm_.damage_upload = true;
  EXPECT_EQ(submit().status, kDone);
  EXPECT_TRUE(farm_.files[digest_of(mesh_)] == mesh_);
}

TEST_F(Client, FilesForgottenMeanwhileAreBroughtAgain) {
  farm_.forget_files = 1;
  EXPECT_EQ(submit().status, kDone);
  farm_.forget_files = 100;
  EXPECT_EQ(submit().status, kFailed);
}

TEST_F(Client, BadJobsGoNowhere) {
  std::ofstream(folder_.file("job.yaml")) << "hyades: 1\nobjects: {a: {mesh: m/gone.obj}}\n";
  const Ran ran = submit();
  EXPECT_EQ(ran.status, kBadArguments);
  EXPECT_TRUE(has(ran.err, "job.yaml:2:")) << ran.err;
  EXPECT_EQ(farm_.calls, 0);
}

TEST_F(Client, FramesOutsideTheJobAreRefused) {
  const Ran ran = submit({"--frames", "5-11"});
  EXPECT_EQ(ran.status, kBadArguments);
  EXPECT_TRUE(has(ran.err, "within the job's range 1-10")) << ran.err;
}

TEST_F(Client, WatchEndsWithTheJob) {
  farm_.events = {event(v1::JOB_STATE_RUNNING, 0), event(v1::JOB_STATE_RUNNING, 50),
                  event(v1::JOB_STATE_DONE, 100)};
  EXPECT_EQ(submit({"--watch"}).status, kDone);
  farm_.break_streams = 2;  // comes again after each break
  const Ran done = run(watch_command, at({"1"}));
  EXPECT_EQ(done.status, kDone);
  EXPECT_TRUE(has(done.err, "warning: frame 1 line 1?[2J (and 2 others: hyades logs 1)\n"))
      << done.err;

  farm_.events.back() = event(v1::JOB_STATE_FAILED, 60);
  v1::Frame& frame = *farm_.events.back().add_changed();
  frame.set_frame(2);
  frame.set_state(v1::FRAME_STATE_FAILED);
  frame.set_reason("no memory");
  const Ran failed = run(watch_command, at({"tri"}));
  EXPECT_EQ(failed.status, kFailed);
  EXPECT_TRUE(has(failed.err, "frame 2 failed: no memory")) << failed.err;

  farm_.events.back() = event(v1::JOB_STATE_CANCELLED, 60);
  EXPECT_EQ(run(watch_command, at({"1", "--quiet"})).status, kCancelled);
}

TEST_F(Client, WatchSaysAtOnceWhyAJobWaitsAndOnce) {
  const std::string why = "it asks for workers with the tag 'gpu', and none is there";
  auto silent = event(v1::JOB_STATE_RUNNING, 0);
  auto waiting = event(v1::JOB_STATE_RUNNING, 0, why);
  for (auto* told : {&silent, &waiting}) told->mutable_job()->set_waiting(true);
  farm_.events = {silent, waiting, waiting, event(v1::JOB_STATE_DONE, 100)};
  add_job("tri");
  const Ran ran = run(watch_command, at({"1"}));
  EXPECT_TRUE(has(ran.err, "tri    0 %  frame 1/2  waiting for its turn\n")) << ran.err;
  EXPECT_TRUE(has(ran.err, "frame 1/2  " + why + "\n")) << ran.err;
  EXPECT_EQ(ran.err.find(why), ran.err.rfind(why)) << ran.err;
}

TEST_F(Client, SubmitAndWatchPrintsTheJobAsItEnds) {
  farm_.events = {event(v1::JOB_STATE_RUNNING, 50), event(v1::JOB_STATE_FAILED, 60)};
  const Ran ran = submit({"--watch", "--json"});
  EXPECT_EQ(ran.status, kFailed);
  EXPECT_EQ(json::parse(ran.out)["state"], "failed") << ran.out;
  EXPECT_EQ(json::parse(ran.out)["samples_done"], 60);
}

TEST_F(Client, NobodyThereIsSaidInOneLine) {
  const auto begin = std::chrono::steady_clock::now();
  const Ran ran = run(jobs_command, {"--coordinator", "127.0.0.1:1"});
  EXPECT_EQ(ran.status, kNoAnswer);
  EXPECT_TRUE(has(ran.err, "no coordinator answers at 127.0.0.1:1")) << ran.err;
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(15));
}

TEST_F(Client, AStartingCoordinatorIsWaitedFor) {
  farm_.unavailable = 3;
  EXPECT_EQ(run(jobs_command, at({})).status, kDone);
  EXPECT_EQ(farm_.calls, 3 + 2) << "the open ones and the last that ended";
}

TEST_F(Client, TheCoordinatorComesFromTheEnvironment) {
  ::setenv("HYADES_COORDINATOR", farm_.address().c_str(), 1);
  EXPECT_EQ(run(jobs_command, {}).status, kDone);
  ::unsetenv("HYADES_COORDINATOR");
}

TEST_F(Client, WrongAddressesAreWrongArguments) {
  const Ran ran = run(jobs_command, {"--coordinator", "127.0.0.1:99999"});
  EXPECT_EQ(ran.status, kBadArguments);
  EXPECT_TRUE(has(ran.err, "expected HOST:PORT")) << ran.err;
  ::setenv("HYADES_COORDINATOR", "127.0.0.1", 1);
  EXPECT_EQ(run(jobs_command, {}).status, kBadArguments);
  ::unsetenv("HYADES_COORDINATOR");
}

TEST_F(Client, TokensOpenTheDoor) {
  farm_.token = "0123456789abcdef";
  const Ran none = run(jobs_command, at({}));
  EXPECT_EQ(none.status, kRefused);
  EXPECT_TRUE(has(none.err, "--token-file")) << none.err;
  std::ofstream(folder_.file("token")) << "fedcba9876543210\n";
  EXPECT_EQ(run(jobs_command, at({"--token-file", folder_.file("token")})).status, kRefused);
  std::ofstream(folder_.file("token")) << farm_.token << "\n";
  EXPECT_EQ(run(jobs_command, at({"--token-file", folder_.file("token")})).status, kDone);
  EXPECT_EQ(run(jobs_command, at({"--token-file", folder_.file("gone")})).status, kBadArguments);
}

TEST_F(Client, PlainTextStaysOnThisMachine) {
  const Ran ran = run(jobs_command, {"--coordinator", "farm.example:7700"});
  EXPECT_EQ(ran.status, kBadArguments);
  EXPECT_TRUE(has(ran.err, "--insecure")) << ran.err;
}

}  // namespace
}  // namespace hyades::cli
