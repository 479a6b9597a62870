#pragma once

#include <mutex>
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

  /// To be held while a large request is parsed and answered, so that many of them do not fill the
  /// memory; not held where another one is.
  std::unique_lock<std::mutex> alone() const {
    return std::unique_lock<std::mutex>(large_, std::try_to_lock);
  }

 private:
  mutable std::mutex large_;
  std::string token_;
};

}  // namespace hyades::coordinator
