#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/printable.h"
#include "farm/json_form.h"

namespace hyades::cli {

using farm::Json;
using farm::level_name;
using farm::state_name;
using farm::to_json;

/// Prints JSON in one line to standard output.
void print_json(const Json& json);

/// What people call a job's state: one that runs is waiting while no worker has any of it.
std::string job_look(const v1::Job& job);

/// Seconds from when somebody began the job (before: from its submission) to its end, or to now.
double seconds_taken(const v1::Job& job);

/// "62.5 %" of something that may be nothing.
std::string percent(uint64_t part, uint64_t whole);

/// Local time of day and date of milliseconds since 1970: "2026-11-21 17:54:38".
std::string format_time(int64_t ms);

/// Prints rows in columns to standard output; the first row is the heading.
void print_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace hyades::cli
