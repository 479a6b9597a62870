#include "coordinator/job_store/quarantine_rows.h"

namespace hyades::coordinator {

core::Status put_quarantine(SqlConnection& db, const StoredQuarantine& worker) {
  return Query(db,
               "INSERT INTO quarantines (worker, reason) VALUES (?, ?) "
               "ON CONFLICT (worker) DO UPDATE SET reason = excluded.reason")
      .bind(worker.worker)
      .bind(worker.reason)
      .run();
}

core::Status delete_quarantine(SqlConnection& db, const std::string& worker) {
  return Query(db, "DELETE FROM quarantines WHERE worker = ?").bind(worker).run();
}

core::Result<std::vector<StoredQuarantine>> read_quarantines(SqlConnection& db) {
  std::vector<StoredQuarantine> workers;
  Query rows(db, "SELECT worker, reason FROM quarantines ORDER BY worker");
  while (rows.next()) workers.push_back({rows.bytes(0), rows.bytes(1)});
  if (core::Status status = rows.status(); !status) return status.error();
  return workers;
}

}  // namespace hyades::coordinator
