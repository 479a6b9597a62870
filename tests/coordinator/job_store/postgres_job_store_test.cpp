// What only the store in PostgreSQL has: others beside it.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/job_store/job_store.h"
#include "coordinator/job_store/postgres_schema.h"
#include "coordinator/sql/postgres.h"
#include "tests/coordinator/job_store/store_place.h"
#include "tests/coordinator/sql/postgres_server.h"

namespace hyades::coordinator {
namespace {

class PostgresJobStore : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::postgres_is_there()) return;
    url_ = test::PostgresServer::shared().make_database();
    db_ = connect();
    ASSERT_TRUE(db_);
  }
  std::unique_ptr<SqlConnection> connect() const {
    auto opened = open_postgres({.url = url_});
    EXPECT_TRUE(opened.ok()) << (opened ? "" : opened.error().message);
    return opened ? std::move(*opened) : nullptr;
  }
  int64_t number_of(const std::string& sql) const {
    Query row(*db_, sql);
    return row.next() ? row.integer(0) : -1;
  }

  std::string url_;
  std::unique_ptr<SqlConnection> db_;
};

TEST_F(PostgresJobStore, ManyMayMakeTheTablesAtOnce) {
  std::vector<std::thread> coordinators;
  for (int i = 0; i < 6; ++i) {
    coordinators.emplace_back([this] {
      const auto db = connect();
      const core::Status made = prepare_postgres(*db);
      EXPECT_TRUE(made.ok()) << made.error().message;
    });
  }
  for (std::thread& one : coordinators) one.join();
  EXPECT_TRUE(prepare_postgres(*db_).ok()) << "they are there";
  EXPECT_TRUE(migrate_postgres(*db_).ok());
  for (const char* table : {"schema_version", "leader", "lease", "secret"}) {
    EXPECT_EQ(number_of(std::string("SELECT COUNT(*) FROM ") + table), 1) << table;
  }
  EXPECT_EQ(number_of("SELECT incarnation FROM leader"), 0);
  EXPECT_EQ(number_of("SELECT LENGTH(text) FROM secret"), 64);
}

TEST_F(PostgresJobStore, ASchemaThatIsThereAndEmptyIsTaken) {
  ASSERT_TRUE(db_->run_script("CREATE SCHEMA hyades").ok());
  EXPECT_TRUE(prepare_postgres(*db_).ok());
  EXPECT_EQ(number_of("SELECT COUNT(*) FROM hyades.jobs"), 0);
}

TEST_F(PostgresJobStore, ANewerSchemaIsRefused) {
  ASSERT_TRUE(prepare_postgres(*db_).ok());
  ASSERT_TRUE(Query(*db_, "UPDATE schema_version SET version = 999").run().ok());
  const core::Status refused = prepare_postgres(*db_);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("newer Hyades (schema 999"), std::string::npos);
  EXPECT_FALSE(migrate_postgres(*db_).ok());
  const auto store = open_postgres_job_store({.url = url_, .incarnation = 0});
  ASSERT_FALSE(store.ok());
  EXPECT_NE(store.error().message.find("newer"), std::string::npos) << store.error().message;
  EXPECT_EQ(store.error().message.find(test::PostgresServer::shared().password()),
            std::string::npos);
}

TEST_F(PostgresJobStore, TablesThatAreNotThereAreMissed) {
  EXPECT_FALSE(open_postgres_job_store({.url = url_, .incarnation = 0}).ok());
  EXPECT_FALSE(migrate_postgres(*db_).ok());
}

TEST_F(PostgresJobStore, WhoseSuccessorLeadsStoresNothing) {
  const StorePlace place("postgres");
  const auto old = place.open();
  ASSERT_TRUE(old->add_job(some_job("", "ada")).ok());
  const auto successor = place.open();
  EXPECT_EQ(*successor->next_incarnation(), 2U);
  EXPECT_FALSE(old->add_job(some_job("", "eve")).ok());
  EXPECT_FALSE(old->add_lines(1, some_lines(1)).ok());
  EXPECT_FALSE(old->state(1).ok());
  EXPECT_FALSE(old->remove_job(1).ok());
  EXPECT_EQ(*successor->open_jobs(), std::vector<uint64_t>{1});
  EXPECT_TRUE(successor->lines(1, 0, 10)->empty());
  EXPECT_EQ(successor->add_job(some_job("", "ada"))->existed, false);
}

TEST_F(PostgresJobStore, ALeaderWithoutALeaseHasNoIncarnation) {
  ASSERT_TRUE(prepare_postgres(*db_).ok());
  const auto store = open_postgres_job_store({.url = url_});
  ASSERT_TRUE(store.ok());
  EXPECT_FALSE((*store)->next_incarnation().ok());
}

}  // namespace
}  // namespace hyades::coordinator
