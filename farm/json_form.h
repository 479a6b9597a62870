#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "hyades/v1/admin.pb.h"
#include "hyades/v1/farm.pb.h"
#include "hyades/v1/jobs.pb.h"

namespace hyades::farm {

// The farm's messages as people and scripts see them: `--json` of the commands and the HTTP API.
// Fields are called as in proto/hyades/v1, states are lower-case words, times are milliseconds
// since 1970, UTC; what is listed has a field `id`.

using Json = nlohmann::ordered_json;

std::string state_name(v1::JobState state);
std::string state_name(v1::FrameState state);
std::string state_name(v1::WorkerState state);
std::string level_name(v1::LogLevel level);
/// "submitter".
std::string role_name(v1::Role role);
/// Nothing where it is none.
std::optional<v1::Role> role_of(const std::string& name);

Json to_json(const v1::Job& job);
Json to_json(const v1::Frame& frame);
Json to_json(const v1::Worker& worker);
/// Its kind as a word; a tile only where it is of a unit; times in milliseconds, with parts.
Json to_json(const v1::TimelineStep& step);
Json to_json(const v1::LogLine& line);
Json to_json(const v1::Token& token);
Json to_json(const v1::AuditEntry& entry);

}  // namespace hyades::farm
