// What only PostgreSQL has: others, who may take over, and a network between.
#include "coordinator/sql/postgres.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "tests/coordinator/sql/postgres_server.h"

namespace hyades::coordinator {
namespace {

using Clock = std::chrono::steady_clock;

class Postgres : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::postgres_is_there()) return;
    server_ = &test::PostgresServer::shared();
    url_ = server_->make_database();
    other_ = open({.url = url_});
    ASSERT_TRUE(other_);
    ASSERT_TRUE(other_
                    ->run_script("CREATE SCHEMA hyades;"
                                 "CREATE TABLE leader (incarnation BIGINT PRIMARY KEY);"
                                 "INSERT INTO leader VALUES (1);"
                                 "CREATE TABLE things (number BIGINT)")
                    .ok());
  }

  static std::unique_ptr<SqlConnection> open(const PostgresOptions& options) {
    auto opened = open_postgres(options);
    EXPECT_TRUE(opened.ok()) << (opened ? "" : opened.error().message);
    return opened ? std::move(*opened) : nullptr;
  }
  /// That of the first leader.
  std::unique_ptr<SqlConnection> open_leader(std::chrono::milliseconds patience) {
    return open({.url = url_, .incarnation = 1, .patience = patience, .on_lost = [this](auto& why) {
                   ++lost_;
                   why_ = why;
                 }});
  }
  std::unique_ptr<SqlConnection> open_leader() { return open_leader(std::chrono::seconds(30)); }

  static core::Status add(SqlConnection& db, int64_t value) {
    return Query(db, "INSERT INTO things VALUES (?)").bind(value).run();
  }
  core::Status take_over() const {
    return Query(*other_, "UPDATE leader SET incarnation = incarnation + 1").run();
  }
  static int64_t number_of(SqlConnection& db, const std::string& sql) {
    Query row(db, sql);
    return row.next() ? row.integer(0) : -1;
  }
  int64_t things() const { return number_of(*other_, "SELECT COUNT(*) FROM things"); }

  test::PostgresServer* server_ = nullptr;
  std::string url_;
  std::unique_ptr<SqlConnection> other_;
  int lost_ = 0;
  std::string why_;
};

TEST_F(Postgres, WhoLeadsWrites) {
  const auto leader = open_leader();
  ASSERT_TRUE(add(*leader, 1).ok());
  Transaction transaction(*leader);
  ASSERT_TRUE(add(*leader, 2).ok());
  ASSERT_TRUE(transaction.commit().ok());
  EXPECT_EQ(things(), 2);
  EXPECT_EQ(lost_, 0);
}

TEST_F(Postgres, WhoLedCanWriteNothing) {
  const auto leader = open_leader();
  ASSERT_TRUE(add(*leader, 1).ok());
  ASSERT_TRUE(take_over().ok());
  const core::Status late = add(*leader, 2);
  ASSERT_FALSE(late.ok());
  EXPECT_NE(late.error().message.find(kOtherLeads), std::string::npos) << late.error().message;
  const Transaction transaction(*leader);
  EXPECT_FALSE(transaction.status().ok());
  EXPECT_FALSE(add(*leader, 3).ok());
  EXPECT_EQ(number_of(*leader, "SELECT COUNT(*) FROM things"), -1);
  EXPECT_EQ(things(), 1);
  EXPECT_EQ(lost_, 1) << "once";
  EXPECT_EQ(why_, kOtherLeads);
}

TEST_F(Postgres, TakingOverWaitsForAnOpenTransaction) {
  const auto leader = open_leader();
  std::atomic<bool> taken = false;
  std::thread successor;
  {
    Transaction transaction(*leader);
    ASSERT_TRUE(add(*leader, 1).ok());
    successor = std::thread([&] {
      EXPECT_TRUE(take_over().ok());
      taken = true;
    });
    for (int i = 0; i < 5; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      EXPECT_FALSE(taken);
      EXPECT_TRUE(add(*leader, 2).ok());
    }
    EXPECT_TRUE(transaction.commit().ok());
  }
  successor.join();
  EXPECT_EQ(things(), 6) << "all of it was there before the other one led";
  EXPECT_FALSE(add(*leader, 7).ok());
}

TEST_F(Postgres, WhoIsFrozenInATransactionHoldsNobodyUp) {
  const auto leader = open_leader();
  Transaction transaction(*leader);
  ASSERT_TRUE(add(*leader, 1).ok());
  const auto begun = Clock::now();
  EXPECT_TRUE(take_over().ok());
  EXPECT_LT(Clock::now() - begun, std::chrono::seconds(8));
  EXPECT_FALSE(transaction.commit().ok());
  EXPECT_EQ(lost_, 1);
  EXPECT_EQ(things(), 0);
}

TEST_F(Postgres, AConnectionThatIsEndedIsLostOnce) {
  const auto leader = open_leader();
  const int64_t backend = number_of(*leader, "SELECT pg_backend_pid()");
  ASSERT_GT(backend, 0);
  EXPECT_EQ(number_of(*other_, fmt::format("SELECT 1 WHERE pg_terminate_backend({})", backend)), 1);
  EXPECT_FALSE(add(*leader, 1).ok());
  EXPECT_FALSE(add(*leader, 1).ok());
  EXPECT_EQ(lost_, 1);
  EXPECT_FALSE(why_.empty());
  EXPECT_EQ(things(), 0);
}

TEST_F(Postgres, AServerThatIsSilentIsGivenUp) {
  const auto leader = open_leader(std::chrono::seconds(2));
  const auto backend = static_cast<pid_t>(number_of(*leader, "SELECT pg_backend_pid()"));
  ASSERT_GT(backend, 1);
  ASSERT_EQ(::kill(backend, SIGSTOP), 0);
  const auto begun = Clock::now();
  EXPECT_FALSE(add(*leader, 1).ok());
  const auto took = Clock::now() - begun;
  ::kill(backend, SIGCONT);
  EXPECT_GE(took, std::chrono::seconds(2));
  EXPECT_LT(took, std::chrono::seconds(10));
  EXPECT_EQ(lost_, 1);
  EXPECT_NE(why_.find("has not answered for 2 s"), std::string::npos) << why_;
}

TEST_F(Postgres, ADatabaseThatOnlyReadsNowIsLeft) {
  const auto leader = open_leader();
  ASSERT_TRUE(leader->run_script("SET default_transaction_read_only = on").ok());
  EXPECT_FALSE(add(*leader, 1).ok());
  EXPECT_EQ(lost_, 1);
  EXPECT_NE(why_.find("read-only"), std::string::npos) << why_;
}

TEST_F(Postgres, AStatementThatFailsLosesNothing) {
  const auto leader = open_leader();
  EXPECT_FALSE(Query(*leader, "INSERT INTO nothing VALUES (1)").run().ok());
  ASSERT_TRUE(add(*leader, 1).ok());
  EXPECT_EQ(lost_, 0);
  Transaction transaction(*leader);
  EXPECT_FALSE(Query(*leader, "INSERT INTO nothing VALUES (1)").run().ok());
  EXPECT_FALSE(transaction.commit().ok()) << "it was rolled back";
  EXPECT_EQ(lost_, 0);
}

TEST_F(Postgres, WhatIsNoTextIsStoredAllTheSame) {
  ASSERT_TRUE(other_->run_script("CREATE TABLE texts (text TEXT)").ok());
  const std::string text("a\0b\xFF\xC3\xA9", 6);
  ASSERT_TRUE(Query(*other_, "INSERT INTO texts VALUES (?)").bind(text).run().ok());
  Query row(*other_, "SELECT text FROM texts WHERE text = ?");
  row.bind(text);
  ASSERT_TRUE(row.next());
  EXPECT_EQ(row.bytes(0), "a?b?\xC3\xA9");
}

TEST_F(Postgres, TheFirstOfSeveralHostsMayBeSilent) {
  // Nobody listens on the first port, and the second takes connections without a word.
  test::PostgresServer frozen;
  const std::string silent = frozen.make_database();
  const std::string after_user = url_.substr(url_.find('@') + 1);
  const std::string name = after_user.substr(after_user.find('/'));
  const std::string url =
      fmt::format("postgresql://farm:{}@127.0.0.1:1,127.0.0.1:{},127.0.0.1:{}{}",
                  server_->password(), frozen.port(), server_->port(), name);
  frozen.freeze();
  const auto begun = Clock::now();
  EXPECT_TRUE(open({.url = url}));
  EXPECT_LT(Clock::now() - begun, std::chrono::seconds(10));
  const auto refused = open_postgres({.url = silent});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message.find(frozen.password()), std::string::npos);
}

TEST_F(Postgres, SocketsDoAsWell) {
  const auto db = open({.url = server_->make_database_by_socket(), .name = "hyades test"});
  EXPECT_EQ(number_of(*db,
                      "SELECT COUNT(*) FROM pg_stat_activity WHERE application_name = "
                      "'hyades test'"),
            1);
}

TEST_F(Postgres, PasswordsAreInNoError) {
  const std::string secret = "s3cr3t";
  const std::string place = fmt::format("127.0.0.1:{}/nothing", server_->port());
  for (const std::string& url : {
           "postgresql://farm:" + secret + "@" + place,
           "postgresql://farm@" + place + "?password=" + secret,
           "postgresql://farm@" + place + "?pass%77ord=" + secret,
           "postgresql://farm:" + secret + "@127.0.0.1:1/farm",
           // Not written as a URL has to be.
           "postgresql://farm:" + secret + "/x@" + place,
           "postgresql://farm:12/" + secret + "@" + place,
           "postgresql://farm:x?" + secret + "@" + place,
           "postgresql://farm:%zz" + secret + "@" + place,
           "postgresql://farm:" + secret + "@[127.0.0.1:1/farm",
           "host=127.0.0.1 port=1 user=farm password=" + secret,
           "host=127.0.0.1 port=1 user=farm password=a://" + secret + "@b",
           "host=127.0.0.1 port=" + secret,
           "password '" + secret,
       }) {
    const auto opened = open_postgres({.url = url});
    ASSERT_FALSE(opened.ok()) << url;
    EXPECT_EQ(opened.error().message.find(secret), std::string::npos) << opened.error().message;
    EXPECT_FALSE(opened.error().message.empty());
    EXPECT_EQ(without_password(url).find(secret), std::string::npos) << without_password(url);
  }
}

TEST(PostgresUrl, IsShownWithoutItsPassword) {
  EXPECT_EQ(without_password("postgresql://ada:pass@db.example:5433/hyades?sslmode=require"),
            "postgresql://ada@db.example:5433/hyades");
  EXPECT_EQ(without_password("postgres://ada:p%40ss@one,two/hyades"),
            "postgresql://ada@one,two/hyades");
  EXPECT_EQ(without_password("postgresql://ada@one:1,two:2/"), "postgresql://ada@one:1,two:2");
  EXPECT_EQ(without_password("host=db user=ada password=pass dbname=hyades"),
            "postgresql://ada@db/hyades");
  EXPECT_EQ(without_password("postgresql://ada:pa/ss@db/hyades"), "the database");
  EXPECT_EQ(without_password("no URL"), "the database");
}

TEST(PostgresUrl, IsKnownByItsBeginning) {
  EXPECT_TRUE(is_postgres_url("postgresql://db/hyades"));
  EXPECT_TRUE(is_postgres_url("postgres:///hyades"));
  EXPECT_FALSE(is_postgres_url("my-farm"));
  EXPECT_FALSE(is_postgres_url("host=db"));
}

}  // namespace
}  // namespace hyades::coordinator
