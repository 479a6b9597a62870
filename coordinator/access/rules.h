#pragma once

#include <string>

#include <grpcpp/support/status.h>

#include "coordinator/access/caller.h"

namespace hyades::coordinator {

/// Who may do something, whichever way he asks for it.
struct Rule {
  const char* action;    ///< "job.cancel": what refusals and the audit log call it
  v1::Role least;        ///< of viewer < submitter < operator < admin; unspecified: everybody may
  bool worker = false;   ///< whether workers may, too
  bool audited = false;  ///< changes something: the audit log notes each, and who did it
  bool steers_job = false;  ///< the request's `job`: only its owner and operators may
};

bool may(v1::Role role, const Rule& rule);

/// OK, or PERMISSION_DENIED with what is needed and how to come by it.
grpc::Status allow(const Caller& caller, const Rule& rule);

/// Whether the caller may steer a job of this owner: PERMISSION_DENIED where it is another's and he
/// no operator.
grpc::Status allow_steering(const Caller& caller, uint64_t job, const std::string& owner,
                            bool proven);

/// "submitter".
std::string role_name(v1::Role role);

}  // namespace hyades::coordinator
