#pragma once

#include <string>

#include <grpcpp/support/status.h>

#include "coordinator/operations/route.h"
#include "coordinator/web/exchange.h"

namespace hyades::coordinator {

/// Puts into `message` what stands in the path of a request, and in its query what the route takes
/// from there. NOT_FOUND where the path names nothing that can be, INVALID_ARGUMENT where the query
/// holds what cannot be.
grpc::Status read_target(const WebRequest& request, const Route& route, Message& message);

/// Puts what the body of a request (JSON) holds into `message`, as `form` has it. INVALID_ARGUMENT
/// with what was wrong.
grpc::Status read_body(const std::string& body, const BodyForm& form, Message& message);

}  // namespace hyades::coordinator
