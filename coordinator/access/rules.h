#pragma once

#include <cstdint>
#include <string>

#include <grpcpp/support/status.h>

#include "coordinator/access/caller.h"

namespace hyades::coordinator {

/// Who may do something, whichever way they ask for it.
struct Rule {
  const char* action;    ///< "job.cancel": what refusals and the audit log call it
  v1::Role least;        ///< of viewer < submitter < operator < admin; unspecified: everybody may
  bool worker = false;   ///< whether workers may, too
  bool audited = false;  ///< changes something: the audit log notes each, and who did it
  bool steers_job = false;  ///< the request's `job`: only its owner and operators may
};

/// Whether a caller of this role may.
bool may(v1::Role role, const Rule& rule);

/// OK, or PERMISSION_DENIED with what is needed and how to come by it.
grpc::Status allow(const Caller& caller, const Rule& rule);

/// Whether the caller may steer everybody's jobs: operators and admins may.
bool steers_all(const Caller& caller);

/// OK where the caller may steer a job of this owner (`proven`: a token has shown who that is), or
/// PERMISSION_DENIED with why not.
grpc::Status allow_steering(const Caller& caller, uint64_t job, const std::string& owner,
                            bool proven);

}  // namespace hyades::coordinator
