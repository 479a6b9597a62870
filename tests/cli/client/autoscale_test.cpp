// `hyades autoscale`: how many workers, and what becomes of the command.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "cli/client/failure.h"
#include "cli/client/finish_time.h"
#include "cli/client/scale_call.h"
#include "cli/client/scale_decision.h"
#include "cli/client_commands.h"
#include "tests/cli/client/fake_farm.h"
#include "tests/support/temp_folder.h"

namespace hyades::cli {
namespace {

using test::TempFolder;

constexpr double kHour = 3600;

ScaleState state(std::vector<ScaleJob> jobs) {
  ScaleState state;
  state.jobs = std::move(jobs);
  state.threads_per_worker = 8;
  state.least = 0;
  state.most = 100;
  return state;
}

TEST(ScaleDecision, AnEmptyQueueNeedsTheFewest) {
  EXPECT_EQ(decide_scale(state({})).wanted, 0U);
  ScaleState some = state({});
  some.least = 2;
  EXPECT_EQ(decide_scale(some).wanted, 2U);
}

TEST(ScaleDecision, WorkIsSharedByAsManyAsItTakesInTime) {
  // 800 hours of a thread in 10 hours: 80 threads.
  EXPECT_EQ(decide_scale(state({{800 * kHour, 10 * kHour, 0}})).wanted, 10U);
  EXPECT_EQ(decide_scale(state({{801 * kHour, 10 * kHour, 0}})).wanted, 11U);
  EXPECT_EQ(decide_scale(state({{0.1 * kHour, 10 * kHour, 0}})).wanted, 1U);
}

TEST(ScaleDecision, TheDeadlineThatNeedsMostDecides) {
  // 8 hours of work in 1 hour, and much later 16 hours more in 100.
  EXPECT_EQ(decide_scale(state({{16 * kHour, 100 * kHour, 0}, {8 * kHour, kHour, 0}})).wanted, 1U);
  EXPECT_EQ(decide_scale(state({{16 * kHour, 100 * kHour, 0}, {80 * kHour, kHour, 0}})).wanted,
            10U);
  // What is due earlier has to be done as well.
  EXPECT_EQ(decide_scale(state({{80 * kHour, 2 * kHour, 0}, {80 * kHour, kHour, 0}})).wanted, 10U);
  EXPECT_EQ(decide_scale(state({{240 * kHour, 2 * kHour, 0}, {80 * kHour, kHour, 0}})).wanted, 20U);
}

TEST(ScaleDecision, WhatIsLateGetsAllThatMayBeButNotMoreThanItCanUse) {
  const auto late = decide_scale(state({{8000 * kHour, -kHour, 0}}));
  EXPECT_EQ(late.wanted, 100U);
  EXPECT_NE(late.why.find("workers would be right"), std::string::npos) << late.why;
  // Four minutes of a worker's work are not worth five starts.
  EXPECT_EQ(decide_scale(state({{8 * 240, -kHour, 0}})).wanted, 4U);
  EXPECT_EQ(decide_scale(state({{800 * kHour, -kHour, 3}})).wanted, 3U);
  EXPECT_EQ(decide_scale(state({{800 * kHour, -kHour, 3}, {800 * kHour, -kHour, 4}})).wanted, 7U);
}

TEST(ScaleDecision, WorkThatNobodyHasBegunGetsOneWorkerToMeasureIt) {
  EXPECT_EQ(decide_scale(state({{std::nullopt, kHour, 0}})).wanted, 1U);
  EXPECT_EQ(decide_scale(state({{std::nullopt, kHour, 0}, {80 * kHour, kHour, 0}})).wanted, 10U);
}

TEST(ScaleDecision, AJobCountsForNoMoreWorkersThanMayRenderIt) {
  // One may have two workers and is late by far; the other is a minute of work for one.
  EXPECT_EQ(decide_scale(state({{800 * kHour, -kHour, 2}, {8 * 60, kHour, 0}})).wanted, 3U);
  // The limit of one is nothing to the other.
  EXPECT_EQ(decide_scale(state({{800 * kHour, kHour, 2}, {80 * kHour, kHour, 0}})).wanted, 12U);
}

ScaleDecision now_wanted(const ScaleState& state) {
  return ScalePlan(std::chrono::minutes(5)).next(state, {});
}

TEST(ScalePlan, BeyondTheMoneyThereAreOnlyTheFewest) {
  ScaleState dear = state({{800 * kHour, 10 * kHour, 0}});
  dear.interval = kHour;
  dear.price = 2;
  dear.money_left = 1000;
  EXPECT_EQ(now_wanted(dear).wanted, 10U);
  dear.money_left = 7;  // three workers for an hour, and a rest
  EXPECT_EQ(now_wanted(dear).wanted, 3U);
  EXPECT_NE(now_wanted(dear).why.find("7.00 are left"), std::string::npos);
  dear.money_left = -1;
  EXPECT_EQ(now_wanted(dear).wanted, 0U);
  dear.least = 2;
  EXPECT_EQ(now_wanted(dear).wanted, 2U);
}

TEST(ScalePlan, NeverSpendsMoreThanThereIsWhileItWaitsToSendWorkersHome) {
  ScaleState farm = state({{1000 * kHour, kHour, 0}});
  farm.most = 20;
  farm.interval = 60;
  farm.price = 0.35;
  ScalePlan plan(std::chrono::hours(1));
  double spent = 0;
  ScaleDamper::TimePoint now{};
  uint32_t last = 0;
  for (int minute = 0; minute < 120; ++minute) {
    if (minute == 1) farm.jobs = {{kHour, kHour, 0}};  // one is enough, and the others stay a while
    farm.money_left = 1 - spent;
    last = plan.next(farm, now).wanted;
    spent += last * *farm.price / 60;
    now += std::chrono::minutes(1);
  }
  EXPECT_LE(spent, 1.0 + 1e-9);
  EXPECT_GT(spent, 0.9) << "what is there may be spent";
  EXPECT_EQ(last, 0U);
}

TEST(ScaleDamper, GoesUpAtOnceAndDownWhenLessWasEnoughForLong) {
  using std::chrono::minutes;
  const ScaleDamper::TimePoint start{};
  ScaleDamper damper(minutes(5));
  EXPECT_EQ(damper.follow(3, start), 3U);
  EXPECT_EQ(damper.follow(9, start + minutes(1)), 9U);
  EXPECT_EQ(damper.follow(2, start + minutes(2)), 9U);
  EXPECT_EQ(damper.follow(4, start + minutes(4)), 9U);
  EXPECT_EQ(damper.follow(2, start + minutes(6)), 9U);
  EXPECT_EQ(damper.follow(2, start + minutes(7)), 4U);
  EXPECT_EQ(damper.follow(2, start + minutes(10)), 2U);
  EXPECT_EQ(damper.follow(5, start + minutes(11)), 5U);
}

TEST(FinishTime, IsReadInTheWaysThatPeopleWrite) {
  ::setenv("TZ", "UTC", 1);
  ::tzset();
  const std::time_t now = 1'700'000'000;  // 2023-11-14T22:13:20Z
  EXPECT_EQ(*parse_moment("2023-11-14T23:00:00Z", now), now + 2800);
  EXPECT_EQ(*parse_moment("2023-11-14T23:00Z", now), now + 2800);
  EXPECT_EQ(*parse_moment("2023-11-14T23:00", now), now + 2800);
  EXPECT_EQ(*parse_moment("23:00", now), now + 2800);
  EXPECT_EQ(*parse_moment("22:13", now), now - 20 + 86400) << "tomorrow";
  for (const char* text : {"", "25:00", "noon", "23:00 ", "2023-11-14", "1h"}) {
    EXPECT_FALSE(parse_moment(text, now)) << text;
  }
  ::unsetenv("TZ");
  ::tzset();
}

std::string read_file(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

bool never() { return false; }

TEST(ScaleCall, GivesTheNumberAsArgumentAndInTheEnvironment) {
  const TempFolder folder;
  const auto called =
      call_scaler("sh -c 'echo $HYADES_WANTED $* >\"$0\"' " + folder.file("said") + " --replicas",
                  7, 30, never);
  ASSERT_TRUE(called.ok()) << called.error().message;
  EXPECT_EQ(read_file(folder.file("said")), "7 --replicas 7\n");
}

TEST(ScaleCall, TellsWhatACommandThatFailsSays) {
  const auto called = call_scaler("echo no such deployment; exit 3; :", 7, 30, never);
  ASSERT_FALSE(called.ok());
  EXPECT_NE(called.error().message.find("(3)"), std::string::npos) << called.error().message;
  EXPECT_NE(called.error().message.find("no such deployment"), std::string::npos);
}

TEST(ScaleCall, EndsACommandThatHangsWithAllThatItHasStarted) {
  const TempFolder folder;
  const auto called =
      call_scaler("sleep 300 & echo $! >" + folder.file("child") + "; wait; :", 7, 0.5, never);
  ASSERT_FALSE(called.ok());
  EXPECT_EQ(called.error().message, "it took longer than 0.5 s and was ended");
  const int child = std::stoi(read_file(folder.file("child")));
  bool gone = false;
  for (int i = 0; i < 500 && !gone; ++i) {
    std::string status = read_file("/proc/" + std::to_string(child) + "/stat");
    gone = status.empty() || status.find(") Z") != std::string::npos;
    if (!gone) ::usleep(10'000);
  }
  EXPECT_TRUE(gone);
}

class Autoscale : public ::testing::Test {
 protected:
  int run(std::vector<std::string> words) {
    const bool own = std::find(words.begin(), words.end(), "--exec") != words.end();
    words.insert(words.begin(),
                 {"autoscale", "--coordinator", farm_.address(), "--max", "20", "--once"});
    if (!own) words.insert(words.end(), {"--exec", "echo >>" + folder_.file("called")});
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    ::testing::internal::CaptureStderr();
    const int status = autoscale_command(static_cast<int>(argv.size()), argv.data());
    err_ = ::testing::internal::GetCapturedStderr();
    return status;
  }
  /// What the command was called with.
  std::string called() const { return read_file(folder_.file("called")); }

  v1::Job& add_job(double threads_hours_left) {
    v1::Job job;
    job.set_id(farm_.jobs.size() + 1);
    job.set_state(v1::JOB_STATE_RUNNING);
    job.set_samples(2'000'000);
    job.set_samples_done(1'000'000);
    job.set_core_seconds(threads_hours_left * kHour);  // as many samples are left as are done
    job.set_submitted_ms(1000 * static_cast<int64_t>(std::time(nullptr)));
    farm_.jobs.push_back(job);
    return farm_.jobs.back();
  }
  void add_worker(const std::vector<std::string>& tags = {}) {
    v1::Worker worker;
    worker.set_id(farm_.workers.size() + 1);
    worker.set_threads(8);
    worker.set_leased(16);
    worker.set_state(v1::WORKER_STATE_ACTIVE);
    for (const std::string& tag : tags) worker.add_tags(tag);
    farm_.workers.push_back(worker);
  }

  TempFolder folder_;
  FakeFarm farm_;
  std::string err_;
};

TEST_F(Autoscale, AsksForWhatTheQueueNeeds) {
  add_job(78);
  add_worker();
  EXPECT_EQ(run({"--within", "10h"}), kDone) << err_;
  EXPECT_EQ(called(), "1\n") << err_;
  EXPECT_EQ(run({"--within", "2h"}), kDone) << err_;
  EXPECT_EQ(called(), "1\n5\n") << err_;
}

TEST_F(Autoscale, ATimeOfDayIsTheFirstOneAfterAJobsSubmission) {
  ::setenv("TZ", "UTC", 1);  // no clocks change
  ::tzset();
  // Submitted six hours ago, due five hours ago: late, so that all the workers are wanted that may
  // be.
  const std::time_t due = std::time(nullptr) - 5 * 3600;
  char text[6];
  std::tm local{};
  std::strftime(text, sizeof text, "%H:%M", ::localtime_r(&due, &local));
  add_job(1600).set_submitted_ms(1000 * (static_cast<int64_t>(due) - 3600));
  add_worker();
  EXPECT_EQ(run({"--finish-by", text}), kDone) << err_;
  EXPECT_EQ(called(), "20\n") << err_;
  // Submitted an hour after it: due tomorrow, in nineteen hours.
  farm_.jobs.back().set_submitted_ms(1000 * (static_cast<int64_t>(due) + 3600));
  EXPECT_EQ(run({"--finish-by", text}), kDone) << err_;
  EXPECT_EQ(called(), "20\n11\n") << err_;
  ::unsetenv("TZ");
  ::tzset();
}

TEST_F(Autoscale, PausedJobsAndThoseForOtherWorkersDoNotCount) {
  add_job(800).set_state(v1::JOB_STATE_PAUSED);
  add_job(800).add_tags("gpu");
  add_worker();
  EXPECT_EQ(run({}), kDone) << err_;
  EXPECT_EQ(called(), "0\n") << err_;
  farm_.workers.clear();
  add_worker({"gpu", "big"});
  EXPECT_EQ(run({"--tags", "gpu,big"}), kDone) << err_;
  EXPECT_EQ(called(), "0\n20\n") << err_;
}

TEST_F(Autoscale, ACommandThatFailsIsToldAndIsTheExitStatus) {
  add_job(80);
  EXPECT_EQ(run({"--exec", "echo quota; false"}), kFailed);
  EXPECT_NE(err_.find("the command failed, it is tried again: "), std::string::npos) << err_;
  EXPECT_NE(err_.find("quota"), std::string::npos) << err_;
}

TEST_F(Autoscale, DryRunsCallNobody) {
  add_job(80).set_samples_done(0);
  EXPECT_EQ(run({"--dry-run"}), kDone) << err_;
  EXPECT_NE(err_.find("wanted 1, there are 0: work that nobody has begun"), std::string::npos)
      << err_;
  EXPECT_FALSE(std::filesystem::exists(folder_.file("called")));
}

TEST_F(Autoscale, WrongArgumentsAreTold) {
  EXPECT_EQ(run({"--min", "21"}), kBadArguments);
  EXPECT_EQ(run({"--max-cost", "7"}), kBadArguments);
  EXPECT_NE(err_.find("expected --price"), std::string::npos) << err_;
  EXPECT_EQ(run({"--finish-by", "noon"}), kBadArguments);
  EXPECT_EQ(run({"--finish-by", "18:00", "--within", "2h"}), kBadArguments);
  EXPECT_EQ(run({"--within", "soon"}), kBadArguments);
}

}  // namespace
}  // namespace hyades::cli
