#include "worker/clouds/preemption_watch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/worker/clouds/fake_cloud.h"

namespace hyades::worker {
namespace {

using Manner = FakeCloud::Manner;

class Heard : public PreemptionWatch::Listener {
 public:
  void preempted(const Notice& notice) override {
    const std::lock_guard lock(mutex_);
    notices_.push_back(notice);
    changed_.notify_all();
  }
  void watch_trouble(const std::string& reason) override {
    const std::lock_guard lock(mutex_);
    troubles_.push_back(reason);
    changed_.notify_all();
  }
  /// Waits until so many notices and troubles were heard.
  bool wait_for(size_t notices, size_t troubles) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(60), [&] {
      return notices_.size() >= notices && troubles_.size() >= troubles;
    });
  }
  std::vector<Notice> notices() const {
    const std::lock_guard lock(mutex_);
    return notices_;
  }
  std::vector<std::string> troubles() const {
    const std::lock_guard lock(mutex_);
    return troubles_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Notice> notices_;
  std::vector<std::string> troubles_;
};

bool wait_until(const std::function<bool()>& reached) {
  for (int i = 0; i < 6000 && !reached(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return reached();
}

class PreemptionWatchOf : public testing::TestWithParam<Cloud> {};

TEST_P(PreemptionWatchOf, HearsTheNoticeOnce) {
  FakeCloud cloud(GetParam());
  Heard heard;
  const PreemptionWatch watch(GetParam(), cloud.url(), heard);
  ASSERT_TRUE(wait_until([&] { return cloud.asked() >= 3; }));
  EXPECT_TRUE(heard.notices().empty());
  EXPECT_TRUE(heard.troubles().empty()) << heard.troubles().front();
  cloud.preempt(100);
  ASSERT_TRUE(heard.wait_for(1, 0));
  const Notice notice = heard.notices().front();
  EXPECT_EQ(notice.at.size(), 20U) << notice.at;
  EXPECT_GT(notice.seconds_left, 10);
  EXPECT_LE(notice.seconds_left, 100);
  EXPECT_EQ(cloud.missed(), 0U);
  const size_t asked = cloud.asked();
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_EQ(cloud.asked(), asked) << "the watch is over";
}

TEST_P(PreemptionWatchOf, HearsANoticeThatWasThereBefore) {
  FakeCloud cloud(GetParam());
  cloud.preempt(60);
  Heard heard;
  const PreemptionWatch watch(GetParam(), cloud.url(), heard);
  EXPECT_TRUE(heard.wait_for(1, 0));
}

INSTANTIATE_TEST_SUITE_P(Clouds, PreemptionWatchOf,
                         testing::Values(Cloud::aws, Cloud::gcp, Cloud::azure),
                         [](const auto& made) { return std::string(name_of(made.param)); });

TEST(PreemptionWatch, NoticesOfOtherMachinesAreNotOurs) {
  FakeCloud cloud(Cloud::azure);
  cloud.preempt(60, "node_71");
  Heard heard;
  const PreemptionWatch watch(Cloud::azure, cloud.url(), heard);
  ASSERT_TRUE(wait_until([&] { return cloud.asked() >= 4; }));
  EXPECT_TRUE(heard.notices().empty());
}

TEST(PreemptionWatch, WrongAnswersAreToldOnceAndSurvived) {
  for (const Cloud kind : {Cloud::aws, Cloud::gcp, Cloud::azure}) {
    FakeCloud cloud(kind);
    // Of AWS 404 says that all is well, but not where the token is.
    cloud.behave(Manner::missing);
    Heard heard;
    const PreemptionWatch watch(kind, cloud.url(), heard);
    ASSERT_TRUE(wait_until([&] { return cloud.asked() >= 2; }));
    EXPECT_EQ(heard.troubles().size(), 1U) << name_of(kind);
    EXPECT_TRUE(heard.notices().empty());
    cloud.behave(Manner::right);
    cloud.preempt(60);
    EXPECT_TRUE(heard.wait_for(1, 1)) << name_of(kind);
  }
}

TEST(PreemptionWatch, WhateverTheServiceDoesIsNoNotice) {
  for (const Manner manner : {Manner::garbage, Manner::broken, Manner::endless, Manner::hangs_up}) {
    for (const Cloud kind : {Cloud::aws, Cloud::gcp, Cloud::azure}) {
      FakeCloud cloud(kind);
      cloud.behave(manner);
      Heard heard;
      const PreemptionWatch watch(kind, cloud.url(), heard);
      EXPECT_TRUE(heard.wait_for(0, 1)) << name_of(kind) << " " << static_cast<int>(manner);
      EXPECT_TRUE(heard.notices().empty());
    }
  }
}

TEST(PreemptionWatch, EndsWhileTheServiceIsSilentOrNotThere) {
  FakeCloud cloud(Cloud::aws);
  cloud.behave(Manner::silent);
  Heard heard;
  {
    const PreemptionWatch watch(Cloud::aws, cloud.url(), heard);
    ASSERT_TRUE(wait_until([&] { return cloud.asked() >= 1; }));
  }
  { const PreemptionWatch watch(Cloud::gcp, "http://127.0.0.1:1", heard); }
  EXPECT_TRUE(heard.notices().empty());
}

}  // namespace
}  // namespace hyades::worker
