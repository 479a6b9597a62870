#pragma once

#include <cstdint>
#include <optional>

#include <fmt/format.h>
#include <grpcpp/support/status.h>

#include "core/base/result.h"
#include "farm/wire_status.h"

namespace hyades::coordinator {

/// NOT_FOUND: there is no job `id`.
inline grpc::Status no_job(uint64_t id) {
  return {grpc::StatusCode::NOT_FOUND, fmt::format("there is no job {}", id)};
}

/// Whether the store has job `id`, of which it has read `stored`: OK, UNAVAILABLE where it could
/// not be read, or NOT_FOUND.
template <class Stored>
grpc::Status job_is_there(uint64_t id, const core::Result<std::optional<Stored>>& stored) {
  if (!stored) return farm::unavailable(stored.error());
  return *stored ? grpc::Status::OK : no_job(id);
}

/// NOT_FOUND: the job has no frame of this number.
inline grpc::Status no_frame(uint64_t id, int32_t frame) {
  return {grpc::StatusCode::NOT_FOUND, fmt::format("job {} has no frame {}", id, frame)};
}

}  // namespace hyades::coordinator
