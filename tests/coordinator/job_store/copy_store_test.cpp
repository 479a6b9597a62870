#include "coordinator/job_store/copy_store.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/job_store/job_store.h"
#include "coordinator/job_store/postgres_schema.h"
#include "coordinator/job_store/schema.h"
#include "coordinator/sql/postgres.h"
#include "coordinator/sql/sqlite.h"
#include "tests/coordinator/sql/postgres_server.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {
namespace {

StoredJob job_named(const std::string& name) {
  StoredJob job;
  job.key = name + "-key";
  job.spec = std::string("spec\0of ", 8) + name;
  job.name = name;
  job.owner = "ada";
  job.owner_proven = true;
  job.priority = -3;
  job.options = std::string("\x00\xff", 2);
  job.frames = 240;
  job.samples = 1'000'000'000'000;
  job.submitted_ms = 12345;
  return job;
}

/// More rows of each kind than a page has, and numbers that were given to what is gone.
void fill(JobStore& store) {
  const auto gone = store.add_job(job_named("gone"));
  ASSERT_TRUE(gone.ok());
  for (int i = 0; i < 150; ++i) {
    const auto added = store.add_job(job_named("job" + std::to_string(i)));
    ASSERT_TRUE(added.ok());
  }
  std::vector<StoredLine> lines;
  for (int i = 0; i < 250; ++i) lines.push_back({i, 1, {}, "worker", "line " + std::to_string(i)});
  lines[7].frame = 12;
  ASSERT_TRUE(store.add_lines(2, lines).ok());
  for (int32_t frame = -60; frame < 60; ++frame) {
    StoredFrame over{frame, frame != 3, "", "class", 2};
    over.parts = {"one", "two"};
    over.moment = 70 + static_cast<uint64_t>(frame);
    over.black = frame == 4;
    const std::string path = "frame." + std::to_string(frame) + ".png";
    ASSERT_TRUE(store.frame_over(2, over, {{path, frame, 99, std::string(32, '\x80')}}).ok());
  }
  ASSERT_TRUE(store.quarantine({"liar", "told other bits"}).ok());
  ASSERT_TRUE(store.trust({{"one", 5}, {"two", UINT64_MAX}}).ok());
  ASSERT_TRUE(store.add_token({"id", "bob", 2, std::string(32, '\0'), 1, 2, 3, 4, "pool", 5}).ok());
  StoredJob job = job_named("job0");
  job.id = 2;
  job.core_ns = 77;
  job.preview = 9;
  ASSERT_TRUE(store.update_job(job).ok());
  const auto last = store.add_job(job_named("last"));
  ASSERT_TRUE(last.ok());
  ASSERT_TRUE(store.remove_job(last->id).ok());
  while (*store.drop_removed(1000)) {
  }
  ASSERT_TRUE(store.remove_job(gone->id).ok());  // and is still to be dropped
}

/// As a value, which a loop keeps.
template <class T>
T value_of(core::Result<T> result) {
  return std::move(*result);
}

/// All that can be asked of a store, as text.
std::string told(JobStore& store) {
  std::string text = *store.secret() + "\n";
  const auto jobs = store.list(true, "", 0, 1000);
  for (const StoredJob& one : *jobs) {
    const auto job = **store.job(one.id);
    text += std::to_string(job.id) + job.key + job.spec + job.name + job.owner + job.options +
            job.reason + std::to_string(job.samples) + std::to_string(job.priority) +
            std::to_string(job.core_ns) + std::to_string(job.preview.value_or(-1)) + "\n";
    for (const StoredFrame& frame : value_of(store.JobStore::frames(one.id))) {
      text += std::to_string(frame.frame) + (frame.done ? "done" : "failed") + frame.reason +
              frame.worker_class + std::to_string(frame.restarts) + (frame.black ? "black" : "");
    }
    for (const StoredOutput& output : value_of(store.outputs(one.id, 0, 1000))) {
      text += std::to_string(output.number) + output.path + output.sha256;
    }
    for (const StoredLine& line : value_of(store.lines(one.id, 0, 1000))) {
      text += std::to_string(line.number) + line.text + std::to_string(line.frame.value_or(-1));
    }
  }
  for (const StoredQuarantine& one : value_of(store.quarantines())) text += one.worker + one.reason;
  for (const StoredTrust& one : value_of(store.trusted()))
    text += one.worker + std::to_string(one.moment);
  for (const StoredToken& one : value_of(store.tokens()))
    text += one.id + one.name + one.hash + one.pool;
  text += std::to_string(*store.core_ns_of("ada", 0));
  return text;
}

class CopyStore : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::postgres_is_there()) return;
    url_ = test::PostgresServer::shared().make_database();
    auto db = open_postgres({.url = url_});
    ASSERT_TRUE(db.ok());
    postgres_ = std::move(*db);
    ASSERT_TRUE(prepare_postgres(*postgres_).ok());
  }

  /// With the newest schema.
  std::unique_ptr<SqliteConnection> open(const std::string& name) {
    auto db = open_sqlite(folder_.file(name));
    EXPECT_TRUE(db.ok());
    EXPECT_TRUE(migrate(**db).ok());
    return std::move(*db);
  }

  std::unique_ptr<JobStore> store_in(const std::string& name) {
    return std::move(open_sqlite_job_store(folder_.file(name))).value();
  }

  test::TempFolder folder_;
  std::string url_;
  std::unique_ptr<SqlConnection> postgres_;
};

TEST_F(CopyStore, ThereAndBackIsTheSame) {
  std::string before;
  {
    const auto store = store_in("a.db");
    fill(*store);
    before = told(*store);
  }
  {
    const auto from = open("a.db");
    const core::Status copied =
        copy_store({*from, SqlEngine::sqlite}, {*postgres_, SqlEngine::postgres});
    ASSERT_TRUE(copied.ok()) << (copied ? "" : copied.error().message);
  }
  {
    const auto there = open_postgres_job_store({.url = url_, .incarnation = 0});
    ASSERT_TRUE(there.ok()) << (there ? "" : there.error().message);
    EXPECT_EQ(told(**there), before);
  }
  {
    const auto to = open("b.db");
    const core::Status copied =
        copy_store({*postgres_, SqlEngine::postgres}, {*to, SqlEngine::sqlite});
    ASSERT_TRUE(copied.ok()) << (copied ? "" : copied.error().message);
  }
  const auto back = store_in("b.db");
  EXPECT_EQ(told(*back), before);
}

TEST_F(CopyStore, NumbersGoOnWhereTheyWere) {
  uint64_t next = 0;
  {
    const auto store = store_in("a.db");
    fill(*store);
  }
  {
    const auto from = open("a.db");
    ASSERT_TRUE(copy_store({*from, SqlEngine::sqlite}, {*postgres_, SqlEngine::postgres}).ok());
  }
  {
    const auto store = store_in("a.db");
    next = store->add_job(job_named("next"))->id;
  }
  const auto there = open_postgres_job_store({.url = url_, .incarnation = 0});
  ASSERT_TRUE(there.ok());
  EXPECT_EQ((*there)->add_job(job_named("next"))->id, next) << "of a job that is gone";
}

TEST_F(CopyStore, IntoOneThatIsUsedNothingIsCopied) {
  {
    const auto store = store_in("a.db");
    fill(*store);
  }
  const auto from = open("a.db");
  ASSERT_TRUE(copy_store({*from, SqlEngine::sqlite}, {*postgres_, SqlEngine::postgres}).ok());
  const core::Status again =
      copy_store({*from, SqlEngine::sqlite}, {*postgres_, SqlEngine::postgres});
  ASSERT_FALSE(again.ok());
  EXPECT_NE(again.error().message.find("jobs"), std::string::npos);
}

}  // namespace
}  // namespace hyades::coordinator
