#include "coordinator/services/call_meter.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstddef>
#include <string>

#include <grpcpp/support/byte_buffer.h>

#include "coordinator/access/address.h"
#include "coordinator/access/audit_log.h"
#include "coordinator/meters/meters.h"
#include "coordinator/operations/operation.h"
#include "coordinator/services/connection_gate.h"

namespace hyades::coordinator {
namespace {

using grpc::experimental::InterceptionHookPoints;
using grpc::experimental::Interceptor;
using grpc::experimental::InterceptorBatchMethods;
using grpc::experimental::ServerRpcInfo;

/// As gRPC writes it: "NOT_FOUND".
std::string name_of(grpc::StatusCode code) {
  std::string name = result_name({code, ""});
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return name;
}

/// "/hyades.v1.Jobs/List" -> "Jobs/List".
std::string short_name(const std::string& method) {
  const size_t dot = method.rfind('.');
  return dot == std::string::npos ? method : method.substr(dot + 1);
}

/// Whether one message answers one. gRPC does not know: to it all calls are streams (RequestCall).
bool is_unary(const std::string& method) {
  return static_cast<bool>(operation_of_method(method).handle);
}

class CallMeter final : public Interceptor {
 public:
  CallMeter(Meters& meters, ConnectionGate& gate, ServerRpcInfo& info)
      : meters_(meters),
        gate_(gate),
        address_(address_of_peer(info.server_context()->peer())),
        method_(short_name(info.method())),
        unary_(is_unary(method_)),
        begun_(std::chrono::steady_clock::now()) {
    gate_.note_begun(address_);
  }

  /// A call that was broken off has no status.
  ~CallMeter() override {
    gate_.note_over(address_, code_ == grpc::StatusCode::CANCELLED);
    meters_.called(method_, name_of(code_).c_str(), unary_,
                   std::chrono::steady_clock::now() - begun_);
  }
  CallMeter(const CallMeter&) = delete;
  CallMeter& operator=(const CallMeter&) = delete;

  void Intercept(InterceptorBatchMethods* batch) override {
    if (batch->QueryInterceptionHookPoint(InterceptionHookPoints::POST_RECV_MESSAGE)) {
      // All our services take bytes (farm/message_bytes.h).
      if (const auto* bytes = static_cast<const grpc::ByteBuffer*>(batch->GetRecvMessage())) {
        if (bytes->Valid()) meters_.call_bytes(method_, bytes->Length(), 0);
      }
    }
    if (batch->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_MESSAGE)) {
      if (const grpc::ByteBuffer* bytes = batch->GetSerializedSendMessage()) {
        if (bytes->Valid()) meters_.call_bytes(method_, 0, bytes->Length());
      }
    }
    if (batch->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_STATUS)) {
      code_ = batch->GetSendStatus().error_code();
    }
    batch->Proceed();
  }

 private:
  Meters& meters_;
  ConnectionGate& gate_;
  const std::string address_;
  const std::string method_;
  const bool unary_;
  const std::chrono::steady_clock::time_point begun_;
  grpc::StatusCode code_ = grpc::StatusCode::CANCELLED;
};

class Factory final : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  Factory(Meters& meters, ConnectionGate& gate) : meters_(meters), gate_(gate) {}
  Interceptor* CreateServerInterceptor(ServerRpcInfo* info) override {
    return new CallMeter(meters_, gate_, *info);  // gRPC deletes it
  }

 private:
  Meters& meters_;
  ConnectionGate& gate_;
};

}  // namespace

std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> count_calls(
    Meters& meters, ConnectionGate& gate) {
  std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> all;
  all.push_back(std::make_unique<Factory>(meters, gate));
  return all;
}

}  // namespace hyades::coordinator
