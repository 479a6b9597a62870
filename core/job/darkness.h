#pragma once

#include "core/job/job.h"

namespace hyades::core {

/// What is said of a job, or of a scene, that nothing lights.
inline constexpr const char* kNothingGivesLight =
    "nothing gives light, the picture will be black: expected lights, an environment, or an object "
    "with 'emit'";

/// Whether some medium of the job gives light.
bool any_medium_glows(const Job& job);

/// Whether the job has anything that can give light, by what it says alone: without its scene it is
/// not known how bright that is.
bool may_give_light(const Job& job);

}  // namespace hyades::core
