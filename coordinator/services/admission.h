#pragma once

#include <string>

#include <grpcpp/server_context.h>
#include <grpcpp/support/status.h>

namespace hyades::coordinator {

/// Whether a call may come in: it speaks a version that is understood, and shows the token.
class Admission {
 public:
  /// An empty token lets everybody in.
  explicit Admission(std::string token) : token_(std::move(token)) {}

  /// FAILED_PRECONDITION or UNAUTHENTICATED, with the reason, or OK.
  grpc::Status check(const grpc::CallbackServerContext& context) const;

 private:
  std::string token_;
};

}  // namespace hyades::coordinator
