#pragma once

#include <memory>
#include <string>

#include "coordinator/film_store/film_logs.h"

namespace hyades::coordinator {

/// Film logs as folders FOLDER/1, FOLDER/2, ... of this machine's disk.
std::unique_ptr<FilmLogs> disk_film_logs(const std::string& folder);

}  // namespace hyades::coordinator
