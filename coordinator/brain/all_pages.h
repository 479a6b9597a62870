#pragma once

#include <vector>

#include "hyades/v1/farm.pb.h"
#include "hyades/v1/jobs.pb.h"

namespace hyades::coordinator {

class Brain;

// What the brain answers page by page, whole: for those in this process.

/// All jobs that have not ended, the newest first.
std::vector<v1::Job> all_open_jobs(Brain& brain);

/// All workers, in the order of their ids.
std::vector<v1::Worker> all_workers(Brain& brain);

}  // namespace hyades::coordinator
