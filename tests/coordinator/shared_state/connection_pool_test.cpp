#include "coordinator/shared_state/connection_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/coordinator/shared_state/film_database.h"
#include "tests/coordinator/sql/postgres_server.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// A connection that does nothing, and may get lost.
class NoConnection final : public SqlConnection {
 public:
  explicit NoConnection(ConnectionPool::Lost lost) : lost_(std::move(lost)) {}
  std::unique_ptr<SqlStatement> prepare(std::string_view, std::string&) override { return nullptr; }
  core::Status run_script(const std::string&) override {
    lost_("it is lost");
    return core::Error{"it is lost"};
  }
  core::Status begin(Durability) override { return {}; }
  core::Status commit() override { return {}; }
  void roll_back() override {}

 private:
  ConnectionPool::Lost lost_;
};

struct Opener {
  std::atomic<int> made{0};
  std::atomic<bool> refuses{false};
  ConnectionPool::Open open() {
    return
        [this](const ConnectionPool::Lost& lost) -> core::Result<std::unique_ptr<SqlConnection>> {
          if (refuses) return core::Error{"nobody is there"};
          ++made;
          return std::unique_ptr<SqlConnection>(std::make_unique<NoConnection>(lost));
        };
  }
};

TEST(ConnectionPool, OneThreadAfterAnotherHasTheSameConnection) {
  Opener opener;
  ConnectionPool pool(opener.open(), 3, 1s);
  EXPECT_EQ(opener.made, 0) << "none is made before it is needed";
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(pool.take().ok());
  EXPECT_EQ(opener.made, 1);
  const auto one = pool.take();
  const auto two = pool.take();
  EXPECT_EQ(opener.made, 2);
  EXPECT_NE(&**one, &**two);
}

TEST(ConnectionPool, IsWaitedForSoLongAndNoLonger) {
  Opener opener;
  ConnectionPool pool(opener.open(), 1, 300ms);
  auto held = std::make_optional(pool.take());
  const auto begun = Clock::now();
  const auto refused = pool.take();
  EXPECT_GE(Clock::now() - begun, 300ms);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message, "all 1 connections to the database are in use");
  std::thread other([&] { EXPECT_TRUE(pool.take().ok()) << "it is given back meanwhile"; });
  std::this_thread::sleep_for(50ms);
  held.reset();
  other.join();
  EXPECT_EQ(opener.made, 1);
}

TEST(ConnectionPool, ALostConnectionIsReplacedAndTheIdleWithIt) {
  Opener opener;
  ConnectionPool pool(opener.open(), 3, 100ms);
  {
    const auto one = pool.take();
    const auto two = pool.take();
    EXPECT_FALSE(one->is_lost());
  }
  {
    const auto one = pool.take();
    EXPECT_FALSE((**one).run_script("").ok());
    EXPECT_TRUE(one->is_lost());
  }
  EXPECT_EQ(opener.made, 2);
  const auto one = pool.take();
  const auto two = pool.take();
  const auto three = pool.take();
  ASSERT_TRUE(one.ok() && two.ok() && three.ok());
  EXPECT_EQ(opener.made, 5);
  EXPECT_FALSE(pool.take().ok());
}

TEST(ConnectionPool, OneThatCannotBeMadeTakesNoPlace) {
  Opener opener;
  ConnectionPool pool(opener.open(), 1, 100ms);
  opener.refuses = true;
  for (int i = 0; i < 3; ++i) {
    const auto refused = pool.take();
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().message, "nobody is there");
  }
  opener.refuses = false;
  EXPECT_TRUE(pool.take().ok());
}

TEST(ConnectionPool, ThatAnotherOneLeadsIsToldOnce) {
  if (!test::postgres_is_there()) return;
  const std::string url = test::PostgresServer::shared().make_database();
  DatabaseHands hands = make_film_database(url);
  PostgresOptions options = film_leader(url);
  std::vector<std::string> told;
  options.on_lost = [&](const std::string& why) { told.push_back(why); };
  ConnectionPool pool(postgres_connections(options), 3, 1s);
  const auto write = [&] {
    auto db = pool.take();
    return db ? Query(**db, "DELETE FROM lines").run() : db.error();
  };
  ASSERT_TRUE(write().ok());
  hands.run(
      "SELECT pg_terminate_backend(pid) FROM pg_stat_activity "
      "WHERE application_name = 'hyades leader' AND datname = current_database()");
  EXPECT_FALSE(write().ok());
  EXPECT_TRUE(write().ok()) << "a lost connection is replaced";
  EXPECT_TRUE(told.empty());
  hands.run("UPDATE leader SET incarnation = 2");
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(write().ok());
  EXPECT_EQ(told, std::vector<std::string>{kOtherLeads});
}

}  // namespace
}  // namespace hyades::coordinator
