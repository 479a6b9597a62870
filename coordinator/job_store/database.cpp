#include "coordinator/job_store/database.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cstddef>

#include "core/base/descriptor.h"
#include "core/base/posix_file.h"

namespace hyades::coordinator {

namespace {

std::string folder_of(const std::string& path) {
  const size_t slash = path.rfind('/');
  return slash == std::string::npos ? "." : path.substr(0, slash);
}

/// Its files are nobody's but the owner's and the group's, whoever makes them with whatever umask:
/// what SQLite puts beside the file has the file's mode. (One that is there is not opened: to close
/// it would end the locks that this process has of it.)
void hide_from_others(const std::string& path) {
  constexpr mode_t kNotForOthers = S_IRUSR | S_IWUSR | S_IRGRP;
  (void)core::open_file(path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW, kNotForOthers);
  struct stat info {};
  if (::lstat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return;
  (void)::chmod(path.c_str(), info.st_mode & kNotForOthers);
}

}  // namespace

Query::Query(sqlite3* db, std::string_view sql) : db_(db) {
  check(sqlite3_prepare_v2(db, sql.data(), static_cast<int>(sql.size()), &statement_, nullptr));
}

Query::~Query() { sqlite3_finalize(statement_); }

void Query::check(int code) {
  if (code != SQLITE_OK && code != SQLITE_ROW && code != SQLITE_DONE && error_.empty()) {
    error_ = sqlite3_errmsg(db_);
  }
}

Query& Query::bind(int64_t value) {
  check(sqlite3_bind_int64(statement_, ++bound_, value));
  return *this;
}

Query& Query::bind(std::string_view text) {
  check(sqlite3_bind_text(statement_, ++bound_, text.data(), static_cast<int>(text.size()),
                          SQLITE_TRANSIENT));
  return *this;
}

Query& Query::bind_blob(std::string_view bytes) {
  check(sqlite3_bind_blob(statement_, ++bound_, bytes.data(), static_cast<int>(bytes.size()),
                          SQLITE_TRANSIENT));
  return *this;
}

Query& Query::bind_null() {
  check(sqlite3_bind_null(statement_, ++bound_));
  return *this;
}

bool Query::next() {
  if (!error_.empty()) return false;
  const int code = sqlite3_step(statement_);
  check(code);
  return code == SQLITE_ROW;
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

std::string Query::bytes(int column) const {
  const auto* data = static_cast<const char*>(sqlite3_column_blob(statement_, column));
  const auto size = static_cast<size_t>(sqlite3_column_bytes(statement_, column));
  return data == nullptr ? std::string() : std::string(data, size);
}

Transaction::Transaction(sqlite3* db) : db_(db), begun_(Query(db, "BEGIN IMMEDIATE").run()) {}

Transaction::~Transaction() {
  if (open_) (void)Query(db_, "ROLLBACK").run();
}

core::Status Transaction::commit() {
  if (!begun_) return begun_;
  core::Status done = Query(db_, "COMMIT").run();
  if (done) open_ = false;
  return done;
}

core::Result<Database> open_database(const std::string& path) {
  hide_from_others(path);
  sqlite3* raw = nullptr;
  const int code =
      sqlite3_open_v2(path.c_str(), &raw,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
  Database db(raw);
  if (code != SQLITE_OK) return core::Error{path + ": " + sqlite3_errstr(code)};
  const auto failed = [&](const core::Status& what) {
    const bool busy = (sqlite3_errcode(raw) & 0xff) == SQLITE_BUSY;  // less its extended part
    return busy ? core::Error{"another coordinator works in " + folder_of(path)}
                : what.error().in(path);
  };
  // One process at a time; the WAL then needs no shared memory file.
  for (const char* pragma :
       {"PRAGMA locking_mode=EXCLUSIVE", "PRAGMA journal_mode=WAL", "PRAGMA synchronous=FULL",
        "PRAGMA foreign_keys=ON", "PRAGMA cache_size=-2000"}) {
    if (core::Status set = Query(raw, pragma).run(); !set) return failed(set);
  }
  if (core::Status migrated = migrate(raw); !migrated) return failed(migrated);
  return db;
}

}  // namespace hyades::coordinator
