// People hear of jobs that are done, fail or stand still; once each, whatever the other side does.
#include <gtest/gtest.h>

#include "coordinator/notify/notifier.h"
#include "core/base/printable.h"
#include "farm/json_form.h"
#include "tests/coordinator/notify/fake_hook.h"
#include "tests/coordinator/services/farm_world.h"

namespace hyades::coordinator {
namespace {

using farm::Json;

Hook::Options quick(const std::string& url) {
  Hook::Options options;
  options.url = url;
  options.first_wait = 10ms;
  return options;
}

Notifier::Options watching(const FakeHook& hook) {
  Notifier::Options options;
  options.hooks = {hook.url()};
  options.look = 20ms;
  options.hook.first_wait = 10ms;
  return options;
}

TEST(Hook, WhatIsNotTakenComesAgain) {
  FakeHook server;
  server.answer_with({500, 503, 429, 200});
  Hook hook(quick(server.url()));
  hook.post("one");
  hook.post("two");
  ASSERT_TRUE(eventually([&] { return server.bodies().size() == 5; }));
  EXPECT_EQ(server.bodies(), (std::vector<std::string>{"one", "one", "one", "one", "two"}));
}

TEST(Hook, WhatHasMovedGetsTheMessageToo) {
  for (const int status : {301, 302, 307}) {
    FakeHook server;
    server.answer_with({status, 200});
    Hook hook(quick(server.url()));
    hook.post("one");
    ASSERT_TRUE(eventually([&] { return server.bodies().size() == 2; }));
    EXPECT_EQ(server.bodies(), (std::vector<std::string>{"one", "one"})) << status;
  }
}

TEST(Hook, WhatIsRefusedIsToldAndDoesNotComeAgain) {
  FakeHook server;
  server.answer_with({404});
  std::mutex mutex;
  std::string told;
  Hook::Options options = quick(server.url());
  options.tell = [&](const std::string& line) {
    const std::lock_guard lock(mutex);
    told = line;
  };
  {
    Hook hook(options);
    hook.post("one");
    hook.post("two");
    ASSERT_TRUE(eventually([&] { return server.bodies().size() == 2; }));
  }
  EXPECT_NE(told.find("404"), std::string::npos);
  EXPECT_EQ(told.find("secret"), std::string::npos) << "an address may hold a key";
}

/// What a hook says last of messages that it gives up.
class Told {
 public:
  std::function<void(const std::string&)> listener() {
    return [this](const std::string& line) {
      const std::lock_guard lock(mutex_);
      line_ = line;
    };
  }
  std::string line() const {
    const std::lock_guard lock(mutex_);
    return line_;
  }

 private:
  mutable std::mutex mutex_;
  std::string line_;
};

// A hook that answered 307 once had the coordinator post to itself, as an admin.
TEST(Hook, NobodyIsSentToAnotherPlace) {
  for (const int status : {301, 302, 307, 308}) {
    FakeHook victim;
    FakeHook server;
    server.send_to(victim.url());
    server.answer_with({status});
    Told told;
    Hook::Options options = quick(server.url());
    options.tell = told.listener();
    Hook hook(options);
    hook.post("one");
    ASSERT_TRUE(eventually([&] { return !told.line().empty(); }));
    EXPECT_NE(told.line().find("has moved to"), std::string::npos) << told.line();
    EXPECT_TRUE(victim.bodies().empty()) << status;
  }
}

TEST(Hook, ANameDoesNotStandForThisMachineUnlessToldSo) {
  FakeHook server;
  // Names below localhost are this machine, without any name server (RFC 6761, section 6.3).
  const std::string url = "http://hook.localhost:" + std::to_string(server.port()) + "/";
  Told told;
  Hook::Options options = quick(url);
  options.give_up = 50ms;
  options.tell = told.listener();
  {
    Hook hook(options);
    hook.post("one");
    ASSERT_TRUE(eventually([&] { return !told.line().empty(); }));
  }
  EXPECT_NE(told.line().find("--notify-private"), std::string::npos) << told.line();
  EXPECT_TRUE(server.bodies().empty());
  options.may_be_private = true;
  Hook hook(options);
  hook.post("two");
  EXPECT_TRUE(eventually([&] { return server.bodies().size() == 1; }));
}

TEST(Hook, LocalhostInCapitalsIsThisMachineToo) {
  FakeHook server;
  Hook hook(quick("http://LOCALHOST:" + std::to_string(server.port()) + "/"));
  hook.post("one");
  EXPECT_TRUE(eventually([&] { return server.bodies().size() == 1; }));
}

// Slack calls everybody for <!channel>, Mattermost for @channel; both draw links.
TEST(News, ChatServersCallNobodyByANameOfSomebodyElse) {
  News news;
  news.kind = News::Kind::failed;
  news.job.set_id(7);
  news.job.set_name("<!channel> @all [x](http://evil.example) `& \u202Eevil");
  news.job.set_reason("`@here`");
  EXPECT_EQ(chat_message(news, ""),
            R"({"text":"Job 7, `&lt;!channel&gt; @all [x](http://evil.example) '&amp; ?evil`, )"
            R"(failed: 0 of 0 frames are done: `'@here'`"})");
  EXPECT_EQ(text_of(news, core::printable),
            "Job 7, <!channel> @all [x](http://evil.example) `& ?evil, failed: 0 of 0 frames are "
            "done: `@here`");
}

TEST(Hook, NobodyThereIsGivenUpInTheEnd) {
  std::string url;
  {
    const FakeHook gone;
    url = gone.url();
  }
  std::atomic<int> told{0};
  Hook::Options options = quick(url);
  options.give_up = 100ms;
  options.tell = [&](const std::string&) { ++told; };
  Hook hook(options);
  hook.post("one");
  EXPECT_TRUE(eventually([&] { return told == 1; }));
}

TEST(Hook, AnAddressIsOfTheWeb) {
  EXPECT_TRUE(Hook::check("https://chat.example.org/hooks/1").ok());
  EXPECT_FALSE(Hook::check("file:///etc/passwd").ok());
  EXPECT_FALSE(Hook::check("https://").ok());
}

TEST(Notifier, AJobThatIsDoneIsToldOfOnce) {
  FarmWorld world;
  world.start();
  FakeHook server;
  FakeHook chat;
  Notifier::Options options = watching(server);
  options.chats = {chat.url()};
  options.dashboard = "https://farm.example.org";
  const Notifier notifier(*world.controller, options);
  const uint64_t job = world.submit(2);
  const ScriptedWorker worker(world.address, world.script());
  ASSERT_TRUE(world.wait_for(job, v1::JOB_STATE_DONE));
  ASSERT_TRUE(eventually([&] { return !server.bodies().empty() && !chat.bodies().empty(); }));
  const Json said = Json::parse(server.bodies().front());
  EXPECT_EQ(said["event"], "done");
  EXPECT_EQ(said["job"]["id"], job);
  EXPECT_EQ(said["url"], "https://farm.example.org/#/jobs/" + std::to_string(job));
  EXPECT_NE(said["text"].get<std::string>().find("2 frames"), std::string::npos);
  const Json chatted = Json::parse(chat.bodies().front());
  EXPECT_EQ(chatted.size(), 1U);
  EXPECT_NE(chatted["text"].get<std::string>().find("is done"), std::string::npos);
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(server.bodies().size(), 1U);
}

TEST(Notifier, ManyQuickJobsAreAllToldOf) {
  FarmWorld world;
  world.start();
  const uint64_t before = world.submit(1);
  const ScriptedWorker worker(world.address, world.script());
  ASSERT_TRUE(world.wait_for(before, v1::JOB_STATE_DONE));
  FakeHook server;
  Notifier::Options options = watching(server);
  options.look = 300ms;  // most begin and end between two looks
  const Notifier notifier(*world.controller, options);
  std::set<uint64_t> jobs;
  for (int i = 0; i < 8; ++i) jobs.insert(world.submit(1));
  ASSERT_TRUE(eventually([&] { return server.bodies().size() >= jobs.size(); }));
  std::set<uint64_t> told;
  for (const std::string& body : server.bodies())
    told.insert(Json::parse(body)["job"]["id"].get<uint64_t>());
  EXPECT_EQ(told, jobs) << "not of the one that was over before";
}

TEST(Notifier, AJobThatStandsStillIsToldOfWithTheReason) {
  FarmWorld world;
  world.start();
  FakeHook server;
  Notifier::Options options = watching(server);
  options.stall = 150ms;
  const Notifier notifier(*world.controller, options);
  const uint64_t job = world.submit(1);
  ASSERT_TRUE(eventually([&] { return !server.bodies().empty(); }));
  const Json said = Json::parse(server.bodies().front());
  EXPECT_EQ(said["event"], "stalled");
  EXPECT_EQ(said["job"]["id"], job);
  EXPECT_GE(said["reasons"].size(), 1U);
  std::this_thread::sleep_for(400ms);
  EXPECT_EQ(server.bodies().size(), 1U) << "once, until it has moved";
}

TEST(Notifier, APausedJobDoesNotStandStill) {
  FarmWorld world;
  world.start();
  const uint64_t job = world.submit(1);
  v1::JobRequest request;
  request.set_job(job);
  v1::JobResponse response;
  ASSERT_TRUE(world.jobs->Pause(world.context().get(), request, &response).ok());
  FakeHook server;
  Notifier::Options options = watching(server);
  options.stall = 100ms;
  const Notifier notifier(*world.controller, options);
  std::this_thread::sleep_for(400ms);
  EXPECT_TRUE(server.bodies().empty());
}

}  // namespace
}  // namespace hyades::coordinator
