#pragma once

#include <cstdint>
#include <string>

#include "cli/client/farm_client.h"
#include "cli/client/film_display.h"

namespace hyades::cli {

/// Shows how job `id` gets on until it has ended; Ctrl-C leaves it running. Nothing where it is
/// done; a job that failed or was cancelled is a failure, told with its frames. `last`, if not
/// null, becomes the job as it was told last; `films` hears what has changed, and what `viewer` has
/// to say is told.
Outcome watch_job(FarmClient& client, uint64_t id, bool quiet, v1::Job* last = nullptr,
                  FilmDisplay* films = nullptr, Viewer* viewer = nullptr);

}  // namespace hyades::cli
