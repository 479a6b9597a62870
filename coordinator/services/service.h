#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>

#include <grpcpp/impl/rpc_service_method.h>
#include <grpcpp/impl/service_type.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

#include "coordinator/operations/operation.h"
#include "coordinator/services/admission.h"
#include "coordinator/services/producer.h"
#include "coordinator/services/raw.h"

namespace hyades::coordinator {

/// All methods of all services of the wire, by bytes (raw.h): those that one message answers come
/// from the table of operations; streams are added by hand.
class Service final : public grpc::Service {
 public:
  using Context = grpc::CallbackServerContext;
  using Bytes = grpc::ByteBuffer;

  /// All of it outlives the service.
  Service(Backend at, const Admission& admission, Executors& executors);

  /// A method that answers a Request with a stream. `make` makes it, or says why there is none; it
  /// is guarded and begun here.
  template <class Request>
  using MakeStream = std::function<OutgoingStream*(Context&, Request&&, grpc::Status& refused)>;
  template <class Request>
  void add_reader(const char* method, MakeStream<Request> make) {
    const Rule& rule = operation_of_method(method).rule;
    add_raw_reader(method,
                   [this, &rule, make](Context* context,
                                       const Bytes* asked) -> grpc::ServerWriteReactor<Bytes>* {
                     Caller caller;
                     Request request;
                     grpc::Status status = admission_.check(*context, rule, caller);
                     if (status.ok()) status = parse(*asked, farm::kMaxRequestBytes, request);
                     OutgoingStream* stream =
                         status.ok() ? make(*context, std::move(request), status) : nullptr;
                     if (stream == nullptr) return new Refusal(status);
                     stream->guard(admission_, caller);
                     stream->begin();
                     return stream;
                   });
  }
  /// One that takes a stream, and one of which both sides do: the reactor is told whether its
  /// caller was admitted.
  template <class Reactor>
  using MakeReactor =
      std::function<Reactor*(Context&, const Caller&, const grpc::Status& admitted)>;
  void add_writer(const char* method, const MakeReactor<grpc::ServerReadReactor<Bytes>>& make,
                  const Message& response);
  void add_talker(const char* method,
                  const MakeReactor<grpc::ServerBidiReactor<Bytes, Bytes>>& make);

  Backend& backend() { return at_; }
  Executors& executors() { return executors_; }
  const Admission& admission() const { return admission_; }

 private:
  struct UnaryCall;
  using Method = grpc::internal::RpcMethod;
  void add(const char* method, Method::RpcType type, grpc::internal::MethodHandler* handler);
  void add_raw_reader(
      const char* method,
      std::function<grpc::ServerWriteReactor<Bytes>*(Context*, const Bytes*)> begin);
  grpc::ServerUnaryReactor* begin(const Operation& operation, Context& context, const Bytes& asked,
                                  Bytes& said);
  void proceed(const std::shared_ptr<UnaryCall>& call);

  Backend at_;
  const Admission& admission_;
  Executors& executors_;
  std::deque<std::string> names_;  ///< that gRPC points to
};

// The streams, by subject.
void add_job_streams(Service& service);
void add_asset_streams(Service& service);
void add_audit_stream(Service& service);
void add_worker_stream(Service& service);

}  // namespace hyades::coordinator
