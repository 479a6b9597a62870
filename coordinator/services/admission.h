#pragma once

#include <functional>
#include <memory>
#include <mutex>

#include <grpcpp/server_context.h>
#include <grpcpp/support/status.h>

#include "coordinator/access/authority.h"
#include "coordinator/access/rules.h"

namespace hyades::coordinator {

/// Whether a call may come in: it speaks a version that is understood, shows a token, and that
/// token's role may do what it asks for.
class Admission {
 public:
  /// `workers_show`: workers must have shown a certificate. `authority` outlives it.
  Admission(Authority& authority, bool workers_show)
      : authority_(authority), workers_show_(workers_show) {}

  /// OK and who calls; or UNAUTHENTICATED, FAILED_PRECONDITION or PERMISSION_DENIED with the
  /// reason.
  grpc::Status check(const grpc::CallbackServerContext& context, const Rule& rule,
                     Caller& caller) const;

  /// Registers who stays (Authority::visit).
  std::unique_ptr<Visit> visit(const Caller& caller,
                               std::function<void(const grpc::Status&)> leave) const {
    return authority_.visit(caller, std::move(leave));
  }

  /// Where it is kept who did what; null where it is not.
  AuditLog* audit() const { return authority_.audit(); }

  /// To be held while a large request is parsed and answered, so that many of them do not fill the
  /// memory; not held where another one is.
  std::unique_lock<std::mutex> alone() const {
    return std::unique_lock<std::mutex>(large_, std::try_to_lock);
  }

 private:
  grpc::Status admit(const grpc::CallbackServerContext& context, const Rule& rule,
                     Caller& caller) const;

  mutable std::mutex large_;
  Authority& authority_;
  const bool workers_show_;
};

}  // namespace hyades::coordinator
