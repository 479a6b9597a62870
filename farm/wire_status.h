#pragma once

#include <chrono>
#include <string>

#include <grpcpp/support/status.h>

#include "core/base/result.h"
#include "hyades/v1/common.pb.h"

namespace hyades::farm {

/// An error as it goes over the wire, with what a program can make of it.
grpc::Status wire_status(grpc::StatusCode code, const std::string& message,
                         const v1::ErrorDetail& detail);

/// An error as it goes over the wire, which tells the caller to come again after `retry_after`.
grpc::Status retry_later(grpc::StatusCode code, const std::string& message,
                         std::chrono::milliseconds retry_after);

/// RESOURCE_EXHAUSTED for as long as the owner has as much as he may have: to come again is of no
/// use before he has less.
grpc::Status over_quota(const std::string& message);

/// UNAVAILABLE for now, as what the coordinator stores cannot be stored or read; to come again
/// after a second.
grpc::Status unavailable(const core::Error& error);

/// What the error carries; empty where it carries nothing.
v1::ErrorDetail detail_of(const grpc::Status& status);

/// Whether the same call may succeed later by itself: the coordinator is not there, busy, or the
/// connection broke. docs/wire.md lists the codes.
bool is_retryable(const grpc::Status& status);

/// Whether that is because nothing answered, or did in time. Who names a time to come again has
/// spoken.
bool is_unanswered(const grpc::Status& status);

}  // namespace hyades::farm
