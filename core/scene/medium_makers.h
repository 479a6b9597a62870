#pragma once

#include "core/job/job.h"
#include "core/media/make_medium.h"

namespace hyades::core {

/// The medium that `desc` describes at `time`, in metres; `units` is the length of one unit of the
/// job.
MediumPtr make_medium(const MediumDesc& desc, const JobTime& time, float units);

}  // namespace hyades::core
