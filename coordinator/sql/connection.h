#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace hyades::coordinator {

/// A statement of one engine, of which Query makes use. Numbers are of 64 bits, texts are UTF-8.
class SqlStatement {
 public:
  virtual ~SqlStatement() = default;

  // Each binds the parameter with that number, from 1 on; what is bound is copied.
  virtual core::Status bind_integer(int parameter, int64_t value) = 0;
  virtual core::Status bind_text(int parameter, std::string_view text) = 0;
  virtual core::Status bind_blob(int parameter, std::string_view bytes) = 0;
  virtual core::Status bind_null(int parameter) = 0;

  /// Goes to the next row; the first call runs the statement. False at the end.
  virtual core::Result<bool> step() = 0;

  // Columns of the row, from 0 on.
  virtual int64_t integer(int column) const = 0;
  virtual bool is_null(int column) const = 0;
  virtual std::string bytes(int column) const = 0;  ///< text or bytes

  /// Rows that the statement has inserted, updated or deleted; at its end.
  virtual int64_t changed() const = 0;
};

/// When what a transaction has written outlasts the end of the database's machine.
enum class Durability : uint8_t {
  durable,  ///< once it is committed
  lagging   ///< soon afterwards, where the engine can do that
};

/// A connection to a database that speaks SQL: SQLite (sqlite.h) or PostgreSQL (postgres.h). What
/// both understand is written once, with parameters as `?` or `?1`; all tables have columns of
/// BIGINT, TEXT and bytes alone. Not thread-safe.
class SqlConnection {
 public:
  virtual ~SqlConnection() = default;

  /// Null, with `error` set, where it makes no sense to the engine.
  virtual std::unique_ptr<SqlStatement> prepare(std::string_view sql, std::string& error) = 0;
  /// Runs statements without parameters or rows, separated by semicolons.
  virtual core::Status run_script(const std::string& sql) = 0;

  // Transaction makes use of these.
  virtual core::Status begin(Durability durability) = 0;
  virtual core::Status commit() = 0;
  virtual void roll_back() = 0;
};

/// A statement, bound and stepped through. Its first error sticks and ends it.
class Query {
 public:
  Query(SqlConnection& db, std::string_view sql);

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
  int64_t integer(int column) const { return statement_->integer(column); }
  bool is_null(int column) const { return statement_->is_null(column); }
  std::string bytes(int column) const { return statement_->bytes(column); }  ///< text or bytes

  /// Rows that it has inserted, updated or deleted; after run().
  int64_t changed() const { return statement_ ? statement_->changed() : 0; }

 private:
  void note(const core::Status& done);

  std::string error_;  // before the statement, which is made with it
  std::unique_ptr<SqlStatement> statement_;
  int bound_ = 0;
};

/// A number as databases keep it: with its sign bit.
inline int64_t number(uint64_t value) { return static_cast<int64_t>(value); }

/// A transaction: commit() commits it, else it is rolled back.
class Transaction {
 public:
  explicit Transaction(SqlConnection& db, Durability durability = Durability::durable);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  core::Status commit();
  /// Whether it has begun.
  core::Status status() const { return begun_; }

 private:
  SqlConnection& db_;
  core::Status begun_;
  bool open_ = true;
};

}  // namespace hyades::coordinator
