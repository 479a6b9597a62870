#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <string>
#include <utility>

#include <grpcpp/impl/rpc_service_method.h>
#include <grpcpp/impl/service_type.h>
#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

#include "coordinator/operations/operation.h"
#include "coordinator/services/admission.h"
#include "coordinator/services/producer.h"
#include "farm/byte_budget.h"
#include "farm/message_bytes.h"
#include "farm/wire.h"

namespace hyades::coordinator {

/// All methods of all gRPC services. They take bytes (farm/message_bytes.h). Those that one message
/// answers come from the table of operations; streams are added by hand. Nobody's message is taken
/// in before the caller is admitted.
class Service final : public grpc::Service {
 public:
  using Context = grpc::CallbackServerContext;
  using Bytes = grpc::ByteBuffer;

  /// Has the methods of the table. What the arguments refer to outlives the service.
  /// `patience`: with the one message of a call that is admitted, and with who reads its answer.
  /// `waiting`: what much of what waits for its readers is counted in; outlives the service.
  Service(Backend at, const Admission& admission, Executors& executors,
          std::chrono::milliseconds patience, farm::ByteBudget& waiting);

  /// Makes the stream that answers a Request; or null, with the reason in `refused`.
  template <class Request>
  using MakeStream =
      std::function<OutgoingStream*(Context&, const Caller&, Request&&, grpc::Status& refused)>;
  /// Adds a method that answers a Request of an admitted caller with the stream that `make` makes.
  /// The stream ends with the caller's token.
  template <class Request>
  void add_server_stream(const char* method, MakeStream<Request> make) {
    add_raw_server_stream(method, [make](Context& context, const Caller& caller, const Bytes& asked,
                                         grpc::Status& refused) {
      Request request;
      refused = farm::parse(asked, farm::kMaxRequestBytes, request);
      return refused.ok() ? make(context, caller, std::move(request), refused) : nullptr;
    });
  }
  /// Makes the reactor of a call that sends a stream. Where the caller was not admitted, the
  /// reactor ends the call with `admitted`.
  template <class Reactor>
  using MakeReactor =
      std::function<Reactor*(Context&, const Caller&, const grpc::Status& admitted)>;
  /// Adds a method that takes a stream and answers it with `response`, which outlives the service.
  void add_client_stream(const char* method,
                         const MakeReactor<grpc::ServerReadReactor<Bytes>>& make,
                         const Message& response);
  /// Adds a method of which both sides send a stream.
  void add_bidi_stream(const char* method,
                       const MakeReactor<grpc::ServerBidiReactor<Bytes, Bytes>>& make);

  Backend& backend() { return at_; }
  /// The pool on which a stream may wait for the disk, by the method's row.
  farm::ThreadPool& pool_of(const char* method);
  const Admission& admission() const { return admission_; }
  farm::ByteBudget& waiting() { return waiting_; }

 private:
  class UnaryCall;
  class StreamCall;
  using Method = grpc::internal::RpcMethod;
  /// Adds a method that one request begins and a stream answers; `make` gets the request's bytes.
  using MakeRawStream = std::function<OutgoingStream*(Context&, const Caller&, const Bytes& asked,
                                                      grpc::Status& refused)>;
  void add(const char* method, Method::RpcType type, grpc::internal::MethodHandler* handler);
  void add_raw_server_stream(const char* method, const MakeRawStream& make);

  Backend at_;
  const Admission& admission_;
  Executors& executors_;
  const std::chrono::milliseconds patience_;
  farm::ByteBudget& waiting_;
  std::deque<std::string> names_;  ///< of the methods; gRPC keeps pointers to them
};

// Each adds the streams of one subject.
void add_job_streams(Service& service);
void add_film_stream(Service& service);
void add_asset_streams(Service& service);
void add_audit_stream(Service& service);
void add_worker_stream(Service& service);

}  // namespace hyades::coordinator
