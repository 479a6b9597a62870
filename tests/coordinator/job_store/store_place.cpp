#include "tests/coordinator/job_store/store_place.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

#include "coordinator/job_store/postgres_schema.h"
#include "coordinator/job_store/schema.h"
#include "coordinator/sql/postgres.h"
#include "tests/coordinator/sql/postgres_server.h"

namespace hyades::coordinator {
namespace {

template <class Opened>
auto value_or_null(core::Result<std::unique_ptr<Opened>> opened) {
  EXPECT_TRUE(opened.ok()) << (opened ? "" : opened.error().message);
  return opened ? std::move(*opened) : nullptr;
}

}  // namespace

StorePlace::StorePlace(const std::string& engine) {
  if (engine == "sqlite") return;
  url_ = test::PostgresServer::shared().make_database();
  const auto db = open_raw();
  const core::Status made = prepare_postgres(*db);
  EXPECT_TRUE(made.ok()) << made.error().message;
}

std::unique_ptr<JobStore> StorePlace::open() const {
  if (url_.empty()) return value_or_null(open_sqlite_job_store(folder_.file("state.db")));
  const auto db = open_raw();
  Query next(*db, "UPDATE leader SET incarnation = incarnation + 1 RETURNING incarnation");
  EXPECT_TRUE(next.next());
  PostgresOptions options{.url = url_};
  options.incarnation = static_cast<uint64_t>(next.integer(0));
  return value_or_null(open_postgres_job_store(options));
}

std::unique_ptr<SqlConnection> StorePlace::open_raw() const {
  if (url_.empty()) return value_or_null(open_job_database(folder_.file("state.db")));
  return value_or_null(open_postgres({.url = url_}));
}

StoredJob some_job(const std::string& key, const std::string& owner) {
  StoredJob job;
  job.key = key;
  job.spec = std::string("spec\0bytes", 10);
  job.name = "balls";
  job.owner = owner;
  job.priority = -3;
  job.options = std::string("options\0bytes", 13);
  job.frames = 7;
  job.samples = 1'000'000'000'000;
  job.submitted_ms = 42;
  return job;
}

std::vector<StoredLine> some_lines(uint64_t count) {
  std::vector<StoredLine> lines;
  for (uint64_t i = 0; i < count; ++i) {
    lines.push_back({static_cast<int64_t>(i), 1, 7, "w", "line " + std::to_string(i)});
  }
  return lines;
}

}  // namespace hyades::coordinator
