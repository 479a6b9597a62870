// What both engines have in common.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>

#include "coordinator/sql/connection.h"
#include "coordinator/sql/postgres.h"
#include "coordinator/sql/sqlite.h"
#include "tests/coordinator/sql/postgres_server.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

/// Each test is run with a database of each engine.
class Sql : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (GetParam() == std::string("sqlite")) {
      auto opened = open_sqlite(folder_.file("some.db"));
      ASSERT_TRUE(opened.ok()) << opened.error().message;
      db_ = std::move(*opened);
    } else {
      if (!test::postgres_is_there()) return;
      auto opened = open_postgres({.url = test::PostgresServer::shared().make_database()});
      ASSERT_TRUE(opened.ok()) << opened.error().message;
      db_ = std::move(*opened);
      run("CREATE SCHEMA hyades");
    }
    const std::string bytes = GetParam() == std::string("sqlite") ? "BLOB" : "BYTEA";
    run("CREATE TABLE things (number BIGINT, text TEXT, bytes " + bytes + ")");
  }
  void run(const std::string& sql) {
    const core::Status done = db_->run_script(sql);
    ASSERT_TRUE(done.ok()) << sql << ": " << done.error().message;
  }
  void add(int64_t value) {
    const auto done = Query(*db_, "INSERT INTO things (number) VALUES (?)").bind(value).run();
    ASSERT_TRUE(done.ok()) << done.error().message;
  }
  int64_t count() {
    Query rows(*db_, "SELECT COUNT(*) FROM things");
    EXPECT_TRUE(rows.next());
    return rows.integer(0);
  }

  const test::TempFolder folder_;
  std::unique_ptr<SqlConnection> db_;
};

TEST_P(Sql, GivesBackWhatItWasGiven) {
  std::string all;
  for (int i = 0; i < 256; ++i) all += static_cast<char>(i);
  const std::string text = "caf\xC3\xA9 'quoted' ?1 $1 \xF0\x9F\x98\x80";
  const std::string large(3'000'000, '\0');
  for (const int64_t value : {INT64_MIN, int64_t{-1}, int64_t{0}, INT64_MAX}) {
    for (const std::string& bytes : {all, std::string(), std::string(1, '\0'), large}) {
      Query insert(*db_, "INSERT INTO things (number, text, bytes) VALUES (?, ?, ?)");
      ASSERT_TRUE(insert.bind(value).bind(text).bind_blob(bytes).run().ok());
      EXPECT_EQ(insert.changed(), 1);
      Query row(*db_, "SELECT number, text, bytes, LENGTH(bytes) FROM things WHERE text = ?");
      row.bind(text);
      ASSERT_TRUE(row.next()) << row.status().error().message;
      EXPECT_EQ(row.integer(0), value);
      EXPECT_EQ(row.bytes(1), text);
      EXPECT_TRUE(row.bytes(2) == bytes);
      EXPECT_EQ(row.integer(3), static_cast<int64_t>(bytes.size()));
      EXPECT_FALSE(row.is_null(1));
      EXPECT_FALSE(row.next());
      EXPECT_TRUE(row.status().ok());
      ASSERT_TRUE(Query(*db_, "DELETE FROM things").run().ok());
    }
  }
}

TEST_P(Sql, KnowsNothingFromEmpty) {
  Query insert(*db_, "INSERT INTO things (number, text, bytes) VALUES (?, ?, ?)");
  ASSERT_TRUE(insert.bind_null().bind_null().bind_null().run().ok());
  Query row(*db_, "SELECT number, text, bytes FROM things");
  ASSERT_TRUE(row.next());
  for (const int column : {0, 1, 2}) {
    EXPECT_TRUE(row.is_null(column));
    EXPECT_EQ(row.bytes(column), "");
    EXPECT_EQ(row.integer(column), 0);
  }
}

TEST_P(Sql, BindsByOrderOrByNumber) {
  for (int64_t value : {1, 2, 3, 4}) add(value);
  Query ordered(*db_, "SELECT number FROM things WHERE number > ? AND number < ?");
  ordered.bind(1).bind(3);
  ASSERT_TRUE(ordered.next());
  EXPECT_EQ(ordered.integer(0), 2);
  Query numbered(*db_,
                 "SELECT number FROM things WHERE number = ?2 AND ?1 < ?2 AND text IS NULL "
                 "AND '?' = '?' LIMIT ?3");
  numbered.bind(3).bind(4).bind(1);
  ASSERT_TRUE(numbered.next()) << numbered.status().error().message;
  EXPECT_EQ(numbered.integer(0), 4);
}

TEST_P(Sql, SaysHowManyRowsHaveChanged) {
  for (int64_t value : {1, 2, 3, 4}) add(value);
  Query update(*db_, "UPDATE things SET text = 'x' WHERE number > ?");
  ASSERT_TRUE(update.bind(1).run().ok());
  EXPECT_EQ(update.changed(), 3);
  Query none(*db_, "DELETE FROM things WHERE number > ?");
  ASSERT_TRUE(none.bind(9).run().ok());
  EXPECT_EQ(none.changed(), 0);
  Query all(*db_, "DELETE FROM things");
  ASSERT_TRUE(all.run().ok());
  EXPECT_EQ(all.changed(), 4);
}

TEST_P(Sql, TransactionsAreAllOrNothing) {
  {
    Transaction lost(*db_);
    ASSERT_TRUE(lost.status().ok());
    add(1);
    EXPECT_EQ(count(), 1);
  }
  EXPECT_EQ(count(), 0);
  Transaction kept(*db_);
  add(2);
  add(3);
  ASSERT_TRUE(kept.commit().ok());
  EXPECT_EQ(count(), 2);
}

TEST_P(Sql, AStatementThatFailsSaysWhy) {
  for (const char* sql : {"SELECT nothing FROM things", "SELECT * FROM nothing", "SELEKT 1"}) {
    Query wrong(*db_, sql);
    EXPECT_FALSE(wrong.next());
    ASSERT_FALSE(wrong.status().ok());
    const std::string why = wrong.status().error().message;
    EXPECT_EQ(why.rfind("the job store: ", 0), 0U) << why;
    EXPECT_NE(why.find(std::string(sql).starts_with("SELEKT") ? "SELEKT" : "nothing"),
              std::string::npos)
        << why;
    EXPECT_EQ(why.find('\n'), std::string::npos);
  }
  Query bound(*db_, "INSERT INTO nothing VALUES (?, ?)");
  EXPECT_FALSE(bound.bind(1).bind("text").run().ok());
  add(1);
  EXPECT_EQ(count(), 1) << "it goes on";
}

TEST_P(Sql, AFailedTransactionLeavesNothing) {
  run("CREATE TABLE single (number BIGINT PRIMARY KEY)");
  {
    Transaction failed(*db_);
    ASSERT_TRUE(Query(*db_, "INSERT INTO single VALUES (1)").run().ok());
    EXPECT_FALSE(Query(*db_, "INSERT INTO single VALUES (1)").run().ok());
  }
  Query rows(*db_, "SELECT COUNT(*) FROM single");
  ASSERT_TRUE(rows.next());
  EXPECT_EQ(rows.integer(0), 0);
  add(1);
}

TEST_P(Sql, TellsWhichNumberItHasGiven) {
  const std::string key = GetParam() == std::string("sqlite")
                              ? "INTEGER PRIMARY KEY AUTOINCREMENT"
                              : "BIGINT GENERATED BY DEFAULT AS IDENTITY PRIMARY KEY";
  run("CREATE TABLE numbered (id " + key + ", text TEXT)");
  for (const int64_t expected : {1, 2}) {
    Query insert(*db_, "INSERT INTO numbered (text) VALUES ('x') RETURNING id");
    ASSERT_TRUE(insert.next()) << insert.status().error().message;
    EXPECT_EQ(insert.integer(0), expected);
    EXPECT_TRUE(insert.run().ok());
    EXPECT_EQ(insert.changed(), 1);
  }
}

INSTANTIATE_TEST_SUITE_P(, Sql, testing::Values("sqlite", "postgres"),
                         [](const auto& engine) { return std::string(engine.param); });

}  // namespace
}  // namespace hyades::coordinator
