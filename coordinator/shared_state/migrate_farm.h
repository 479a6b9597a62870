#pragma once

#include <cstdint>
#include <string>

#include "core/base/result.h"

namespace hyades::coordinator {

/// A farm's two homes, one of which it leaves for the other.
struct FarmHomes {
  std::string folder;    ///< of a coordinator that keeps all itself
  std::string database;  ///< URL, see PostgresOptions
  std::string files;     ///< the folder beside the database; may be `folder`
};

/// What was moved.
struct MigratedFarm {
  uint64_t logs = 0;       ///< film logs, one for each job with films
  uint64_t log_bytes = 0;  ///< of these
  uint64_t files = 0;      ///< assets, outputs and others that were copied
};

/// Copies the farm of the folder into the database, which must hold none, and into `files`; its
/// state.db is called state.db.migrated then, so that no coordinator starts there by mistake. An
/// error, with the farm as it was, where a coordinator works at either end.
core::Result<MigratedFarm> migrate_to_database(const FarmHomes& homes);

/// Copies the farm of the database into the folder, which must have no state.db. The database's
/// schema gets another name then (hyades_migrated_N), for the same reason. Errors as above.
core::Result<MigratedFarm> migrate_to_folder(const FarmHomes& homes);

}  // namespace hyades::coordinator
