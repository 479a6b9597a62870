#pragma once

#include <optional>
#include <string>

#include <google/protobuf/message.h>
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

/// "DONE" of JOB_STATE_DONE as "done"; "unknown" for the value 0, and for numbers without a name.
std::string enum_word(const google::protobuf::EnumDescriptor& type, int number);
/// The name of a field: its json_name where the proto gives one.
const std::string& json_name(const google::protobuf::FieldDescriptor& field);
/// All fields in the order in which the proto has them. Absent ones are left out where the proto
/// says `optional`, and those of sub-messages; bytes are hexadecimal.
Json to_json(const google::protobuf::Message& message);

/// `frame` only where the line is of one, no number.
Json to_json(const v1::LogLine& line);
/// `times` only where it stands for several.
Json to_json(const v1::AuditEntry& entry);

}  // namespace hyades::farm
