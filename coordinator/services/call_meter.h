#pragma once

#include <memory>
#include <vector>

#include <grpcpp/support/server_interceptor.h>

namespace hyades::coordinator {

class Meters;

/// Counts every call of our services by method and code, with its time and the bytes of its
/// messages. `meters` outlives the server.
std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> count_calls(
    Meters& meters);

}  // namespace hyades::coordinator
