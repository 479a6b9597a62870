#include <cstdint>
#include <memory>
#include <utility>

#include "coordinator/job_store/job_store.h"
#include "coordinator/job_store/postgres_schema.h"
#include "coordinator/job_store/sql_job_store.h"
#include "coordinator/sql/postgres.h"

namespace hyades::coordinator {

core::Result<std::unique_ptr<JobStore>> open_postgres_job_store(const PostgresOptions& options) {
  auto db = open_postgres(options);
  if (!db) return db.error();
  if (core::Status migrated = migrate_postgres(**db); !migrated) {
    return migrated.error().in(without_password(options.url));
  }
  SqlJobStoreParts parts;
  parts.db = std::move(*db);
  parts.next_incarnation = [incarnation =
                                options.incarnation](SqlConnection&) -> core::Result<uint64_t> {
    if (incarnation) return *incarnation;
    return core::Error{"no lease has said which start this is"};
  };
  return make_sql_job_store(std::move(parts));
}

}  // namespace hyades::coordinator
