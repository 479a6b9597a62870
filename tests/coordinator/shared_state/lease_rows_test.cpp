#include "coordinator/shared_state/lease_rows.h"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "coordinator/sql/sqlite.h"

namespace hyades::coordinator {
namespace {

using namespace std::chrono_literals;

class LeaseRows : public testing::Test {
 protected:
  LeaseRows() {
    sqlite3* db = nullptr;
    EXPECT_EQ(sqlite3_open(":memory:", &db), SQLITE_OK);
    db_ = std::make_unique<SqliteConnection>(std::unique_ptr<sqlite3, CloseSqlite>(db));
    EXPECT_TRUE(db_->run_script("CREATE TABLE leader (incarnation INTEGER);"
                                "INSERT INTO leader VALUES (0);"
                                "CREATE TABLE lease (incarnation INTEGER, renewed INTEGER, holder "
                                "TEXT, url TEXT, lease_ms INTEGER);"
                                "INSERT INTO lease VALUES (0, 0, '', '', 0)")
                    .ok());
  }

  LeaseRow row() {
    auto read = read_lease(*db_);
    EXPECT_TRUE(read.ok());
    return read ? *read : LeaseRow{};
  }
  std::optional<uint64_t> take(const LeaseRow& last, const std::string& holder) {
    const auto taken = take_over(*db_, last, holder, 3000ms);
    EXPECT_TRUE(taken.ok());
    return taken ? *taken : std::nullopt;
  }

  std::unique_ptr<SqliteConnection> db_;
};

TEST_F(LeaseRows, OfTwoThatHaveSeenTheSameOneLeads) {
  const LeaseRow seen = row();
  EXPECT_EQ(take(seen, "a:1"), 1U);
  EXPECT_EQ(take(seen, "b:2"), std::nullopt);
  EXPECT_EQ(row().holder, "a:1");
  EXPECT_EQ(row().time, 3000ms);
  EXPECT_EQ(take(row(), "b:2"), 2U);
}

TEST_F(LeaseRows, WhoWasPassedRenewsNothingAndStepsDownForNobody) {
  ASSERT_EQ(take(row(), "a:1"), 1U);
  EXPECT_TRUE(*renew_lease(*db_, 1, "https://a/"));
  EXPECT_EQ(row().renewed, 1U);
  EXPECT_EQ(row().url, "https://a/");
  ASSERT_EQ(take(row(), "b:2"), 2U);
  EXPECT_EQ(row().url, "");
  EXPECT_FALSE(*renew_lease(*db_, 1, "https://a/"));
  ASSERT_TRUE(step_down(*db_, 1).ok());
  EXPECT_EQ(row().holder, "b:2");
  ASSERT_TRUE(step_down(*db_, 2).ok());
  EXPECT_EQ(row().holder, "");
}

TEST_F(LeaseRows, StartsGoOnFromThoseOfAnotherHome) {
  ASSERT_TRUE(raise_incarnation(*db_, 40).ok());
  EXPECT_EQ(row().incarnation, 40U);
  ASSERT_TRUE(raise_incarnation(*db_, 7).ok());
  EXPECT_EQ(take(row(), "a:1"), 41U);
  ASSERT_TRUE(raise_incarnation(*db_, 99).ok());
  EXPECT_EQ(row().incarnation, 41U) << "while somebody leads";
  ASSERT_TRUE(step_down(*db_, 41).ok());
  EXPECT_EQ(take(row(), "b:2"), 42U);
}

}  // namespace
}  // namespace hyades::coordinator
