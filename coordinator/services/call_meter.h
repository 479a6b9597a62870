#pragma once

#include <memory>
#include <vector>

#include <grpcpp/support/server_interceptor.h>

namespace hyades::coordinator {

class ConnectionGate;
class Meters;

/// Counts every call of our services by method and code, with its time and the bytes of its
/// messages. `meters` and `gate`, which hears of each call that begins and ends, outlive the
/// server.
std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> count_calls(
    Meters& meters, ConnectionGate& gate);

}  // namespace hyades::coordinator
