#pragma once

#include <memory>
#include <string>

#include "coordinator/film_store/film_logs.h"
#include "coordinator/shared_state/database_log_files.h"

namespace hyades::coordinator {

/// Film logs in a database, from which it removes, beside all else, what leaders before have left.
/// `scratch`: a folder of this machine's disk for films that leave memory; it goes with this
/// process.
std::unique_ptr<FilmLogs> database_film_logs(std::unique_ptr<DatabaseLogFiles> files,
                                             const std::string& scratch);

}  // namespace hyades::coordinator
