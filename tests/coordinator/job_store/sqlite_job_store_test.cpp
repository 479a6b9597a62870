// What only the store in SQLite has: a file, on a disk that may be full, of an older schema.
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "coordinator/job_store/job_store.h"
#include "coordinator/job_store/log_rows.h"
#include "coordinator/job_store/schema.h"
#include "tests/coordinator/job_store/store_place.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

std::unique_ptr<JobStore> open(const std::string& path) {
  auto store = open_sqlite_job_store(path);
  EXPECT_TRUE(store.ok()) << (store ? "" : store.error().message);
  return store ? std::move(*store) : nullptr;
}

TEST(SqliteJobStore, ASecondOneIsToldWhoIsThere) {
  const test::TempFolder folder;
  const auto first = open(folder.file("state.db"));
  const auto second = open_sqlite_job_store(folder.file("state.db"));
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().message + "/state.db",
            "another coordinator works in " + folder.file("state.db"));
}

/// While it lives the disk takes nothing that this process writes.
class NoWrites {
 public:
  NoWrites() {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit none{0, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &none);
  }
  ~NoWrites() { setrlimit(RLIMIT_FSIZE, &before_); }
  NoWrites(const NoWrites&) = delete;
  NoWrites& operator=(const NoWrites&) = delete;

 private:
  rlimit before_{};
};

TEST(SqliteJobStore, LinesThatCouldNotBeStoredPushOutNoOthers) {
  const test::TempFolder folder;
  auto store = open(folder.file("state.db"));
  ASSERT_TRUE(store->add_job(some_job("", "ada")).ok());
  ASSERT_TRUE(store->add_lines(1, some_lines(kMostLines - kLinesDropped + 100)).ok());
  for (uint64_t i = 0; i < 2; ++i) {
    const NoWrites full;
    ASSERT_FALSE(store->add_lines(1, some_lines(kLinesDropped / 2 - 100)).ok());
  }
  ASSERT_TRUE(store->add_lines(1, some_lines(200)).ok());
  EXPECT_EQ(store->lines(1, 0, 1)->at(0).text, "line 0") << "there was room";
  EXPECT_EQ(store->lines(1, 0, UINT32_MAX)->size(), kMostLines - kLinesDropped + 300);
}

TEST(SqliteJobStore, NoLineIsOverwrittenWhereNoneHadToGo) {
  const test::TempFolder folder;
  const std::string path = folder.file("state.db");
  ASSERT_TRUE(open(path)->add_job(some_job("", "ada")).ok());
  const auto db = open_job_database(path);
  ASSERT_TRUE(db.ok());
  LogRows table;
  ASSERT_TRUE(table.add(**db, 1, some_lines(10)).ok());
  {
    Transaction lost(**db);  // nobody tells the table that it is rolled back
    ASSERT_TRUE(table.add(**db, 1, some_lines(kMostLines - 20)).ok());
  }
  ASSERT_TRUE(table.add(**db, 1, some_lines(20)).ok());
  const auto lines = read_lines(**db, 1, 0, UINT32_MAX);
  ASSERT_EQ(lines->size(), 30U);
  EXPECT_EQ(lines->at(0).text, "line 0");
}

TEST(SqliteJobStore, FilesOfTheFirstSchemasAreBroughtUpToDate) {
  const test::TempFolder folder;
  const std::string path = folder.file("state.db");
  {
    auto store = open(path);
    ASSERT_TRUE(store->add_job(some_job("", "ada")).ok());
    ASSERT_TRUE(store->frame_over(1, {3, true, "", "class", 2}, {}).ok());
  }
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db,
                         "ALTER TABLE jobs ADD COLUMN spec BLOB NOT NULL DEFAULT x''; "
                         "UPDATE jobs SET spec = (SELECT spec FROM specs WHERE job = id); "
                         "DROP TABLE specs; DROP INDEX jobs_of_owner; "
                         "DROP INDEX black_frames; ALTER TABLE frames DROP COLUMN black; "
                         "DROP TABLE removals; DROP INDEX doubtful_frames; ALTER TABLE frames DROP "
                         "COLUMN doubtful; "
                         "DROP TABLE parts; DROP TABLE trusted; DROP INDEX outputs_of_frame; "
                         "DROP TABLE tokens; DROP TRIGGER count_core_time; DROP TABLE core_time; "
                         "ALTER TABLE jobs DROP COLUMN core_ns; ALTER TABLE jobs DROP COLUMN "
                         "preview; ALTER TABLE jobs DROP COLUMN owner_proven; "
                         "ALTER TABLE jobs DROP COLUMN options; DROP TABLE secret; "
                         "ALTER TABLE jobs DROP COLUMN samples_done; "
                         "ALTER TABLE jobs DROP COLUMN begun_ms; "
                         "ALTER TABLE jobs DROP COLUMN busy_ns; "
                         "PRAGMA user_version=3",
                         nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(db);
  auto store = open(path);
  const auto frames = store->frames(1);
  ASSERT_EQ(frames->size(), 1U);
  EXPECT_FALSE(frames->at(0).suspect);
  EXPECT_FALSE(frames->at(0).black);
  EXPECT_EQ((*store->job(1))->spec, some_job("", "ada").spec);
  EXPECT_EQ((*store->job(1))->core_ns, 0U);
  EXPECT_FALSE((*store->job(1))->preview);
  EXPECT_FALSE((*store->job(1))->owner_proven) << "no token has shown who ada is";
  EXPECT_TRUE(store->mark_divergent({"worker", "divergent"}, 0, {})->empty())
      << "whose films an older program finished is not known";
}

TEST(SqliteJobStore, OwnersOfTheSixthSchemaAreProvenByTokensThatWereThereBefore) {
  const test::TempFolder folder;
  const std::string path = folder.file("state.db");
  {
    auto store = open(path);
    StoredToken token{"9f3a01c2", "ada", 2, std::string(32, 'h'), 1000};
    ASSERT_TRUE(store->add_token(token).ok());
    for (const auto& [owner, submitted] :
         {std::pair("ada", 999), std::pair("ada", 1000), std::pair("bob", 2000)}) {
      StoredJob job = some_job("", owner);
      job.submitted_ms = submitted;
      ASSERT_TRUE(store->add_job(job).ok());
    }
  }
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db,
                         "ALTER TABLE jobs ADD COLUMN spec BLOB NOT NULL DEFAULT x''; "
                         "UPDATE jobs SET spec = (SELECT spec FROM specs WHERE job = id); "
                         "DROP TABLE specs; DROP INDEX jobs_of_owner; "
                         "DROP INDEX black_frames; ALTER TABLE frames DROP COLUMN black; "
                         "DROP TABLE removals; "
                         "DROP TRIGGER count_core_time; DROP TABLE core_time; "
                         "ALTER TABLE jobs DROP COLUMN owner_proven; "
                         "ALTER TABLE jobs DROP COLUMN options; DROP TABLE secret; "
                         "ALTER TABLE tokens DROP COLUMN pool; "
                         "ALTER TABLE tokens DROP COLUMN machines; "
                         "ALTER TABLE jobs DROP COLUMN samples_done; "
                         "ALTER TABLE jobs DROP COLUMN begun_ms; "
                         "ALTER TABLE jobs DROP COLUMN busy_ns; "
                         "PRAGMA user_version=6",
                         nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(db);
  auto store = open(path);
  EXPECT_EQ(store->tokens()->front().machines, 20'000U) << "as many as a farm may have";
  EXPECT_FALSE((*store->job(1))->owner_proven);
  EXPECT_TRUE((*store->job(2))->owner_proven);
  EXPECT_FALSE((*store->job(3))->owner_proven);
}

TEST(SqliteJobStore, ANewerSchemaIsRefused) {
  const test::TempFolder folder;
  const std::string path = folder.file("state.db");
  open(path).reset();
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db, "PRAGMA user_version=999", nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(db);
  const auto refused = open_sqlite_job_store(path);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("newer"), std::string::npos) << refused.error().message;
}

TEST(SqliteJobStore, OneProcessAtATime) {
  const test::TempFolder folder;
  const auto store = open(folder.file("state.db"));
  EXPECT_FALSE(open_sqlite_job_store(folder.file("state.db")).ok());
}

}  // namespace
}  // namespace hyades::coordinator
