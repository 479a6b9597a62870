#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "coordinator/film_store/log_files.h"
#include "coordinator/shared_state/connection_pool.h"
#include "coordinator/sql/connection.h"
#include "coordinator/sql/postgres.h"
#include "core/base/mutex.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// Files in the tables log_files and log_chunks of a database (postgres_schema.cpp), all bytes in
/// rows. What is done to names is durable and atomic at once; folders are parts of names and need
/// not be made. What is written is buffered, up to a megabyte; LogWriter::sync() is the commit of
/// what is left. Thread-safe.
///
/// Nobody locks a folder against other processes: each transaction makes sure that this coordinator
/// leads (PostgresOptions::incarnation), so that whoever led before changes nothing. lock() keeps
/// apart what one process does.
///
/// A call that changes something and fails as the connection is lost may have done its work, or may
/// do it soon. What only reads is tried again for a while: a log takes what it cannot read for
/// damaged.
class DatabaseLogFiles final : public LogFiles {
 public:
  /// `database.on_lost` is called once, and only where another coordinator leads.
  explicit DatabaseLogFiles(const PostgresOptions& database);
  /// With `connections` at most, which may be those of SQLite; what only reads is tried again for
  /// `patience`.
  DatabaseLogFiles(ConnectionPool::Open open, size_t connections,
                   std::chrono::milliseconds patience);

  core::Status make_folder(const std::string&) override { return {}; }
  core::Status sync_folder(const std::string&) override { return {}; }
  core::Status sync_file(const std::string&) override { return {}; }
  /// Nothing where there is no such folder.
  core::Result<std::vector<std::string>> list(const std::string& folder) override;
  core::Result<std::unique_ptr<LogWriter>> create(const std::string& path) override;
  core::Result<std::unique_ptr<LogReader>> open(const std::string& path) override;
  core::Status rename(const std::string& from, const std::string& to) override;
  core::Status remove(const std::string& path) override;
  core::Status truncate(const std::string& path, uint64_t size) override;
  core::Result<std::unique_ptr<LogLock>> lock(const std::string& path) override;

  /// The folders in which files are, in any order.
  core::Result<std::vector<std::string>> folders();
  /// Removes chunks without a file, which a commit that came after its file's removal may have
  /// left. For whoever begins to lead, by any thread and at any time.
  core::Status remove_garbage();

 private:
  class Writer;
  class Reader;
  class Lock;
  using Work = std::function<core::Status(SqlConnection& db)>;

  core::Status read(const Work& work);
  core::Status write(const Work& work);

  ConnectionPool pool_;
  const std::chrono::milliseconds patience_;
  core::Mutex mutex_;
  std::set<std::string> locked_ HYADES_GUARDED_BY(mutex_);
};

}  // namespace hyades::coordinator
