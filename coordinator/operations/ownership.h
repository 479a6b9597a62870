#pragma once

#include <cstdint>
#include <memory>

#include <grpcpp/support/status.h>

#include "coordinator/access/caller.h"
#include "coordinator/controller/controller.h"

namespace hyades::coordinator {

/// OK where the caller may steer the job: its owner may, and operators. NOT_FOUND, or
/// PERMISSION_DENIED. May wait for the store.
grpc::Status may_steer(Controller& controller, const Caller& caller, uint64_t job);

/// Puts in whose job it will be: the token's name, or, where that is none, the login. Another owner
/// is for operators: PERMISSION_DENIED. `proven`: a token stands for the name, the owner's own or
/// that of an operator; without one it gives nobody any rights.
grpc::Status name_owner(const Caller& caller, v1::SubmitRequest& request, bool& proven);

/// Counts a stream of the caller's for as long as the entry lives; null, with RESOURCE_EXHAUSTED in
/// `refused`, where its owner has as many as he may. Workers have as many as they need.
std::unique_ptr<OwnerConnections::Entry> count_connection(Controller& controller,
                                                          const Caller& caller,
                                                          grpc::Status& refused);

}  // namespace hyades::coordinator
