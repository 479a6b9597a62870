#pragma once

#include <string>
#include <vector>

#include "core/job/job.h"

namespace hyades::core {

/// Every file that the job names (meshes, images), once each, in order of first mention; relative
/// to the job's folder; UDIM patterns as they are. Files that those files name in turn are found by
/// loading them.
std::vector<std::string> referenced_files(const Job& job);

}  // namespace hyades::core
