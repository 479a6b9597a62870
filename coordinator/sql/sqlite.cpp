#include "coordinator/sql/sqlite.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

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

class SqliteStatement final : public SqlStatement {
 public:
  SqliteStatement(sqlite3* db, sqlite3_stmt* statement) : db_(db), statement_(statement) {}
  ~SqliteStatement() override { sqlite3_finalize(statement_); }
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;

  core::Status bind_integer(int parameter, int64_t value) override {
    return checked(sqlite3_bind_int64(statement_, parameter, value));
  }
  core::Status bind_text(int parameter, std::string_view text) override {
    return checked(sqlite3_bind_text(statement_, parameter, text.data(),
                                     static_cast<int>(text.size()), SQLITE_TRANSIENT));
  }
  core::Status bind_blob(int parameter, std::string_view bytes) override {
    return checked(sqlite3_bind_blob(statement_, parameter, bytes.data(),
                                     static_cast<int>(bytes.size()), SQLITE_TRANSIENT));
  }
  core::Status bind_null(int parameter) override {
    return checked(sqlite3_bind_null(statement_, parameter));
  }

  core::Result<bool> step() override {
    const int code = sqlite3_step(statement_);
    if (core::Status done = checked(code); !done) return done.error();
    if (code == SQLITE_DONE) changed_ = sqlite3_changes(db_);
    return code == SQLITE_ROW;
  }

  int64_t integer(int column) const override { return sqlite3_column_int64(statement_, column); }
  bool is_null(int column) const override {
    return sqlite3_column_type(statement_, column) == SQLITE_NULL;
  }
  std::string bytes(int column) const override {
    const auto* data = static_cast<const char*>(sqlite3_column_blob(statement_, column));
    const auto size = static_cast<size_t>(sqlite3_column_bytes(statement_, column));
    return data == nullptr ? std::string() : std::string(data, size);
  }
  int64_t changed() const override { return changed_; }

 private:
  core::Status checked(int code) const {
    if (code == SQLITE_OK || code == SQLITE_ROW || code == SQLITE_DONE) return {};
    return core::Error{sqlite3_errmsg(db_)};
  }

  sqlite3* db_;
  sqlite3_stmt* statement_;
  int64_t changed_ = 0;
};

}  // namespace

std::unique_ptr<SqlStatement> SqliteConnection::prepare(std::string_view sql, std::string& error) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(get(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr) !=
      SQLITE_OK) {
    error = sqlite3_errmsg(get());
    return nullptr;
  }
  return std::make_unique<SqliteStatement>(get(), statement);
}

core::Status SqliteConnection::run_script(const std::string& sql) {
  char* error = nullptr;
  if (sqlite3_exec(get(), sql.c_str(), nullptr, nullptr, &error) == SQLITE_OK) return {};
  core::Error why{error};
  sqlite3_free(error);
  return why;
}

core::Status SqliteConnection::begin(Durability /*durability*/) {
  return Query(*this, "BEGIN IMMEDIATE").run();
}
core::Status SqliteConnection::commit() { return Query(*this, "COMMIT").run(); }
void SqliteConnection::roll_back() { (void)Query(*this, "ROLLBACK").run(); }

core::Result<std::unique_ptr<SqliteConnection>> open_sqlite(const std::string& path) {
  hide_from_others(path);
  sqlite3* raw = nullptr;
  const int code =
      sqlite3_open_v2(path.c_str(), &raw,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
  auto db = std::make_unique<SqliteConnection>(std::unique_ptr<sqlite3, CloseSqlite>(raw));
  if (code != SQLITE_OK) return core::Error{path + ": " + sqlite3_errstr(code)};
  // One process at a time; the WAL then needs no shared memory file.
  for (const char* pragma : {"PRAGMA locking_mode=EXCLUSIVE", "PRAGMA journal_mode=WAL",
                             "PRAGMA synchronous=FULL", "PRAGMA cache_size=-2000"}) {
    if (core::Status set = Query(*db, pragma).run(); !set) {
      const bool busy = (sqlite3_errcode(raw) & 0xff) == SQLITE_BUSY;  // less its extended part
      return busy ? core::Error{"another coordinator works in " + folder_of(path)}
                  : set.error().in(path);
    }
  }
  return db;
}

}  // namespace hyades::coordinator
