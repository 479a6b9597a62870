#include "coordinator/operations/ownership.h"

#include <climits>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "coordinator/access/rules.h"

namespace hyades::coordinator {

grpc::Status may_steer(Controller& controller, const Caller& caller, uint64_t job) {
  if (steers_all(caller)) return grpc::Status::OK;
  v1::GetJobResponse got;
  if (const grpc::Status known = controller.queries().get(job, INT32_MAX, got); !known.ok())
    return known;
  return allow_steering(caller, job, got.job().owner(), got.job().owner_proven());
}

grpc::Status name_owner(const Caller& caller, v1::SubmitRequest& request, bool& proven) {
  // An operator vouches for the name that they give; where no token is asked for everybody is one.
  proven = !request.owner().empty() ? !caller.token_id.empty() : !caller.name.empty();
  if (request.owner().empty()) {
    request.set_owner(caller.name.empty() ? request.login() : caller.name);
  } else if (request.owner() != caller.name && !steers_all(caller)) {
    return {grpc::StatusCode::PERMISSION_DENIED,
            fmt::format("this token ({}) is that of {}: only an operator submits for others, {} "
                        "here (leave out the owner)",
                        caller.token_id, caller.name, request.owner())};
  }
  return grpc::Status::OK;
}

std::unique_ptr<OwnerConnections::Entry> count_connection(Controller& controller,
                                                          const Caller& caller,
                                                          grpc::Status& refused) {
  const bool works = caller.role == v1::ROLE_WORKER;
  return controller.connections().enter(works ? std::string() : caller.name, refused);
}

}  // namespace hyades::coordinator
