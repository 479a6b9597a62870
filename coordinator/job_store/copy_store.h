#pragma once

#include <cstdint>

#include "coordinator/sql/connection.h"
#include "core/base/result.h"

namespace hyades::coordinator {

/// The engine of a database, for what each has its own words for.
enum class SqlEngine : uint8_t { sqlite, postgres };

/// A job store's database.
struct StoreDatabase {
  SqlConnection& db;
  SqlEngine engine;
};

/// Copies all that a job store keeps, its secret and the numbers that it gives next too, in one
/// transaction. Both have the newest schema; an error where `to` has jobs, tokens or workers
/// already. How often coordinators have started is not in it (JobStore::next_incarnation).
core::Status copy_store(const StoreDatabase& from, const StoreDatabase& to);

}  // namespace hyades::coordinator
