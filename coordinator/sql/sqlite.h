#pragma once

#include <sqlite3.h>

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "coordinator/sql/connection.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// Closes what unique_ptr owns.
struct CloseSqlite {
  void operator()(sqlite3* db) const { sqlite3_close(db); }
};

/// A SQLite file, open.
class SqliteConnection final : public SqlConnection {
 public:
  explicit SqliteConnection(std::unique_ptr<sqlite3, CloseSqlite> db) : db_(std::move(db)) {}

  std::unique_ptr<SqlStatement> prepare(std::string_view sql, std::string& error) override;
  core::Status run_script(const std::string& sql) override;
  core::Status begin(Durability durability) override;
  core::Status commit() override;
  void roll_back() override;

  /// For what SQLite alone has.
  sqlite3* get() const { return db_.get(); }

 private:
  std::unique_ptr<sqlite3, CloseSqlite> db_;
};

/// Opens or makes the file (which others than its owner and group cannot read), for this process
/// alone: WAL, synchronous=FULL. An error where another process has it.
core::Result<std::unique_ptr<SqliteConnection>> open_sqlite(const std::string& path);

}  // namespace hyades::coordinator
