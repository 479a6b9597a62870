#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <grpcpp/server_context.h>
#include <grpcpp/support/status.h>

#include "coordinator/access/authority.h"
#include "coordinator/access/rules.h"
#include "hyades/v1/work.pb.h"

namespace hyades::coordinator {

/// Whether a call may come in: it speaks a version that is understood, shows a token, and that
/// token's role may do what it asks for.
class Admission {
 public:
  /// Hears of a caller (Caller::address is address_text()) who has shown a token that is one, or,
  /// where none is asked for, could do without.
  using Known = std::function<void(const Caller& caller)>;

  /// Hears of an address from which a call has shown no token that is one.
  using Unknown = std::function<void(const std::string& address)>;

  /// Our end of the connection by which calls come from an address, as own_end() has it.
  using OwnEndTo = std::function<std::string(const std::string& address)>;

  /// `workers_show`: workers must have shown a certificate. `authority` outlives it.
  Admission(Authority& authority, bool workers_show, OwnEndTo own_end, Known known, Unknown unknown)
      : authority_(authority),
        workers_show_(workers_show),
        own_end_(std::move(own_end)),
        known_(std::move(known)),
        unknown_(std::move(unknown)) {}

  /// OK, with who calls in `caller`; or why the call may not come in: UNAUTHENTICATED,
  /// FAILED_PRECONDITION or PERMISSION_DENIED. Who has no right to call is noted in the audit log.
  grpc::Status check(const grpc::CallbackServerContext& context, const Rule& rule,
                     Caller& caller) const;

  /// Registers a caller's open stream; `leave` is called when the caller's token is of no use any
  /// more (Authority::visit).
  std::unique_ptr<Visit> visit(const Caller& caller,
                               std::function<void(const grpc::Status&)> leave) const {
    return authority_.visit(caller, std::move(leave));
  }

  /// By what a worker is known (Authority::admit_worker).
  grpc::Status admit_worker(const Caller& caller, const v1::Hello& hello,
                            WorkerCredential& credential) const {
    return authority_.admit_worker(caller, hello.worker_id(), hello.keeps_token(), credential);
  }

  /// The audit log; null where none is kept.
  AuditLog* audit() const { return authority_.audit(); }

 private:
  grpc::Status admit(const grpc::CallbackServerContext& context, const Rule& rule,
                     Caller& caller) const;

  Authority& authority_;
  const bool workers_show_;
  const OwnEndTo own_end_;
  const Known known_;
  const Unknown unknown_;
};

}  // namespace hyades::coordinator
