#pragma once

#include <string>
#include <vector>

#include "core/job/job.h"
#include "core/job/map_reader.h"

namespace hyades::core {

/// The light groups that the job's lights, emitting objects and environment belong to, ascending,
/// each once.
std::vector<std::string> light_groups_of(const Job& job);

/// Reads key light_group: letters, digits, _ and -, for it becomes part of channels' names.
void read_light_group(MapReader& reader, std::string& group);

}  // namespace hyades::core
