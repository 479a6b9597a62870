#pragma once

#include <vector>

#include "hyades/v1/farm.pb.h"
#include "hyades/v1/jobs.pb.h"

namespace hyades::coordinator {

class Controller;

// What the controller answers page by page, whole: for those in this process.

/// All jobs that have not ended, the newest first.
std::vector<v1::Job> all_open_jobs(Controller& controller);

/// All workers, in the order of their ids.
std::vector<v1::Worker> all_workers(Controller& controller);

}  // namespace hyades::coordinator
