#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "coordinator/job_store/postgres_schema.h"
#include "coordinator/shared_state/connection_pool.h"
#include "coordinator/sql/connection.h"
#include "coordinator/sql/postgres.h"
#include "coordinator/sql/sqlite.h"

namespace hyades::coordinator {

/// Whatever a test does to a database beside what it tests: each must succeed.
class DatabaseHands {
 public:
  explicit DatabaseHands(std::unique_ptr<SqlConnection> db) : db_(std::move(db)) {}

  void run(const std::string& sql) {
    const core::Status done = db_->run_script(sql);
    if (!done) throw std::runtime_error(done.error().message);
  }
  int64_t number_of(const std::string& sql) {
    Query row(*db_, sql);
    if (!row.next())
      throw std::runtime_error(row.status() ? "no row" : row.status().error().message);
    return row.integer(0);
  }
  SqlConnection& db() { return *db_; }

 private:
  std::unique_ptr<SqlConnection> db_;
};

/// A PostgreSQL database in which incarnation 1 leads.
inline DatabaseHands make_film_database(const std::string& url) {
  auto db = open_postgres({.url = url});
  if (!db) throw std::runtime_error(db.error().message);
  if (core::Status made = prepare_postgres(**db); !made) {
    throw std::runtime_error(made.error().message);
  }
  DatabaseHands hands(std::move(*db));
  hands.run("UPDATE leader SET incarnation = 1");
  return hands;
}

inline PostgresOptions film_leader(const std::string& url, uint64_t incarnation = 1) {
  PostgresOptions options;
  options.url = url;
  options.name = "hyades leader";
  options.incarnation = incarnation;
  return options;
}

/// The tables of films in a SQLite file, which has one connection at a time.
inline ConnectionPool::Open film_tables_in_sqlite(const std::string& path) {
  return [path](const ConnectionPool::Lost&) -> core::Result<std::unique_ptr<SqlConnection>> {
    auto db = open_sqlite(path);
    if (!db) return db.error();
    core::Status made = (*db)->run_script(
        "CREATE TABLE IF NOT EXISTS log_files (id INTEGER PRIMARY KEY AUTOINCREMENT, folder TEXT, "
        "name TEXT, UNIQUE (folder, name));"
        "CREATE TABLE IF NOT EXISTS log_chunks (file BIGINT, position BIGINT, size BIGINT, "
        "bytes BLOB, PRIMARY KEY (file, position))");
    if (!made) return made.error();
    return std::unique_ptr<SqlConnection>(std::move(*db));
  };
}

}  // namespace hyades::coordinator
