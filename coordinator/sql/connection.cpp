#include "coordinator/sql/connection.h"

namespace hyades::coordinator {

Query::Query(SqlConnection& db, std::string_view sql) : statement_(db.prepare(sql, error_)) {}

void Query::note(const core::Status& done) {
  if (!done && error_.empty()) error_ = done.error().message;
}

Query& Query::bind(int64_t value) {
  if (statement_) note(statement_->bind_integer(++bound_, value));
  return *this;
}

Query& Query::bind(std::string_view text) {
  if (statement_) note(statement_->bind_text(++bound_, text));
  return *this;
}

Query& Query::bind_blob(std::string_view bytes) {
  if (statement_) note(statement_->bind_blob(++bound_, bytes));
  return *this;
}

Query& Query::bind_null() {
  if (statement_) note(statement_->bind_null(++bound_));
  return *this;
}

bool Query::next() {
  if (!error_.empty()) return false;
  const core::Result<bool> row = statement_->step();
  if (!row) error_ = row.error().message;
  return row && *row;
}

core::Status Query::run() {
  while (next()) {
  }
  return status();
}

core::Status Query::status() const {
  if (error_.empty()) return {};
  return core::Error{"the job store: " + error_};
}

Transaction::Transaction(SqlConnection& db, Durability durability)
    : db_(db), begun_(db.begin(durability)) {}

Transaction::~Transaction() {
  if (open_ && begun_) db_.roll_back();
}

core::Status Transaction::commit() {
  if (!begun_) return begun_;
  core::Status done = db_.commit();
  if (done) open_ = false;
  return done;
}

}  // namespace hyades::coordinator
