#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cli/printable.h"
#include "hyades/v1/farm.pb.h"
#include "hyades/v1/jobs.pb.h"

namespace hyades::cli {

// The farm's messages as people and scripts see them. In JSON fields are called as in
// proto/hyades/v1 and states are lower-case words; times are milliseconds since 1970, UTC.

using Json = nlohmann::ordered_json;

std::string state_name(v1::JobState state);
std::string state_name(v1::FrameState state);
std::string state_name(v1::WorkerState state);
std::string level_name(v1::LogLevel level);

Json to_json(const v1::Job& job);
Json to_json(const v1::Frame& frame);
Json to_json(const v1::Worker& worker);
Json to_json(const v1::LogLine& line);

/// Prints JSON in one line to standard output.
void print_json(const Json& json);

/// "62.5 %" of something that may be nothing.
std::string percent(uint64_t part, uint64_t whole);

/// Local time of day and date of milliseconds since 1970: "2026-11-21 17:54:38".
std::string format_time(int64_t ms);

/// Prints rows in columns to standard output; the first row is the heading.
void print_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace hyades::cli
