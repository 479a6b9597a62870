#include "farm/wire_status.h"

#include <cstdint>

namespace hyades::farm {

grpc::Status wire_status(grpc::StatusCode code, const std::string& message,
                         const v1::ErrorDetail& detail) {
  v1::StatusDetails details;
  details.set_code(code);
  details.set_message(message);
  details.add_details()->PackFrom(detail);
  return {code, message, details.SerializeAsString()};
}

grpc::Status retry_later(grpc::StatusCode code, const std::string& message,
                         std::chrono::milliseconds retry_after) {
  v1::ErrorDetail detail;
  detail.set_retry_after_ms(static_cast<uint32_t>(retry_after.count()));
  return wire_status(code, message, detail);
}

grpc::Status over_quota(const std::string& message) {
  v1::ErrorDetail detail;
  detail.set_quota(true);
  return wire_status(grpc::StatusCode::RESOURCE_EXHAUSTED, message, detail);
}

grpc::Status unavailable(const core::Error& error) {
  return retry_later(grpc::StatusCode::UNAVAILABLE, error.message, std::chrono::seconds(1));
}

v1::ErrorDetail detail_of(const grpc::Status& status) {
  v1::StatusDetails details;
  v1::ErrorDetail detail;
  if (details.ParseFromString(status.error_details())) {
    for (const auto& any : details.details()) {
      if (any.UnpackTo(&detail)) return detail;
    }
  }
  return {};
}

bool is_retryable(const grpc::Status& status) {
  switch (status.error_code()) {
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
      return !detail_of(status).quota();
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::ABORTED:
    case grpc::StatusCode::DEADLINE_EXCEEDED:
    case grpc::StatusCode::INTERNAL:
    case grpc::StatusCode::UNKNOWN:
    case grpc::StatusCode::CANCELLED:
      return true;
    default:
      return false;
  }
}

bool is_unanswered(const grpc::Status& status) {
  const bool silence = status.error_code() == grpc::StatusCode::UNAVAILABLE ||
                       status.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED;
  return silence && detail_of(status).retry_after_ms() == 0;
}

}  // namespace hyades::farm
