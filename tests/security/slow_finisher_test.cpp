// Jobs whose outputs take minutes to make.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

/// A farm whose finisher does not end with frames of the jobs 1 and 2 before go() was called. The
/// frame of job 1 is being finished.
class SlowFinisher : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string program = world_.folder.file("finisher");
    std::ofstream(program) << "#!/bin/sh\n"
                           << "case \"${2##*/}\" in\n"
                           << "  1-*|2-*) echo $$ >>" << begun_ << "; until [ -e " << go_
                           << " ]; do sleep 0.05; done;;\n"
                           << "esac\n"
                           << "exec " << world_.options.finisher << " \"$@\"\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    world_.options.finisher = program;
    world_.start();
    EXPECT_EQ(submit("mallory"), 1U);
    worker_.emplace(world_.address, world_.script());
    ASSERT_TRUE(eventually([&] { return !begun().empty(); }));
    EXPECT_EQ(submit("mallory"), 2U)
        << "after the first one's finisher: which begins first is known";
  }
  void TearDown() override {
    world_.stop();
    for (const pid_t finisher : begun()) EXPECT_FALSE(is_alive(finisher));
  }

  uint64_t submit(const std::string& owner) {
    return world_.submit(1, [&](v1::SubmitRequest& request) { request.set_owner(owner); });
  }
  /// The finishers that were begun with for those jobs.
  std::vector<pid_t> begun() const {
    std::vector<pid_t> finishers;
    std::ifstream file(begun_);
    for (pid_t one; file >> one;) finishers.push_back(one);
    return finishers;
  }
  void go() const { std::ofstream(go_) << "go"; }
  static bool is_alive(pid_t process) { return ::kill(process, 0) == 0; }

  FarmWorld world_;

 private:
  const std::string begun_ = world_.folder.file("begun");
  const std::string go_ = world_.folder.file("go");
  std::optional<ScriptedWorker> worker_;
};

TEST_F(SlowFinisher, IsWaitedForByNobodyElse) {
  EXPECT_TRUE(world_.wait_for(submit("ada"), v1::JOB_STATE_DONE));
  EXPECT_EQ(begun().size(), 1U) << "of one owner's frames one is finished at a time";
}

TEST_F(SlowFinisher, IsWhatPeopleAreToldThatTheirJobsWaitFor) {
  ASSERT_TRUE(eventually([&] { return world_.get(1).job().frames_finishing() == 1; }));
  EXPECT_FALSE(world_.get(1).job().waiting()) << "it is worked on, though no worker has any of it";
  v1::ExplainResponse why;
  ASSERT_TRUE(world_.jobs->Explain(world_.context().get(), about(1), &why).ok());
  ASSERT_GT(why.reasons_size(), 0);
  EXPECT_NE(why.reasons(0).find("its outputs are being made"), std::string::npos) << why.reasons(0);
}

TEST_F(SlowFinisher, EndsWithItsJob) {
  const pid_t first = begun().front();
  v1::JobResponse now;
  ASSERT_TRUE(world_.jobs->Cancel(world_.context().get(), about(1), &now).ok());
  EXPECT_TRUE(eventually([&] { return !is_alive(first); }));
  EXPECT_TRUE(eventually([&] { return begun().size() == 2; })) << "the next one's turn has come";
  EXPECT_EQ(world_.get(1).job().state(), v1::JOB_STATE_CANCELLED);
}

/// Of a job that is cancelled and retried nothing waits from before: neither films nor work.
TEST_F(SlowFinisher, KeepsNothingOfJobsThatWereCancelled) {
  const auto finishing = [&] {
    const v1::GetJobResponse now = world_.get(2);
    return now.frames_size() > 0 && now.frames(0).state() == v1::FRAME_STATE_FINISHING;
  };
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(eventually(finishing));
    v1::JobResponse now;
    ASSERT_TRUE(world_.jobs->Cancel(world_.context().get(), about(2), &now).ok());
    ASSERT_TRUE(world_.jobs->Retry(world_.context().get(), about(2), &now).ok());
  }
  ASSERT_TRUE(eventually(finishing));
  go();
  EXPECT_TRUE(world_.wait_for(1, v1::JOB_STATE_DONE));
  EXPECT_TRUE(world_.wait_for(2, v1::JOB_STATE_DONE));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_EQ(begun().size(), 2U) << "each frame is finished once";
}

}  // namespace
}  // namespace hyades::coordinator
