#pragma once

#include "hyades/v1/jobs.pb.h"

namespace hyades::farm {

/// Whether the job is done, failed or cancelled.
inline bool has_ended(const v1::Job& job) {
  return job.state() == v1::JOB_STATE_DONE || job.state() == v1::JOB_STATE_FAILED ||
         job.state() == v1::JOB_STATE_CANCELLED;
}

}  // namespace hyades::farm
