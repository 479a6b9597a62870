#pragma once

#include <cstdint>

#include <fmt/format.h>
#include <grpcpp/support/status.h>

namespace hyades::coordinator {

/// What who asks for a job is told where there is none.
inline grpc::Status no_job(uint64_t id) {
  return {grpc::StatusCode::NOT_FOUND, fmt::format("there is no job {}", id)};
}

/// What who asks for a frame is told where its job has none of that number.
inline grpc::Status no_frame(uint64_t id, int32_t frame) {
  return {grpc::StatusCode::NOT_FOUND, fmt::format("job {} has no frame {}", id, frame)};
}

}  // namespace hyades::coordinator
