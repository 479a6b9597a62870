#pragma once

#include <string>
#include <vector>

#include "core/job/job.h"

namespace hyades::core {

/// The light groups that the job's lights, emitting objects and environment belong to, ascending,
/// each once.
std::vector<std::string> light_groups_of(const Job& job);

}  // namespace hyades::core
