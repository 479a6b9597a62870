#include "coordinator/backup/copy_database.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <ios>
#include <memory>
#include <optional>
#include <span>
#include <system_error>
#include <thread>

#include "coordinator/backup/read_file.h"
#include "coordinator/sql/sqlite.h"
#include "core/base/hash.h"

namespace hyades::coordinator {
namespace {

constexpr int kTries = 100;
constexpr std::chrono::milliseconds kPause{100};
/// A log of changes begins anew with other numbers in its first bytes.
constexpr size_t kLogHeader = 32;

std::string log_of(const std::string& path) { return path + "-wal"; }

/// What `path` holds now; nothing where there is no such file.
core::Result<std::optional<core::Sha256>> digest_of(const std::string& path,
                                                    const std::string& copy_to, size_t most) {
  if (!std::filesystem::exists(path)) return std::optional<core::Sha256>();
  std::ofstream copy;
  if (!copy_to.empty()) copy.open(copy_to, std::ios::binary | std::ios::trunc);
  core::Sha256Stream digest;
  size_t left = most;
  const auto read = read_file(path, std::nullopt, [&](std::span<const std::byte> bytes) {
    const auto piece = bytes.first(std::min(bytes.size(), left));
    left -= piece.size();
    digest.add(piece);
    if (!copy_to.empty()) {
      copy.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    }
    return left > 0 && (copy_to.empty() || copy.good());
  });
  if (!read) return read.error();
  if (!copy_to.empty() && !copy.flush()) return core::Error{copy_to + ": could not be written"};
  return std::optional(digest.digest());
}

constexpr size_t kAll = SIZE_MAX;

/// One try; false where the coordinator has begun one of the files anew meanwhile.
core::Result<bool> copy_once(const std::string& from, const std::string& to,
                             const std::function<void()>& between) {
  const auto log_before = digest_of(log_of(from), "", kLogHeader);
  if (!log_before) return log_before.error();
  const auto copied = digest_of(from, to, kAll);
  if (!copied) return copied.error();
  if (!*copied) return core::Error{from + ": there is no job store"};
  between();
  // What is appended meanwhile may come or not: SQLite takes whole changes only.
  const auto log = digest_of(log_of(from), log_of(to), kAll);
  if (!log) return log.error();
  const auto log_after = digest_of(log_of(from), "", kLogHeader);
  const auto again = digest_of(from, "", kAll);
  if (!log_after) return log_after.error();
  if (!again) return again.error();
  return *log_before == *log_after && *copied == *again;
}

/// Takes the log of changes into the copy and looks whether all is whole.
core::Status join(const std::string& path) {
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &raw, SQLITE_OPEN_READWRITE, nullptr);
  SqliteConnection db{std::unique_ptr<sqlite3, CloseSqlite>(raw)};
  if (code != SQLITE_OK) return core::Error{path + ": " + sqlite3_errstr(code)};
  for (const char* pragma : {"PRAGMA locking_mode=EXCLUSIVE", "PRAGMA journal_mode=DELETE"}) {
    if (auto done = Query(db, pragma).run(); !done) return done.error().in(path);
  }
  Query check(db, "PRAGMA integrity_check");
  const bool whole = check.next() && check.bytes(0) == "ok";
  if (auto status = check.status(); !status) return status.error().in(path);
  if (!whole) return core::Error{path + ": the job store is damaged"};
  return {};
}

}  // namespace

core::Status copy_database(const std::string& from, const std::string& to,
                           const std::function<void()>& between) {
  for (int i = 0; i < kTries; ++i) {
    std::error_code none;
    std::filesystem::remove(log_of(to), none);
    const auto copied = copy_once(from, to, between);
    if (!copied) return copied.error();
    if (*copied) return join(to);
    std::this_thread::sleep_for(kPause);
  }
  return core::Error{from + ": it changed while it was copied, each time of " +
                     std::to_string(kTries)};
}

}  // namespace hyades::coordinator
