// Viewers who ask for more pictures than they read.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
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
#include "tests/coordinator/services/troubled_store.h"
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
    api_.emplace(*world_.farm.controller, held_, longest_turn_);
    api_->add_routes(router_);
  }

  void ask(const std::string& who, int width, Answer answer) const {
    ask(who, job_, width, answer);
  }
  void ask(const std::string& who, const std::string& job, int width, const Answer& answer,
           const std::string& frame = "1") const {
    WebRequest request;
    request.method = "GET";
    request.path = {"api", "v1", "jobs", job, "frames", frame, "picture"};
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

  /// Returns when all that this one has asked for is answered, or waits for a turn of its frame.
  void await_asked(const std::string& who) const {
    std::promise<void> answered;
    ask(who, "999", 16, [&](const WebReply& reply) {
      EXPECT_EQ(reply.status, 404U);
      answered.set_value();
    });
    answered.get_future().wait();
  }

  /// Of more jobs, of whose frame there is a picture.
  std::string another_job(const std::string& document = FarmWorld::document(1)) {
    std::string job = std::to_string(world_.farm.submit_text(document));
    EXPECT_TRUE(eventually([&] {
      return world_.client->get("/api/v1/jobs/" + job + "/frames/1/picture").status == 200;
    }));
    return job;
  }
  /// Of an ended job.
  std::string another_finished_job() {
    const uint64_t job = world_.farm.submit(1);
    EXPECT_TRUE(world_.farm.wait_for(job, v1::JOB_STATE_DONE));
    return std::to_string(job);
  }

  /// A copy of the film of a job's frame, which `then` gets by the thread that makes copies of it.
  void copy_film(const std::string& job, JobQueries::FilmTaker then) const {
    const grpc::Status held =
        world_.farm.controller->queries().film_alone(std::stoull(job), 1, std::move(then));
    ASSERT_TRUE(held.ok()) << held.error_message();
  }

  /// copy_film() of a taker that waits until the promise is kept: no other copy comes until then.
  void hold_film(const std::string& job, std::promise<void>& go) const {
    copy_film(job,
              [gone = std::shared_future<void>(go.get_future())](const auto&...) { gone.wait(); });
  }

  /// A second is spent for somebody, in a turn of the job's frame.
  void spend_for(const std::string& who, const std::string& job) const {
    std::promise<void> go;
    hold_film(job, go);
    std::vector<std::promise<void>> answered(2);
    for (size_t i = 0; i < answered.size(); ++i) {
      ask(who, job, 16 + static_cast<int>(i), [&, i](const WebReply&) {
        // What an answer takes counts for the next one.
        if (i == 0) std::this_thread::sleep_for(1s);
        answered[i].set_value();
      });
    }
    await_asked(who);
    go.set_value();
    for (std::promise<void>& one : answered) one.get_future().wait();
  }

  /// An answer that notes who has got his picture.
  Answer note(const std::string& who) {
    return [this, who](const WebReply& reply) {
      EXPECT_EQ(reply.status, 200U) << who;
      const std::lock_guard lock(served_mutex_);
      served_.push_back(who);
    };
  }
  std::vector<std::string> served() {
    const std::lock_guard lock(served_mutex_);
    return served_;
  }
  bool await_served(size_t count) {
    return eventually([&] { return served().size() == count; });
  }

  std::string tag_of(uint64_t job) const {
    FrameNow now;
    (void)world_.farm.controller->queries().frame_now(job, 1, now);
    return now.tag;
  }
  /// Ends the job and tries it again.
  void begin_anew(uint64_t job) const {
    v1::JobResponse now;
    const auto call = world_.farm.context();
    ASSERT_TRUE(world_.farm.jobs->Cancel(call.get(), about(job), &now).ok());
    ASSERT_TRUE(world_.farm.wait_for(job, v1::JOB_STATE_CANCELLED));
    const auto again = world_.farm.context();
    ASSERT_TRUE(world_.farm.jobs->Retry(again.get(), about(job), &now).ok());
    ASSERT_TRUE(eventually([&] { return !tag_of(job).empty(); }));
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
    EXPECT_EQ(answer_to("ada", 79).status, 503) << "what they have counts for her, too";
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
  std::chrono::milliseconds longest_turn_ = PicturesApi::kLongestTurn;
  std::mutex served_mutex_;
  std::vector<std::string> served_;  ///< as of note()
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
  constexpr size_t kRefused = kAsked - PictureTurns::kMostOfFrameOfOne;
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
  EXPECT_EQ(std::count(adas.begin(), adas.end(), 200U), PictureTurns::kMostOfFrameOfOne);
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

/// A frame has its turn by whoever asks for it, not by who has asked first, and for much besides.
TEST_F(UnreadPictures, WhoAsksForAllFramesFirstKeepsNobodyFromOne) {
  start(true);
  const std::string second = another_finished_job();
  std::promise<void> go;
  const std::shared_future<void> gone(go.get_future());
  std::promise<void> begun;
  std::promise<unsigned> later;
  ask("ada", 16, [&](const WebReply&) {
    begun.set_value();
    gone.wait();
  });
  begun.get_future().wait();
  ask("ada", second, 16, [&](const WebReply& reply) { later.set_value(reply.status); });
  await_asked("ada");
  std::promise<unsigned> bobs;
  ask("bob", second, 17, [&](const WebReply& reply) { bobs.set_value(reply.status); });
  auto bob = bobs.get_future();
  const bool served = bob.wait_for(20s) == std::future_status::ready;
  go.set_value();
  ASSERT_TRUE(served) << "ada's first frame is not over";
  EXPECT_EQ(bob.get(), 200U);
  EXPECT_EQ(later.get_future().get(), 200U);
}

/// Of a turn that has lasted for long the rest comes after those for whom less time was spent.
TEST_F(UnreadPictures, ALongTurnGivesWayBetweenTwoPictures) {
  longest_turn_ = 0ms;
  start(false);
  const std::string second = another_job();
  const std::string third = another_job();
  std::vector<std::promise<void>> go(2);
  hold_film(job_, go[0]);
  hold_film(second, go[1]);
  // Where two films are in work, bob has to wait until one of them is over.
  ask("carl", second, 16, note("carl"));
  await_asked("carl");
  for (int i = 0; i < 4; ++i) {
    ask("ada", job_, 16 + i, [&, noted = note("ada")](const WebReply& reply) {
      const bool first = served().empty();
      noted(reply);
      if (!first) return;
      ask("bob", third, 16, note("bob"));
      await_asked("bob");
    });
  }
  await_asked("ada");
  go[0].set_value();
  EXPECT_TRUE(await_served(5));
  go[1].set_value();
  EXPECT_TRUE(await_served(6));
  EXPECT_EQ(served(), (std::vector<std::string>{"ada", "bob", "ada", "ada", "ada", "carl"}));
}

/// Who wants pictures of a frame shares its turn with others, by whomever it has come, and
/// whatever was spent for him lately.
TEST_F(UnreadPictures, InATurnWhoHasHadLeastOfItIsNext) {
  start(false);
  spend_for("bob", another_job());
  std::promise<void> go;
  hold_film(job_, go);
  for (int i = 0; i < 3; ++i) ask("ada", job_, 17 + i, note("ada"));
  await_asked("ada");
  ask("bob", job_, 16, note("bob"));
  await_asked("bob");
  go.set_value();
  EXPECT_TRUE(await_served(4));
  EXPECT_EQ(served(), (std::vector<std::string>{"ada", "bob", "ada", "ada"}));
}

/// A turn gives way to those who wait for the same frame, whatever else is in work for them, and
/// was.
TEST_F(UnreadPictures, ALongTurnGivesWayToWhoHasAnotherTurn) {
  longest_turn_ = 0ms;
  start(false);
  const std::string second = another_job();
  spend_for("bob", second);
  std::vector<std::promise<void>> go(2);
  hold_film(job_, go[0]);
  hold_film(second, go[1]);
  ask("bob", second, 18, note("bob's other"));
  await_asked("bob");
  for (int i = 0; i < 6; ++i) {
    ask("ada", job_, 16 + i, [&, noted = note("ada")](const WebReply& reply) {
      const bool first = served().empty();
      noted(reply);
      if (!first) return;
      ask("bob", job_, 30, note("bob"));
      await_asked("bob");
    });
  }
  await_asked("ada");
  go[0].set_value();
  EXPECT_TRUE(await_served(7));
  go[1].set_value();
  EXPECT_TRUE(await_served(8));
  const std::vector<std::string> all = served();
  EXPECT_LE(std::find(all.begin(), all.end(), "bob") - all.begin(), 2) << "after one of hers more";
}

/// Who has all that he wants of a frame waits no longer for another one than anybody, though it is
/// by him that the frame's turn has come.
TEST_F(UnreadPictures, ALongTurnGivesWayToItsOwner) {
  longest_turn_ = 0ms;
  start(false);
  const std::string second = another_job();
  std::vector<std::promise<void>> go(2);
  hold_film(job_, go[0]);
  const auto begun = std::chrono::steady_clock::now();
  ask("ada", job_, 16, [&, noted = note("ada")](const WebReply& reply) {
    noted(reply);
    ask("ada", second, 16, note("ada's other"));
    await_asked("ada");
    hold_film(job_, go[1]);  // of what bob wants one is made of the film that is there
    // This is spent for bob, and more than was spent for her.
    std::this_thread::sleep_for(2 * (std::chrono::steady_clock::now() - begun));
  });
  await_asked("ada");
  for (int i = 0; i < 3; ++i) ask("bob", job_, 17 + i, note("bob"));
  await_asked("bob");
  go[0].set_value();
  EXPECT_TRUE(eventually([&] { return served().size() >= 3; }));
  go[1].set_value();
  EXPECT_TRUE(await_served(5));
  EXPECT_EQ(served(), (std::vector<std::string>{"ada", "bob", "ada's other", "bob", "bob"}));
}

/// What is left of a turn is before all else that its caller has asked for since.
TEST_F(UnreadPictures, WhatGivesWayKeepsItsPlace) {
  longest_turn_ = 0ms;
  start(false);
  const std::string second = another_job();
  const std::string third = another_job();
  const std::string fourth = another_job();
  std::vector<std::promise<void>> go(2);
  hold_film(job_, go[0]);
  hold_film(second, go[1]);
  ask("carl", second, 16, note("carl"));
  await_asked("carl");
  for (int i = 0; i < 2; ++i) {
    ask("ada", job_, 16 + i, [&, noted = note("ada")](const WebReply& reply) {
      const bool first = served().empty();
      noted(reply);
      if (!first) return;
      ask("ada", fourth, 16, note("ada's other"));
      await_asked("ada");
      ask("bob", third, 16, note("bob"));
      await_asked("bob");
    });
  }
  await_asked("ada");
  go[0].set_value();
  EXPECT_TRUE(await_served(4));
  go[1].set_value();
  EXPECT_TRUE(await_served(5));
  EXPECT_EQ(served(), (std::vector<std::string>{"ada", "bob", "ada", "ada's other", "carl"}));
}

/// That nobody has begun with a frame is no lack of memory, which others' ends would mend.
TEST_F(UnreadPictures, FramesThatHaveNotBegunWaitForNobody) {
  start(false);
  const std::string second = another_job(FarmWorld::document(2));
  std::promise<void> go;
  hold_film(job_, go);
  ask("carl", job_, 16, note("carl"));
  await_asked("carl");
  std::promise<unsigned> adas;
  ask(
      "ada", second, 16, [&](const WebReply& reply) { adas.set_value(reply.status); }, "2");
  auto ada = adas.get_future();
  const bool told = ada.wait_for(20s) == std::future_status::ready;
  EXPECT_TRUE(served().empty());
  go.set_value();
  EXPECT_TRUE(told) << "carl's film is waited for";
  EXPECT_EQ(ada.get(), 503U);
  EXPECT_TRUE(await_served(1));
}

/// Nor is that the store fails.
TEST_F(UnreadPictures, WhatTheStoreFailsWaitsForNobody) {
  const auto trouble = std::make_shared<Trouble>();
  world_.farm.wrap_store = [&](std::unique_ptr<JobStore> store) {
    return std::make_unique<TroubledStore>(std::move(store), trouble);
  };
  start(true);
  const std::string second = another_finished_job();
  std::vector<std::promise<void>> begun(2);
  std::vector<std::promise<void>> go(2);
  const auto hold = [&](size_t i) {
    return [&, i, gone = std::shared_future<void>(go[i].get_future())](const WebReply&) {
      begun[i].set_value();
      gone.wait();
    };
  };
  ask("carl", job_, 16, hold(0));
  begun[0].get_future().wait();
  ask("dave", job_, 16, hold(1));  // it is there
  begun[1].get_future().wait();
  // It fails when ada's frame has begun: eve's question is between what is done for ada.
  std::promise<unsigned> adas;
  ask("ada", second, 16, [&](const WebReply& reply) { adas.set_value(reply.status); });
  ask("eve", "999", 16, [&](const WebReply&) { trouble->of_reads(Trouble::Kind::fails); });
  go[1].set_value();
  auto ada = adas.get_future();
  const bool told = ada.wait_for(20s) == std::future_status::ready;
  trouble->of_reads(Trouble::Kind::none);
  go[0].set_value();
  EXPECT_TRUE(told) << "carl's turn is waited for";
  EXPECT_EQ(ada.get(), 503U);
}

/// What has found no memory waits for its caller's share, as all else does.
TEST_F(UnreadPictures, WhatFindsNoMemoryIsNotBeforeEverybody) {
  world_.farm.options.film_memory = uint64_t{16} << 20U;
  start(false);
  const std::string second = another_job();
  std::string smaller = FarmWorld::document(1);
  const std::string size = "[80, 48]";
  const std::string small =
      another_job(smaller.replace(smaller.find(size), size.size(), "[32, 24]"));
  // All the room that copies of films may take, but for a small one.
  std::vector<std::shared_ptr<const core::Film>> films;
  for (bool full = false; !full;) {
    std::promise<std::shared_ptr<const core::Film>> copied;
    copy_film(small, [&](const grpc::Status&, const auto&, auto film) { copied.set_value(film); });
    films.push_back(copied.get_future().get());
    full = films.back() == nullptr;
  }
  ASSERT_GT(films.size(), 3U);
  films.resize(films.size() - 2);
  std::promise<void> go;
  const std::shared_future<void> gone(go.get_future());
  copy_film(job_, [gone](const auto&...) { gone.wait(); });
  std::vector<std::promise<unsigned>> answers(3);
  const auto to = [&](size_t i) {
    return [&answer = answers[i]](const WebReply& reply) { answer.set_value(reply.status); };
  };
  ask("carl", job_, 16, to(0));
  await_asked("carl");
  ask("ada", second, 16, to(1));
  await_asked("ada");
  ask("bob", small, 16, to(2));
  auto bob = answers[2].get_future();
  const bool served = bob.wait_for(20s) == std::future_status::ready;
  films.clear();
  go.set_value();
  ASSERT_TRUE(served) << "ada's, for which there is no memory, is before him";
  EXPECT_EQ(bob.get(), 200U);
  EXPECT_EQ(answers[0].get_future().get(), 200U);
  EXPECT_EQ(answers[1].get_future().get(), 200U);
}

/// However much waits when a turn is over, the next one comes.
TEST_F(UnreadPictures, ATurnThatEndsInACrowdIsNotTheLast) {
  start(true);
  const std::string second = another_finished_job();
  std::vector<std::promise<void>> begun(2);
  std::vector<std::promise<void>> go(2);
  const auto hold = [&](size_t i) {
    return
        [&begun = begun[i], gone = std::shared_future<void>(go[i].get_future())](const WebReply&) {
          begun.set_value();
          gone.wait();
        };
  };
  ask("ada", 16, hold(0));
  begun[0].get_future().wait();
  std::promise<unsigned> later;
  ask("ada", second, 16, [&](const WebReply& reply) { later.set_value(reply.status); });
  await_asked("ada");
  ask("dave", 16, hold(1));  // it is there
  begun[1].get_future().wait();
  std::atomic<int> answered{0};
  std::atomic<int> refused{0};
  for (const char* who : {"eve", "fred", "gwen"}) {
    for (int i = 0; i < 500; ++i) {
      ask(who, "999", 16,
          [&](const WebReply& reply) { ++(reply.status == 404 ? answered : refused); });
    }
  }
  EXPECT_EQ(refused, 500) << "nothing more may wait";
  go[0].set_value();
  EXPECT_TRUE(eventually([&] { return answered > 0; }));  // ada's turn is over
  go[1].set_value();
  EXPECT_TRUE(eventually([&] { return answered == 1000; }));
  auto ada = later.get_future();
  ASSERT_EQ(ada.wait_for(20s), std::future_status::ready);
  EXPECT_EQ(ada.get(), 200U);
}

/// Who has more than he may costs others nothing of what is kept for them.
TEST_F(UnreadPictures, WhatIsKeptForOthersStays) {
  start(true);
  const WebReply kept = answer_to("bob", 79);
  ASSERT_EQ(kept.status, 200U);
  std::vector<WebReply> unread;
  while (unread.empty() || unread.back().status == 200) {
    unread.push_back(answer_to("ada", 16 + static_cast<int>(unread.size())));
  }
  EXPECT_EQ(unread.back().status, 503U);
  EXPECT_EQ(answer_to("bob", 79).text, kept.text);
}

/// Who mirrors what another asks for, and reads nothing of it, fills his own room.
TEST_F(UnreadPictures, WhatOthersDoNotReadIsTheirs) {
  start(true);
  std::vector<WebReply> unread;
  for (int width = 16; width <= FarmWorld::kWidth; ++width) {
    EXPECT_EQ(answer_to("bob", width).status, 200) << width;
    unread.push_back(answer_to("mallory", width));
  }
  EXPECT_EQ(unread.front().status, 200);
  EXPECT_TRUE(unread.front().is_counted)
      << "and not once more by the connection, which has less room";
  EXPECT_EQ(unread.back().status, 503);
}

/// An earlier life's picture is none of this one's, though its frames are counted anew.
TEST_F(UnreadPictures, TheTagOfAJobThatBeganAnewIsAnother) {
  start(false);
  worker_.reset();
  const uint64_t job = world_.farm.submit(1);
  const std::string first = tag_of(job);
  EXPECT_NE(first, "");
  begin_anew(job);
  EXPECT_NE(tag_of(job), first);
}

/// ... nor is one that was made a moment ago.
TEST_F(UnreadPictures, PicturesOfAJobThatBeganAnewAreNotOfBefore) {
  start(false);
  const WebReply before = answer_to("ada", 16);
  ASSERT_EQ(before.status, 200U);
  worker_.reset();
  begin_anew(std::stoull(job_));
  EXPECT_NE(answer_to("ada", 16).headers, before.headers) << "the same ETag";
}

}  // namespace
}  // namespace hyades::coordinator
