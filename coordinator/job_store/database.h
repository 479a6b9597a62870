#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <sqlite3.h>

#include "core/base/result.h"

namespace hyades::coordinator {

/// A prepared statement, bound and stepped through. Its first error sticks and ends it.
class Query {
 public:
  Query(sqlite3* db, std::string_view sql);
  ~Query();
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  // Each binds the next parameter.
  Query& bind(int64_t value);
  Query& bind(std::string_view text);
  Query& bind_blob(std::string_view bytes);
  Query& bind_null();

  /// Goes to the next row; false at the end or after an error.
  bool next();
  /// Goes through all rows to the end.
  core::Status run();
  /// The first error.
  core::Status status() const;

  // Columns of the row.
  int64_t integer(int column) const { return sqlite3_column_int64(statement_, column); }
  bool is_null(int column) const { return sqlite3_column_type(statement_, column) == SQLITE_NULL; }
  std::string bytes(int column) const;  ///< text or bytes

 private:
  void check(int code);

  sqlite3* db_;
  sqlite3_stmt* statement_ = nullptr;
  int bound_ = 0;
  std::string error_;
};

/// A number as the database keeps it: with its sign bit.
inline int64_t number(uint64_t value) { return static_cast<int64_t>(value); }

/// A transaction: commit() commits it, else it is rolled back.
class Transaction {
 public:
  explicit Transaction(sqlite3* db);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  core::Status commit();
  /// Whether it has begun.
  core::Status status() const { return begun_; }

 private:
  sqlite3* db_;
  core::Status begun_;
  bool open_ = true;
};

/// Closes what unique_ptr owns.
struct CloseDatabase {
  void operator()(sqlite3* db) const { sqlite3_close(db); }
};
using Database = std::unique_ptr<sqlite3, CloseDatabase>;

/// Opens or makes the file, for this process alone, and brings its schema to kSchemaVersion
/// (schema.cpp).
core::Result<Database> open_database(const std::string& path);

/// The version of the schema that this program reads and writes.
extern const int kSchemaVersion;
/// Brings an open database to kSchemaVersion. An error where it is newer, or cannot be written.
core::Status migrate(sqlite3* db);

}  // namespace hyades::coordinator
