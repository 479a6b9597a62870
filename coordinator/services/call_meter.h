#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <grpcpp/support/server_interceptor.h>

namespace hyades::coordinator {

class Meters;

/// Counts every call of our services by method and code, with its time and the bytes of its
/// messages, and tells `broken` the address (address_text()) of each that was broken off. `meters`
/// outlives the server.
std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> count_calls(
    Meters& meters, std::function<void(const std::string& address)> broken);

}  // namespace hyades::coordinator
