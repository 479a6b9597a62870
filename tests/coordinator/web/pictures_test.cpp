// Viewers who ask for more pictures than they read.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/web/pictures_api.h"
#include "farm/byte_budget.h"
#include "tests/coordinator/web/web_world.h"

namespace hyades::coordinator {
namespace {

constexpr uint64_t kMost = 200'000;
constexpr uint64_t kMostOfOne = 100'000;
/// The largest picture that the tests ask for, with what its header takes.
constexpr uint64_t kPicture = FarmWorld::kWidth * FarmWorld::kHeight * 3 * 2 + 1000;

/// The pictures of a job with one frame, and people who look at them over connections that hold on
/// to what they get.
class UnreadPictures : public ::testing::Test {
 protected:
  ~UnreadPictures() override {
    if (api_) api_->close();
    api_.reset();
    worker_.reset();
    world_.stop();
  }

  /// `finished`: the frame, else it stays in mid-render.
  void start(bool finished) {
    world_.farm.options.unit_time = 1ms;
    world_.start();
    job_ = std::to_string(world_.farm.submit(1));
    ScriptedWorker::Script script = world_.farm.script();
    if (!finished) {
      script.threads = 64;
      script.meddle = [this](ScriptedWorker&, const v1::LeasedUnit& leased) {
        const std::lock_guard lock(begun_mutex_);
        return begun_.insert(leased.job()).second;
      };
    }
    worker_.emplace(world_.farm.address, script);
    const std::string path = "/api/v1/jobs/" + job_;
    ASSERT_TRUE(eventually([&] {
      if (finished && world_.json(path)["job"]["state"] != "done") return false;
      return world_.client->get(path + "/frames/1/picture").status == 200;
    }));
    api_.emplace(*world_.farm.controller, held_);
    api_->add_routes(router_);
  }

  void ask(const std::string& who, int width, Answer answer) const {
    ask(who, job_, width, answer);
  }
  void ask(const std::string& who, const std::string& job, int width, const Answer& answer) const {
    WebRequest request;
    request.method = "GET";
    request.path = {"api", "v1", "jobs", job, "frames", "1", "picture"};
    request.query = {{"format", "half"}, {"width", std::to_string(width)}};
    request.caller.name = who;
    router_.answer(request, answer);
  }

  /// Asks and waits for the answer.
  WebReply answer_to(const std::string& who, int width) const {
    const auto reply = std::make_shared<std::promise<WebReply>>();
    auto coming = reply->get_future();
    ask(who, width, [reply](WebReply made) { reply->set_value(std::move(made)); });
    return coming.get();
  }

  /// The world's own server may hold the memory of what it has just answered for a moment more.
  void await_room() {
    ASSERT_TRUE(eventually([&] { return answer_to("eve", 79).status == 200; }));
  }

  /// Nobody reads what is asked for with more and more widths.
  void expect_bounded() {
    std::vector<WebReply> unread;
    uint64_t bytes = 0;
    int refused = 0;
    for (int width = 16; width < FarmWorld::kWidth; ++width) {
      WebReply reply = answer_to("ada", width);
      if (reply.status == 200) bytes += reply.text->size();
      if (reply.status == 503) ++refused;
      unread.push_back(std::move(reply));
    }
    EXPECT_GT(bytes, kMostOfOne / 2);
    EXPECT_LE(bytes, kMostOfOne + kPicture);
    EXPECT_GT(refused, 20);
    EXPECT_TRUE(farm::Json::parse(*unread.back().text)["error"].contains("retry_after_ms"));
    EXPECT_EQ(answer_to("bob", 79).status, 200) << "others have room";
    EXPECT_EQ(answer_to("ada", 79).status, 200) << "and what they have is no more";
    unread.clear();
    EXPECT_EQ(answer_to("ada", 78).status, 200);
  }

  WebWorld world_;
  std::string job_;
  std::mutex begun_mutex_;
  std::set<uint64_t> begun_;  ///< jobs of which a unit was delivered
  std::optional<ScriptedWorker> worker_;
  const std::shared_ptr<farm::ByteBudget> held_ =
      std::make_shared<farm::ByteBudget>(kMost, kMostOfOne);
  Router router_;
  std::optional<PicturesApi> api_;
};

TEST_F(UnreadPictures, OfAFrameInMidRenderAreNotMany) {
  start(false);
  expect_bounded();
}

TEST_F(UnreadPictures, OfAFinishedFrameAreNotMany) {
  start(true);
  expect_bounded();
}

TEST_F(UnreadPictures, WhatIsOnlyKeptGivesWay) {
  start(false);
  // Each is read at once, and what all of them have together is more than one may have.
  for (int round = 0; round < 2; ++round) {
    for (int width = 16; width <= FarmWorld::kWidth; ++width) {
      EXPECT_EQ(answer_to("ada", width).status, 200) << width;
    }
  }
}

TEST_F(UnreadPictures, OfOneFrameAFewAreWantedAtATime) {
  start(false);
  // The thread that copies films is kept from it until all have asked.
  std::promise<void> go;
  const std::shared_future<void> gone(go.get_future());
  const grpc::Status held = world_.farm.controller->queries().film_alone(
      std::stoull(job_), 1, [gone](const auto&...) { gone.wait(); });
  ASSERT_TRUE(held.ok()) << held.error_message();
  std::mutex mutex;
  std::vector<unsigned> adas;
  std::vector<unsigned> bobs;
  const auto note = [&](std::vector<unsigned>& whose) {
    return [&](const WebReply& reply) {
      const std::lock_guard lock(mutex);
      whose.push_back(reply.status);
    };
  };
  const auto answered = [&](size_t of_ada, size_t of_bob) {
    return eventually([&] {
      const std::lock_guard lock(mutex);
      return adas.size() == of_ada && bobs.size() == of_bob;
    });
  };
  constexpr size_t kAsked = 50;
  constexpr size_t kRefused = kAsked - PicturesApi::kMostOfFrameOfOne;
  for (size_t i = 0; i < kAsked; ++i) ask("ada", 16 + static_cast<int>(i), note(adas));
  const bool refused = answered(kRefused, 0);
  const std::vector<unsigned> first = [&] {
    const std::lock_guard lock(mutex);
    return adas;
  }();
  ask("bob", 16, note(bobs));
  ask("bob", 80, note(bobs));
  go.set_value();
  ASSERT_TRUE(refused);
  EXPECT_EQ(first, std::vector<unsigned>(kRefused, 503));
  ASSERT_TRUE(answered(kAsked, 2));
  EXPECT_EQ(bobs, (std::vector<unsigned>{200, 200}));
  EXPECT_EQ(std::count(adas.begin(), adas.end(), 200U), PicturesApi::kMostOfFrameOfOne);
}

/// Films that take long to come keep others' waiting where different callers want them, and no
/// more.
TEST_F(UnreadPictures, OneCallerWaitsForOneFilmAtATime) {
  start(false);
  std::vector<std::string> jobs = {job_};
  while (jobs.size() < 3) jobs.push_back(std::to_string(world_.farm.submit(1)));
  for (const std::string& job : jobs) {
    ASSERT_TRUE(eventually([&] {
      return world_.client->get("/api/v1/jobs/" + job + "/frames/1/picture").status == 200;
    }));
  }
  std::promise<void> go;
  const std::shared_future<void> gone(go.get_future());
  for (size_t i = 0; i < 2; ++i) {
    const grpc::Status held = world_.farm.controller->queries().film_alone(
        std::stoull(jobs[i]), 1, [gone](const auto&...) { gone.wait(); });
    ASSERT_TRUE(held.ok()) << held.error_message();
  }
  std::promise<unsigned> bobs;
  std::vector<std::promise<unsigned>> adas(2);
  for (size_t i = 0; i < 2; ++i) {
    ask("ada", jobs[i], 16, [&, i](const WebReply& reply) { adas[i].set_value(reply.status); });
  }
  std::this_thread::sleep_for(300ms);  // both would be begun with, if they might
  ask("bob", jobs[2], 16, [&](const WebReply& reply) { bobs.set_value(reply.status); });
  auto bob = bobs.get_future();
  const bool served = bob.wait_for(20s) == std::future_status::ready;
  go.set_value();
  ASSERT_TRUE(served) << "ada's films were all that were waited for";
  EXPECT_EQ(bob.get(), 200U);
  for (std::promise<unsigned>& ada : adas) EXPECT_EQ(ada.get_future().get(), 200U);
}

/// There is memory for one picture at a time: who asks without end takes turns with who asks once.
TEST_F(UnreadPictures, WhoAsksInALoopKeepsNobodyFromFinishedOnes) {
  world_.farm.options.film_memory = 600'000;
  start(true);
  await_room();
  std::atomic<bool> stop{false};
  std::atomic<int> shown{0};
  std::vector<std::thread> adas;
  for (int i = 0; i < 4; ++i) {
    adas.emplace_back([&, i] {
      for (int width = 16 + i; !stop; width = width < 76 ? width + 4 : 16 + i) {
        if (answer_to("ada", width).status == 200) ++shown;
      }
    });
  }
  for (int width = 17; width < 77; width += 2) {
    EXPECT_EQ(answer_to("bob", width).status, 200) << width;
  }
  EXPECT_TRUE(eventually([&] { return shown > 10; }));
  stop = true;
  for (std::thread& ada : adas) ada.join();
}

/// What was put back is made alone: the file of who asks without end, which is larger and takes
/// longer to be read, would else find the room first each time.
TEST_F(UnreadPictures, WhoAsksForASmallerOneHasHisTurnToo) {
  world_.farm.options.film_memory = 600'000;
  start(true);
  await_room();
  std::string smaller = FarmWorld::document(1);
  const std::string size = "[80, 48]";
  smaller.replace(smaller.find(size), size.size(), "[64, 40]");
  const uint64_t job = world_.farm.submit_text(smaller);
  ASSERT_TRUE(world_.farm.wait_for(job, v1::JOB_STATE_DONE));
  constexpr int kMost = 4000;
  std::atomic<bool> stop{false};
  std::atomic<int> asked{0};
  std::vector<std::thread> adas;
  for (int i = 0; i < 2; ++i) {
    adas.emplace_back([&, i] {
      for (int width = 16 + i; !stop && asked < kMost; width = width < 76 ? width + 2 : 16 + i) {
        (void)answer_to("ada", width);
        ++asked;
      }
    });
  }
  for (int width = 17; width < 57; width += 2) {
    std::promise<unsigned> answer;
    ask("bob", std::to_string(job), width,
        [&](const WebReply& reply) { answer.set_value(reply.status); });
    EXPECT_EQ(answer.get_future().get(), 200U) << width;
  }
  EXPECT_LT(asked, kMost) << "he was served when she had enough";
  stop = true;
  for (std::thread& ada : adas) ada.join();
}

/// What nobody has begun with is not made any more once the coordinator ends.
TEST_F(UnreadPictures, AnEndWaitsForNoneThatOnlyWait) {
  start(true);
  std::promise<void> begun;
  std::promise<void> go;
  const std::shared_future<void> gone(go.get_future());
  ask("ada", 20, [&](const WebReply&) {
    begun.set_value();
    gone.wait();
  });
  begun.get_future().wait();
  std::atomic<int> made{0};
  std::atomic<int> refused{0};
  for (int i = 0; i < 100; ++i) {
    ask("ada", 21 + i % 8,
        [&](const WebReply& reply) { ++(reply.status == 200 ? made : refused); });
  }
  api_->close();
  go.set_value();
  api_.reset();
  EXPECT_EQ(made, 0);
  EXPECT_EQ(refused, 100);
}

/// Who asks while pictures of the same film are being sent comes after them.
TEST_F(UnreadPictures, WhatIsAskedForWhileOthersAreSentComesLater) {
  start(false);
  std::promise<unsigned> bobs;
  std::promise<unsigned> adas;
  ask("ada", 20, [&](const WebReply& reply) {
    ask("bob", 30, [&](const WebReply& other) { bobs.set_value(other.status); });
    std::this_thread::sleep_for(300ms);  // it is begun with, if it may
    adas.set_value(reply.status);
  });
  EXPECT_EQ(adas.get_future().get(), 200U);
  auto bob = bobs.get_future();
  ASSERT_EQ(bob.wait_for(20s), std::future_status::ready);
  EXPECT_EQ(bob.get(), 200U);
  EXPECT_EQ(answer_to("ada", 31).status, 200);
}

}  // namespace
}  // namespace hyades::coordinator
