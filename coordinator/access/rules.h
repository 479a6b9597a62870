#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <grpcpp/support/status.h>

#include "coordinator/access/caller.h"

namespace hyades::coordinator {

/// Who may do a deed, whichever way he asks for it.
struct Rule {
  const char* deed;    ///< "job.cancel": what refusals call it
  v1::Role least;      ///< of viewer < submitter < operator < admin; unspecified: everybody may
  bool worker;         ///< whether workers may, too
  bool audited;        ///< changes something: each is noted, and who did it (files: upload_note.h)
  const char* method;  ///< of gRPC: "Jobs/Cancel"; empty: none does it
  std::vector<const char*> routes;  ///< of HTTP: "POST /api/v1/jobs/{job}/cancel"
};

/// All of them.
std::span<const Rule> all_rules();

/// The rule of a method of gRPC, or of a route as Router::add has it. What has none is for admins.
const Rule& rule_of_method(std::string_view method);
const Rule& rule_of_route(std::string_view route);

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
