#pragma once

#include <memory>
#include <string>
#include <vector>

#include "coordinator/job_store/job_store.h"
#include "coordinator/sql/connection.h"
#include "tests/support/temp_folder.h"

namespace hyades::coordinator {

/// A place for a job store, in a database of either engine: "sqlite" or "postgres" (a test asks
/// postgres_is_there() before).
class StorePlace {
 public:
  explicit StorePlace(const std::string& engine);

  /// Opens the store as a coordinator does that starts: with the next incarnation. Null, and the
  /// test has failed, where that goes wrong.
  std::unique_ptr<JobStore> open() const;
  /// The database itself. With SQLite nobody else may have it open.
  std::unique_ptr<SqlConnection> open_raw() const;

 private:
  const test::TempFolder folder_;
  std::string url_;  ///< PostgreSQL's; else empty
};

StoredJob some_job(const std::string& key, const std::string& owner);
std::vector<StoredLine> some_lines(uint64_t count);

}  // namespace hyades::coordinator
