// Who leads, on a real server and in real time.
#include "coordinator/shared_state/leader_lease.h"

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "coordinator/job_store/job_store.h"
#include "coordinator/sql/postgres.h"
#include "tests/coordinator/sql/postgres_server.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// A coordinator as far as it leads or stands by.
struct Contender {
  explicit Contender(const std::string& database, const std::string& name) {
    options.database = database;
    options.holder = name;
    options.time = 1000ms;
    options.on_lost = [this](const std::string& why) {
      reason = why;
      ++losses;
    };
    options.pause = [this](std::chrono::milliseconds time) {
      std::this_thread::sleep_for(std::min(time, 50ms));
      return !stop.load();
    };
    options.tell = [this](const LeaseRow& leader, const std::string& trouble) {
      seen = leader.holder + " " + leader.url;
      if (!trouble.empty()) ++troubles;
    };
  }

  std::unique_ptr<LeaderLease> lead() const {
    auto led = LeaderLease::wait(options);
    EXPECT_TRUE(led.ok()) << (led ? "" : led.error().message);
    return led ? std::move(*led) : nullptr;
  }

  LeaderOptions options;
  std::atomic<bool> stop{false};
  std::atomic<int> losses{0};
  std::atomic<int> troubles{0};
  std::string reason;
  std::string seen;
};

class LeaderLeaseTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::postgres_is_there()) return;
    database_ = test::PostgresServer::shared().make_database();
  }

  static bool soon(const std::function<bool()>& what) {
    const auto end = Clock::now() + 20s;
    while (!what() && Clock::now() < end) std::this_thread::sleep_for(10ms);
    return what();
  }

  std::string database_;
};

TEST_F(LeaderLeaseTest, TheFirstLeadsAndTheNextStandsByUntilItStepsDown) {
  Contender first(database_, "first:1");
  Contender second(database_, "second:2");
  auto leads = first.lead();
  ASSERT_TRUE(leads);
  EXPECT_EQ(leads->incarnation(), 1U);
  EXPECT_TRUE(leads->holds());
  leads->set_url("https://first.example/");
  auto later = std::async(std::launch::async, [&] { return second.lead(); });
  // It is renewed, so that nobody takes over.
  EXPECT_EQ(later.wait_for(3s), std::future_status::timeout);
  leads.reset();
  auto next = later.get();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->incarnation(), 2U);
  EXPECT_EQ(second.seen, "first:1 https://first.example/");
  EXPECT_EQ(first.losses, 0);
}

TEST_F(LeaderLeaseTest, WhoIsPassedWritesNothingAndHearsOfIt) {
  Contender first(database_, "first:1");
  auto leads = first.lead();
  ASSERT_TRUE(leads);
  auto store = open_postgres_job_store(
      leader_connection(database_, leads->incarnation(), [](const std::string&) {}));
  ASSERT_TRUE(store.ok());
  ASSERT_TRUE((*store)->quarantine({"before", ""}).ok());

  auto other = open_postgres({.url = database_});
  ASSERT_TRUE(other.ok());
  ASSERT_TRUE((*other)
                  ->run_script("UPDATE hyades.leader SET incarnation = 2;"
                               "UPDATE hyades.lease SET incarnation = 2, holder = 'second:2'")
                  .ok());
  const auto refused = (*store)->quarantine({"after", ""});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find(kOtherLeads), std::string::npos);
  EXPECT_TRUE(soon([&] { return first.losses == 1; }));
  EXPECT_EQ(first.reason, kOtherLeads);
  EXPECT_FALSE(leads->holds());
  leads.reset();  // which does not step down for the other
  Query holder(**other, "SELECT holder FROM hyades.lease");
  ASSERT_TRUE(holder.next());
  EXPECT_EQ(holder.bytes(0), "second:2");
}

TEST_F(LeaderLeaseTest, ItEndsWithoutTheDatabaseAndAnotherTakesOverOnceThatIsBack) {
  test::PostgresServer server(true);
  const std::string database = server.make_database();
  Contender first(database, "first:1");
  auto leads = first.lead();
  ASSERT_TRUE(leads);
  server.kill();
  EXPECT_TRUE(soon([&] { return first.losses == 1; }));
  EXPECT_NE(first.reason.find("the lease has run out"), std::string::npos) << first.reason;
  leads.reset();

  Contender impatient(database, "third:3");
  EXPECT_FALSE(LeaderLease::wait(impatient.options).ok());
  Contender second(database, "second:2");
  second.options.patient = true;
  auto later = std::async(std::launch::async, [&] { return second.lead(); });
  EXPECT_TRUE(soon([&] { return second.troubles > 0; }));
  server.start();
  auto next = later.get();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->incarnation(), 2U);
}

TEST_F(LeaderLeaseTest, WhoDoesNothingAnyMoreIsReplaced) {
  Contender first(database_, "first:1");
  Contender second(database_, "second:2");
  const auto leads = first.lead();
  ASSERT_TRUE(leads);
  std::atomic<bool> works{true};
  leads->renew_while([&] { return works.load(); });
  auto later = std::async(std::launch::async, [&] { return second.lead(); });
  EXPECT_EQ(later.wait_for(2s), std::future_status::timeout);
  works = false;
  const auto next = later.get();
  ASSERT_TRUE(next);
  EXPECT_EQ(first.losses, 1);
}

TEST_F(LeaderLeaseTest, WaitingEndsWhenItIsTold) {
  Contender first(database_, "first:1");
  const auto leads = first.lead();
  ASSERT_TRUE(leads);
  Contender second(database_, "second:2");
  auto later = std::async(std::launch::async, [&] { return second.lead(); });
  second.stop = true;
  EXPECT_EQ(later.get(), nullptr);
}

}  // namespace
}  // namespace hyades::coordinator
